//! Merges the results of all shards of a campaign. Each shard must be given exactly once, in any order.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use raypencil_files::FileError;

use crate::error::CampaignError;
use crate::plan::{Campaign, Shard};
use crate::record::TerrainRecord;
use crate::sealed::refused;
use crate::shard::{ShardResult, read_result};

/// Maximum number of missing shards that a message names.
const MAX_NAMED_SHARDS: usize = 20;

/// Results of a whole campaign.
#[derive(Debug, Clone, PartialEq)]
pub struct Merged {
    /// The campaign.
    pub campaign: Campaign,
    /// Records of all terrains, by their number.
    pub terrains: Vec<TerrainRecord>,
}

/// Reads the results of all shards from `folders` and merges them; `commit` is that of this program, where it is known.
///
/// # Errors
/// Names the file that is damaged, that belongs to another campaign, or that another program has made, the shard that is given twice, or the shards that are
/// missing.
pub fn merge(folders: &[PathBuf], commit: Option<&str>) -> Result<Merged, CampaignError> {
    let files = results_in(folders)?;
    let read = |file: PathBuf| read_result(&file, commit).map(|result| (file, result));
    if let Some(merged) = merge_results(files.into_iter().map(read))? {
        return Ok(merged);
    }
    let given: Vec<String> = folders.iter().map(|folder| folder.display().to_string()).collect();
    Err(CampaignError::Shards {
        found: format!("no result in {}", given.join(", ")),
        expected: "folders with a shard-I-of-N.json, which a finished shard leaves".into(),
    })
}

/// Merges results, each with the name of its file. `None`: there are none.
///
/// # Errors
/// Those of the results, and those of [`merge`].
pub(crate) fn merge_results(
    results: impl Iterator<Item = Result<(PathBuf, (Campaign, ShardResult)), CampaignError>>,
) -> Result<Option<Merged>, CampaignError> {
    let mut campaign: Option<(Campaign, u64, String)> = None;
    let mut shards: BTreeMap<Shard, String> = BTreeMap::new();
    let mut terrains: BTreeMap<u64, TerrainRecord> = BTreeMap::new();
    for result in results {
        let (file, (own, ShardResult { shard, terrains: records })) = result?;
        let name = file.display().to_string();
        let refuse = |found: String, expected: String| refused(&file, found, expected);
        match &campaign {
            None => campaign = Some((own.clone(), shard.count, name.clone())),
            Some((first, count, first_name)) if *first != own || *count != shard.count => {
                let words =
                    |campaign: &Campaign, count: u64| format!("{}, in {count} shards", campaign.words());
                let expected = format!("{}, as in {first_name}", words(first, *count));
                return Err(refuse(words(&own, shard.count), expected));
            }
            Some(_) => {}
        }
        if let Some(other) = shards.insert(shard, name.clone()) {
            let found = format!("shard {} of {} again", shard.index + 1, shard.count);
            return Err(refuse(found, format!("each shard once: it is in {other} too")));
        }
        terrains.extend(records.into_iter().map(|record| (record.terrain, record)));
    }
    let Some((campaign, count, _)) = campaign else { return Ok(None) };
    let mut absent = (0..count).filter(|&index| !shards.contains_key(&Shard { index, count }));
    let first: Vec<String> =
        absent.by_ref().take(MAX_NAMED_SHARDS).map(|index| (index + 1).to_string()).collect();
    if !first.is_empty() {
        let others = absent.count();
        let others = if others > 0 { format!(" and {others} others") } else { String::new() };
        return Err(CampaignError::Shards {
            found: format!("no shard {}{others} of {count}", first.join(", ")),
            expected: "all of them".into(),
        });
    }
    Ok(Some(Merged { campaign, terrains: terrains.into_values().collect() }))
}

/// Paths of the results in the folders, sorted.
fn results_in(folders: &[PathBuf]) -> Result<Vec<PathBuf>, CampaignError> {
    let mut found = Vec::new();
    for folder in folders {
        let refuse = |source| FileError::Io { path: folder.clone(), action: "read", source };
        for entry in std::fs::read_dir(folder).map_err(refuse)? {
            let path = entry.map_err(refuse)?.path();
            if is_result(&path) {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

/// Whether a file is the result of a shard, by its name.
fn is_result(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    name.starts_with("shard-") && name.ends_with(".json")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_told_by_their_names() {
        assert!(is_result(Path::new("a/shard-1-of-2.json")));
        for name in ["a/summary.json", "a/shard-1-of-2.json.part", "shard-1/a", "a/part-shard-1.json"] {
            assert!(!is_result(Path::new(name)), "{name}");
        }
    }
}
