//! Hostile inputs by rule: each is refused, or is a good file after all and is said to be one by its family. All of them are run by
//! `just hostile-inputs`; here every fifth of the older families is, and fewer of the others.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};

use raypencil::campaign::Campaign;
use raypencil_tests::malformed::hostile::{
    Family, bags, calibrations, campaign_records, generators, lists, manifests, meshes, notes, packed_maps,
    patterns, ray_arrays, rays, sealed_campaigns, sealed_sweeps, settings, trajectories,
};
use serde_json::Value;

use super::{assert_all, run, runner};

/// One in so many cases of a large family is run here.
const STRIDE: usize = 61;

/// One in so many cases of an older family is: they are smaller, and each of their cases is another idea.
const SMALL_STRIDE: usize = 5;

fn campaign() -> Value {
    let campaign = Campaign::new(5, 2).of_commit(raypencil_cli::commit());
    serde_json::to_value(campaign).expect("JSON of numbers and texts")
}

/// Runs one in [`SMALL_STRIDE`] of the cases of a family, which has this many; of those that are run, so many are good files.
fn assert_family(family: &Family, cases: usize, good: usize) {
    let found = (family.cases.len(), accepted(family, SMALL_STRIDE));
    assert_eq!(found, (cases, good), "cases, and good files among those that are run");
}

/// Runs one in [`STRIDE`] of the cases of a family, which has this many.
fn assert_some(family: &Family, cases: usize) {
    accepted(family, STRIDE);
    assert_eq!(family.cases.len(), cases);
}

/// Runs one in `stride` cases of a family. Returns how many of them were accepted.
fn accepted(family: &Family, stride: usize) -> usize {
    let names: BTreeSet<&str> = family.cases.iter().map(|case| case.name.as_str()).collect();
    assert_eq!(names.len(), family.cases.len(), "each name once");
    let accepted = AtomicUsize::new(0);
    let some: Vec<_> = family.cases.iter().step_by(stride).cloned().collect();
    assert_all(&some, |case| {
        let (faults, is_accepted) = runner::verdict(family, case, &run(case));
        accepted.fetch_add(usize::from(is_accepted), Ordering::Relaxed);
        faults
    });
    println!("{} of {} cases, {} accepted", some.len(), family.cases.len(), accepted.load(Ordering::Relaxed));
    accepted.into_inner()
}

#[test]
fn hostile_records_of_a_campaign() {
    assert_family(&campaign_records(&campaign()), 639, 9);
}

#[test]
fn hostile_calibrations() {
    assert_family(&calibrations(), 588, 14);
}

#[test]
fn hostile_rays() {
    assert_family(&rays(), 730, 16);
}

#[test]
fn hostile_meshes() {
    assert_family(&meshes(), 1042, 27);
}

#[test]
fn hostile_settings_of_generated_ground() {
    assert_family(&generators(), 738, 4);
}

#[test]
fn changed_bytes_of_sealed_files() {
    // A record has the commit or the digest of the program that made it; a byte in that which is a hostile one already is not replaced
    // by itself.
    for (sealed, cases) in [(sealed_campaigns(&campaign()), 1150..1180), (sealed_sweeps(), 3250..3350)] {
        accepted(&sealed, STRIDE);
        assert!(cases.contains(&sealed.cases.len()), "{}", sealed.cases.len());
    }
}

#[test]
fn changed_bytes_of_packs_and_of_notes() {
    assert_some(&manifests(), 2049);
    assert_some(&packed_maps(), 2791);
    assert_some(&notes(), 849);
}

#[test]
fn changed_bytes_of_patterns_poses_and_bags() {
    assert_some(&patterns(), 1966);
    assert_some(&trajectories(), 515);
    assert_some(&bags(), 2092);
}

#[test]
fn settings_and_lists_take_what_the_guide_says() {
    assert_some(&settings(), 1639);
    assert_some(&lists(), 1600);
}

#[test]
fn arrays_of_rays_that_are_none() {
    assert_some(&ray_arrays(), 687);
}
