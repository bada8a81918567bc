//! The files of a campaign as bytes, without a folder: for fuzz targets and for tests of hostile records.

use std::path::{Path, PathBuf};

use crate::error::CampaignError;
use crate::merge::{Merged, merge_results};
use crate::plan::Campaign;
use crate::record::TerrainRecord;
use crate::sealed::{sealed_anew, unsealed};
use crate::shard::{ShardResult, checked_record, checked_result};

/// The text of a record or of a result with the digest that its contents have. A digest keeps out damage, not malice: anyone
/// can compute one. `None`: the text is neither.
pub fn sealed(text: &[u8]) -> Option<String> {
    sealed_anew::<TerrainRecord>(text).or_else(|| sealed_anew::<ShardResult>(text))
}

/// What a run that goes on makes of the bytes of a terrain's record. `None`: it runs the terrain again.
///
/// # Errors
/// A record of another campaign.
pub fn record_from_bytes(
    bytes: &[u8],
    file: &Path,
    campaign: &Campaign,
    terrain: u64,
) -> Result<Option<TerrainRecord>, CampaignError> {
    let Ok((own, record, _)) = unsealed(bytes, file) else { return Ok(None) };
    checked_record((own, record), file, campaign, terrain)
}

/// Merges the results of all shards, as [`merge`](crate::merge()) does. Each has the name of its file. `None`: there are none.
///
/// # Errors
/// Those of [`merge`](crate::merge()).
pub fn merge_bytes(
    results: &[(PathBuf, Vec<u8>)],
    commit: Option<&str>,
) -> Result<Option<Merged>, CampaignError> {
    let read = |(file, bytes): &(PathBuf, Vec<u8>)| {
        let (campaign, result, _) = unsealed(bytes, file)?;
        let result = checked_result((campaign, result), file, commit)?;
        Ok((file.clone(), result))
    };
    merge_results(results.iter().map(read))
}
