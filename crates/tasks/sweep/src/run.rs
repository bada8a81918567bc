//! Makes the runs of a part of a sweep, and joins the records of all parts.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use raypencil_files::{
    FileError, OutputFolder, ask_place, bytes, create_folder, remove_dir, write_atomically,
};
use raypencil_harness::Contender;
use raypencil_scene_io::{InputFile, SceneInputs};

use crate::error::SweepError;
use crate::plan::{Part, Sweep, Task};
use crate::record::{Outcome, Record, is_made, maps_folder, read_record, record_file, write_record};
use crate::work::Worker;

const PLAN_FILE: &str = "sweep.json";

/// Runs without a record that are counted.
const MAX_MISSING: usize = 10_000;

/// Maximum size of a plan, bytes.
const MAX_PLAN_BYTES: u64 = 1 << 28;

/// Receives the progress of a sweep.
pub trait SweepProgress: Sync {
    /// `done` of the `of` runs are done; `made` of them were made now.
    fn runs(&self, done: u64, of: u64, made: u64);

    /// `done` of the `planned` frames of a drive are done.
    fn frames(&self, done: u64, planned: u64);
}

/// Makes the runs of a part into `folder`, those of one ground one after the other.
///
/// A run whose record is in the folder, whole, is not made again: an interruption loses at most the run that was being
/// made, and a sweep with more values goes on where an earlier one ended. A run that was refused is tried again, and so is
/// one whose files or maps are not as they were, or that another program made.
///
/// # Errors
/// A folder or a file that cannot be written; parameters that make no setting.
pub fn run_part(
    sweep: &Sweep,
    part: Part,
    contenders: &[Contender],
    folder: &Path,
    progress: &dyn SweepProgress,
) -> Result<(), SweepError> {
    create_folder(&folder.join("runs"))?;
    let plan = serde_json::to_string_pretty(sweep).expect("JSON of texts and numbers");
    write_atomically(folder.join(PLAN_FILE), |file| writeln!(file, "{plan}"))?;
    let runs = sweep.order(part);
    for &run in &runs {
        ask_place(&record_file(folder, sweep, run))?;
    }
    let mut worker = Worker::new(sweep, contenders);
    let inputs = SceneInputs::new();
    let mut made = 0;
    for (done, &run) in (1..).zip(&runs) {
        if !is_made(folder, sweep, run, &inputs) {
            let record = worker.run(run, folder, &inputs, &|done, planned| progress.frames(done, planned))?;
            write_record(folder, sweep, run, &record)?;
            made += 1;
        }
        progress.runs(done, runs.len() as u64, made);
    }
    if sweep.task == Task::Render {
        remove_maps_beyond(folder, sweep.runs())?;
    }
    Ok(())
}

/// Removes maps that a larger sweep has left: they would belong to no row of the table.
fn remove_maps_beyond(folder: &Path, runs: u64) -> Result<(), SweepError> {
    let Ok(entries) = std::fs::read_dir(folder.join("maps")) else { return Ok(()) };
    for entry in entries.flatten() {
        let number = entry.file_name().to_str().and_then(|name| name.parse::<u64>().ok());
        let Some(number) = number.filter(|number| *number >= runs) else { continue };
        if entry.file_name().to_str() == maps_folder(number).strip_prefix("maps/")
            && entry.file_type().is_ok_and(|kind| kind.is_dir())
        {
            // What a run has not made stays.
            OutputFolder::begin(&entry.path())?.finish()?;
            let _ = remove_dir(&entry.path());
        }
    }
    Ok(())
}

/// Whether each run of a part has its results in the folder.
pub fn has_part(sweep: &Sweep, part: Part, folder: &Path) -> bool {
    let inputs = SceneInputs::new();
    part.runs(sweep.runs()).all(|run| is_made(folder, sweep, run, &inputs))
}

/// A sweep with the outcomes of all of its runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Finished {
    /// The plan.
    pub sweep: Sweep,
    /// Outcomes by the number of the run.
    pub outcomes: Vec<Outcome>,
}

impl Finished {
    /// Runs that were refused, with the reason.
    pub fn refused(&self) -> impl Iterator<Item = (u64, &str)> {
        (0..).zip(&self.outcomes).filter_map(|(run, outcome)| match outcome {
            Outcome::Refused(why) => Some((run, why.as_str())),
            Outcome::Results(_) => None,
        })
    }

    /// Whether every run was made, and each comparison passed.
    pub fn passes(&self) -> bool {
        self.outcomes.iter().all(Outcome::passes)
    }
}

/// Names of the records in a folder.
fn records_in(folder: &Path) -> Vec<OsString> {
    let entries = std::fs::read_dir(folder.join("runs")).into_iter().flatten();
    entries.flatten().map(|entry| entry.file_name()).collect()
}

/// Joins the records of all runs of a sweep, which are in any of the folders.
///
/// # Errors
/// A folder that is given twice; runs without a record; runs of files of one name whose bytes differ.
pub fn finish(sweep: &Sweep, folders: &[PathBuf]) -> Result<Finished, SweepError> {
    let whole = |folder: &PathBuf| folder.canonicalize().unwrap_or_else(|_| folder.clone());
    for (index, folder) in folders.iter().enumerate() {
        // Whoever gives one twice has forgotten another, or counts its runs twice.
        if folders[..index].iter().any(|earlier| whole(earlier) == whole(folder)) {
            return Err(SweepError::Plan {
                found: format!("{} is given twice", folder.display()),
                expected: "each folder once".into(),
            });
        }
    }
    let mut outcomes = Vec::new();
    let mut missing = Vec::new();
    let there: BTreeSet<OsString> = folders.iter().flat_map(|folder| records_in(folder)).collect();
    // The bytes of each file, and the run that they were first seen in.
    let mut files: BTreeMap<String, (String, u64)> = BTreeMap::new();
    for run in 0..sweep.runs() {
        // A plan may say millions of runs of which there is no record.
        if missing.len() == MAX_MISSING {
            break;
        }
        if !there.contains(record_file(Path::new(""), sweep, run).file_name().unwrap_or_default()) {
            missing.push(run);
            continue;
        }
        let records: Vec<Record> =
            folders.iter().filter_map(|folder| read_record(folder, sweep, run)).collect();
        let with_results = records.iter().position(|record| matches!(record.outcome, Outcome::Results(_)));
        let Some(record) = records.into_iter().nth(with_results.unwrap_or(0)) else {
            missing.push(run);
            continue;
        };
        for InputFile { name, sha256 } in record.inputs {
            let (known, first) = files.entry(name.clone()).or_insert_with(|| (sha256.clone(), run));
            if *known != sha256 {
                return Err(SweepError::Plan {
                    found: format!("{name} is another file for run {run} than for run {first}"),
                    expected: "files that stay as they are for the whole sweep: make its runs again".into(),
                });
            }
        }
        outcomes.push(record.outcome);
    }
    let (Some(first), count) = (missing.first(), missing.len()) else {
        return Ok(Finished { sweep: sweep.clone(), outcomes });
    };
    let more = if count == MAX_MISSING { "or more " } else { "" };
    Err(SweepError::Plan {
        found: format!(
            "{count} {more}of {} runs have no record, the first of them run {first}",
            sweep.runs()
        ),
        expected: "all of them: run the parts that are missing, with the same build".into(),
    })
}

/// Reads the plan of a sweep from its folder.
///
/// # Errors
/// A file that cannot be read, or that is no plan.
pub fn read_plan(folder: &Path) -> Result<Sweep, SweepError> {
    let file = folder.join(PLAN_FILE);
    let text =
        bytes::read_file(&file, MAX_PLAN_BYTES).map_err(|error| FileError::io(&file, "read", error))?;
    plan_from_bytes(&text, &file)
}

/// The same from the contents of a file; `file` is its name in messages.
pub(crate) fn plan_from_bytes(text: &[u8], file: &Path) -> Result<Sweep, SweepError> {
    let refused = |found: String| SweepError::Record {
        file: file.display().to_string(),
        found,
        expected: "the plan of a sweep, as `raypencil sweep` writes it".into(),
    };
    let plan: Sweep = serde_json::from_slice(text).map_err(|error| refused(error.to_string()))?;
    plan.checked().map_err(|error| refused(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_beyond_the_runs_go_by_the_names_that_runs_give_them() {
        let folder = tempfile::tempdir().unwrap();
        let maps = folder.path().join("maps");
        for name in ["000001", "000002", "7", "notes"] {
            std::fs::create_dir_all(maps.join(name)).unwrap();
        }
        std::fs::write(maps.join("000009"), "no folder").unwrap();
        remove_maps_beyond(folder.path(), 2).unwrap();
        let entries = std::fs::read_dir(&maps).unwrap();
        let left: BTreeSet<OsString> = entries.map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left, ["000001", "000009", "7", "notes"].map(OsString::from).into());
    }
}
