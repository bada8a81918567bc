//! Records that a digest seals, with one byte after the other changed: each is refused, but where the JSON says the same as before.

use std::fs;
use std::sync::OnceLock;

use raypencil::harness::contender;
use raypencil::sweep::{Axis, Part, Sweep, SweepProgress, Task, run_part};
use serde_json::Value;
use tempfile::TempDir;

use super::Family;
use super::campaign::sealed_results;
use super::edits::with_each_byte;
use crate::malformed::case::Case;

/// One in so many changes of a result of a campaign is tried, and of a record of a sweep.
const CAMPAIGN_STRIDE: usize = 5;
const SWEEP_STRIDE: usize = 2;

/// What a changed byte is named after if the JSON is the same as before.
const SAME: &str = "same";

/// The files with each byte changed. The names of those that say the same as before end with [`SAME`].
fn changed(text: &[u8], is_same: impl Fn(&Value, &Value) -> bool) -> Vec<(String, Vec<u8>)> {
    let whole: Value = serde_json::from_slice(text).expect("a good file");
    let named = |(name, bytes): (String, Vec<u8>)| {
        let is_same = serde_json::from_slice(&bytes).is_ok_and(|value| is_same(&whole, &value));
        (if is_same { format!("{name}-{SAME}") } else { name }, bytes)
    };
    with_each_byte(text).into_iter().map(named).collect()
}

fn is_good(name: &str) -> bool {
    name.ends_with("unchanged") || name.ends_with(SAME)
}

/// Results of the second half of a campaign, for a program that writes `campaign` into its own.
pub fn sealed_campaigns(campaign: &Value) -> Family {
    let [first, second] = sealed_results(campaign);
    let mut cases = Vec::new();
    for (name, bytes) in changed(second.as_bytes(), |a, b| a == b).into_iter().step_by(CAMPAIGN_STRIDE) {
        let (file, run) = ("b/shard-2-of-2.json", "campaign merge a b -o out");
        let case = Case::of_file(&format!("sealed-campaign-{name}"), "a changed byte", run, file, bytes, "")
            .file("a/shard-1-of-2.json", first.clone());
        cases.push(case.says(&["shard-2-of-2.json"]));
    }
    Family { is_good, ..Family::of(cases) }
}

/// A sweep of one run, as its program has left it.
struct Swept {
    plan: Vec<u8>,
    /// Name of the record, by what decides it.
    name: String,
    record: Vec<u8>,
}

/// Progress that nobody looks at.
struct Nobody;

impl SweepProgress for Nobody {
    fn runs(&self, _: u64, _: u64, _: u64) {}

    fn frames(&self, _: u64, _: u64) {}
}

fn swept() -> &'static Swept {
    static SWEPT: OnceLock<Swept> = OnceLock::new();
    SWEPT.get_or_init(|| {
        let folder = TempDir::new().expect("a folder");
        let sizes = ["camera.width_px=8", "camera.height_px=6", "beam.columns=4", "beam.rows=1"];
        let axes = sizes.map(|text| Axis::parse(text).expect("a key")).to_vec();
        let names = ["scanline", "tracer"];
        let sweep = Sweep::new("pyramids", axes, Task::Validate, names.map(String::from).to_vec(), false);
        let contenders = names.map(|name| contender(name).expect("a renderer"));
        let sweep = sweep.expect("a sweep");
        run_part(&sweep, Part::WHOLE, &contenders, folder.path(), &Nobody).expect("a run");
        let mut records = fs::read_dir(folder.path().join("runs")).expect("records");
        let record = records.next().expect("a record").expect("its name");
        Swept {
            plan: fs::read(folder.path().join("sweep.json")).expect("a plan"),
            name: record.file_name().into_string().expect("hexadecimal digits"),
            record: fs::read(record.path()).expect("a record"),
        }
    })
}

/// Good files as seeds of a fuzz target.
pub(super) fn good() -> Vec<(&'static str, &'static [u8])> {
    vec![("plan", &swept().plan), ("record", &swept().record)]
}

/// The run of a case, beside whose changed file the other one of the sweep lies.
fn merge(name: String, what: &'static str, plan: Vec<u8>, record: Vec<u8>) -> Case {
    let place = format!("a/runs/{}", swept().name);
    Case::new(name, what, "sweep merge a -o out", &[]).file("a/sweep.json", plan).file(&place, record)
}

/// Records and plans of a sweep.
pub fn sealed_sweeps() -> Family {
    let Swept { plan, record, .. } = swept();
    let mut cases = Vec::new();
    for (name, bytes) in changed(record, |a, b| a == b).into_iter().step_by(SWEEP_STRIDE) {
        let case = merge(format!("sealed-sweep-{name}"), "a changed byte of a record", plan.clone(), bytes);
        cases.push(case.says(&["1 of 1 runs have no record"]));
    }
    // A plan's scene is a name for people: its digest decides.
    let is_same = |whole: &Value, value: &Value| {
        let mut value = value.clone();
        let is_text = value.get("scene").is_some_and(Value::is_string);
        if let (true, Some(keys)) = (is_text, value.as_object_mut()) {
            keys.insert("scene".into(), whole["scene"].clone());
        }
        value == *whole
    };
    for (name, bytes) in changed(plan, is_same) {
        cases.push(merge(format!("plan-{name}"), "a changed byte of a plan", bytes, record.clone()));
    }
    Family { is_good, ..Family::of(cases) }
}
