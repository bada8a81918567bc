//! A program under test that answers all, a part or nothing, and what the record says of it.

use raypencil_harness::{contender, write_maps};
use raypencil_judge::Class;
use raypencil_scene::{RenderOutput, Request, Sampling};
use raypencil_tests::fixtures::subject;

use super::*;

/// What the tracer answers to the rays of the small scene.
fn answers() -> RenderOutput {
    contender("tracer").unwrap().renderer.render(&subject().scene, &Request::EVERYTHING)
}

/// The record of a program whose answers are these files of a recording of `output`, and which ends with `code`.
fn hunted(output: &RenderOutput, files: &[&str], partial: bool, code: u8) -> PartRecord {
    let (folder, subject) = (tempfile::tempdir().unwrap(), subject());
    write_maps(output, "tracer", &subject, Sampling::Centres, folder.path()).unwrap();
    let copies = files
        .iter()
        .map(|file| format!("cp {} {{out}}/;", quoted(&folder.path().join(file).to_string_lossy())));
    let command = format!(
        "test -d {{pack}} && test -d {{out}}; {} echo the end >&2; exit {code}",
        copies.collect::<String>()
    );
    let campaign = Campaign { partial, ..Campaign::new(5, 1).hunting(&command).unwrap() };
    hunt(&campaign, &command, PartName::Own, &subject, None).unwrap()
}

const BOTH: [&str; 2] = ["camera.exr", "beam-0.exr"];

#[test]
fn a_program_that_answers_all_has_an_answer_to_every_ray() {
    let record = hunted(&answers(), &BOTH, false, 0);
    assert_eq!((record.failed, record.not_compared, record.compared), (None, 0, 48 * 40 + 64 * 4));
    assert_eq!(record.by_class[Class::Defect as usize] + record.by_class[Class::Undecided as usize], 0);
    assert!(record.hits > 1000 && record.hits < record.compared, "{}", record.hits);
}

#[test]
fn a_program_that_is_silent_on_a_sensor_fails_whatever_it_may_leave_out() {
    for partial in [false, true] {
        for (answered, silent) in [(BOTH[0], "beam-0"), (BOTH[1], "camera")] {
            let record = hunted(&answers(), &[answered], partial, 0);
            let failed = record.failed.expect("a reason");
            // Its rays count as not compared.
            let rays = if silent == "camera" { 48 * 40 } else { 64 * 4 };
            assert_eq!(record.not_compared, rays, "{partial} {silent}");
            assert!(failed.starts_with(&format!("it answers no ray of {silent}, ")), "{partial}: {failed}");
        }
        assert!(hunted(&answers(), &[], partial, 0).failed.is_some(), "{partial}");
    }
}

#[test]
fn a_program_that_says_of_no_ray_what_it_hits_fails_unless_it_may() {
    let mut cosines = answers();
    for map in cosines.camera.iter_mut().chain(&mut cosines.beams) {
        (map.face, map.range, map.depth, map.point) = (None, None, None, None);
    }
    cosines.returns.clear();
    cosines.flux.clear();
    let failed = hunted(&cosines, &BOTH, false, 0).failed.expect("a reason");
    assert!(failed.starts_with("it says of no ray of camera, beam-0 what it hits, "), "{failed}");
    let allowed = hunted(&cosines, &BOTH, true, 0);
    assert_eq!(allowed.failed, None);
    assert!(allowed.compared > 1000, "{}", allowed.compared);
}

#[test]
fn a_program_that_ends_badly_fails_with_its_last_words() {
    let failed = hunted(&answers(), &BOTH, false, 3);
    assert_eq!(failed.compared, 0);
    let why = failed.failed.expect("a reason");
    assert!(why.contains('3') && why.ends_with(": the end"), "{why}");
}

#[test]
fn the_last_words_are_those_of_the_last_line_that_has_some() {
    let command = "printf 'first\\n  why  \\n   \\n\\n' >&2; : {pack} {out}; exit 3";
    let campaign = Campaign::new(5, 1).hunting(command).unwrap();
    let record = hunt(&campaign, command, PartName::Own, &subject(), None).unwrap();
    let why = record.failed.expect("a reason");
    assert!(why.ends_with(": why"), "{why}");
}

#[test]
fn a_program_that_takes_too_long_is_told_its_time_in_seconds() {
    let command = "sleep 30; : {pack} {out}";
    let campaign = Campaign { candidate_ms: Some(250), ..Campaign::new(5, 1).hunting(command).unwrap() };
    let record = hunt(&campaign, command, PartName::Own, &subject(), None).unwrap();
    assert_eq!(record.failed.as_deref(), Some("it ran for more than 0.25 s"));
}

/// It would fail in each scene: nothing is hunted.
#[test]
fn what_is_no_program_ends_a_campaign() {
    let folder = tempfile::tempdir().unwrap();
    let plain = folder.path().join("plain");
    std::fs::write(&plain, "no program").unwrap();
    for program in [quoted(&plain.to_string_lossy()), "no-such-program-anywhere".into()] {
        let command = format!("{program} {{pack}} {{out}}");
        let campaign = Campaign::new(5, 1).hunting(&command).unwrap();
        let error = hunt(&campaign, &command, PartName::Own, &subject(), None).expect_err("an error");
        assert!(error.to_string().contains("expected a program that can be run"), "{error}");
    }
}
