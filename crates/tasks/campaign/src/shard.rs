//! Runs the terrains of one shard, one after the other. Each leaves a file, so an interrupted shard can continue.

use std::path::{Component, Path, PathBuf};

use raypencil_files::{
    FileError, Journal, ask_place, create_folder, file_sha256_hex, program_sha256, remove_dir, remove_file,
};
use raypencil_scene_io::InputFile;
use serde::{Deserialize, Serialize};

use crate::error::CampaignError;
use crate::plan::{Campaign, Shard};
use crate::record::TerrainRecord;
use crate::record_check::check_record;
use crate::sealed::{Made, read_sealed, refused, write_sealed};
use crate::terrain::terrain;

/// Maximum size of the record of a terrain, bytes. One has some thousands.
const MAX_RECORD_BYTES: u64 = 1 << 20;

/// Maximum size of the result of a shard, bytes. One of 10,000 terrains has some 60 million.
const MAX_RESULT_BYTES: u64 = 1 << 30;

/// Folders of what terrains leave beside their records.
const LEFT_FOLDERS: [&str; 2] = ["misses", "wrong"];

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
/// that was running. One whose files are not as they were, of the scene or of a program under test, or that another build has
/// made, is run again, and what it left is removed. Scenes with a wrong ray are written to `folder/wrong`, rays that a program
/// under test answers wrongly to `folder/misses`.
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
    for &number in &numbers {
        ask_place(&terrain_file(folder, number))?;
    }
    ask_place(&result)?;
    let mut records = Vec::with_capacity(numbers.len());
    let mut rays = 0;
    for (done, &number) in (1..).zip(&numbers) {
        let file = terrain_file(folder, number);
        let (earlier, made) = earlier_record(&file, campaign, number)?;
        let record = match earlier {
            Some(record) => record,
            None => {
                remove_left(folder, made);
                let journal = Journal::begin(folder).map_err(|error| FileError::io(folder, "read", error))?;
                let record = terrain(campaign, number, Some(folder))?;
                let left = journal.written().into_iter().filter(|(path, _)| is_left(path, number));
                let left = left.map(|(path, sha256)| InputFile { name: path.display().to_string(), sha256 });
                let made = Made { program: program_sha256().to_string(), left: left.collect() };
                write_sealed(&file, campaign, &record, Some(&made))?;
                rays += record.parts.iter().map(|part| part.compared).sum::<u64>();
                record
            }
        };
        records.push(record);
        progress.done(done, numbers.len() as u64, rays);
    }
    write_sealed(&result, campaign, &ShardResult { shard, terrains: records }, None)?;
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
    let (campaign, result, _) = read_sealed(file, MAX_RESULT_BYTES)?;
    checked_result((campaign, result), file, commit)
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

/// The record of an earlier run, and what it was made by. `None`: there is none that is whole and still true, and the terrain
/// must be run again.
///
/// # Errors
/// A record of another campaign.
fn earlier_record(
    file: &Path,
    campaign: &Campaign,
    number: u64,
) -> Result<(Option<TerrainRecord>, Option<Made>), CampaignError> {
    // What cannot be read is replaced: a pipe, a folder without rights, a file of any size.
    let Ok((own, record, made)) = read_sealed(file, MAX_RECORD_BYTES) else { return Ok((None, None)) };
    let record = checked_record((own, record), file, campaign, number)?;
    let is_of_this_program = made.as_ref().is_some_and(|made| made.program == program_sha256());
    Ok((record.filter(|_| is_of_this_program), made))
}

/// Whether a file below the campaign's folder belongs to a terrain.
fn is_left(path: &Path, terrain: u64) -> bool {
    let parts: Vec<Component> = path.components().take(2).collect();
    let [Component::Normal(folder), Component::Normal(name)] = parts.as_slice() else { return false };
    LEFT_FOLDERS.iter().any(|left| *folder == *left)
        && name.to_string_lossy().starts_with(&format!("terrain-{terrain:06}-"))
}

/// Removes what an earlier run of a terrain has left, if it is as it was written.
fn remove_left(folder: &Path, made: Option<Made>) {
    for InputFile { name, sha256 } in made.map(|made| made.left).unwrap_or_default() {
        let name = Path::new(&name);
        let is_below = name.components().all(|part| matches!(part, Component::Normal(_)));
        let file = folder.join(name);
        let is_file = std::fs::symlink_metadata(&file).is_ok_and(|found| found.is_file());
        if is_below
            && is_file
            && LEFT_FOLDERS.iter().any(|left| name.starts_with(left))
            && file_sha256_hex(&file).is_ok_and(|(_, found)| found == sha256)
            && remove_file(&file).is_ok()
        {
            // Its folders too, if that was their last file.
            let inner = file.ancestors().skip(1).take_while(|above| *above != folder);
            inner.take_while(|above| remove_dir(above).is_ok()).for_each(drop);
        }
    }
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
    if !own.is_planned_as(campaign) {
        let expected = format!("one of {}: give another campaign a folder of its own", campaign.words());
        return Err(refused(file, format!("a record of {}", own.words()), expected));
    }
    let is_own = record.terrain == number
        && own.has_same_files(campaign, number)
        && check_record(&record, campaign).is_ok();
    Ok(is_own.then_some(record))
}

#[cfg(test)]
#[path = "../tests/unit/records.rs"]
mod tests;

#[cfg(test)]
#[path = "../tests/unit/left.rs"]
mod left_tests;
