//! Faults planted in the sources of products, one at a time: the table, the outcomes of a run, and the page.
//!
//! [`injected_faults`](crate::injected_faults) asks whether a comparison finds a wrong renderer. It says nothing about
//! code that both renderers and the referee share, or that exists only once: whatever is wrong there, all agree on.
//! Tests alone stand for this code. Each entry of `tests/planted/*.toml` is one mistake in it, as one textual
//! replacement. `just planted-faults` plants one after the other, and runs tests until one fails.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

/// A fault: one textual replacement in a source file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlantedFault {
    /// Name, unique among all faults.
    pub name: String,
    /// Source file, relative to the root of the workspace.
    pub file: String,
    /// Text that is replaced; it occurs exactly once in the file.
    pub find: String,
    /// Text that stands there instead.
    pub replace: String,
    /// One sentence on what is wrong.
    pub wrong: String,
    /// Crates whose tests are asked, one after the other, until one catches the fault.
    pub ask: Vec<String>,
    /// Whether this is a control: a replacement that changes no behaviour, so that no test may fail.
    #[serde(default)]
    pub control: bool,
    /// Whether the tests that were asked missed the fault in the first run, so that one was written for it.
    #[serde(default)]
    pub missed_at_first: bool,
}

/// The contents of one file of the table.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    fault: Vec<PlantedFault>,
}

impl PlantedFault {
    /// The crate that the fault is planted in, by the path of its file; empty if the file is no source of a crate: Rust, the
    /// script of the pages, or the Python package.
    pub fn crate_name(&self) -> &str {
        self.file
            .strip_prefix("crates/")
            .and_then(|rest| rest.split_once('/'))
            .and_then(|(_floor, rest)| rest.split_once('/'))
            .filter(|(_, file)| ["src/", "script/", "python/"].iter().any(|folder| file.starts_with(folder)))
            .map_or("", |(name, _)| name)
    }

    /// The source with the fault in it; `None` unless `find` occurs exactly once.
    ///
    /// ```
    /// use raypencil_tests::planted::PlantedFault;
    ///
    /// let text = |text: &str| text.to_string();
    /// let fault = PlantedFault {
    ///     name: text("half-for-whole"),
    ///     file: text("crates/base/scene/src/beam.rs"),
    ///     find: text("0.5 * fan"),
    ///     replace: text("fan"),
    ///     wrong: text("The whole angle stands for the half."),
    ///     ask: vec![text("scene")],
    ///     control: false,
    ///     missed_at_first: false,
    /// };
    /// assert_eq!(fault.crate_name(), "scene");
    /// assert_eq!(fault.plant("tan(0.5 * fan)").as_deref(), Some("tan(fan)"));
    /// assert_eq!(fault.plant("tan(angle)"), None);
    /// ```
    pub fn plant(&self, source: &str) -> Option<String> {
        let mut places = source.match_indices(&self.find);
        match (places.next(), places.next()) {
            (Some((at, _)), None) => {
                Some([&source[..at], &self.replace, &source[at + self.find.len()..]].concat())
            }
            _ => None,
        }
    }
}

/// All entries of the table in the folder `tests/planted`: the crates in alphabetical order, each with its name as the
/// name of its file.
///
/// # Panics
/// If a file is no such table.
pub fn planted_faults(folder: &Path) -> Vec<(String, PlantedFault)> {
    let mut files: Vec<_> = fs::read_dir(folder)
        .expect("the folder of the table")
        .map(|entry| entry.expect("an entry of the folder").path())
        // A file that begins with a point belongs to an editor or to a tool.
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .filter(|path| path.file_name().is_some_and(|name| !name.to_string_lossy().starts_with('.')))
        .collect();
    files.sort();
    let mut faults = Vec::new();
    for path in files {
        let of = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let text = fs::read_to_string(&path).expect("a file of the table");
        let table: Table =
            toml::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        faults.extend(table.fault.into_iter().map(|fault| (of.clone(), fault)));
    }
    faults
}

/// What the tests made of a fault.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Outcome {
    /// Tests of the crate `asked` failed; their names, in alphabetical order.
    Caught {
        /// Crate whose tests failed.
        asked: String,
        /// Names of the tests that failed.
        tests: Vec<String>,
    },
    /// The tests of all crates that were asked passed.
    NotCaught,
    /// The source does not compile; the first error of the compiler.
    DoesNotCompile(String),
}

/// Outcome of a fault, and what it holds for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Recorded {
    /// The fault as it was planted.
    pub fault: PlantedFault,
    /// Commit of the sources and tests.
    pub commit: String,
    /// What the tests made of it.
    pub outcome: Outcome,
}

/// Outcomes of a run, by the names of the faults.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Outcomes {
    /// Last commit whose tests passed without a fault, for each crate that was asked.
    pub passed_without: BTreeMap<String, String>,
    /// Outcomes.
    pub of: BTreeMap<String, Recorded>,
}

impl Outcomes {
    /// The recorded outcome of a fault, if it still holds at `commit`.
    ///
    /// A fault that was caught stays so: later commits only add tests. All else may change with every commit.
    pub fn holds(&self, fault: &PlantedFault, commit: &str) -> Option<&Outcome> {
        let recorded = self.of.get(&fault.name).filter(|recorded| recorded.fault == *fault)?;
        let lasting = matches!(recorded.outcome, Outcome::Caught { .. }) && !fault.control;
        (lasting || recorded.commit == commit).then_some(&recorded.outcome)
    }
}

const HEAD: &str = "\
# Shared faults

Both renderers and the referee read one scene, so they agree on whatever is wrong before the scene exists. The image
sensor, the rover, its chassis, the records of a drive, the terrain and the files exist only once. No comparison checks this
code: its tests must. This page measures them. Each fault is one mistake that a person could make, planted in the source of a
product by one textual replacement ([`tests/planted`](../../tests/planted)). `just planted-faults` plants one after the
other, runs the tests, and writes this page.

* The tests are the fast unit tests and integration tests of the fault's own crate. If they miss the fault, the tests of
  crates that depend on it are asked, as the table says. Doc tests are not run, and neither are the slowest tests: whole
  drives, and files of any bytes. Faults in the script of the pages are asked of the tests that open pages in a browser, those
  of the Python door of its tests by pytest.
* *Caught by* is the first failing test in alphabetical order, and the number of other tests of the same crate that fail.
  Its crate is named where it is another one. Tests of digests come last, since they only say that something changed: no
  fault is caught by them alone.
* Without a fault all these tests pass; the run checks this first. It also plants *controls*, which change no
  behaviour: they must not be caught.
* The mark *(new)* means that the earlier ones of these tests missed the fault, and that a test was then written for it.
  Tests that are not asked (doc tests, whole drives, tests of the whole workspace) may find some of these faults too.
";

/// The page `docs/evidence/shared-faults.md`.
///
/// # Panics
/// If a fault has no outcome.
pub fn page(faults: &[(String, PlantedFault)], outcomes: &Outcomes) -> String {
    let outcome = |fault: &PlantedFault| &outcomes.of[&fault.name].outcome;
    let table = |control: bool| -> String {
        let rows = faults.iter().filter(|(_, fault)| fault.control == control);
        rows.map(|(of, fault)| {
            let how = how(of, outcome(fault), fault.missed_at_first);
            format!("| `{}` | {of} | {} | {how} |\n", fault.name, fault.wrong)
        })
        .collect()
    };
    let mut text = String::from(HEAD);
    text += "\n## Faults\n\n| fault | crate | what is wrong | caught by |\n| --- | --- | --- | --- |\n";
    text += &table(false);
    text += "\n## Controls\n\n| control | crate | what is changed | caught by |\n| --- | --- | --- | --- |\n";
    text += &table(true);
    text +=
        "\n## Totals\n\n| crate | faults | caught at first | caught now |\n| --- | ---: | ---: | ---: |\n";
    let mut crates: Vec<&str> = faults.iter().map(|(of, _)| of.as_str()).collect();
    crates.dedup();
    let mut all = [0; 3];
    for name in crates {
        let mut counts = [0; 3];
        for (_, fault) in faults.iter().filter(|(of, fault)| of == name && !fault.control) {
            let caught = usize::from(matches!(outcome(fault), Outcome::Caught { .. }));
            counts[0] += 1;
            counts[1] += if fault.missed_at_first { 0 } else { caught };
            counts[2] += caught;
        }
        text += &format!("| {name} | {} | {} | {} |\n", counts[0], counts[1], counts[2]);
        all = std::array::from_fn(|column| all[column] + counts[column]);
    }
    let [count, at_first, now] = all;
    text += &format!("| all | {count} | {at_first} | {now} |\n\nCaught: {now} of {count}.\n");
    text
}

/// Tests that compare bits with those of an earlier day. They notice any change, and cannot tell which is right.
pub const DIGEST_TESTS: [&str; 2] =
    ["the_bits_do_not_depend_on_threads_or_optimisation", "the_bytes_are_these"];

/// The last cell of a row.
fn how(of: &str, outcome: &Outcome, missed_at_first: bool) -> String {
    match outcome {
        Outcome::NotCaught => "**not caught**".to_string(),
        Outcome::DoesNotCompile(error) => format!("**does not compile**: {}", error.replace('|', "/")),
        Outcome::Caught { asked, tests } => {
            let is_digest = |test: &&String| DIGEST_TESTS.iter().any(|digest| test.ends_with(digest));
            let first =
                tests.iter().find(|test| !is_digest(test)).or(tests.first()).map_or("", String::as_str);
            let place = if asked == of { String::new() } else { format!("{asked}: ") };
            let others = match tests.len().saturating_sub(1) {
                0 => String::new(),
                1 => " and 1 other".to_string(),
                count => format!(" and {count} others"),
            };
            let new = if missed_at_first { " (new)" } else { "" };
            format!("{place}`{first}`{others}{new}")
        }
    }
}
