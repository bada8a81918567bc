//! Record of a run: a file that says by a digest whether it is whole.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use raypencil_files::{FileError, bytes, hex_digits, sha256, write_atomically};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::plan::Sweep;
use crate::results::Named;

const FORMAT: u32 = 1;

/// Maximum size of a record, bytes. One has some hundred numbers.
const MAX_RECORD_BYTES: u64 = 1 << 20;

/// Most results of a run, of which each becomes a column: a drive has about a hundred.
const MAX_RESULTS: usize = 1000;

/// Most characters of the name of a result.
const MAX_NAME_CHARS: usize = 200;

/// Most characters of a result that is a text, and of a reason.
const MAX_TEXT_CHARS: usize = 4000;

/// What a run gave.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Its results.
    Results(Vec<Named>),
    /// Why it could not be made.
    Refused(String),
}

impl Outcome {
    /// A run that could not be made, with the reason in one line: it becomes a cell of the table.
    pub(crate) fn refused(why: &str) -> Self {
        let plain = why.chars().map(|c| if c.is_control() { ' ' } else { c });
        Self::Refused(plain.take(MAX_TEXT_CHARS).collect())
    }

    /// Whether the run was made, and its comparison passed if it is one.
    pub fn passes(&self) -> bool {
        match self {
            Self::Refused(_) => false,
            Self::Results(results) => {
                results.iter().all(|(name, value)| name != "passes" || *value == Value::Bool(true))
            }
        }
    }
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

/// Whether a run may have given that: whoever writes a record by hand can seal it, too.
fn is_possible(outcome: &Outcome) -> bool {
    let is_text = |text: &str| text.chars().count() <= MAX_TEXT_CHARS && !text.chars().any(char::is_control);
    let results = match outcome {
        Outcome::Results(results) => results,
        Outcome::Refused(why) => return is_text(why),
    };
    let is_name = |name: &str| {
        let allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "_-.".contains(c);
        !name.is_empty() && name.len() <= MAX_NAME_CHARS && name.chars().all(allowed)
    };
    let is_cell = |value: &Value| match value {
        Value::Null | Value::Bool(_) | Value::Number(_) => true,
        Value::String(text) => is_text(text),
        Value::Array(_) | Value::Object(_) => false,
    };
    let names: BTreeSet<&str> = results.iter().map(|(name, _)| name.as_str()).collect();
    // No run is without any result, and none gives two of one name.
    !results.is_empty()
        && results.len() <= MAX_RESULTS
        && names.len() == results.len()
        && results.iter().all(|(name, value)| is_name(name) && is_cell(value))
}

/// Reads a record. `None`: it is not there, damaged, or of another run, and the run must be made again.
pub(crate) fn read_record(folder: &Path, sweep: &Sweep, run: u64) -> Option<Outcome> {
    let text = bytes::read_file(&record_file(folder, sweep, run), MAX_RECORD_BYTES).ok()?;
    let sealed: Sealed = serde_json::from_slice(&text).ok()?;
    let is_whole = sealed.format == FORMAT
        && sealed.run == sweep.identity(run)
        && sealed.sha256 == digest(&sealed.run, &sealed.outcome)
        && is_possible(&sealed.outcome);
    is_whole.then_some(sealed.outcome)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Task;
    use serde_json::json;

    fn read_back(outcome: &Outcome) -> Option<Outcome> {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("runs")).unwrap();
        let sweep = Sweep::new("pyramids", Vec::new(), Task::Render, vec!["scanline".into()], false).unwrap();
        write_record(folder.path(), &sweep, 0, outcome).unwrap();
        read_record(folder.path(), &sweep, 0)
    }

    fn results(results: &[(&str, Value)]) -> Outcome {
        Outcome::Results(results.iter().map(|(name, value)| (name.to_string(), value.clone())).collect())
    }

    #[test]
    fn a_record_is_read_back() {
        for outcome in [
            results(&[
                ("camera.hits", json!(7)),
                ("beam-0.flux_w", json!(0.5)),
                ("share", Value::Null),
                ("goal", json!("met")),
                ("passes", json!(true)),
            ]),
            Outcome::refused(&format!(
                "scene.toml:3:1: unknown key\n\u{1b}[8mKnown keys: {}",
                "é".repeat(9000)
            )),
        ] {
            assert_eq!(read_back(&outcome).as_ref(), Some(&outcome));
        }
    }

    #[test]
    fn what_no_run_gives_is_no_record_although_it_is_sealed() {
        let many: Vec<(String, Value)> = (0..=MAX_RESULTS).map(|k| (format!("k{k}"), json!(k))).collect();
        for outcome in [
            results(&[]),
            results(&[("camera.hits", json!(1)), ("camera.hits", json!(2))]),
            results(&[("", json!(1))]),
            results(&[("\u{1b}[31mhits", json!(1))]),
            results(&[("a,b", json!(1))]),
            results(&[(&"a".repeat(MAX_NAME_CHARS + 1), json!(1))]),
            results(&[("hits", json!([1, 2]))]),
            results(&[("hits", json!({ "of": 1 }))]),
            results(&[("goal", json!("\u{1b}]0;title\u{7}"))]),
            results(&[("goal", json!("a".repeat(MAX_TEXT_CHARS + 1)))]),
            Outcome::Results(many),
            Outcome::Refused("no\nAll runs agree".into()),
            Outcome::Refused("\u{1b}[8mno".into()),
            Outcome::Refused("a".repeat(MAX_TEXT_CHARS + 1)),
        ] {
            assert_eq!(read_back(&outcome), None, "{outcome:?}");
        }
    }
}
