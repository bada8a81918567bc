//! A check as programs read it, and recordings that say little.

use serde_json::Value;
use std::path::{Path, PathBuf};

use raypencil_harness::contender;
use raypencil_judge::{Class, GroundTruth, Quantity, Recorded, check};
use raypencil_pack::{Checked, check_json, check_pack};
use raypencil_scene::{Precision, Request, Silent};
use raypencil_tests::schema::{assert_keys_are_closed, schema_faults};

const SCHEMA: &str = include_str!("../../../docs/formats/check.schema.json");

fn pack() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/packs/pyramids")
}

fn of_itself() -> Checked {
    check_pack(&pack(), &pack(), Some(Precision::F64), &Silent).expect("a pack as it was written")
}

#[test]
fn the_json_keeps_to_its_schema() {
    let schema: Value = serde_json::from_str(SCHEMA).unwrap();
    assert_keys_are_closed(&schema);
    let mut checked = of_itself();
    let clean: Value = serde_json::from_str(&check_json(&checked)).unwrap();
    assert_eq!(schema_faults(&schema, &clean), Vec::<String>::new());
    assert_eq!(clean["verdict"], "agrees");
    // One with a defect and an unknown channel.
    checked.check.sensors[0].by_class[Class::Defect as usize] = 1;
    checked.recorded.unknown.push("camera/mine".into());
    let largest =
        checked.check.sensors[0].items[&Quantity::Range.into()].worst_ulps.clone().expect("compared");
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
fn classes_add_up_and_nothing_of_a_perfect_candidate_is_off() {
    let Checked { check, .. } = of_itself();
    assert!(check.passes());
    for sensor in &check.sensors {
        assert_eq!(sensor.compared(), sensor.by_class[Class::Agree as usize]);
        for (item, tally) in &sensor.items {
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
fn frames_in_memory_are_judged_in_double_precision() {
    let scene = raypencil_scene_io::load(
        &pack().join("scene.toml").to_string_lossy(),
        &raypencil_scene_io::Overrides::default(),
    )
    .expect("the pack's scene")
    .scene;
    let truth = GroundTruth::certified(&scene, &Silent);
    for renderer in ["scanline", "tracer"] {
        let frame = contender(renderer).unwrap().renderer.render(&scene, &Request::EVERYTHING);
        let mut recorded = Recorded::of_output(renderer, &scene, &frame, Precision::F64);
        let found = check(&truth, &recorded, &Silent);
        assert!(found.passes());
        let totals = found.totals();
        let ratio = |quantity: Quantity| {
            let own = totals.iter().filter(|(item, _)| item.quantity == quantity);
            own.filter_map(|(_, tally)| tally.worst_ratio.as_ref())
                .fold(0.0, |most: f64, one| most.max(one.value))
        };
        for quantity in Quantity::ALL {
            // Derived bounds leave room; none is missing.
            assert!(ratio(quantity) < 0.5, "{renderer}: {quantity} {}", ratio(quantity));
        }
        // Without the faces the values tell; without the pencils' pixels the images do.
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
        assert!(found.passes(), "{renderer}: {:?}", found.sensors.iter().find_map(|s| s.defects.first()));
        // An image without one of its pencils is wrong all the same.
        let image = recorded.answers.light[0].image.as_mut().unwrap();
        let at = image.cells().iter().position(|flux| *flux > 0.0).unwrap();
        image.cells_mut()[at] *= 0.75;
        assert!(!check(&truth, &recorded, &Silent).passes());
    }
}
