//! All shards of a campaign as one: in whatever order they are given, each exactly once, none damaged.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::campaign::{Campaign, CampaignError, Shard};
use crate::record::{TerrainRecord, read_sealed};
use crate::shard::ShardResult;

/// The results of a whole campaign.
#[derive(Debug, Clone, PartialEq)]
pub struct Merged {
    /// Which.
    pub campaign: Campaign,
    /// Every terrain, in order.
    pub terrains: Vec<TerrainRecord>,
}

/// Puts the results of all shards together, from the folders that hold them.
///
/// # Errors
/// Names the file that is damaged or of another campaign, the shard that is there twice, or those that are absent.
pub fn merge(folders: &[PathBuf]) -> Result<Merged, CampaignError> {
    let mut campaign: Option<(Campaign, u64, String)> = None;
    let mut shards: BTreeMap<Shard, String> = BTreeMap::new();
    let mut terrains: BTreeMap<u64, TerrainRecord> = BTreeMap::new();
    for file in results_in(folders)? {
        let name = file.display().to_string();
        let (of, ShardResult { shard, terrains: records }) = read_sealed(&file)?;
        let refuse =
            |found: String, expected: String| CampaignError::Record { file: name.clone(), found, expected };
        match &campaign {
            None => campaign = Some((of.clone(), shard.count, name.clone())),
            Some((first, count, first_name)) if *first != of || *count != shard.count => {
                let words = |of: &Campaign, count: u64| {
                    format!(
                        "{} terrains, seed {}, version {}, in {count} shards",
                        of.terrains, of.seed, of.version
                    )
                };
                let expected = format!("{}, as in {first_name}", words(first, *count));
                return Err(refuse(words(&of, shard.count), expected));
            }
            Some(_) => {}
        }
        if let Some(other) = shards.insert(shard, name.clone()) {
            let found = format!("shard {} of {} again", shard.index + 1, shard.count);
            return Err(refuse(found, format!("each shard once: it is in {other} too")));
        }
        let numbers: Vec<u64> = shard.terrains(&of).collect();
        if shard.index >= shard.count || !records.iter().map(|one| one.terrain).eq(numbers) {
            let expected = "exactly the terrains of its shard, in order".to_string();
            return Err(refuse(format!("{} terrains", records.len()), expected));
        }
        terrains.extend(records.into_iter().map(|record| (record.terrain, record)));
    }
    let Some((campaign, count, _)) = campaign else {
        let given: Vec<String> = folders.iter().map(|folder| folder.display().to_string()).collect();
        return Err(CampaignError::Shards {
            found: format!("no result in {}", given.join(", ")),
            expected: "folders with a shard-I-of-N.json, as a campaign leaves when it is finished".into(),
        });
    };
    let absent: Vec<String> = (0..count)
        .filter(|&index| !shards.contains_key(&Shard { index, count }))
        .map(|index| (index + 1).to_string())
        .collect();
    if !absent.is_empty() {
        return Err(CampaignError::Shards {
            found: format!("no shard {} of {count}", absent.join(", ")),
            expected: "all of them".into(),
        });
    }
    Ok(Merged { campaign, terrains: terrains.into_values().collect() })
}

/// The results that the folders hold, by name.
fn results_in(folders: &[PathBuf]) -> Result<Vec<PathBuf>, CampaignError> {
    let mut found = Vec::new();
    for folder in folders {
        let refuse = |source| raypencil_files::FileError::Io { path: folder.clone(), action: "read", source };
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

fn is_result(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    name.starts_with("shard-") && name.ends_with(".json")
}
