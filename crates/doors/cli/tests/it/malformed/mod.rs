//! Malformed inputs: the command refuses each, in its own process with limited memory and processor time.
#![cfg(unix)]
// CHOICE: Unix only, because a shell sets the limits. The readers are the same on other systems.

mod hostile;
mod runner;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use raypencil_tests::malformed::{Case, all, good, table, tiffs};

use runner::short;

fn run(case: &Case) -> runner::Run {
    runner::run(case, Path::new(env!("CARGO_BIN_EXE_raypencil")))
}

fn faults(case: &Case) -> Vec<String> {
    runner::faults(case, &run(case))
}

/// Runs all cases in parallel, and reports all defects together.
fn assert_all(cases: &[Case], faults: impl Fn(&Case) -> Vec<String> + Sync) {
    let next = AtomicUsize::new(0);
    let found = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(2, usize::from).min(8) {
            scope.spawn(|| {
                while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let faults = faults(case);
                    if !faults.is_empty() {
                        let text = format!("{} ({}):\n  {}", case.name, case.what, faults.join("\n  "));
                        found.lock().expect("the list").push(text);
                    }
                }
            });
        }
    });
    let mut found = found.into_inner().expect("the list");
    found.sort();
    assert!(found.is_empty(), "{} of {} cases:\n\n{}", found.len(), cases.len(), found.join("\n\n"));
}

#[test]
fn every_malformed_file_is_refused() {
    let cases = all();
    let names: BTreeSet<&str> = cases.iter().map(|case| case.name.as_str()).collect();
    assert_eq!(names.len(), cases.len(), "each name once");
    assert!(cases.len() >= 100, "{} cases", cases.len());
    assert_all(&cases, faults);
}

#[test]
fn every_malformed_tiff_is_refused() {
    assert_all(&tiffs(), faults);
}

#[test]
fn good_files_pass_under_the_same_limits() {
    assert_all(&good(), |case| {
        let run = run(case);
        match run.status.and_then(|status| status.code()) {
            // Exit code 1 means that a difference was found.
            Some(0 | 1) if run.message.is_empty() => Vec::new(),
            other => vec![format!("exit code {other:?}"), short(&run.message)],
        }
    });
}

#[test]
fn the_document_lists_every_case() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/evidence/malformed-inputs.md");
    let written = fs::read_to_string(path).unwrap_or_default();
    assert!(
        written == table(),
        "docs/evidence/malformed-inputs.md is not what `just malformed-inputs` writes"
    );
}
