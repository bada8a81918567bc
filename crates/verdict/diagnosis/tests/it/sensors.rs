//! Reasons sensor by sensor: each mistake in one of them, beside another one in another, and what must have no reason.

use std::sync::Arc;

use raypencil_diagnosis::Mistake;
use raypencil_judge::{Quantity, Recorded};
use raypencil_referee::ExactRenderer;
use raypencil_scene::{Camera, Maybe, Mounted, Precision, Renderer, Request, Scene, SensorId, SensorMap};

use super::candidates::*;
use super::one::as_single;
use super::wrong_renderers::wrong::Wrong;
use super::wrong_renderers::{MISTAKES, Make, Random};

const CAMERA: SensorId = SensorId::Camera;
const BEAM: SensorId = SensorId::Beam(1);

/// Mistakes in the camera, and the key by which each is told.
const TABLE: [(&str, &str); 34] = [
    ("last row lost", "lines_lost"),
    ("last row 0", "lines_lost"),
    ("last row twice", "line_doubled"),
    ("last column lost", "lines_lost"),
    ("top left corner", "corner_rays"),
    ("half a pixel in x", "principal_point"),
    ("principal point", "principal_point"),
    ("focal length", "focal_length"),
    ("pitch", "pitch"),
    ("pose", "pose"),
    ("range scaled", "factor"),
    ("range offset", "offset"),
    ("range rounded", "rounded"),
    ("far hits lost", "cut_off"),
    ("far ranges clamped", "cut_off"),
    ("range from the plane", "from_plane"),
    ("rows reversed", "rows_reversed"),
    ("width of pixels", "pixel_pitch"),
    ("height of pixels", "pixel_pitch"),
    ("both sides of pixels", "pixel_pitch"),
    ("rotation read as w, x, y, z", "quaternion_order"),
    ("inverse depth", "inverse"),
    ("points' axes", "axes"),
    ("normals' axes", "axes"),
    ("points from the sensor", "points_from_sensor"),
    ("points moved", "points_moved"),
    ("half precision", "half_precision"),
    ("view space of OpenGL", "sensor_frame"),
    ("sensor's frame, x ahead", "sensor_frame"),
    ("points in the sensor's frame", "sensor_frame"),
    ("points rounded", "points_rounded"),
    ("squared range", "squared"),
    ("z-buffer", "z_buffer"),
    ("reversed z-buffer", "z_buffer"),
];

/// The same in a beam.
const OF_BEAM: [(&str, &str); 4] = [
    ("thickness", "thickness"),
    ("another beam", "other_beam"),
    ("pose inverted", "pose_inverted"),
    ("inverse lengths", "inverse"),
];

fn named(name: &str) -> Make {
    *MISTAKES.iter().find(|(own, _)| *own == name).expect("a mistake of the list")
}

/// A candidate with mistakes in some sensors.
fn made(bench: &Bench, makes: &[(&str, SensorId)]) -> Wrong {
    let mut wrong = Wrong::right(bench);
    for (name, sensor) in makes {
        wrong.make(bench, named(name), *sensor, &mut Random(3));
    }
    wrong
}

#[test]
fn a_mistake_in_the_camera_is_told_of_the_camera_alone() {
    for (name, key) in TABLE {
        let wrong = made(few_pyramids(), &[(name, CAMERA)]);
        assert_eq!(few_pyramids().reasons(&wrong.candidate), [format!("camera: {key}")], "{name}");
        assert_eq!(wrong.false_reason(few_pyramids().diagnosis(&wrong.candidate).as_ref()), None);
    }
}

/// Rays that stand in no cell, for all are shifted by one, and lengths that are hardly off: rules of rays that change nothing must not
/// be told for their sake.
#[test]
fn a_lost_column_proves_no_rule_of_rays() {
    let bench = pyramids();
    for factor in [1.000_000_1, 1.000_01, 1.001] {
        let mut wrong = Wrong::right(bench);
        wrong.make(bench, named("one column left"), CAMERA, &mut Random(3));
        ranges(&mut wrong.candidate, |_, range| range * factor);
        let found = bench.diagnosis(&wrong.candidate);
        let keys = bench.reasons(&wrong.candidate);
        assert!(keys.iter().all(|keys| !keys.contains("backs")), "{:?}", found.map(|found| found.sentence()));
    }
}

/// Rows of a beam meet the same faces: where a part of the first row is lost, faces taken from the next row are right again. But the
/// ranges are not those of the next row.
#[test]
fn a_row_that_is_lost_in_part_is_no_shift() {
    let mut candidate =
        only_of(&pyramids().exact, BEAM, &[Quantity::Face, Quantity::Range, Quantity::Normal]);
    let depths = pyramids().exact.answers.map(BEAM).depth.clone();
    let map = candidate.answers.maps.iter_mut().find(|map| map.sensor == BEAM).unwrap();
    map.range = depths;
    for i in 0..22 {
        map.face.as_mut().unwrap().set(i, 0, Maybe::NONE);
        map.range.as_mut().unwrap().set(i, 0, Maybe::NONE);
        map.normal.as_mut().unwrap().set(i, 0, Maybe::NONE);
    }
    let told = pyramids().reasons(&candidate);
    assert!(told.iter().all(|reason| !reason.contains("shifted")), "{told:?}");
}

#[test]
fn a_mistake_in_a_beam_is_told_of_the_beam_alone() {
    for (name, key) in OF_BEAM {
        let wrong = made(few_pyramids(), &[(name, BEAM)]);
        assert_eq!(few_pyramids().reasons(&wrong.candidate), [format!("beam-1: {key}")], "{name}");
        assert_eq!(wrong.false_reason(few_pyramids().diagnosis(&wrong.candidate).as_ref()), None);
    }
}

#[test]
fn axes_are_told_of_the_vectors_that_have_them() {
    let told = |name: &str| {
        let wrong = made(few_pyramids(), &[(name, CAMERA)]);
        few_pyramids().diagnosis(&wrong.candidate).unwrap().reasons[0].mistakes[0].to_string()
    };
    assert!(told("points' axes").starts_with("points are in other axes"));
    assert!(told("normals' axes").starts_with("normals are in other axes"));
    assert!(told("axes turned").starts_with("points and normals are in other axes"));
    assert!(told("points in the sensor's frame").starts_with("points are in the sensor's frame:"));
    assert!(told("sensor's frame").starts_with("points and normals are in the sensor's frame:"));
    assert!(told("view space of OpenGL").contains("OpenGL's axes"));
}

#[test]
fn two_sensors_with_their_own_mistakes_have_their_own_reasons() {
    let of_beam =
        [("rows reversed", "rows_reversed"), ("range offset", "offset"), ("fan", "fan"), ("yaw", "yaw")];
    for (index, (name, key)) in TABLE.iter().enumerate().step_by(3) {
        let (other, other_key) = of_beam[index % of_beam.len()];
        let wrong = made(few_pyramids(), &[(*name, CAMERA), (other, BEAM)]);
        let expected = [format!("camera: {key}"), format!("beam-1: {other_key}")];
        assert_eq!(few_pyramids().reasons(&wrong.candidate), expected, "{name}, {other}");
    }
}

#[test]
fn one_mistake_in_two_sensors_is_one_reason() {
    let beams = made(few_pyramids(), &[("rows reversed", SensorId::Beam(0)), ("rows reversed", BEAM)]);
    assert_eq!(few_pyramids().reasons(&beams.candidate), ["beam-0, beam-1: rows_reversed"]);
    let found = few_pyramids().diagnosis(&beams.candidate).unwrap();
    assert!(!found.reasons[0].is_everywhere);
    let all = made(
        few_pyramids(),
        &[("rows reversed", CAMERA), ("rows reversed", SensorId::Beam(0)), ("rows reversed", BEAM)],
    );
    assert!(few_pyramids().diagnosis(&all.candidate).unwrap().reasons[0].is_everywhere);
}

/// Where what is farther is also deeper, nobody knows which of both cuts, and it is not said.
#[test]
fn a_cut_that_range_and_depth_fit_alike_is_told_of_both() {
    let bench = few_pyramids();
    let wrong = made(bench, &[("far hits lost, by range and depth alike", BEAM)]);
    assert_eq!(bench.reasons(&wrong.candidate), ["beam-1: cut_off"]);
    let words = bench.diagnosis(&wrong.candidate).expect("a reason").sentence();
    assert!(words.contains("or a depth that goes with it, are lost"), "{words}");
}

/// The arithmetic is the program's: a sensor of which a handful of rays shows it has the same reason, whatever their number.
#[test]
fn single_precision_of_few_rays_is_that_of_the_other_sensors() {
    let exact = &few_pyramids().exact;
    let mut single = exact.clone();
    ranges(&mut single, |index, range| {
        let range = range as f32;
        f64::from(if index.is_multiple_of(2) { range.next_up() } else { range })
    });
    // Of the last beam three ranges are as single precision has them, and no more.
    let last = single.answers.maps.len() - 1;
    let mut right = exact.answers.maps[last].range.clone().expect("ranges");
    let range = single.answers.maps[last].range.as_mut().expect("ranges");
    let mut left = 3;
    for (cell, exact) in range.cells_mut().iter_mut().zip(right.cells_mut()) {
        let is_off = |(stated, exact): (f64, f64)| (stated - exact).abs() > exact * 1e-7;
        if left > 0 && cell.get().zip(exact.get()).is_some_and(is_off) {
            left -= 1;
        } else {
            *cell = *exact;
        }
    }
    assert_eq!(left, 0);
    let found = few_pyramids().diagnosis(&single).expect("a reason");
    assert_eq!(found.unexplained, []);
    assert_eq!(few_pyramids().reasons(&single), ["camera, beam-0, beam-1: single_precision"]);
}

#[test]
fn a_sensor_without_a_reason_is_said_to_have_none() {
    let wrong = made(few_pyramids(), &[("half a pixel in x", CAMERA), ("every fifth is lost", BEAM)]);
    let found = few_pyramids().diagnosis(&wrong.candidate).unwrap();
    assert_eq!(found.unexplained, [BEAM]);
    assert!(
        found.sentence().ends_with("for the wrong rays of beam-1 no reason is known"),
        "{}",
        found.sentence()
    );
}

#[test]
fn too_few_wrong_rays_have_no_reason_but_confirm_one() {
    // The last column of a beam of four rows is four rays; that of a camera is many.
    let few = made(few_pyramids(), &[("last column lost", BEAM)]);
    assert_eq!(few_pyramids().reasons(&few.candidate), [""; 0]);
    // Two beams of eight pencils: neither is enough by itself, both are, and the camera's reason is confirmed by one.
    let bench = pyramids_with_pencils(40, 32, 8, 1);
    let [first, second] = [SensorId::Beam(0), SensorId::Beam(1)];
    let told = |sensors: &[SensorId]| {
        let makes: Vec<_> = sensors.iter().map(|sensor| ("faces from 1", *sensor)).collect();
        bench.reasons(&made(&bench, &makes).candidate)
    };
    assert_eq!(told(&[second]), [""; 0]);
    assert_eq!(told(&[first, second]), ["beam-0, beam-1: faces_shifted"]);
    assert_eq!(told(&[CAMERA, second]), ["camera, beam-1: faces_shifted"]);
}

#[test]
fn a_lost_line_beside_undeclared_single_precision_is_told() {
    let mut wrong = made(few_pyramids(), &[("last row twice", CAMERA)]);
    as_single(&mut wrong.candidate, &mut 0);
    let last = 31;
    // The last row repeats the rounded one.
    for map in &mut wrong.candidate.answers.maps[..1] {
        for image in [&mut map.range, &mut map.depth, &mut map.cos_incidence].into_iter().flatten() {
            (0..40).for_each(|i| image.set(i, last, image.at(i, last - 1)));
        }
    }
    let told = few_pyramids().reasons(&wrong.candidate);
    assert_eq!(told[0], "camera: line_doubled + single_precision");
}

#[test]
fn honest_errors_have_no_reason() {
    for name in [
        "noise",
        "some noise",
        "one wrong face in a thousand",
        "a face is not there",
        "a corner is elsewhere",
    ] {
        for seed in [1, 2] {
            let mut wrong = Wrong::right(few_pyramids());
            wrong.make(few_pyramids(), named(name), CAMERA, &mut Random(seed));
            assert_eq!(few_pyramids().reasons(&wrong.candidate), [""; 0], "{name}");
        }
    }
}

#[test]
fn faces_that_are_not_there_are_no_cut() {
    // All hits of the right wall are lost, and so all beyond 6 m: but no face is cut there.
    let bench = two_walls();
    let lost = |is_lost: &dyn Fn(u32, u32, f64) -> bool| {
        let mut wrong = Wrong::right(&bench);
        let map = &mut wrong.candidate.answers.maps[0];
        let ranges = map.range.clone().unwrap();
        for (i, j) in (0..24).flat_map(|j| (0..32).map(move |i| (i, j))) {
            if ranges.at(i, j).get().is_some_and(|range| is_lost(i, j, range)) {
                map.face.as_mut().unwrap().set(i, j, Maybe::NONE);
                for image in [&mut map.range, &mut map.depth, &mut map.cos_incidence].into_iter().flatten() {
                    image.set(i, j, Maybe::NONE);
                }
                for image in [&mut map.point, &mut map.normal].into_iter().flatten() {
                    image.set(i, j, Maybe::NONE);
                }
            }
        }
        bench.reasons(&wrong.candidate)
    };
    assert_eq!(lost(&|_, _, range| range > 6.0), [""; 0]);
    assert_eq!(lost(&|_, _, range| range > 21.0), ["camera: cut_off"]);
}

#[test]
fn numbers_are_told_with_their_value_and_unit() {
    let told = |name: &str| {
        let wrong = made(few_pyramids(), &[(name, CAMERA)]);
        few_pyramids().diagnosis(&wrong.candidate).unwrap().reasons[0].mistakes[0]
    };
    assert_eq!(told("half a pixel in x").to_string(), "cx is 19.5 in place of 20 px");
    let Mistake::Rounded { quantum, .. } = told("lengths rounded") else { panic!() };
    assert_eq!(quantum, 1e-3);
}

/// What a program says that renders the bench with another camera: its beams meet what they should.
fn with_camera(bench: &Bench, change: impl Fn(&mut Mounted<Camera>)) -> Recorded {
    let mut camera = *bench.scene.camera();
    change(&mut camera);
    let (mesh, beams) = (Arc::clone(bench.scene.mesh()), bench.scene.beams().to_vec());
    let other = Scene::new(mesh, camera, beams, bench.scene.atmosphere(), bench.scene.flux_model()).unwrap();
    let output = ExactRenderer.render(&other, &Request::EVERYTHING);
    Recorded::of_output("mine", bench.scene, &output, Precision::F64)
}

#[test]
fn the_light_of_right_beams_is_explained_by_the_camera_that_sees_it() {
    let bench = few_pyramids();
    let moved = |by: [f64; 2]| {
        with_camera(bench, |camera| {
            camera.sensor.principal_point[0] += by[0];
            camera.sensor.principal_point[1] += by[1];
        })
    };
    let all = |key: &str| vec![format!("camera, beam-0, beam-1: {key}")];
    // By whole pixels the camera's own rays are those of shifted cells; the light of the beams tells the two apart.
    for by in [[-0.5, 0.0], [0.25, 0.0], [0.0, 0.5], [1.0, 0.0], [0.0, -1.0]] {
        assert_eq!(bench.reasons(&moved(by)), all("principal_point"), "{by:?}");
    }
    let longer = with_camera(bench, |camera| camera.sensor.focal_length *= 1.01);
    assert_eq!(bench.reasons(&longer), all("focal_length"));
    let lower = with_camera(bench, |camera| camera.scene_from_sensor.position.z -= 0.125);
    assert_eq!(bench.reasons(&lower), all("position"));
    let found = bench.diagnosis(&moved([-0.5, 0.0])).unwrap();
    assert!(found.unexplained.is_empty() && found.reasons[0].is_everywhere);
    assert!(found.reasons[0].share() > 0.98, "{}", found.sentence());

    // A beam whose light is wrong beside that has no reason: its flux is a third too high.
    let mut brighter = moved([-0.5, 0.0]);
    let flux = brighter.answers.light[1].returns.flux.as_mut().unwrap();
    flux.cells_mut().iter_mut().for_each(|flux| *flux *= 4.0 / 3.0);
    let found = bench.diagnosis(&brighter).unwrap();
    assert_eq!(bench.reasons(&brighter)[0], "camera, beam-0: principal_point");
    assert!(found.reasons.iter().all(|one| !one.sensors.contains(&BEAM) || one.sensors.len() == 1));
}

#[test]
fn a_camera_that_is_wrong_in_its_light_alone_is_told_nothing_of_its_lengths() {
    let bench = few_pyramids();
    let mut dark = bench.exact.clone();
    let image = dark.answers.light[1].image.as_mut().unwrap();
    image.cells_mut().iter_mut().for_each(|flux| *flux *= 1.0 + 1e-9);
    assert_eq!(bench.reasons(&dark), [""; 0]);
}

#[test]
fn a_sensor_that_misses_everything_has_no_reason() {
    let bench = dots();
    let mut blind = bench.exact.clone();
    let SensorMap { range, depth, face, point, normal, cos_incidence, .. } = &mut blind.answers.maps[0];
    for lengths in [range, depth, cos_incidence].into_iter().flatten() {
        lengths.cells_mut().fill(Maybe::NONE);
    }
    for vectors in [point, normal].into_iter().flatten() {
        vectors.cells_mut().fill(Maybe::NONE);
    }
    face.iter_mut().for_each(|faces| faces.cells_mut().fill(Maybe::NONE));
    assert_eq!(bench.reasons(&blind), [""; 0]);
}

#[test]
fn one_length_everywhere_is_not_rounded() {
    // All ranges are 2.0 to 2.4 m: 0 is the multiple of 5 m below each of them.
    let bench = dots();
    let mut constant = bench.exact.clone();
    let ranges = constant.answers.maps[0].range.as_mut().unwrap();
    assert!(ranges.cells().iter().all(|one| one.get().is_some_and(|range| (2.0..2.5).contains(&range))));
    ranges.cells_mut().fill(Maybe::some(0.0));
    assert_eq!(bench.reasons(&constant), [""; 0]);
}

/// Ranges of one sensor rounded to multiples of a quantum.
fn round(candidate: &mut Recorded, map: usize, quantum: f64) {
    let ranges = candidate.answers.maps[map].range.as_mut().unwrap();
    let rounded = |range: f64| (range / quantum).round() * quantum;
    ranges.cells_mut().iter_mut().for_each(|cell| *cell = cell.get().map(rounded).into());
}

#[test]
fn a_quantum_is_confirmed_only_by_lengths_that_are_its_multiples() {
    let bench = few_pyramids();
    let told = |of_beam: f64| {
        let mut candidate = bench.exact.clone();
        round(&mut candidate, 0, 1e-3);
        round(&mut candidate, 2, of_beam);
        bench.reasons(&candidate)
    };
    assert_eq!(told(1e-3), ["camera, beam-1: rounded"]);
    // Three millimetres are multiples of one, but too far off; a third of one is none.
    assert_eq!(told(3e-3), ["camera: rounded"]);
    assert_eq!(told(1e-3 / 3.0), ["camera: rounded"]);
    // Other lengths of the list have their own reason.
    assert_eq!(told(2e-3), ["camera: rounded", "beam-1: rounded"]);
}

#[test]
fn lengths_that_end_in_one_plane_are_told_no_factor_and_no_place() {
    // Of a slanted wall each direction of a shift fits, of a straight one only that along its normal.
    for (slopes, factor) in
        [([0.5, 0.25], 1.003), ([0.5, 0.25], 0.999), ([0.0, 0.0], 1.003), ([0.0, 0.0], 1.01)]
    {
        let bench = one_wall(slopes);
        // Right points would tell the two apart.
        let mut candidate = only(&bench.exact, &[Quantity::Range]);
        ranges(&mut candidate, |_, range| factor * range);
        assert_eq!(bench.reasons(&candidate), [""; 0], "{slopes:?} {factor}");
    }
}

#[test]
fn what_several_sensors_say_goes_before_what_fits_one() {
    // A beam that looks straight down: its frame is the scene's in other axes, right is x, down is -y, forward is -z.
    let bench = few_pyramids();
    let (mesh, camera) = (Arc::clone(bench.scene.mesh()), *bench.scene.camera());
    let mut beams = bench.scene.beams().to_vec();
    let rotation = glam::DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0);
    let position = beams[1].scene_from_sensor.position + glam::DVec3::new(4.0, 0.0, 2.0);
    beams[1].scene_from_sensor = raypencil_scene::Pose { position, rotation };
    let scene = Scene::new(mesh, camera, beams, bench.scene.atmosphere(), bench.scene.flux_model()).unwrap();
    let bench = Bench::of(scene);
    let hits = bench.exact.answers.maps[2].normal.as_ref().unwrap();
    assert!(hits.cells().iter().filter(|cell| cell.get().is_some()).count() >= 12);
    let mut candidate = bench.exact.clone();
    normals(&mut candidate, |_, n| glam::DVec3::new(n.x, -n.y, -n.z));
    let told = bench.reasons(&candidate);
    assert_eq!(told, ["camera, beam-0, beam-1: axes"]);
}

/// A graphics card computes the numbers of its z-buffer in single precision, from a matrix of single precision.
#[test]
fn numbers_of_a_z_buffer_in_single_precision_are_told_and_noise_is_not() {
    let bench = pyramids();
    let with = |of_depth: &dyn Fn(usize, f64) -> f64| {
        let mut candidate = bench.exact.clone();
        let depth = candidate.answers.maps.iter_mut().find(|map| map.sensor == CAMERA).expect("the camera");
        for (index, cell) in depth.depth.iter_mut().flat_map(|image| image.cells_mut()).enumerate() {
            *cell = cell.get().map_or(Maybe::NONE, |depth| Maybe::some(of_depth(index, depth)));
        }
        bench.diagnosis(&stored_single(&candidate)).map(|found| found.sentence())
    };
    let (near, far) = (0.3_f32, 250.0_f32);
    let (a, b) = (far / (far - near), -far * near / (far - near));
    let told = with(&|_, depth| f64::from(a + b / depth as f32)).expect("a reason");
    assert!(told.contains("depth.Z holds numbers of a z-buffer, 0 at 0.3 m and 1 at 250 m"), "{told}");
    // From -1 to 1, as OpenGL has them.
    let told = with(&|_, depth| f64::from(2.0 * (a + b / depth as f32) - 1.0)).expect("a reason");
    assert!(told.contains("z-buffer, -1 at 0.3 m and 1 at 250 m"), "{told}");
    // A far plane of which single precision keeps two digits is told as the roundest number, and not as 996 m.
    let (near, far) = (0.01_f32, 1000.0_f32);
    let (a, b) = (far / (far - near), -far * near / (far - near));
    let told = with(&|_, depth| f64::from(a + b / depth as f32)).expect("a reason");
    assert!(told.contains("z-buffer, 0 at 0.01 m and 1 at 1000 m"), "{told}");
    // The same numbers with an error of a hundred last digits, up and down.
    let (a, b) = (1.001, -0.3);
    let noise = with(&|index, depth| {
        let share = f64::from((index as u32).wrapping_mul(2_654_435_769) >> 8) / f64::from(1 << 24);
        f64::from(a + b / depth as f32) + 1.2e-5 * (share - 0.5)
    });
    assert!(noise.is_none_or(|told| !told.contains("z-buffer")));
}
