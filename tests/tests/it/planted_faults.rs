//! The table of planted faults (`tests/planted`) against the sources, and against `docs/evidence/shared-faults.md`.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::house::crates;
use raypencil_tests::planted::{DIGEST_TESTS, PlantedFault, planted_faults};

/// Crates whose code is shared or exists once.
const CRATES: [&str; 9] =
    ["chassis", "drive", "files", "mesh-io", "rover", "scene", "scene-io", "sensor", "terrain"];

/// Minimum number of faults in all, and in each crate.
const MIN_FAULTS: usize = 40;
const MIN_FAULTS_PER_CRATE: usize = 5;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn faults() -> Vec<(String, PlantedFault)> {
    planted_faults(&Path::new(env!("CARGO_MANIFEST_DIR")).join("planted"))
}

#[test]
fn every_fault_can_be_planted() {
    for (of, fault) in faults() {
        let name = &fault.name;
        assert_eq!(fault.crate_name(), of, "{name} is in the table of its crate");
        let source = fs::read_to_string(root().join(&fault.file)).expect("a source file");
        let wrong = fault.plant(&source);
        let wrong =
            wrong.unwrap_or_else(|| panic!("{name}: `find` must occur exactly once in {}", fault.file));
        assert_ne!(wrong, source, "{name} changes the source");
    }
}

#[test]
fn every_fault_is_a_product_s_and_not_a_test_s() {
    for (_, fault) in faults() {
        let source = fs::read_to_string(root().join(&fault.file)).expect("a source file");
        let tests = source.find("#[cfg(test)]").unwrap_or(source.len());
        let at = source.find(&fault.find).expect("the text to replace");
        assert!(at < tests, "{}: the replaced text is in the tests of {}", fault.name, fault.file);
        let line = source[..at].rsplit('\n').next().unwrap_or_default().trim_start();
        // A fault may begin with a comment, but a doc comment alone is no behaviour.
        assert!(!line.starts_with("///"), "{}: the replaced text is a doc comment", fault.name);
    }
}

#[test]
fn names_are_unique_and_every_entry_is_complete() {
    let faults = faults();
    let names: BTreeSet<&str> = faults.iter().map(|(_, fault)| fault.name.as_str()).collect();
    assert_eq!(names.len(), faults.len(), "two faults have one name");
    let crates = crates();
    for (of, fault) in &faults {
        let name = &fault.name;
        assert!(name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'), "{name}");
        assert!(fault.wrong.ends_with('.') && !fault.wrong.contains(['|', '\n']), "{name}: {}", fault.wrong);
        assert_eq!(fault.ask.first(), Some(of), "{name}: the crate's own tests are asked first");
        for asked in &fault.ask {
            // The tests of the whole workspace, which open pages in a browser, are those of no product.
            assert!(asked == "tests" || crates.contains_key(asked), "{name} asks {asked}");
        }
        assert!(!fault.control || !fault.missed_at_first, "{name}: no test is written for a control");
    }
}

#[test]
fn every_crate_has_faults_and_a_control() {
    let faults = faults();
    let count = |of: &str, control: bool| {
        faults.iter().filter(|(crate_name, fault)| crate_name == of && fault.control == control).count()
    };
    for of in CRATES {
        assert!(count(of, false) >= MIN_FAULTS_PER_CRATE, "{of} has {} faults", count(of, false));
        assert!(count(of, true) >= 1, "{of} has no control");
    }
    let all = faults.iter().filter(|(_, fault)| !fault.control).count();
    assert!(all >= MIN_FAULTS, "{all} faults");
}

#[test]
fn the_page_has_one_row_for_each_entry() {
    let page = fs::read_to_string(root().join("docs/evidence/shared-faults.md"));
    let page = page.expect("the page, as `just planted-faults` writes it");
    let rows: Vec<Vec<&str>> = page
        .lines()
        .filter(|line| line.starts_with("| `"))
        .map(|line| line.trim_matches('|').split(" | ").map(str::trim).collect())
        .collect();
    let mut faults = faults();
    // Controls have a table of their own, the second.
    faults.sort_by_key(|(_, fault)| fault.control);
    let listed: Vec<_> = rows.iter().map(|row| (row[0].trim_matches('`'), row[1], row[2])).collect();
    let expected: Vec<_> =
        faults.iter().map(|(of, fault)| (fault.name.as_str(), of.as_str(), fault.wrong.as_str())).collect();
    assert_eq!(listed, expected, "`just planted-faults` writes the page again");
    for (row, (_, fault)) in rows.iter().zip(&faults) {
        assert_eq!(row.len(), 4, "{row:?}");
        assert_eq!(row[3] == "**not caught**", fault.control, "{row:?}");
        assert!(!row[3].contains("does not compile"), "{row:?}");
        assert!(!DIGEST_TESTS.iter().any(|digest| row[3].contains(digest)), "by a digest alone: {row:?}");
    }
    let count = faults.iter().filter(|(_, fault)| !fault.control).count();
    assert!(page.ends_with(&format!("\nCaught: {count} of {count}.\n")), "all of {count} are caught");
}
