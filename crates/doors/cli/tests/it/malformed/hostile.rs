//! Hostile inputs by rule: each is refused, or is a good file after all and is said to be one by its family.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};

use raypencil::campaign::Campaign;
use raypencil_tests::malformed::hostile::{Family, calibrations, campaign_records, generators, meshes, rays};

use super::{assert_all, faults, run, short};

/// Runs a family, which has this many cases, of which so many are good files.
fn assert_family(family: &Family, cases: usize, good: usize) {
    let names: BTreeSet<&str> = family.cases.iter().map(|case| case.name.as_str()).collect();
    assert_eq!(names.len(), family.cases.len(), "each name once");
    let accepted = AtomicUsize::new(0);
    assert_all(&family.cases, |case| {
        if !(family.is_good)(&case.name) {
            return faults(case);
        }
        accepted.fetch_add(1, Ordering::Relaxed);
        let run = run(case);
        match run.status.and_then(|status| status.code()) {
            // Exit code 1 means that a difference or a fault of a mesh was found.
            Some(0 | 1) if !run.message.contains("panicked") => Vec::new(),
            other => vec![format!("a good file: exit code {other:?}"), short(&run.message)],
        }
    });
    println!("{} cases, {} of them good", family.cases.len(), accepted.load(Ordering::Relaxed));
    assert_eq!(
        (family.cases.len(), accepted.into_inner()),
        (cases, good),
        "cases, and good files among them"
    );
}

#[test]
fn hostile_records_of_a_campaign() {
    let campaign = Campaign::new(5, 2).of_commit(raypencil_cli::commit());
    let campaign = serde_json::to_value(campaign).expect("JSON of numbers and texts");
    assert_family(&campaign_records(&campaign), 639, 29);
}

#[test]
fn hostile_calibrations() {
    assert_family(&calibrations(), 588, 73);
}

#[test]
fn hostile_rays() {
    assert_family(&rays(), 730, 90);
}

#[test]
fn hostile_meshes() {
    assert_family(&meshes(), 1042, 126);
}

#[test]
fn hostile_settings_of_generated_ground() {
    assert_family(&generators(), 738, 25);
}
