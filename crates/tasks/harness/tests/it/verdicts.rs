//! What passes and what does not, one reason at a time; and the numbers of reports, each by its name.

use raypencil_cast::{Questions, Stated, cast, compare, rays_from_bytes};
use raypencil_files::write_npy;
use raypencil_harness::{
    Estimate, MonteCarloImage, RaySetResult, Validation, compare_images, contender, expected_images, probe,
    read_sides,
};
use raypencil_judge::{Class, Largest};
use raypencil_pack::Declarations;
use raypencil_referee::{Displacement, Ruling};
use raypencil_scene::{FaceId, Image, Place, Precision, SensorId, Sides, Silent, Triangles};
use raypencil_tests::fixtures;
use serde_json::Value;

use crate::reports::{summary_json, summary_markdown};

fn summary(validation: &Validation) -> Value {
    serde_json::from_str(&summary_json(validation)).unwrap()
}

#[test]
fn a_ray_that_is_wrong_or_undecided_fails_and_a_tie_or_a_rounding_does_not() {
    for (class, passes) in [
        (Class::Agree, true),
        (Class::Tie, true),
        (Class::Rounding, true),
        (Class::Approximation, true),
        (Class::Undecided, false),
        (Class::Defect, false),
    ] {
        for sensor in 0..2 {
            let mut validation = fixtures::agreeing();
            let sensor = &mut validation.pairs[0].sensors[sensor];
            sensor.by_class[Class::Agree as usize] -= 1;
            sensor.by_class[class as usize] += 1;
            assert_eq!((validation.renderers_pass(), validation.passes()), (passes, passes), "{class:?}");
            assert_eq!(summary(&validation)["passes"], passes, "{class:?}");
        }
    }
}

#[test]
fn nothing_compared_is_told_so_whatever_is_missing() {
    let mut validation = fixtures::agreeing();
    for sensor in &mut validation.pairs[0].sensors {
        sensor.not_compared += sensor.by_class.iter().sum::<u64>();
        sensor.by_class = [0; Class::COUNT];
    }
    assert!(!validation.passes());
    assert_eq!(summary(&validation)["verdict"], "nothing_compared");
    assert!(summary_markdown(&validation).starts_with("### ? Nothing was compared"));
}

#[test]
fn a_hit_of_either_renderer_is_something() {
    for renderer in 0..2 {
        let mut validation = fixtures::empty();
        assert!(!validation.hits_something());
        let map = validation.rendered[renderer].output.camera.as_mut().unwrap();
        map.range.as_mut().unwrap().set(3, 4, raypencil_scene::Maybe::some(7.0));
        assert!(validation.hits_something(), "{renderer}");
    }
}

/// A candidate of which nothing is wrong, with an image and a radiance map of which nothing is wrong either.
fn right_candidate() -> Validation {
    let mut validation = fixtures::with_candidate();
    let report = &mut validation.scoreboard.as_mut().unwrap().candidates[0];
    for sensor in &mut report.check.sensors {
        sensor.by_class[Class::Agree as usize] +=
            std::mem::take(&mut sensor.by_class[Class::Defect as usize]);
    }
    report.radiance[0].wrong = 0;
    let expected = expected_images(&validation.subject.scene, 4, &Silent);
    let image = MonteCarloImage { integrator: "direct".into(), beam: 0, estimate: expected[0].clone() };
    report.images = vec![compare_images(&image, &expected[0])];
    validation
}

#[test]
fn each_fault_of_a_candidate_alone_fails() {
    assert!(right_candidate().passes());
    type Fault = fn(&mut raypencil_harness::CandidateReport);
    let faults: [(&str, Fault); 5] = [
        ("a wrong ray", |report| report.check.sensors[0].by_class[Class::Defect as usize] = 1),
        ("an undecided ray", |report| report.check.sensors[1].by_class[Class::Undecided as usize] = 1),
        ("a wrong ray of radiance", |report| report.radiance[0].wrong = 1),
        ("an image that is too bright", |report| report.images[0].theirs[0] *= 1.01),
        ("nothing is compared", |report| {
            report.check.sensors.iter_mut().for_each(|sensor| sensor.by_class = [0; Class::COUNT]);
        }),
    ];
    for (words, fault) in faults {
        let mut validation = right_candidate();
        fault(&mut validation.scoreboard.as_mut().unwrap().candidates[0]);
        assert!(validation.renderers_pass() && !validation.passes(), "{words}");
        assert_eq!(summary(&validation)["verdict"], "candidates_wrong", "{words}");
    }
}

#[test]
fn the_classes_of_rays_and_sets_of_rays_are_all_rays() {
    let square = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let mesh = Triangles::new(square, vec![[0, 1, 2], [0, 2, 3]]).unwrap();
    // Two on the diagonal, one beside it, one that misses; the last is stated wrongly.
    let text = b"0.5,0.5,1,0,0,-1\n0.25,0.25,1,0,0,-1\n0.75,0.5,1,0,0,-1\n5,5,1,0,0,-1\n0.75,0.25,1,0,0,-1";
    let rays = rays_from_bytes(text, "here".as_ref()).unwrap().rays;
    let mut stated = Stated::of(&cast(&mesh, &rays, Sides::Both, Questions::default(), &Silent));
    stated.face.as_mut().unwrap()[4] = Some(FaceId(1));
    let comparison = compare(&mesh, &rays, Sides::Both, &stated, Precision::F64, &Silent);
    let answers = cast(&mesh, &rays, Sides::Both, Questions::default(), &Silent);
    let mut validation = fixtures::agreeing();
    let before = validation.counts();
    let name = "head".to_string();
    validation.ray_sets = vec![RaySetResult { index: 0, name, answers, comparison: Some(comparison) }];
    let counts = validation.counts();
    let of_set = [counts.agree - before.agree, counts.tie - before.tie, counts.defects - before.defects];
    assert_eq!((of_set, counts.compared - before.compared), ([2, 2, 1], 5));
    let classes =
        [counts.agree, counts.tie, counts.rounding, counts.approximation, counts.undecided, counts.defects];
    assert_eq!(classes.iter().sum::<u64>(), counts.compared);
    assert!(!validation.passes());
}

#[test]
fn of_equal_errors_the_first_is_told() {
    let mut validation = fixtures::agreeing();
    let mut number = 0;
    for result in &mut validation.pairs[0].sensors {
        let sensor = result.sensor;
        let items: Vec<_> = result.items.iter().map(|(item, _)| item).collect();
        for item in items {
            let place = Place { sensor, i: number, j: 0 };
            result.items.entry(item).worst_ratio = Some(Largest { value: 0.25, place, ruling: None });
            number += 1;
        }
    }
    let text = summary_markdown(&validation);
    let (_, told) =
        text.split_once("The largest error is 25.0 % of its bound, in ").expect("the largest error");
    let (_, place) = told.split_once(" at ").expect("its place");
    let first = validation.pairs[0].sensors.iter().flat_map(|result| result.items.iter());
    let first = first
        .filter(|(_, tally)| tally.of(Class::Agree) > 0)
        .find_map(|(_, tally)| tally.worst_ratio.clone());
    assert!(place.starts_with(&format!("{}.", first.expect("a tally").place)), "{place}");
}

#[test]
fn the_numbers_of_a_probe_have_their_names() {
    let subject = fixtures::subject();
    let contenders = ["scanline", "tracer"].map(|name| contender(name).unwrap());
    let mut probe = probe(&subject, fixtures::MISS, &contenders, &Silent).unwrap();
    let back = probe.answers[1].back.as_mut().expect("a return");
    back.ruling.visible = Ruling::Wrong;
    back.ruling.pixel = Ruling::Rounding(Displacement { dx: 0.5, dy: 0.25 });
    let json = probe.to_json();
    let mut hits = vec![(&json["exact"]["hit"], probe.exact)];
    hits.extend((0..2).map(|k| (&json["answers"][k]["hit"], probe.answers[k].hit)));
    for (json, hit) in hits {
        let hit = hit.expect("a hit");
        assert_ne!(hit.range, hit.depth);
        assert_eq!(
            [&json["range_m"], &json["depth_m"], &json["incidence_cosine"]],
            [hit.range, hit.depth, hit.cos_incidence]
        );
        assert_eq!(json["face"], hit.face.0);
        assert_eq!(
            [&json["point_m"], &json["normal"]],
            [&serde_json::json!(hit.point.to_array()), &serde_json::json!(hit.normal.to_array())]
        );
    }
    let back = probe.exact_return.expect("a return");
    let json_back = &json["exact"]["return"];
    assert_eq!(
        [
            &json_back["camera_depth_m"],
            &json_back["off_axis_cosine"],
            &json_back["emission_cosine"],
            &json_back["flux"]
        ],
        [back.depth, back.cos_off_axis, back.cos_view, back.flux]
    );
    let ruled = &json["answers"][1]["return"];
    assert_eq!(ruled["visible_ruling"], "wrong");
    assert!(ruled["pixel_ruling"].as_str().unwrap().starts_with("rounding: "), "{ruled}");
    let margins = probe.visibility_margins.as_ref().expect("margins of a pencil");
    for (key, margin) in [
        ("face_margin", &probe.face_margin),
        ("surface_margin", &probe.surface_margin),
        ("visibility_margin", &margins.visibility),
    ] {
        assert_eq!(json["exact"][key]["cells"], serde_json::json!([margin.lo, margin.hi]), "{key}");
    }
}

#[test]
fn variances_of_independent_pixels_add_up() {
    let image = |cells: [f64; 4]| Image::from_cells(2, 2, cells.to_vec());
    let estimate = Estimate::of_independent_pixels(image([1.0, 2.0, 3.0, 4.0]), image([2.0, 4.0, 5.0, 6.0]));
    // 4 + 16 + 25 + 36 = 81.
    assert_eq!((estimate.total, estimate.total_error), (10.0, 9.0));
}

#[test]
fn a_scale_concerns_whichever_side_has_whole_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let sides = ["reals", "wholes", "other"].map(|name| folder.path().join(name));
    for side in &sides {
        std::fs::create_dir_all(side.join("camera")).unwrap();
    }
    for side in [&sides[0], &sides[2]] {
        write_npy(side.join("camera/range.T.npy"), &[&Image::filled(2, 1, 1.5_f64)]).unwrap();
    }
    write_npy(sides[1].join("camera/range.T.npy"), &[&Image::filled(2, 1, 1500_u32)]).unwrap();
    let declared = Declarations { scale: Some(0.001), ..Declarations::default() };
    let read = |a: usize, b: usize| read_sides([&sides[a], &sides[b]], &declared, &Silent);
    for [a, b] in [[0, 1], [1, 0]] {
        for side in read(a, b).unwrap() {
            let values = &side.channels.by_key["camera/range.T"].values;
            assert!((values.real(0) - 1.5).abs() < 1e-12, "{}", side.path.display());
        }
    }
    // Where neither has, it was declared in vain.
    assert!(read(0, 2).is_err());
}

#[test]
fn places_of_both_sensors_are_probed_by_their_own_names() {
    let subject = fixtures::subject();
    let contenders = [contender("tracer").unwrap()];
    for (place, name) in
        [(fixtures::MISS, "beam-0"), (Place { sensor: SensorId::Camera, i: 5, j: 30 }, "camera")]
    {
        let json = probe(&subject, place, &contenders, &Silent).unwrap().to_json();
        assert_eq!((&json["sensor"], &json["cell"]), (&name.into(), &serde_json::json!([place.i, place.j])));
    }
}
