//! Looking hard: many random terrains, every sensor, both renderers, the referee on all that differs.
//!
//! ```text
//! terrain    one terrain: its scenes, rendered, compared, judged -> a record
//! record     what is kept of a terrain, as JSON with a digest of its own
//! shard      the terrains of one shard, one after the other; takes up where it was broken off
//! merge      the records of all shards -> one summary, in whatever order they come
//! summary    for people and for programs
//! ```
//!
//! A terrain is a function of the campaign's seed and its own number alone, so a shard is too.

use serde::{Deserialize, Serialize};

use raypencil_files::{FileError, FolderError};

/// What a campaign is: these numbers give the same result again.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Campaign {
    /// Of everything that is drawn.
    pub seed: u64,
    /// How many terrains.
    pub terrains: u64,
    /// The version that runs it: another may draw other terrains.
    pub version: String,
}

impl Campaign {
    /// A campaign of this version.
    pub fn new(seed: u64, terrains: u64) -> Self {
        Self { seed, terrains, version: env!("CARGO_PKG_VERSION").into() }
    }
}

/// Which part of a campaign: terrains k with k mod `count` = `index`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shard {
    /// From 0.
    pub index: u64,
    /// How many shards there are.
    pub count: u64,
}

impl Shard {
    /// The whole campaign.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// The terrains of the shard.
    pub fn terrains(self, campaign: &Campaign) -> impl Iterator<Item = u64> {
        (self.index..campaign.terrains).step_by(usize::try_from(self.count).unwrap_or(usize::MAX))
    }
}

/// Why a campaign could not go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CampaignError {
    /// The folder.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A file; the message names it.
    #[error(transparent)]
    File(#[from] FileError),
    /// A file of a campaign that is damaged, or of another one.
    #[error("{file}: {found}; expected {expected}")]
    Record {
        /// The file.
        file: String,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// Shards that are no whole campaign together.
    #[error("{found}; expected {expected}")]
    Shards {
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
}
