//! Makes the runs of a part of a sweep, and joins the records of all parts.

use std::path::{Path, PathBuf};

use raypencil_files::{FileError, bytes, create_folder, write_atomically};
use raypencil_harness::Contender;

use crate::error::SweepError;
use crate::plan::{Part, Sweep};
use crate::record::{Outcome, read_record, write_record};
use crate::work::Worker;

const PLAN_FILE: &str = "sweep.json";

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
/// made, and a sweep with more values goes on where an earlier one ended. A run that was refused is tried again.
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
    let mut worker = Worker::new(sweep, contenders);
    let mut made = 0;
    for (done, &run) in (1..).zip(&runs) {
        if !matches!(read_record(folder, sweep, run), Some(Outcome::Results(_))) {
            let outcome = worker.run(run, folder, &|done, planned| progress.frames(done, planned))?;
            write_record(folder, sweep, run, &outcome)?;
            made += 1;
        }
        progress.runs(done, runs.len() as u64, made);
    }
    Ok(())
}

/// Whether each run of a part has its results in the folder.
pub fn has_part(sweep: &Sweep, part: Part, folder: &Path) -> bool {
    part.runs(sweep.runs()).all(|run| matches!(read_record(folder, sweep, run), Some(Outcome::Results(_))))
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

/// Joins the records of all runs of a sweep, which are in any of the folders.
///
/// # Errors
/// Runs without a record.
pub fn finish(sweep: &Sweep, folders: &[PathBuf]) -> Result<Finished, SweepError> {
    let mut outcomes = Vec::new();
    let mut missing = Vec::new();
    for run in 0..sweep.runs() {
        let records: Vec<Outcome> =
            folders.iter().filter_map(|folder| read_record(folder, sweep, run)).collect();
        let with_results = records.iter().position(|outcome| matches!(outcome, Outcome::Results(_)));
        match records.into_iter().nth(with_results.unwrap_or(0)) {
            Some(outcome) => outcomes.push(outcome),
            None => missing.push(run),
        }
    }
    let (Some(first), count) = (missing.first(), missing.len()) else {
        return Ok(Finished { sweep: sweep.clone(), outcomes });
    };
    Err(SweepError::Plan {
        found: format!("{count} of {} runs have no record, the first of them run {first}", sweep.runs()),
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
    let refused = |found: String| SweepError::Record {
        file: file.display().to_string(),
        found,
        expected: "the plan of a sweep, as `raypencil sweep` writes it".into(),
    };
    let plan: Sweep = serde_json::from_slice(&text).map_err(|error| refused(error.to_string()))?;
    plan.checked().map_err(|error| refused(error.to_string()))
}
