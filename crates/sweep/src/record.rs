//! Record of a run: a file that says by a digest whether it is whole.

use std::path::{Path, PathBuf};

use raypencil_files::{FileError, bytes, hex_digits, sha256, write_atomically};
use serde::{Deserialize, Serialize};

use crate::plan::Sweep;
use crate::results::Named;

/// Number of the format.
const FORMAT: u32 = 1;

/// Maximum size of a record, bytes. One has some hundred numbers.
const MAX_RECORD_BYTES: u64 = 1 << 20;

/// What a run gave.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Its results.
    Results(Vec<Named>),
    /// Why it could not be made.
    Refused(String),
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Sealed {
    format: u32,
    /// What decided the results; see [`Sweep::identity`].
    run: String,
    /// SHA-256 of the compact JSON of `(format, run, outcome)`.
    sha256: String,
    outcome: Outcome,
}

fn digest(run: &str, outcome: &Outcome) -> String {
    let text = serde_json::to_string(&(FORMAT, run, outcome)).expect("JSON of numbers and texts");
    hex_digits(&sha256(text.as_bytes()))
}

/// Path of a run's record. Its name is the start of what decides it.
pub(crate) fn record_file(folder: &Path, sweep: &Sweep, run: u64) -> PathBuf {
    folder.join("runs").join(format!("{}.json", &sweep.identity(run)[..32]))
}

/// Writes a record.
pub(crate) fn write_record(
    folder: &Path,
    sweep: &Sweep,
    run: u64,
    outcome: &Outcome,
) -> Result<(), FileError> {
    let identity = sweep.identity(run);
    let sealed = serde_json::json!({
        "format": FORMAT,
        "run": identity,
        "sha256": digest(&identity, outcome),
        "outcome": outcome,
    });
    write_atomically(record_file(folder, sweep, run), |file| writeln!(file, "{sealed}"))
}

/// Reads a record. `None`: it is not there, damaged, or of another run, and the run must be made again.
pub(crate) fn read_record(folder: &Path, sweep: &Sweep, run: u64) -> Option<Outcome> {
    let text = bytes::read_file(&record_file(folder, sweep, run), MAX_RECORD_BYTES).ok()?;
    let sealed: Sealed = serde_json::from_slice(&text).ok()?;
    let is_whole = sealed.format == FORMAT
        && sealed.run == sweep.identity(run)
        && sealed.sha256 == digest(&sealed.run, &sealed.outcome);
    is_whole.then_some(sealed.outcome)
}
