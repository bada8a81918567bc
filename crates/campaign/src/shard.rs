//! The terrains of one shard, one after the other. Each leaves a file; what is there already is not done again.

use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

use crate::campaign::{Campaign, CampaignError, Shard};
use crate::record::{TerrainRecord, read_sealed, write_sealed};
use crate::terrain::terrain;
use raypencil_files::create_folder;

/// Who wants to hear how a campaign goes.
pub trait CampaignProgress: Sync {
    /// So many terrains of the shard are done, and this many rays of them in this run.
    fn done(&self, terrains: u64, of: u64, rays: u64);
}

/// What a finished shard leaves: its terrains, in their order.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ShardResult {
    pub(super) shard: Shard,
    pub(super) terrains: Vec<TerrainRecord>,
}

/// Where a shard's result is.
pub(super) fn result_file(folder: &Path, shard: Shard) -> PathBuf {
    folder.join(format!("shard-{}-of-{}.json", shard.index + 1, shard.count))
}

/// Where a terrain's record is while its shard runs.
fn terrain_file(folder: &Path, terrain: u64) -> PathBuf {
    folder.join("terrains").join(format!("terrain-{terrain:06}.json"))
}

/// Runs a shard into `folder`, and returns where its result is. A terrain whose record is there, whole and of this
/// campaign, is not run again: after an interruption at most the one that was running is lost. Scenes of terrains with
/// a wrong ray are left in `folder/wrong`.
///
/// # Errors
/// A folder that holds another campaign; what the file system says.
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
        let kept = if file.exists() { kept(&file, campaign, number)? } else { None };
        let record = match kept {
            Some(record) => record,
            None => {
                let record = terrain(campaign, number, Some(&folder.join("wrong")))?;
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

/// A record that is there, if it is whole. A damaged one is made again; one of another campaign is refused.
fn kept(file: &Path, campaign: &Campaign, number: u64) -> Result<Option<TerrainRecord>, CampaignError> {
    match read_sealed::<TerrainRecord>(file) {
        Ok((of, record)) if of == *campaign && record.terrain == number => Ok(Some(record)),
        Ok((of, _)) => Err(CampaignError::Record {
            file: file.display().to_string(),
            found: format!("a record of {} terrains, seed {}, version {}", of.terrains, of.seed, of.version),
            expected: format!(
                "one of {} terrains, seed {}, version {}: give another campaign a folder of its own",
                campaign.terrains, campaign.seed, campaign.version
            ),
        }),
        Err(CampaignError::Record { .. }) => Ok(None),
        Err(error) => Err(error),
    }
}
