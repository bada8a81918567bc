//! Many random terrains, both renderers, the referee on all that differs.

mod campaign;
pub mod cases;
mod merge;
mod record;
mod shard;
mod summary;
mod terrain;

pub use campaign::{Campaign, CampaignError, Shard};
pub use merge::{Merged, merge};
pub use record::{PartName, PartRecord, QuantityRecord, TerrainRecord, WorstRecord, WrongRay};
pub use shard::{CampaignProgress, run_shard};
pub use summary::{campaign_json, campaign_screen, write_campaign};
pub use terrain::{scene_of, terrain};
