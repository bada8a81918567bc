//! Each number of a report by its own value. In a small validation most of them are equal, or 0: two that stand in each other's place
//! would not be seen.

use std::time::Duration;

use glam::DVec3;
use raypencil_cast::{Comparison, Questions, RayVerdict, cast, rays_from_bytes};
use raypencil_files::{ArrayData, Limits, Raster, read_exr, write_npy};
use raypencil_harness::{
    Candidate, Estimate, ImageComparison, MapFormat, MonteCarloImage, RadianceComparison, RadianceMap,
    RaySetResult, Validation, Z_TEST_LIMITS, compare_images, compare_radiance, contender, map_arrays, probe,
    scene_json, validate, write_maps_as, write_ray_sets,
};
use raypencil_judge::{GroundTruth, JudgeShare, Largest};
use raypencil_referee::Margin;
use raypencil_report::{number, quantity};
use raypencil_scene::pattern::{Mounting, PatternRays};
use raypencil_scene::{
    CastRay, Image, Maybe, NamedRaySet, Place, Precision, Request, Sampling, Scene, SensorId, Sides, Silent,
    Stage, Triangles,
};
use raypencil_scene_io::Subject;
use raypencil_tests::fixtures;
use serde_json::{Value, json};

use crate::reports::{report_html, summary_json, summary_markdown};

fn summary(validation: &Validation) -> Value {
    serde_json::from_str(&summary_json(validation)).unwrap()
}

const CAMERA: SensorId = SensorId::Camera;

#[test]
fn errors_and_ratios_have_their_own_values_and_rays() {
    let mut validation = fixtures::agreeing();
    let result = &mut validation.pairs[0].sensors[0];
    let items: Vec<_> = result.items.iter().map(|(item, _)| item).collect();
    for item in &items {
        let tally = result.items.entry(*item);
        let at = |value, i| Some(Largest { value, place: Place { sensor: CAMERA, i, j: 3 }, ruling: None });
        (tally.worst_error, tally.worst_ratio) = (at(0.5, 11), at(0.25, 22));
    }
    let summary = summary(&validation);
    for quantity in summary["pairs"][0]["sensors"][0]["quantities"].as_array().unwrap() {
        for (key, value, i) in [("worst_error", 0.5, 11), ("worst_ratio", 0.25, 22)] {
            let worst = &quantity[key];
            assert_eq!([&worst["value"], &worst["i"]], [&json!(value), &json!(i)], "{quantity}");
            assert!(worst["probe"].as_str().unwrap().ends_with(&format!("--pixel {i},3")), "{worst}");
        }
    }
    let text = summary_markdown(&validation);
    let row = text.lines().find(|line| line.contains("| depth |") && line.contains("22,3")).expect("a row");
    let [error, ratio] = ["11,3", "22,3"].map(|place| row.find(place).expect("a place"));
    assert!(error < ratio, "{row}");
}

#[test]
fn what_was_rendered_has_its_sizes_lights_and_times() {
    let mut validation = fixtures::agreeing();
    let flux = |light: f64| Image::filled(48, 40, light);
    validation.rendered[0].output.flux = vec![flux(1.0), flux(2.0)];
    validation.rendered[0].time = Duration::from_millis(2500);
    validation.stages = vec![Stage { name: "walking".into(), time: Duration::from_millis(1500) }];
    let summary = summary(&validation);
    let first = &summary["renderers"][0];
    assert_eq!([&first["flux"], &first["seconds"]], [&json!([1920.0, 3840.0]), &json!(2.5)]);
    assert_eq!(summary["stages"], json!([{ "name": "walking", "seconds": 1.5 }]));
    let sizes: Vec<[&Value; 3]> = first["sensors"]
        .as_array()
        .unwrap()
        .iter()
        .map(|map| ["sensor", "columns", "rows"].map(|key| &map[key]))
        .collect();
    assert_eq!(
        sizes,
        [[&json!("camera"), &json!(48), &json!(40)], [&json!("beam-0"), &json!(64), &json!(4)]]
    );
}

#[test]
fn hits_that_approximations_lose_and_add_are_told_apart() {
    let mut validation = fixtures::approximate();
    let mut causes = 0;
    for sensor in &mut validation.pairs[0].sensors {
        for tally in sensor.approximations.values_mut() {
            (tally.rays, tally.lost, tally.added) = (77, 31, 5);
            causes += 1;
        }
    }
    assert!(causes > 0);
    let summary = summary(&validation);
    for sensor in summary["pairs"][0]["sensors"].as_array().unwrap() {
        for cause in sensor["causes"].as_array().unwrap() {
            assert_eq!(["rays", "lost", "added"].map(|key| &cause[key]), [77, 31, 5], "{cause}");
        }
    }
    let all = validation.approximations();
    let text = summary_markdown(&validation);
    for tally in all.values() {
        let cells = format!("| {} | {} | {} |", tally.rays, tally.lost, tally.added);
        assert!(text.contains(&cells), "{cells}: {text}");
    }
}

#[test]
fn rays_of_a_set_count_by_their_own_class() {
    let square = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let mesh = Triangles::new(square, vec![[0, 1, 2], [0, 2, 3]]).unwrap();
    let text =
        b"0.5,0.25,1,0,0,-1\n0.75,0.25,1,0,0,-1\n0.75,0.5,1,0,0,-1\n5,5,1,0,0,-1\n6,6,1,0,0,-1\n7,7,1,0,0,-1";
    let rays = rays_from_bytes(text, "here".as_ref()).unwrap().rays;
    let answers = cast(&mesh, &rays, Sides::Both, Questions::default(), &Silent);
    let same = |is_tie| RayVerdict::Same { is_tie };
    let rounding = RayVerdict::Rounding { moved: [0.0; 2] };
    let verdicts = vec![same(true), rounding, rounding, same(false), same(false), rounding];
    let comparison = Comparison { verdicts, values: Vec::new(), met: 3, precision: Precision::F64 };
    let mut validation = fixtures::agreeing();
    let before = validation.counts();
    validation.ray_sets =
        vec![RaySetResult { index: 0, name: "head".into(), answers, comparison: Some(comparison) }];
    let after = validation.counts();
    let more = [
        after.agree - before.agree,
        after.tie - before.tie,
        after.rounding - before.rounding,
        after.defects - before.defects,
        after.judged - before.judged,
    ];
    assert_eq!(more, [2, 1, 3, 0, 6]);
    // Those of all sensors, and not of the last one.
    let judged: u64 = validation.pairs[0].sensors.iter().map(|sensor| sensor.judged).sum();
    assert_eq!(before.judged, judged);
    assert!(validation.pairs[0].sensors.iter().all(|sensor| sensor.judged > 0));
}

/// An image of which nothing is off.
fn image() -> ImageComparison {
    ImageComparison {
        integrator: "path".into(),
        beam: 0,
        pixels: 4,
        theirs: [2.0, 0.5],
        ours: [2.0, 0.25],
        z_rms: 0.0,
        z_mean: 0.0,
        z_largest: 0.0,
        at: None,
    }
}

#[test]
fn an_image_passes_below_each_limit_and_fails_above_it() {
    // The limits of docs/theory, once more: a total within 0.1 % and 3 standard errors, z of rms 1.25, mean 0.25, at most 5.
    assert!(image().is_within(&Z_TEST_LIMITS));
    for part in [0.9, 1.1] {
        let wide = |off: f64| ImageComparison { theirs: [2.0 + off, 1e9], ..image() };
        let of_z = |z: f64| ImageComparison { theirs: [2.0 + 1e-6 * z, 1e-6], ours: [2.0, 0.0], ..image() };
        let all = [
            ("total", wide(2.0 * 1e-3 * part)),
            ("total below", wide(-2.0 * 1e-3 * part)),
            ("z of the total", of_z(3.0 * part)),
            ("z of the total below", of_z(-3.0 * part)),
            ("rms", ImageComparison { z_rms: 1.25 * part, ..image() }),
            ("mean", ImageComparison { z_mean: 0.25 * part, ..image() }),
            ("mean below", ImageComparison { z_mean: -0.25 * part, ..image() }),
            ("largest", ImageComparison { z_largest: 5.0 * part, ..image() }),
            ("largest below", ImageComparison { z_largest: -5.0 * part, ..image() }),
        ];
        for (what, image) in all {
            assert_eq!(image.is_within(&Z_TEST_LIMITS), part < 1.0, "{what} at {part} of its limit");
        }
    }
}

#[test]
fn of_pixels_that_are_off_alike_the_first_is_told() {
    let image = |cells: [f64; 4]| Image::from_cells(2, 2, cells.to_vec());
    let of = |mean| Estimate::of_independent_pixels(image(mean), image([1.0; 4]));
    let theirs = MonteCarloImage { integrator: "path".into(), beam: 0, estimate: of([8.0, 9.0, 8.0, 9.0]) };
    let found = compare_images(&theirs, &of([8.0; 4]));
    assert_eq!(found.at.map(|place| (place.i, place.j)), Some((1, 0)));
}

#[test]
fn the_light_of_a_candidate_has_its_numbers_in_their_places() {
    let mut validation = fixtures::with_candidate();
    let report = &mut validation.scoreboard.as_mut().unwrap().candidates[0];
    let at = Some(Place { sensor: CAMERA, i: 7, j: 9 });
    report.images = vec![ImageComparison {
        theirs: [2.0, 0.5],
        ours: [4.0, 0.25],
        z_rms: 1.0,
        z_mean: 0.125,
        z_largest: -3.0,
        at,
        ..image()
    }];
    report.radiance = vec![RadianceComparison {
        sensor: CAMERA,
        beam: 0,
        lit: 11,
        dark: 12,
        shadowed: 13,
        doubtful: 14,
        wrong: 5,
        worst: Some((0.75, Place { sensor: CAMERA, i: 1, j: 2 })),
    }];
    let text = summary_markdown(&validation);
    let total = |value: f64, part: f64| format!("| {} W (1 ± {}) ", number(value), number(part));
    assert!(text.contains(&(total(2.0, 0.25) + &total(4.0, 0.0625))), "{text}");
    let z = format!(
        "| rms {}, mean +{}, largest {} at camera pixel 7,9 ",
        number(1.0),
        number(0.125),
        number(-3.0)
    );
    assert!(text.contains(&z), "{z}: {text}");
    let radiance = format!("| 11 | 12 | 27 | {} at camera pixel 1,2 | 5 |", number(0.75));
    assert!(text.contains(&radiance), "{radiance}: {text}");
    let mine = &summary(&validation)["panel"]["renderers"][2];
    let image = &mine["images"][0];
    for (key, value) in [
        ("total_w", 2.0),
        ("total_error_w", 0.5),
        ("expected_w", 4.0),
        ("expected_error_w", 0.25),
        ("total_relative", -0.5),
        ("z_rms", 1.0),
        ("z_mean", 0.125),
        ("z_largest", -3.0),
    ] {
        assert_eq!(image[key], value, "{key}");
    }
    let radiance = &mine["radiance"][0];
    let keys = ["lit", "dark", "shadowed", "doubtful", "wrong"];
    assert_eq!(keys.map(|key| radiance[key].as_u64()), [11, 12, 13, 14, 5].map(Some));
    assert_eq!(radiance["worst_relative"], 0.75);
}

#[test]
fn a_probe_tells_each_margin_and_each_cosine_by_its_name() {
    let (subject, contenders) = (fixtures::subject(), [contender("tracer").unwrap()]);
    let found = probe(&subject, fixtures::MISS, &contenders, &Silent).unwrap();
    let judge = raypencil_referee::Referee::new(&subject.scene);
    let Place { sensor, i, j } = fixtures::MISS;
    let margins = judge.margins(sensor, i, j).unwrap();
    let both = |margin: &Margin| [margin.lo, margin.hi];
    assert_ne!(both(&margins.face), both(&margins.surface));
    assert_eq!(both(&found.face_margin), both(&margins.face));
    assert_eq!(both(&found.surface_margin), both(&margins.surface));
    let back = found.exact_return.unwrap();
    assert_ne!(back.cos_off_axis, back.cos_view);
    let traced = found.answers[0].back.as_ref().unwrap().back;
    let text = found.to_string();
    let lines: Vec<&str> = text.lines().filter(|line| line.contains("cos(phi)")).collect();
    assert_eq!(lines.len(), 2, "of the exact answer and of the tracer's: {text}");
    for (line, back) in lines.into_iter().zip([back, traced]) {
        let words = format!("cos(phi) {}, cos(theta) {}, ", back.cos_off_axis, back.cos_view);
        assert!(line.contains(&words), "{words}: {line}");
    }
}

#[test]
fn what_is_nothing_in_a_map_is_that_of_its_quantity() {
    let (subject, folder) = (fixtures::subject(), tempfile::tempdir().unwrap());
    let mut output = contender("tracer").unwrap().renderer.render(&subject.scene, &Request::EVERYTHING);
    let returns = &mut output.returns[0];
    for image in [&mut returns.depth, &mut returns.cos_off_axis, &mut returns.cos_view] {
        image.as_mut().unwrap().set(3, 1, Maybe::NONE);
    }
    let map = output.map(SensorId::Beam(0)).unwrap();
    let arrays = map_arrays(map, &output, subject.scene.flux_model());
    let cell = |name: &str| {
        let array = arrays.iter().find(|array| array.name == name).unwrap_or_else(|| panic!("{name}"));
        let ArrayData::F64(numbers) = &array.data else { panic!("{name}") };
        numbers[64 + 3]
    };
    // Of lengths infinity, of all else no number.
    assert_eq!(cell("view.Z"), f64::INFINITY);
    assert!(cell("offAxis.V").is_nan() && cell("emission.V").is_nan());
    // A vector in the colours of viewers: x is red, y green, z blue.
    let of_one = |format| {
        write_maps_as(format, &output, "tracer", &subject, Sampling::Centres, folder.path()).unwrap()
    };
    of_one(MapFormat::ExrEach);
    let normal = read_exr(folder.path().join("camera/N.exr"), &Limits::default()).unwrap();
    let hit = output.map(CAMERA).unwrap().hit(24, 30).expect("a hit");
    let shown = ["R", "G", "B"].map(|name| match &normal.channels[name] {
        Raster::F32(image) => image.at(24, 30),
        Raster::U32(_) => panic!("whole numbers"),
    });
    assert_eq!(shown, hit.normal.to_array().map(|part| part as f32));
    assert_ne!(shown[0], shown[2]);
}

#[test]
fn a_pixel_that_sees_nothing_has_no_radiance_and_not_none_that_is_known() {
    let subject = fixtures::subject();
    let truth = GroundTruth::certified(&subject.scene, &Silent);
    let (i, j) = (0..40)
        .flat_map(|j| (0..48).map(move |i| (i, j)))
        .find(|&(i, j)| truth.hit(Place { sensor: CAMERA, i, j }).is_none())
        .expect("a pixel that sees nothing");
    let compared = |cell: f64| {
        let mut image = Image::filled(48, 40, 0.0);
        image.set(i, j, cell);
        compare_radiance(&truth, &RadianceMap { sensor: CAMERA, beam: 0, image })
    };
    let right = compared(0.0);
    for wrong in [f64::NAN, 1e-300, -1.0] {
        let found = compared(wrong);
        assert_eq!((found.wrong, found.dark), (right.wrong + 1, right.dark - 1), "{wrong}");
    }
}

#[test]
fn each_image_has_the_total_that_is_stated_for_its_beam() {
    let (mut subject, folder) = (fixtures::subject(), tempfile::tempdir().unwrap());
    let scene = &subject.scene;
    let beams = vec![scene.beams()[0], scene.beams()[0]];
    let mesh = scene.mesh().clone();
    subject.scene = Scene::new(mesh, *scene.camera(), beams, scene.atmosphere(), scene.flux_model()).unwrap();
    let camera = folder.path().join("camera");
    std::fs::create_dir(&camera).unwrap();
    for beam in 0..2 {
        for part in ["mean", "error"] {
            let image = Image::filled(48, 40, 1.0_f64);
            write_npy(camera.join(format!("direct.{part}.beam{beam}.npy")), &[&image]).unwrap();
        }
    }
    let ranges = contender("tracer").unwrap().renderer.render(&subject.scene, &Request::MAPS).camera.unwrap();
    let cells =
        ranges.range.unwrap().cells().iter().map(|cell| cell.get().unwrap_or(f64::INFINITY)).collect();
    write_npy(camera.join("range.T.npy"), &[&Image::from_cells(48, 40, cells)]).unwrap();
    let totals = json!([
        { "way": "direct", "beam": 0, "mean": 3.0, "error": 0.5 },
        { "way": "direct", "beam": 1, "mean": 4.0, "error": 0.25 },
    ]);
    let note = json!({ "format": 1, "program": "P 1", "arithmetic": "f64", "totals": totals });
    std::fs::write(folder.path().join("candidate.json"), note.to_string()).unwrap();
    let candidate = Candidate::read(folder.path(), &subject.scene).unwrap();
    let told: Vec<_> = candidate
        .images
        .iter()
        .map(|image| (image.beam, image.estimate.total, image.estimate.total_error))
        .collect();
    assert_eq!(told, [(0, 3.0, 0.5), (1, 4.0, 0.25)]);
}

#[test]
fn a_field_of_view_is_about_its_own_principal_point() {
    let text = "version = 1\n[camera]\nwidth_px = 40\nheight_px = 20\npixel_pitch_um = [1000, 2000]\nfocal_length_mm = 10\n\
                principal_point_px = [10, 8]\n";
    let loaded = raypencil_scene_io::load_text(text, "wide").unwrap();
    // 10 of 40 columns of 1 mm, and 8 of 20 rows of 2 mm, before the axis: tangents of 1 and 3, of 1.6 and 2.4.
    let angle = |tangent: f64| libm::atan(tangent).to_degrees();
    let expected = [angle(1.0) + angle(3.0), angle(1.6) + angle(2.4)];
    let told = &scene_json(&loaded)["camera"]["field_of_view_deg"];
    for (axis, expected) in expected.into_iter().enumerate() {
        let told = told[axis].as_f64().unwrap();
        assert!((told - expected).abs() < 1e-9, "{axis}: {told} {expected}");
    }
}

/// The small subject with a second beam, which has twice the power.
fn two_beams() -> Subject {
    let mut subject = fixtures::subject();
    let scene = &subject.scene;
    let mut bright = scene.beams()[0];
    bright.sensor.power = 2.0;
    let beams = vec![scene.beams()[0], bright];
    subject.scene =
        Scene::new(scene.mesh().clone(), *scene.camera(), beams, scene.atmosphere(), scene.flux_model())
            .unwrap();
    subject
}

fn validated(subject: Subject) -> Validation {
    let contenders = ["scanline", "tracer"].map(|name| contender(name).unwrap());
    validate(subject, &contenders, JudgeShare::default(), &Silent)
}

#[test]
fn the_picture_of_the_light_is_the_sum_over_all_beams() {
    let mut validation = validated(two_beams());
    // Each renderer has light of its own, so that none stands for another.
    for image in &mut validation.rendered[1].output.flux {
        image.cells_mut().iter_mut().for_each(|flux| *flux *= 8.0);
    }
    let page = report_html(&validation);
    let mut brightest: f64 = 0.0;
    for rendered in &validation.rendered {
        let [one, two] = rendered.output.flux.as_slice() else { panic!("two images") };
        let sum: Vec<f64> = one.cells().iter().zip(two.cells()).map(|(one, two)| one + two).collect();
        let lit = sum.iter().filter(|flux| **flux > 0.0).count();
        let note = format!("{} in {lit} pixels", quantity(sum.iter().sum(), "W"));
        assert!(page.contains(&note), "{note}");
        brightest = sum.iter().copied().fold(brightest, f64::max);
    }
    // The scale of the pictures ends at the brightest pixel of all: its marks, `left:36%">1e-8`, stand at their parts of it.
    let bar = page.split("flux, W per pixel").next().unwrap().rsplit("class=\"ramp\"").next().unwrap();
    let mark = bar.split("<span style=\"left:").nth(2).expect("a mark beside that of 0");
    let (percent, rest) = mark.split_once("%\">").unwrap();
    let flux: f64 = rest.split('<').next().unwrap().replace('\u{2212}', "-").parse().unwrap();
    let end = 100.0 * flux / percent.parse::<f64>().unwrap();
    assert!((end - brightest).abs() < 1e-12 * brightest, "{end} is not {brightest}");
}

#[test]
fn each_set_of_rays_has_its_own_answers() {
    let down = |x: f64| CastRay::new(DVec3::new(x, 0.0, 50.0), DVec3::NEG_Z);
    let set = |name: &str, rays: Vec<CastRay>| {
        let pattern = PatternRays {
            shape: vec![rays.len() as u64],
            rays,
            times: None,
            weights: None,
            returns: None,
            elevations_deg: None,
            mounting: Mounting::HERE,
        };
        NamedRaySet::new(name, pattern, Sides::Both).unwrap()
    };
    // One ray down to the ground, and three beside it, one of them into the sky.
    let up = CastRay::new(DVec3::new(3.0, 0.0, 50.0), DVec3::Z);
    let sets = vec![set("one", vec![down(0.0)]), set("three", vec![down(1.0), up, down(2.0)])];
    let mut subject = fixtures::subject();
    subject.scene = subject.scene.with_ray_sets(sets).unwrap();
    let validation = validated(subject.clone());
    let of = |set: &RaySetResult| (set.name.clone(), set.answers.first.len(), set.answers.counts().0);
    let told: Vec<_> = validation.ray_sets.iter().map(of).collect();
    assert_eq!(told, [("one".to_string(), 1, 1), ("three".to_string(), 3, 2)]);
    for renderer in ["tracer", "referee"] {
        let folder = tempfile::tempdir().unwrap();
        let written = write_ray_sets(&subject, renderer, folder.path(), &Silent).unwrap().unwrap();
        let hits: Vec<Value> = written
            .iter()
            .map(|path| {
                serde_json::from_slice::<Value>(&std::fs::read(path).unwrap()).unwrap()["counts"]["hits"]
                    .clone()
            })
            .collect();
        assert_eq!(hits, [1, 2], "{renderer}");
    }
}
