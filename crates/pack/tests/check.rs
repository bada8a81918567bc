//! Checks of candidates: reports for people and programs, and recordings with few channels.

use std::path::{Path, PathBuf};

use raypencil_files::{Limits, Values, read_npy, write_npy};
use raypencil_judge::{Class, GroundTruth, Quantity, Recorded, check};
use raypencil_pack::{Checked, check_json, check_pack, check_screen, write_check};
use raypencil_scanline::Scanline;
use raypencil_scene::{Precision, Renderer, Request, Silent};
use raypencil_tests::schema::{assert_keys_are_closed, schema_faults};
use raypencil_tracer::Tracer;
use serde_json::Value;

const SCHEMA: &str = include_str!("../../../docs/formats/check.schema.json");

fn pack() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/packs/pyramids")
}

/// The pack checked against itself.
fn perfect() -> Checked {
    check_pack(&pack(), &pack(), Some(Precision::F64), &Silent).expect("a pack as it was written")
}

/// A candidate with the faces and ranges of the camera only. One range is wrong by 1 m.
fn partial() -> Checked {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let candidate = folder.path().join("mine");
    std::fs::create_dir_all(candidate.join("camera")).expect("a folder");
    std::fs::copy(pack().join("camera/face.I.npy"), candidate.join("camera/face.I.npy")).expect("a file");
    let array = read_npy(pack().join("camera/range.T.npy"), &Limits::default()).expect("an array");
    let [Values::Reals(ranges)] = array.planes.as_slice() else { panic!("one plane of reals") };
    let mut ranges = ranges.clone();
    let hit = ranges.cells().iter().position(|range| range.is_finite()).expect("a hit");
    ranges.cells_mut()[hit] += 1.0;
    write_npy(candidate.join("camera/range.T.npy"), &[&ranges]).expect("a file");
    check_pack(&pack(), &candidate, None, &Silent).expect("a candidate that keeps to the conventions")
}

/// Compares a report with its snapshot. Version and paths are left out.
fn assert_report(name: &str, text: &str) {
    let text = text.replace(&pack().display().to_string(), "PACK");
    insta::with_settings!({ filters => vec![(r"raypencil \d+\.\d+\.\d+", "raypencil [version]")] }, {
        insta::assert_snapshot!(name, text);
    });
}

#[test]
fn screens_are_as_the_snapshots_show() {
    assert_report("screen_of_a_perfect_candidate", &check_screen(&perfect()));
    assert_report("screen_of_a_partial_candidate", &check_screen(&partial()));
}

#[test]
fn junit_is_as_the_snapshot_shows() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [junit, _] = write_check(&partial(), folder.path()).expect("a writable folder").try_into().unwrap();
    assert_report("junit_of_a_partial_candidate", &std::fs::read_to_string(junit).unwrap());
}

#[test]
fn the_json_keeps_to_its_schema() {
    let schema: Value = serde_json::from_str(SCHEMA).unwrap();
    assert_keys_are_closed(&schema);
    let mut checked = perfect();
    let clean: Value = serde_json::from_str(&check_json(&checked)).unwrap();
    assert_eq!(schema_faults(&schema, &clean), Vec::<String>::new());
    assert_eq!(clean["verdict"], "agrees");
    // A report with a defect and an unknown channel.
    checked.check.sensors[0].by_class[Class::Defect as usize] = 1;
    checked.recorded.unknown.push("camera/mine".into());
    let largest = checked.check.sensors[0]
        .items
        .get(Quantity::Range.into())
        .unwrap()
        .worst_ulps
        .clone()
        .expect("compared");
    checked.check.sensors[0].defects.push(raypencil_judge::Defect {
        place: largest.place,
        item: Quantity::Range.into(),
        what: "off".into(),
    });
    let wrong: Value = serde_json::from_str(&check_json(&checked)).unwrap();
    assert_eq!(schema_faults(&schema, &wrong), Vec::<String>::new());
    assert_eq!(wrong["verdict"], "defects");
}

#[test]
fn classes_add_up_and_a_perfect_candidate_has_no_error() {
    let Checked { check, .. } = perfect();
    assert!(check.passes());
    for sensor in &check.sensors {
        assert_eq!(sensor.compared(), sensor.by_class[Class::Agree as usize]);
        for (item, tally) in sensor.items.iter() {
            assert!(tally.compared() <= sensor.compared(), "{item:?}");
            assert!(tally.others.is_empty(), "{item:?}");
            assert!(
                tally.worst_error.as_ref().is_none_or(|largest| largest.value == 0.0),
                "{item:?}: {tally:?}"
            );
        }
    }
}

#[test]
fn outputs_in_memory_are_judged_in_double_precision() {
    let scene = raypencil_scene_io::load(
        &pack().join("scene.toml").to_string_lossy(),
        &raypencil_scene_io::Overrides::default(),
    )
    .expect("the pack's scene")
    .scene;
    let truth = GroundTruth::certified(&scene, &Silent);
    let renderers: [&dyn Renderer; 2] = [&Scanline::default(), &Tracer::new()];
    for renderer in renderers {
        let output = renderer.render(&scene, &Request::EVERYTHING);
        let mut recorded = Recorded::of_output(renderer.name(), &scene, &output, Precision::F64);
        let found = check(&truth, &recorded, &Silent);
        assert!(found.passes());
        let totals = found.totals();
        let ratio = |quantity: Quantity| {
            let items = totals.iter().filter(|(item, _)| item.quantity == quantity);
            items
                .filter_map(|(_, tally)| tally.worst_ratio.as_ref())
                .fold(0.0, |largest: f64, one| largest.max(one.value))
        };
        for quantity in Quantity::ALL {
            // The derived bounds leave room.
            assert!(ratio(quantity) < 0.5, "{}: {quantity} {}", renderer.name(), ratio(quantity));
        }
        // Without faces the values are judged, and without the pencils' pixels the images.
        for map in &mut recorded.answers.maps {
            map.face = None;
        }
        for light in &mut recorded.answers.light {
            light.returns.pixel = None;
            light.returns.visible = None;
        }
        recorded.storage.retain(|(_, item), _| {
            !matches!(item.quantity, Quantity::Face | Quantity::Pixel | Quantity::Visible)
        });
        let found = check(&truth, &recorded, &Silent);
        assert!(
            found.passes(),
            "{}: {:?}",
            renderer.name(),
            found.sensors.iter().find_map(|s| s.defects.first())
        );
        // An image that lacks a quarter of one pixel's flux is wrong nevertheless.
        let image = recorded.answers.light[0].image.as_mut().unwrap();
        let at = image.cells().iter().position(|flux| *flux > 0.0).unwrap();
        image.cells_mut()[at] *= 0.75;
        assert!(!check(&truth, &recorded, &Silent).passes());
    }
}
