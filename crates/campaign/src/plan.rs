//! The plan of a campaign: its terrains, and the shards that they are divided into.
//!
//! A terrain depends only on the campaign's seed and its own number, so a shard can run anywhere and at any time.

use serde::{Deserialize, Serialize};

/// A campaign. Equal campaigns give equal results, byte for byte.
///
/// ```
/// use raypencil_campaign::{Campaign, Shard};
///
/// let campaign = Campaign::new(5, 10);
/// // Shard k of n has the terrains whose number is k modulo n.
/// let second_of_four = Shard { index: 1, count: 4 };
/// assert_eq!(second_of_four.terrains(&campaign).collect::<Vec<_>>(), [1, 5, 9]);
/// assert_eq!(Shard::WHOLE.terrains(&campaign).count(), 10);
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Campaign {
    /// Seed of all random numbers.
    pub seed: u64,
    /// Number of terrains.
    pub terrains: u64,
    /// Version of raypencil. Another version may make other terrains.
    pub version: String,
}

impl Campaign {
    /// A campaign run by this version.
    pub fn new(seed: u64, terrains: u64) -> Self {
        Self { seed, terrains, version: env!("CARGO_PKG_VERSION").into() }
    }
}

/// Part of a campaign: the terrains k with k mod `count` = `index`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shard {
    /// Index of the shard, from 0.
    pub index: u64,
    /// Number of shards.
    pub count: u64,
}

impl Shard {
    /// The whole campaign as one shard.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// Numbers of the shard's terrains, ascending.
    pub fn terrains(self, campaign: &Campaign) -> impl Iterator<Item = u64> {
        (self.index..campaign.terrains).step_by(usize::try_from(self.count).unwrap_or(usize::MAX))
    }
}
