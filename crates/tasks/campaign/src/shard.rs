//! Runs the terrains of one shard, one after the other. Each leaves a file, so an interrupted shard can continue.

use std::path::{Path, PathBuf};

use raypencil_files::create_folder;
use serde::{Deserialize, Serialize};

use crate::error::CampaignError;
use crate::plan::{Campaign, Shard};
use crate::record::TerrainRecord;
use crate::record_check::check_record;
use crate::sealed::{read_sealed, refused, write_sealed};
use crate::terrain::terrain;

/// Maximum size of the record of a terrain, bytes. One has some thousands.
const MAX_RECORD_BYTES: u64 = 1 << 20;

/// Maximum size of the result of a shard, bytes. One of 10,000 terrains has some 60 million.
const MAX_RESULT_BYTES: u64 = 1 << 30;

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
/// A folder that holds another campaign; a file that cannot be written; a shard that is none, or a campaign with too many
/// terrains.
pub fn run_shard(
    campaign: &Campaign,
    shard: Shard,
    folder: &Path,
    progress: &dyn CampaignProgress,
) -> Result<PathBuf, CampaignError> {
    let refuse = |(found, expected)| CampaignError::Shards { found, expected };
    campaign.clone().checked(campaign.commit.as_deref()).map_err(refuse)?;
    shard.checked().map_err(refuse)?;
    create_folder(&folder.join("terrains"))?;
    let result = result_file(folder, shard);
    let numbers: Vec<u64> = shard.terrains(campaign).collect();
    let mut records = Vec::with_capacity(numbers.len());
    let mut rays = 0;
    for (done, &number) in (1..).zip(&numbers) {
        let file = terrain_file(folder, number);
        let record = match earlier_record(&file, campaign, number)? {
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
    read_result(&result_file(folder, shard), campaign.commit.as_deref()).is_ok_and(is_own)
}

/// Reads the result of a shard that a program of this commit has made.
///
/// # Errors
/// A file that cannot be read; a record that no such shard can have.
pub(crate) fn read_result(
    file: &Path,
    commit: Option<&str>,
) -> Result<(Campaign, ShardResult), CampaignError> {
    checked_result(read_sealed(file, MAX_RESULT_BYTES)?, file, commit)
}

/// The result, if a shard of a program of this commit can have it.
///
/// # Errors
/// A record that no such shard can have.
pub(crate) fn checked_result(
    (campaign, result): (Campaign, ShardResult),
    file: &Path,
    commit: Option<&str>,
) -> Result<(Campaign, ShardResult), CampaignError> {
    let refuse = |(found, expected)| refused(file, found, expected);
    let campaign = campaign.checked(commit).map_err(refuse)?;
    let shard = result.shard.checked().map_err(refuse)?;
    if !result.terrains.iter().map(|one| one.terrain).eq(shard.terrains(&campaign)) {
        let expected = "exactly the terrains of its shard, by their number".to_string();
        return Err(refuse((format!("{} terrains", result.terrains.len()), expected)));
    }
    for record in &result.terrains {
        check_record(record, &campaign)
            .map_err(|found| refuse((found, "counts that fit together".to_string())))?;
    }
    Ok((campaign, result))
}

/// The record of an earlier run. `None`: there is none, or it is damaged, and the terrain must be run again.
///
/// # Errors
/// A record of another campaign.
fn earlier_record(
    file: &Path,
    campaign: &Campaign,
    number: u64,
) -> Result<Option<TerrainRecord>, CampaignError> {
    // What cannot be read is replaced: a pipe, a folder without rights, a file of any size.
    let Ok(read) = read_sealed(file, MAX_RECORD_BYTES) else { return Ok(None) };
    checked_record(read, file, campaign, number)
}

/// The record, if it is that of this terrain. `None`: the terrain must be run again.
///
/// # Errors
/// A record of another campaign.
pub(crate) fn checked_record(
    (own, record): (Campaign, TerrainRecord),
    file: &Path,
    campaign: &Campaign,
    number: u64,
) -> Result<Option<TerrainRecord>, CampaignError> {
    if own != *campaign {
        let expected = format!("one of {}: give another campaign a folder of its own", campaign.words());
        return Err(refused(file, format!("a record of {}", own.words()), expected));
    }
    let is_own = record.terrain == number && check_record(&record, campaign).is_ok();
    Ok(is_own.then_some(record))
}

#[cfg(test)]
#[path = "../tests/unit/records.rs"]
mod tests;
