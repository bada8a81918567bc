//! Runs the terrains of one shard, one after the other. Each leaves a file, so an interrupted shard can continue.

use std::path::{Path, PathBuf};

use raypencil_files::create_folder;
use serde::{Deserialize, Serialize};

use crate::error::CampaignError;
use crate::plan::{Campaign, Shard};
use crate::record::TerrainRecord;
use crate::sealed::{read_sealed, write_sealed};
use crate::terrain::terrain;

/// Receives the progress of a campaign.
pub trait CampaignProgress: Sync {
    /// `terrains` of the shard's `of` terrains are done, with `rays` rays compared in this run.
    fn done(&self, terrains: u64, of: u64, rays: u64);
}

/// Result of a finished shard: the records of its terrains, by their number.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ShardResult {
    pub(crate) shard: Shard,
    pub(crate) terrains: Vec<TerrainRecord>,
}

/// Path of a shard's result.
fn result_file(folder: &Path, shard: Shard) -> PathBuf {
    folder.join(format!("shard-{}-of-{}.json", shard.index + 1, shard.count))
}

/// Path of a terrain's record while its shard runs.
fn terrain_file(folder: &Path, terrain: u64) -> PathBuf {
    folder.join("terrains").join(format!("terrain-{terrain:06}.json"))
}

/// Runs a shard into `folder`, and returns the path of its result.
///
/// A terrain whose record is in the folder, undamaged, is not run again. So an interruption loses at most the terrain
/// that was running. Scenes with a wrong ray are written to `folder/wrong`, rays that a program under test answers wrongly to
/// `folder/misses`.
///
/// # Errors
/// A folder that holds another campaign; a file that cannot be read or written.
pub fn run_shard(
    campaign: &Campaign,
    shard: Shard,
    folder: &Path,
    progress: &dyn CampaignProgress,
) -> Result<PathBuf, CampaignError> {
    create_folder(&folder.join("terrains"))?;
    let result = result_file(folder, shard);
    let numbers: Vec<u64> = shard.terrains(campaign).collect();
    let mut records = Vec::with_capacity(numbers.len());
    let mut rays = 0;
    for (done, &number) in (1..).zip(&numbers) {
        let file = terrain_file(folder, number);
        let earlier = if file.exists() { earlier_record(&file, campaign, number)? } else { None };
        let record = match earlier {
            Some(record) => record,
            None => {
                let record = terrain(campaign, number, Some(folder))?;
                write_sealed(&file, campaign, &record)?;
                rays += record.parts.iter().map(|part| part.compared).sum::<u64>();
                record
            }
        };
        records.push(record);
        progress.done(done, numbers.len() as u64, rays);
    }
    write_sealed(&result, campaign, &ShardResult { shard, terrains: records })?;
    Ok(result)
}

/// Whether the result of a shard is in the folder, whole, and of this campaign.
pub fn has_result(campaign: &Campaign, shard: Shard, folder: &Path) -> bool {
    let is_own = |(own, result): (Campaign, ShardResult)| own == *campaign && result.shard == shard;
    read_sealed(&result_file(folder, shard)).is_ok_and(is_own)
}

/// The record of an earlier run. `None`: it is damaged, and the terrain must be run again.
///
/// # Errors
/// A record of another campaign; a file that cannot be read.
fn earlier_record(
    file: &Path,
    campaign: &Campaign,
    number: u64,
) -> Result<Option<TerrainRecord>, CampaignError> {
    match read_sealed::<TerrainRecord>(file) {
        Ok((own, record)) if own == *campaign && record.terrain == number => Ok(Some(record)),
        Ok((own, _)) => Err(CampaignError::Record {
            file: file.display().to_string(),
            found: format!("a record of {}", own.words()),
            expected: format!("one of {}: give another campaign a folder of its own", campaign.words()),
        }),
        Err(CampaignError::Record { .. }) => Ok(None),
        Err(error) => Err(error),
    }
}
