//! Commands on a disk that fails, or that die while they write. All operations are walked through by the example `folder_faults`;
//! here some of each command are.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use tempfile::TempDir;

use crate::folder_walk::{Fault, WALKED, Walked, run_until, walk};

/// Tells the test's own process, started again, where to leave what it found: commands print, and a test's process has others.
const CHILD: &str = "RAYPENCIL_FOLDER_FAULTS";

/// The commands that are walked through here, by their words: those that write a folder, and take no time.
const SOME: [&str; 7] = [
    "SCENE -o OUT",
    "SCENE --with tracer --format exr-each -o OUT",
    "SCENE --set camera.pitch_down_deg=30,40 --do render -o OUT",
    "MESH RAYS --any -o OUT",
    "SCENE --no-bench -o OUT",
    "PACK MINE -o OUT",
    "MESH --rays RAYS -o OUT",
];

/// How many operations of each command are walked through.
const OPERATIONS: usize = 2;

#[test]
fn no_fault_of_the_disk_and_no_death_loses_or_leaves_anything() {
    if let Some(report) = std::env::var_os(CHILD) {
        let folder = TempDir::new().unwrap();
        let tree = folder.path().canonicalize().unwrap().join("tree");
        let run = |tree: &Path, words: &[String], fault: Fault| run_until(tree, words, fault, &|| ());
        let mut text = String::new();
        for (number, walked) in WALKED.iter().filter(|walked| SOME.contains(&walked.words)).enumerate() {
            // Charts take longer than all else.
            let words = if walked.name == "sweep" {
                walked.words.replace("30,40", "30")
            } else {
                walked.words.into()
            };
            let walked = Walked { words: &words, ..*walked };
            // Other ones for each command: of its beginning, of its end.
            let some = |count: usize| {
                (0..OPERATIONS).map(|part| ((2 * part + 1) * count / 4 + number) % count).collect()
            };
            let figures = walk(&walked, &tree, &run, &some);
            assert!(
                figures.operations > 10 && figures.states == 2 * OPERATIONS,
                "{}: {figures:?}",
                walked.name
            );
            text.extend(figures.broken.iter().map(|line| format!("{line}\n")));
        }
        fs::write(report, text + "done").unwrap();
        return;
    }
    let folder = TempDir::new().unwrap();
    let report = folder.path().join("report");
    let mut child = Command::new(std::env::current_exe().unwrap());
    child.args([
        "--exact",
        "command::folder_faults::no_fault_of_the_disk_and_no_death_loses_or_leaves_anything",
    ]);
    child.args(["--nocapture", "--test-threads=1"]).env(CHILD, &report);
    let output = child.stdin(Stdio::null()).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    let report = fs::read_to_string(report).unwrap_or_default();
    assert!(output.status.success() && report == "done", "{report}\n{said}");
}
