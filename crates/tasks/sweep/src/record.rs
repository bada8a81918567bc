//! Record of a run: a file that says by a digest whether it is whole, and by others whether it is still that of its run.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use raypencil_files::{
    FileError, bytes, file_sha256_hex, hex_digits, program_sha256, sha256, write_atomically,
};
use raypencil_scene_io::{InputFile, SceneInputs};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::formula::is_formula;
use crate::plan::{Sweep, Task};
use crate::results::Named;

const FORMAT: u32 = 2;

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

/// A run as it was made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Record {
    /// SHA-256 of the program that made it.
    pub program: String,
    /// The files that decided it.
    pub inputs: Vec<InputFile>,
    /// Files that it left, by their path in the folder of the sweep.
    pub left: Vec<InputFile>,
    /// What it gave.
    pub outcome: Outcome,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Sealed {
    format: u32,
    /// What the plan decides of the results; see [`Sweep::identity`].
    run: String,
    /// SHA-256 of the compact JSON of `(format, run, record)`.
    sha256: String,
    record: Record,
}

fn digest(run: &str, record: &Record) -> String {
    let text = serde_json::to_string(&(FORMAT, run, record)).expect("JSON of numbers and texts");
    hex_digits(&sha256(text.as_bytes()))
}

/// The folder of a run's maps, in that of its sweep.
pub(crate) fn maps_folder(run: u64) -> String {
    format!("maps/{run:06}")
}

/// Path of a run's record. Its name is the start of what decides it.
pub(crate) fn record_file(folder: &Path, sweep: &Sweep, run: u64) -> PathBuf {
    folder.join("runs").join(format!("{}.json", &sweep.identity(run)[..32]))
}

pub(crate) fn write_record(folder: &Path, sweep: &Sweep, run: u64, record: &Record) -> Result<(), FileError> {
    let identity = sweep.identity(run);
    let sealed = serde_json::json!({
        "format": FORMAT,
        "run": identity,
        "sha256": digest(&identity, record),
        "record": record,
    });
    write_atomically(record_file(folder, sweep, run), |file| writeln!(file, "{sealed}"))
}

/// Whether a result is a part of a whole, by its name.
fn is_share(name: &str) -> bool {
    name.ends_with("_share")
}

/// Whether a result counts rays, pencils or pixels, by its name.
fn is_count(name: &str) -> bool {
    let of_classes = [
        "compared",
        "agree",
        "tie",
        "rounding",
        "approximation",
        "undecided",
        "defects",
        "not_compared",
        "judged",
    ];
    of_classes.contains(&name) || [".hits", ".visible", ".lit_pixels"].iter().any(|end| name.ends_with(end))
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
    // `run` and `refused` are columns of their own.
    let is_name = |name: &str| is_name(name) && !["run", "refused"].contains(&name);
    let is_cell = |name: &str, value: &Value| match value {
        Value::Null | Value::Bool(_) => true,
        Value::Number(number) if is_share(name) => {
            number.as_f64().is_some_and(|one| (0.0..=1.0).contains(&one))
        }
        Value::Number(number) if is_count(name) => number.is_u64(),
        Value::Number(_) => true,
        Value::String(text) => is_text(text) && !is_formula(text),
        Value::Array(_) | Value::Object(_) => false,
    };
    let names: BTreeSet<&str> = results.iter().map(|(name, _)| name.as_str()).collect();
    // No run is without any result, and none gives two of one name.
    !results.is_empty()
        && results.len() <= MAX_RESULTS
        && names.len() == results.len()
        && results.iter().all(|(name, value)| is_name(name) && is_cell(name, value))
}

/// Whether the folder has the results of a run, made by this program of files that are as they are now, and what it left.
pub(crate) fn is_made(folder: &Path, sweep: &Sweep, run: u64, inputs: &SceneInputs) -> bool {
    let Some(record) = read_record(folder, sweep, run) else { return false };
    let now = || {
        let settings = sweep.settings(run).ok()?;
        inputs.of(&sweep.scene, &settings).ok()
    };
    let is_there = |left: &InputFile| {
        let file = file_sha256_hex(&folder.join(&left.name));
        file.is_ok_and(|(_, sha256)| sha256 == left.sha256)
    };
    // Maps lie by the number of the run, which may have been another.
    let maps = maps_folder(run);
    matches!(record.outcome, Outcome::Results(_))
        && record.program == program_sha256()
        && now().is_some_and(|now| now == record.inputs)
        && (sweep.task != Task::Render || !record.left.is_empty())
        && record.left.iter().all(|left| Path::new(&left.name).starts_with(&maps) && is_there(left))
}

/// Reads a record. `None`: it is not there, damaged, or of another run, and the run must be made again.
pub(crate) fn read_record(folder: &Path, sweep: &Sweep, run: u64) -> Option<Record> {
    from_bytes(&bytes::read_file(&record_file(folder, sweep, run), MAX_RECORD_BYTES).ok()?, sweep, run)
}

/// The same from the contents of a file.
pub(crate) fn from_bytes(text: &[u8], sweep: &Sweep, run: u64) -> Option<Record> {
    let sealed: Sealed = serde_json::from_slice(text).ok()?;
    let is_whole = sealed.format == FORMAT
        && sealed.run == sweep.identity(run)
        && sealed.sha256 == digest(&sealed.run, &sealed.record)
        && is_possible(&sealed.record.outcome);
    is_whole.then_some(sealed.record)
}

/// The text of a record with the digest of what it holds; `None` if it is no record of any run.
pub(crate) fn sealed(text: &[u8]) -> Option<String> {
    let mut sealed: Sealed = serde_json::from_slice(text).ok()?;
    sealed.sha256 = digest(&sealed.run, &sealed.record);
    serde_json::to_string(&sealed).ok()
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
        let record = Record { program: "a".into(), inputs: vec![], left: vec![], outcome: outcome.clone() };
        write_record(folder.path(), &sweep, 0, &record).unwrap();
        read_record(folder.path(), &sweep, 0).map(|record| record.outcome)
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
                ("truth.found_share", json!(1.0)),
                ("whereto.x_m", json!(-3.5)),
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
    fn a_changed_record_is_taken_once_it_is_sealed_anew() {
        use crate::records::{outcome_from_bytes, sealed};
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("runs")).unwrap();
        let sweep = Sweep::new("pyramids", Vec::new(), Task::Render, vec!["scanline".into()], false).unwrap();
        let outcome = |hits: u64| results(&[("camera.hits", json!(hits))]);
        let record = Record { program: "a".into(), inputs: vec![], left: vec![], outcome: outcome(4711) };
        write_record(folder.path(), &sweep, 0, &record).unwrap();
        let text = std::fs::read_to_string(record_file(folder.path(), &sweep, 0)).unwrap();
        let read = |text: &str| outcome_from_bytes(text.as_bytes(), &sweep, 0);
        assert_eq!(read(&text), Some(outcome(4711)));
        let changed = text.replace("4711", "4712");
        assert_eq!(read(&changed), None);
        assert_eq!(read(&sealed(changed.as_bytes()).unwrap()), Some(outcome(4712)));
        assert_eq!(sealed(b"{}"), None);
    }

    #[test]
    fn what_a_run_may_just_give_is_taken() {
        let most: Vec<(String, Value)> = (0..MAX_RESULTS).map(|k| (format!("k{k}"), json!(k))).collect();
        for outcome in [
            Outcome::Results(most),
            results(&[(&"a".repeat(MAX_NAME_CHARS), json!(1))]),
            // Characters, of two bytes each.
            results(&[("goal", json!("\u{e9}".repeat(MAX_TEXT_CHARS)))]),
            Outcome::Refused("\u{e9}".repeat(MAX_TEXT_CHARS)),
            results(&[("a_share", json!(0.0)), ("b_share", json!(1.0)), ("c_share", json!(1))]),
        ] {
            assert_eq!(read_back(&outcome).as_ref(), Some(&outcome));
        }
        // Each count is one by the end of its name, too.
        for name in ["camera.hits", "beam-0.visible", "beam-0.lit_pixels", "judged", "not_compared"] {
            for value in [json!(-1), json!(0.5)] {
                assert_eq!(read_back(&results(&[(name, value)])), None, "{name}");
            }
        }
    }

    #[test]
    fn a_record_of_another_program_or_of_other_bytes_is_not_that_of_the_run() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        std::fs::create_dir(folder.join("runs")).unwrap();
        std::fs::write(folder.join("scene.toml"), "version = 1\n").unwrap();
        let scene = folder.join("scene.toml").display().to_string();
        let sweep = Sweep::new(&scene, Vec::new(), Task::Drive, vec!["scanline".into()], false).unwrap();
        let record = Record {
            program: program_sha256().into(),
            inputs: SceneInputs::new().of(&scene, &[]).unwrap(),
            left: Vec::new(),
            outcome: results(&[("frames", json!(7))]),
        };
        let other = "0".repeat(64);
        let is_made = |sweep: &Sweep, change: &dyn Fn(&mut Record)| {
            let mut record = record.clone();
            change(&mut record);
            write_record(folder, sweep, 0, &record).unwrap();
            is_made(folder, sweep, 0, &SceneInputs::new())
        };
        let file = |name: &str| InputFile { name: name.into(), sha256: other.clone() };
        assert!(is_made(&sweep, &|_| {}));
        assert!(!is_made(&sweep, &|record| record.program = other.clone()));
        assert!(!is_made(&sweep, &|record| record.inputs[0].sha256 = other.clone()));
        assert!(!is_made(&sweep, &|record| record.inputs.push(file("g.obj"))));
        assert!(!is_made(&sweep, &|record| record.inputs.clear()));
        assert!(!is_made(&sweep, &|record| record.left.push(file("maps/000000/camera.exr"))));
        assert!(!is_made(&sweep, &|record| record.outcome = Outcome::refused("no")));
        // A map that is there, and lies where run 1 has its own.
        let maps = folder.join("maps/000001");
        std::fs::create_dir_all(&maps).unwrap();
        std::fs::write(maps.join("camera.exr"), "").unwrap();
        let (_, sha256) = file_sha256_hex(&maps.join("camera.exr")).unwrap();
        let of_another = InputFile { name: "maps/000001/camera.exr".into(), sha256 };
        assert!(!is_made(&sweep, &|record| record.left.push(of_another.clone())));
        // Whoever renders leaves maps.
        let render = Sweep { task: Task::Render, ..sweep };
        assert!(!is_made(&render, &|_| {}));
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
            results(&[("run", json!(1))]),
            results(&[("refused", json!("no"))]),
            results(&[("goal", json!("=cmd|' /C calc'!A0"))]),
            results(&[("camera.hits", json!(-1))]),
            results(&[("camera.hits", json!(0.5))]),
            results(&[("defects", json!(-3))]),
            results(&[("beam-0.visible_share", json!(1.5))]),
            results(&[("truth.found_share", json!(-0.1))]),
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
