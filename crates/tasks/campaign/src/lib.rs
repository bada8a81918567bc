//! Campaigns: both renderers on many random terrains, and the referee's ruling on every ray on which they differ.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! A terrain depends only on the campaign's seed and its own number. So a campaign can be divided into shards, which
//! run anywhere, can be interrupted, and are merged into one summary. `docs/guide/campaign.md` is the user's guide; the
//! classes of rays are those of `raypencil-judge`.
//!
//! ```text
//! plan, error        campaign and shards; errors
//! record -> sealed   the record of a terrain; files with a digest of their content
//! record_check       whether a record that was read can be that of a terrain
//! cases/             test scenes, which property tests use, too
//! scenes             the scenes of a terrain
//! terrain -> shard   runs one terrain; runs the terrains of a shard
//! merge -> totals    the records of all shards; counts and worst errors over them
//! records            the same files as bytes, for fuzz targets
//! summary -> document     what programs read; all of it as one document, which every report prints
//! ```
//!
//! ```
//! use raypencil_campaign::{Campaign, Shard};
//!
//! // Ten terrains in four shards: each terrain is in exactly one shard.
//! let campaign = Campaign::new(5, 10);
//! let shards = (0..4).map(|index| Shard { index, count: 4 });
//! let mut terrains: Vec<u64> = shards.flat_map(|shard| shard.terrains(&campaign)).collect();
//! terrains.sort();
//! assert_eq!(terrains, (0..10).collect::<Vec<_>>());
//! ```

mod candidate;
mod candidate_process;
pub mod cases;
mod document;
mod error;
mod folder;
mod merge;
mod own_scenes;
mod plan;
mod reasons;
mod record;
mod record_check;
pub mod records;
mod scenes;
mod sealed;
mod shard;
mod summary;
mod terrain;
mod totals;

pub use document::campaign_document;
pub use error::CampaignError;
pub use folder::write_campaign;
pub use merge::{Merged, merge};
pub use own_scenes::OwnScenes;
pub use plan::{Campaign, MAX_SHARDS, MAX_TERRAINS, Shard};
pub use record::{PartName, PartRecord, QuantityRecord, ReasonRecord, TerrainRecord, WorstRecord, WrongRay};
pub use scenes::scene_of;
pub use shard::{CampaignProgress, has_result, run_shard};
pub use terrain::terrain;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_campaign;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
