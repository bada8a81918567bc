//! A scene of two walls. Outputs that differ in one value: which quantity is a defect, and what else is told; first of two
//! renderers, then of a recording.

use std::sync::Arc;

use glam::DVec3;
use raypencil_judge::{
    ApproximationTally, Attributions, Class, GroundTruth, Item, Judge, JudgeShare, Quantity, Recorded,
    SensorResult, Side, check, class_of_ray, compare, compare_judged, item_of_channel, listed_defects,
    range_bound,
};
use raypencil_referee::ExactRenderer;
use raypencil_scene::{
    Atmosphere, FaceId, Fidelity, FluxModel, Material, Maybe, Mesh, Mounted, Pixel, Place, Pose, Precision,
    RenderOutput, Renderer, Request, Returns, Scene, SensorId, SensorMap, Silent, Switches, rig,
};

/// A wall at z = 2 m that ends at x = 1/8 m (face 0) before a wall at z = 4 m (face 1). A camera of 9 x 9 pixels at the
/// origin and a beam of 8 x 2 pencils, 0.3 m above it, look along z. Columns 0 to 4 of both meet face 0, the others
/// face 1.
pub(super) fn walls(flux_model: FluxModel) -> Scene {
    let corners = vec![
        [0.125, -40.0, 2.0],
        [-90.0, 0.0, 2.0],
        [0.125, 40.0, 2.0],
        [90.0, -90.0, 4.0],
        [-90.0, 0.0, 4.0],
        [90.0, 90.0, 4.0],
    ];
    let plaster = Material { name: "plaster".into(), reflectivity: 0.5 };
    let mesh =
        Mesh::new(DVec3::ZERO, corners, vec![[0, 1, 2], [3, 4, 5]], vec![0; 2], vec![plaster]).unwrap();
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: rig::camera(9, 9, 0.0625, 0.5) };
    let above = Pose::from_position(DVec3::new(0.0, -0.3, 0.0));
    let beam = Mounted { scene_from_sensor: above, sensor: rig::beam(8, 2, [0.05, 0.004], 0.5) };
    Scene::new(Arc::new(mesh), camera, vec![beam], Atmosphere { attenuation: 0.01 }, flux_model).unwrap()
}

/// The same, with the beam moved so that its pencils land `pixels` to the right. Unmoved, those of columns 0 and 2 land at
/// 1.7 and 3.3 pixels from the left.
fn walls_with_pencils_moved(pixels: f64) -> Scene {
    let scene = walls(FluxModel::Radiometric);
    let mut beam = scene.beams()[0];
    // A pixel at 2 m is 1/4 m wide.
    beam.scene_from_sensor.position.x = 0.25 * pixels;
    let air = scene.atmosphere();
    Scene::new(scene.mesh().clone(), *scene.camera(), vec![beam], air, FluxModel::Radiometric).unwrap()
}

pub(super) fn exact(scene: &Scene) -> RenderOutput {
    ExactRenderer.render(scene, &Request::EVERYTHING)
}

fn compared(scene: &Scene, a: &RenderOutput, b: &RenderOutput, share: JudgeShare) -> Vec<SensorResult> {
    let side = |name, output| Side { name, output, precision: Precision::F64, attributions: None };
    compare_judged(&Judge::new(scene, share), side("one", a), side("other", b))
}

fn compared_sides(scene: &Scene, a: Side<'_>, b: Side<'_>) -> Vec<SensorResult> {
    compare_judged(&Judge::new(scene, JudgeShare::Sample), a, b)
}

pub(super) fn map(output: &mut RenderOutput) -> &mut SensorMap {
    &mut output.beams[0]
}

pub(super) fn returns(output: &mut RenderOutput) -> &mut Returns {
    &mut output.returns[0]
}

/// A change of one value of pencil (2, 1), which meets face 0, and the quantity that it makes wrong.
type Change = (Quantity, fn(&mut RenderOutput));

const CHANGES: [Change; 10] = [
    (Quantity::Range, |output| nudge(&mut map(output).range)),
    (Quantity::Depth, |output| nudge(&mut map(output).depth)),
    (Quantity::CosIncidence, |output| nudge(&mut map(output).cos_incidence)),
    (Quantity::Point, |output| shift(&mut map(output).point)),
    (Quantity::Normal, |output| shift(&mut map(output).normal)),
    (Quantity::CameraDepth, |output| nudge(&mut returns(output).depth)),
    (Quantity::CosOffAxis, |output| nudge(&mut returns(output).cos_off_axis)),
    (Quantity::CosView, |output| nudge(&mut returns(output).cos_view)),
    (Quantity::PencilFlux, |output| {
        let flux = returns(output).flux.as_mut().unwrap();
        flux.set(2, 1, flux.at(2, 1) * 1.001);
    }),
    (Quantity::Pixel, |output| {
        let pixels = returns(output).pixel.as_mut().unwrap();
        let Pixel { i, j } = pixels.at(2, 1).get().unwrap();
        pixels.set(2, 1, Maybe::some(Pixel { i: i + 1, j }));
    }),
];

fn nudge(image: &mut Option<raypencil_scene::Image<Maybe<f64>>>) {
    let image = image.as_mut().unwrap();
    image.set(2, 1, Maybe::some(image.at(2, 1).get().unwrap() + 1e-6));
}

fn shift(image: &mut Option<raypencil_scene::Image<Maybe<DVec3>>>) {
    let image = image.as_mut().unwrap();
    image.set(2, 1, Maybe::some(image.at(2, 1).get().unwrap() + DVec3::new(0.0, 1e-6, 0.0)));
}

#[test]
fn an_output_agrees_with_itself() {
    for model in [FluxModel::Radiometric, FluxModel::Eq1] {
        let scene = walls(model);
        let output = exact(&scene);
        for share in [JudgeShare::Sample, JudgeShare::All] {
            let [camera, beam] = &compared(&scene, &output, &output, share)[..] else {
                panic!("two sensors")
            };
            assert_eq!(
                (camera.sensor, camera.of(Class::Agree), camera.compared()),
                (SensorId::Camera, 81, 81)
            );
            assert_eq!((beam.sensor, beam.of(Class::Agree), beam.compared()), (SensorId::Beam(0), 16, 16));
            assert!(camera.defects.is_empty() && beam.defects.is_empty());
            if share == JudgeShare::All {
                assert_eq!((camera.judged, beam.judged), (81, 16));
            } else {
                // One ray in 64 is sampled: by chance more than 20 of 97 are so with a probability below 1e-15.
                assert!(camera.judged + beam.judged < 20);
            }
            let of = |quantity: Quantity| beam.items.get(quantity.into()).unwrap();
            assert_eq!((of(Quantity::Range).compared(), of(Quantity::Range).not_compared), (16, 0));
            assert_eq!((of(Quantity::PencilFlux).compared(), of(Quantity::Pixel).of(Class::Agree)), (16, 16));
        }
    }
}

#[test]
fn without_a_judge_of_ones_own_a_sample_is_judged() {
    let scene = walls(FluxModel::Radiometric);
    let output = exact(&scene);
    let side = |name| Side { name, output: &output, precision: Precision::F64, attributions: None };
    let found = compare(&scene, side("one"), side("other"));
    let by_judge = compared(&scene, &output, &output, JudgeShare::Sample);
    let counts = |sensors: &[SensorResult]| -> Vec<_> {
        sensors.iter().map(|sensor| (sensor.sensor, sensor.by_class, sensor.judged)).collect()
    };
    assert_eq!((counts(&found), found.len()), (counts(&by_judge), 2));
}

#[test]
fn one_wrong_value_is_one_defect_of_its_quantity() {
    for model in [FluxModel::Radiometric, FluxModel::Eq1] {
        let scene = walls(model);
        let right = exact(&scene);
        for (quantity, change) in CHANGES {
            let mut wrong = right.clone();
            change(&mut wrong);
            // With either on either side, sampled or not.
            for (a, b) in [(&right, &wrong), (&wrong, &right)] {
                for share in [JudgeShare::Sample, JudgeShare::All] {
                    let sensors = compared(&scene, a, b, share);
                    let beam = &sensors[1];
                    assert_eq!((beam.of(Class::Defect), beam.of(Class::Agree)), (1, 15), "{quantity}");
                    assert_eq!(beam.items.get(quantity.into()).unwrap().of(Class::Defect), 1, "{quantity}");
                    let defect = &beam.defects[0];
                    assert_eq!((defect.place.i, defect.place.j, defect.item), (2, 1, quantity.into()));
                    assert_eq!(beam.listed[0].place, defect.place);
                    assert_eq!(listed_defects(&sensors)[0].item, quantity.into());
                }
            }
        }
    }
}

#[test]
fn values_that_differ_in_their_last_place_agree() {
    for model in [FluxModel::Radiometric, FluxModel::Eq1] {
        let scene = walls(model);
        let right = exact(&scene);
        let mut other = right.clone();
        let up = |image: &mut Option<raypencil_scene::Image<Maybe<f64>>>| {
            for cell in image.as_mut().unwrap().cells_mut() {
                *cell = Maybe::some(cell.get().unwrap().next_up());
            }
        };
        let maps = map(&mut other);
        [&mut maps.range, &mut maps.depth, &mut maps.cos_incidence].into_iter().for_each(up);
        let back = returns(&mut other);
        [&mut back.depth, &mut back.cos_off_axis, &mut back.cos_view].into_iter().for_each(up);
        for flux in back.flux.as_mut().unwrap().cells_mut() {
            *flux = flux.next_up();
        }
        for (a, b) in [(&right, &other), (&other, &right)] {
            let sensors = compared(&scene, a, b, JudgeShare::All);
            assert_eq!((sensors[0].of(Class::Agree), sensors[1].of(Class::Agree)), (81, 16));
        }
        assert_eq!(checked(&scene, &other, Precision::F64)[1].of(Class::Agree), 16);
    }
}

#[test]
fn a_mistake_that_both_share_is_found_by_the_referee() {
    let scene = walls(FluxModel::Radiometric);
    for (quantity, change) in CHANGES {
        let mut wrong = exact(&scene);
        change(&mut wrong);
        let beam = &compared(&scene, &wrong, &wrong, JudgeShare::All)[1];
        assert_eq!((beam.of(Class::Defect), beam.of(Class::Agree)), (1, 15), "{quantity}");
        assert_eq!(beam.defects[0].item, quantity.into());
    }
}

#[test]
fn another_face_or_none_is_a_defect_of_face_or_hit() {
    let scene = walls(FluxModel::Radiometric);
    let right = exact(&scene);
    // Pencil (2, 1) is stated to meet the wall behind.
    let mut wrong = right.clone();
    map(&mut wrong).face.as_mut().unwrap().set(2, 1, Maybe::some(FaceId(1)));
    let beam = &compared(&scene, &right, &wrong, JudgeShare::Sample)[1];
    assert_eq!(beam.of(Class::Defect), 1);
    assert_eq!(beam.items.get(Quantity::Face.into()).unwrap().of(Class::Defect), 1);
    // Both answers are in words. The range is that of the wall at 2 m, a little aslant.
    let words = &beam.defects[0].what;
    assert!(
        words.contains("one: face 0 at range 2.") && words.contains("other: face 1 at range 2."),
        "{words}"
    );

    // It is stated to miss.
    let mut wrong = right.clone();
    map(&mut wrong).face.as_mut().unwrap().set(2, 1, Maybe::NONE);
    map(&mut wrong).range.as_mut().unwrap().set(2, 1, Maybe::NONE);
    let beam = &compared(&scene, &right, &wrong, JudgeShare::Sample)[1];
    assert_eq!((beam.of(Class::Defect), beam.defects[0].item), (1, Quantity::Hit.into()));
    assert!(beam.defects[0].what.contains("other: no hit"), "{}", beam.defects[0].what);
}

#[test]
fn a_hidden_hit_that_delivers_and_a_seen_one_that_does_not_are_defects() {
    let scene = walls(FluxModel::Radiometric);
    let right = exact(&scene);
    let mut wrong = right.clone();
    returns(&mut wrong).visible.as_mut().unwrap().set(2, 1, false);
    let beam = &compared(&scene, &right, &wrong, JudgeShare::Sample)[1];
    assert_eq!((beam.of(Class::Defect), beam.defects[0].item), (1, Quantity::Visible.into()));
    // Both say so, and both have a flux: they contradict themselves, whether or not the referee is asked.
    let beam = &compared(&scene, &wrong, &wrong, JudgeShare::Sample)[1];
    assert_eq!((beam.of(Class::Defect), beam.defects[0].item), (1, Quantity::Visible.into()));
    // A seen hit that lands in no pixel.
    let mut wrong = right.clone();
    returns(&mut wrong).pixel.as_mut().unwrap().set(2, 1, Maybe::NONE);
    let beam = &compared(&scene, &wrong, &wrong, JudgeShare::Sample)[1];
    assert_eq!(beam.of(Class::Defect), 1);
    assert_eq!(beam.items.get(Quantity::Visible.into()).unwrap().of(Class::Defect), 1);
}

#[test]
fn a_pixel_is_the_sum_of_its_pencils() {
    let scene = walls(FluxModel::Radiometric);
    let right = exact(&scene);
    let lit = returns(&mut right.clone()).pixel.as_ref().unwrap().at(2, 1).get().unwrap();
    for factor in [0.999, 1.001] {
        let mut wrong = right.clone();
        let flux = wrong.flux[0].at(lit.i, lit.j);
        wrong.flux[0].set(lit.i, lit.j, flux * factor);
        for (a, b) in [(&right, &wrong), (&wrong, &right), (&wrong, &wrong)] {
            let camera = &compared(&scene, a, b, JudgeShare::Sample)[0];
            assert_eq!((camera.of(Class::Defect), camera.of(Class::Agree)), (1, 80));
            let defect = &camera.defects[0];
            assert_eq!(
                (defect.place.i, defect.place.j, defect.item),
                (lit.i, lit.j, Quantity::PixelFlux.into())
            );
        }
    }
    // Light where no pencil lands.
    let mut wrong = right.clone();
    wrong.flux[0].set(8, 8, 1e-9);
    assert_eq!(compared(&scene, &right, &wrong, JudgeShare::Sample)[0].of(Class::Defect), 1);
}

#[test]
fn one_ray_has_the_class_that_it_has_among_all() {
    let scene = walls(FluxModel::Radiometric);
    let right = exact(&scene);
    let mut wrong = right.clone();
    nudge(&mut map(&mut wrong).range);
    let judge = Judge::new(&scene, JudgeShare::Sample);
    let side = |output| Side { name: "one", output, precision: Precision::F64, attributions: None };
    let class = |a, b, sensor, i, j| class_of_ray(&judge, side(a), side(b), Place { sensor, i, j });
    let beam = SensorId::Beam(0);
    assert_eq!(class(&right, &wrong, beam, 2, 1), Some((Class::Defect, Quantity::Range)));
    for (sensor, i, j) in [(beam, 1, 1), (beam, 2, 0), (SensorId::Camera, 8, 8)] {
        assert_eq!(class(&right, &wrong, sensor, i, j).unwrap().0, Class::Agree);
    }
    for (sensor, i, j) in [(beam, 8, 0), (beam, 0, 2), (SensorId::Beam(1), 0, 0), (SensorId::Camera, 0, 9)] {
        assert_eq!(class(&right, &wrong, sensor, i, j), None);
    }
    // A side that does not tell whether its rays hit.
    let mut less = right.clone();
    (map(&mut less).range, map(&mut less).face) = (None, None);
    assert_eq!((class(&right, &less, beam, 2, 1), class(&less, &right, beam, 2, 1)), (None, None));
}

#[test]
fn what_a_side_leaves_out_is_not_compared() {
    let scene = walls(FluxModel::Radiometric);
    let right = exact(&scene);
    let mut less = right.clone();
    map(&mut less).normal = None;
    map(&mut less).face = None;
    returns(&mut less).cos_view = None;
    returns(&mut less).visible = None;
    for (a, b) in [(&right, &less), (&less, &right)] {
        let beam = &compared(&scene, a, b, JudgeShare::Sample)[1];
        assert_eq!(beam.of(Class::Agree), 16);
        for quantity in [Quantity::Normal, Quantity::Face, Quantity::CosView, Quantity::Visible] {
            let tally = beam.items.get(quantity.into()).unwrap();
            assert_eq!((tally.compared(), tally.not_compared), (0, 16), "{quantity}");
        }
        assert_eq!(beam.items.get(Quantity::Range.into()).unwrap().compared(), 16);
    }
}

#[test]
fn light_without_hits_is_not_compared() {
    // A side that leaves out the maps of its beam, but not its returns and its image: there are no compared pencils to
    // judge the pixels by.
    let scene = walls(FluxModel::Radiometric);
    let right = exact(&scene);
    let mut less = right.clone();
    less.beams.clear();
    for (a, b) in [(&right, &less), (&less, &right), (&less, &less)] {
        let [camera, beam] = &compared(&scene, a, b, JudgeShare::Sample)[..] else { panic!("two sensors") };
        assert_eq!((beam.not_compared, beam.compared()), (16, 0));
        assert_eq!(beam.items.get(Quantity::Range.into()).unwrap().not_compared, 16);
        let light = camera.items.get(Quantity::PixelFlux.into()).unwrap();
        assert_eq!((light.compared(), light.not_compared), (0, 81));
        assert_eq!(camera.of(Class::Agree), 81);
    }
}

#[test]
fn the_difference_of_two_ranges_is_the_second_minus_the_first() {
    let scene = walls(FluxModel::Radiometric);
    let right = exact(&scene);
    let mut far = right.clone();
    let ranges = map(&mut far).range.as_mut().unwrap();
    ranges.set(2, 1, Maybe::some(ranges.at(2, 1).get().unwrap() + 0.5));
    let beam = &compared(&scene, &right, &far, JudgeShare::Sample)[1];
    let differences = beam.range_difference.as_ref().unwrap();
    assert!((differences.at(2, 1).get().unwrap() - 0.5).abs() < 1e-15);
    assert_eq!(differences.at(3, 1).get(), Some(0.0));
    let worst = beam.items.get(Quantity::Range.into()).unwrap().worst_error.as_ref().unwrap();
    assert!((worst.value - 0.5).abs() < 1e-15);
    assert_eq!((worst.place.i, worst.place.j), (2, 1));
}

fn checked(scene: &Scene, output: &RenderOutput, precision: Precision) -> Vec<SensorResult> {
    let recorded = Recorded::of_output("recording", scene, output, precision);
    check(&GroundTruth::certified(scene, &Silent), &recorded, &Silent).sensors
}

#[test]
fn a_recording_of_the_exact_answers_is_exact() {
    for model in [FluxModel::Radiometric, FluxModel::Eq1] {
        let scene = walls(model);
        let [camera, beam] = &checked(&scene, &exact(&scene), Precision::F64)[..] else {
            panic!("two sensors")
        };
        assert_eq!((camera.of(Class::Agree), camera.compared()), (81, 81));
        assert_eq!((beam.of(Class::Agree), beam.compared(), beam.judged), (16, 16, 0));
        for (item, tally) in camera.items.iter().chain(beam.items.iter()) {
            assert!(tally.worst_ulps.as_ref().is_none_or(|worst| worst.value == 0.0), "{item:?}");
        }
    }
}

#[test]
fn one_wrong_value_of_a_recording_is_one_defect_of_its_quantity() {
    for model in [FluxModel::Radiometric, FluxModel::Eq1] {
        let scene = walls(model);
        for (quantity, change) in CHANGES {
            let mut wrong = exact(&scene);
            change(&mut wrong);
            let [camera, beam] = &checked(&scene, &wrong, Precision::F64)[..] else { panic!("two sensors") };
            assert_eq!((beam.of(Class::Defect), beam.of(Class::Agree)), (1, 15), "{quantity}");
            let defect = &beam.defects[0];
            assert_eq!((defect.place.i, defect.place.j, defect.item), (2, 1, quantity.into()));
            let tally = beam.items.get(quantity.into()).unwrap();
            assert_eq!(tally.others, [(defect.place, Class::Defect)], "{quantity}");
            // The image itself is right.
            assert_eq!(camera.of(Class::Agree), 81, "{quantity}");
        }
    }
}

#[test]
fn a_hit_too_far_or_too_near_is_told_why_it_is_none() {
    let scene = walls(FluxModel::Radiometric);
    let mut beam = scene.beams()[0];
    // Face 0 lies within 3 m, face 1 beyond.
    beam.sensor.max_range = 3.0;
    let air = scene.atmosphere();
    let short =
        Scene::new(scene.mesh().clone(), *scene.camera(), vec![beam], air, FluxModel::Radiometric).unwrap();
    let what = |range: Option<f64>| {
        let mut wrong = exact(&short);
        let of_pencil = exact(&scene).beams[0].range.as_ref().unwrap().at(7, 1).get();
        map(&mut wrong).face.as_mut().unwrap().set(7, 1, Maybe::some(FaceId(1)));
        map(&mut wrong).range.as_mut().unwrap().set(7, 1, range.or(of_pencil).into());
        checked(&short, &wrong, Precision::F64)[1].defects[0].what.clone()
    };
    // Pencil 7 runs along (0.175, 0, 0.5): it meets the wall at 4 m at 4.2379... m, and its plane at 0.52974... m.
    let far = what(None);
    assert!(
        far.contains("true is no hit (4.2379") && far.contains("m is beyond the maximum range of 3 m)"),
        "{far}"
    );
    let near = what(Some(0.25));
    assert!(
        near.contains("no hit (0.25 m is before the sensor's plane, which the ray meets at 0.5297"),
        "{near}"
    );
    let neither = what(Some(1.0));
    assert!(neither.contains("true is no hit (referee: "), "{neither}");
}

#[test]
fn wrong_hits_faces_and_visibilities_of_a_recording() {
    let scene = walls(FluxModel::Radiometric);
    let mut wrong = exact(&scene);
    map(&mut wrong).face.as_mut().unwrap().set(2, 1, Maybe::some(FaceId(1)));
    let beam = &checked(&scene, &wrong, Precision::F64)[1];
    assert_eq!((beam.of(Class::Defect), beam.judged, beam.defects[0].item), (1, 1, Quantity::Face.into()));
    assert!(
        beam.defects[0].what.contains("it says face 1, true is face 0 at 2."),
        "{}",
        beam.defects[0].what
    );

    let mut wrong = exact(&scene);
    returns(&mut wrong).visible.as_mut().unwrap().set(2, 1, false);
    let beam = &checked(&scene, &wrong, Precision::F64)[1];
    assert_eq!((beam.of(Class::Defect), beam.defects[0].item), (1, Quantity::Visible.into()));
    // Its pixel is right.
    assert_eq!(beam.items.get(Quantity::Pixel.into()).unwrap().of(Class::Agree), 16);
}

#[test]
fn a_hidden_pencil_is_known_by_its_flux() {
    // From 1.5 m to the right the beam sees behind the near wall. Its column 0 meets the far wall at x = 1.5 - 1.4 m, and
    // the camera's line of sight to there crosses the near wall at x = 0.05 m.
    let mut scene = walls(FluxModel::Radiometric);
    let mut beam = scene.beams()[0];
    beam.scene_from_sensor.position.x = 1.5;
    scene =
        Scene::new(scene.mesh().clone(), *scene.camera(), vec![beam], scene.atmosphere(), scene.flux_model())
            .unwrap();
    let mut output = exact(&scene);
    let back = output.returns[0].clone();
    assert_eq!((back.visible.unwrap().at(0, 1), back.flux.unwrap().at(0, 1)), (false, 0.0));
    // A recording that does not say what is visible.
    output.returns[0].visible = None;
    assert_eq!(checked(&scene, &output, Precision::F64)[1].of(Class::Agree), 16);
    // Light from there is a defect.
    output.returns[0].flux.as_mut().unwrap().set(0, 1, 1e-9);
    assert_eq!(checked(&scene, &output, Precision::F64)[1].of(Class::Defect), 1);
}

#[test]
fn a_recorded_pixel_is_the_sum_of_its_pencils() {
    let scene = walls(FluxModel::Radiometric);
    let right = exact(&scene);
    let lit = returns(&mut right.clone()).pixel.as_ref().unwrap().at(2, 1).get().unwrap();
    // With its pencils, and by the image alone.
    let mut alone = right.clone();
    alone.returns[0] = Returns::unsupported(8, 2);
    for (output, factor) in [(&right, 0.999), (&right, 1.001), (&alone, 1.001)] {
        let mut wrong = output.clone();
        let flux = wrong.flux[0].at(lit.i, lit.j);
        wrong.flux[0].set(lit.i, lit.j, flux * factor);
        let camera = &checked(&scene, &wrong, Precision::F64)[0];
        assert_eq!((camera.of(Class::Defect), camera.of(Class::Agree)), (1, 80));
        assert_eq!((camera.defects[0].place.i, camera.defects[0].place.j), (lit.i, lit.j));
    }
}

#[test]
fn the_error_of_a_recorded_pixel_is_told_in_units_in_the_last_place() {
    let scene = walls(FluxModel::Radiometric);
    let mut output = exact(&scene);
    let Pixel { i, j } = returns(&mut output).pixel.as_ref().unwrap().at(2, 1).get().unwrap();
    let sum = output.flux[0].at(i, j);
    output.flux[0].set(i, j, sum.next_up().next_up().next_up());
    let camera = &checked(&scene, &output, Precision::F64)[0];
    let worst = camera.items.get(Item::of_image(0)).unwrap().worst_ulps.as_ref().unwrap();
    assert_eq!((worst.value, worst.place.i, worst.place.j), (3.0, i, j));
    // Where no light falls, the smallest number is too much.
    output.flux[0].set(0, 8, f64::from_bits(1));
    assert_eq!(checked(&scene, &output, Precision::F64)[0].of(Class::Defect), 1);
}

#[test]
fn a_pixel_that_adds_up_a_wrong_pencil_is_a_defect_like_it() {
    // A pencil that is said to land one pixel to the right, and whose light is in the image there.
    let scene = walls(FluxModel::Radiometric);
    let mut wrong = exact(&scene);
    let Pixel { i, j } = returns(&mut wrong).pixel.as_ref().unwrap().at(2, 1).get().unwrap();
    let (_, move_pencil) = CHANGES[9];
    move_pencil(&mut wrong);
    let watts = returns(&mut wrong).flux.as_ref().unwrap().at(2, 1);
    for (i, more) in [(i, -watts), (i + 1, watts)] {
        let sum = wrong.flux[0].at(i, j);
        wrong.flux[0].set(i, j, sum + more);
    }
    let camera = &checked(&scene, &wrong, Precision::F64)[0];
    assert_eq!((camera.of(Class::Defect), camera.of(Class::Agree)), (2, 79));
    for defect in &camera.defects {
        assert!(defect.what.contains("it adds up a pencil that is wrong"), "{}", defect.what);
    }
}

#[test]
fn light_near_a_border_may_go_either_way_within_the_arithmetic() {
    // 1e-7 of a pixel from the border: far beyond the arithmetic of f64, far within that of f32. A point at 2 m has
    // roundings of some 1e-7 m in f32, 4e-7 of a pixel, and the bound is a few dozen of them.
    let scene = walls_with_pencils_moved(1e-7 - 0.3);
    let right = exact(&scene);
    let [upper, lower] = [0, 1].map(|j| right.returns[0].flux.as_ref().unwrap().at(2, j));
    assert_eq!(right.returns[0].pixel.as_ref().unwrap().at(2, 1).get(), Some(Pixel { i: 3, j: 3 }));
    let moved = |watts: f64| {
        let mut output = right.clone();
        output.returns[0] = Returns::unsupported(8, 2);
        let [left, here] = [2, 3].map(|i| output.flux[0].at(i, 3));
        output.flux[0].set(2, 3, left + watts);
        output.flux[0].set(3, 3, here - watts);
        output
    };
    let classes = |output: &RenderOutput, precision| {
        let camera = &checked(&scene, output, precision)[0];
        [Class::Agree, Class::Rounding, Class::Defect].map(|class| camera.of(class))
    };
    // None, one or both of the two pencils in the other pixel.
    assert_eq!(classes(&moved(0.0), Precision::F32), [81, 0, 0]);
    for watts in [upper, lower, upper + lower] {
        assert_eq!(classes(&moved(watts), Precision::F32), [79, 2, 0]);
        assert_eq!(classes(&moved(watts), Precision::F64), [79, 0, 2]);
    }
    // A recording that gives the light of its pencils, but not where they land, says no more.
    let mut with_flux = moved(upper);
    with_flux.returns[0].flux = right.returns[0].flux.clone();
    assert_eq!(classes(&with_flux, Precision::F32), [79, 2, 0]);
    // Half a pencil is no answer.
    assert_eq!(classes(&moved(0.5 * upper), Precision::F32), [79, 0, 2]);
    // Farther from the border nothing may move.
    let scene = walls(FluxModel::Radiometric);
    let mut wrong = exact(&scene);
    let watts = wrong.returns[0].flux.as_ref().unwrap().at(2, 0);
    wrong.returns[0] = Returns::unsupported(8, 2);
    let [left, here] = [2, 3].map(|i| wrong.flux[0].at(i, 3));
    wrong.flux[0].set(2, 3, left + watts);
    wrong.flux[0].set(3, 3, here - watts);
    assert_eq!(checked(&scene, &wrong, Precision::F32)[0].of(Class::Defect), 2);
}

#[test]
fn light_that_just_misses_the_image_may_be_on_it_within_the_arithmetic() {
    // The pencils of column 0 land 1e-7 of a pixel beside the image, those of column 1 in column 0.8.
    let scene = walls_with_pencils_moved(-1.7 - 1e-7);
    let right = exact(&scene);
    assert_eq!(right.returns[0].pixel.as_ref().unwrap().at(0, 1).get(), None);
    let place = Place { sensor: SensorId::Beam(0), i: 0, j: 1 };
    let judge = Judge::new(&scene, JudgeShare::Sample);
    let watts = judge.returned_as(place, FaceId(0), true, Some(Pixel { i: 0, j: 3 })).unwrap().flux;
    let mut more = right.clone();
    more.returns[0] = Returns::unsupported(8, 2);
    let sum = more.flux[0].at(0, 3);
    more.flux[0].set(0, 3, sum + watts);
    let classes = |precision| {
        let camera = &checked(&scene, &more, precision)[0];
        [Class::Agree, Class::Rounding, Class::Defect].map(|class| camera.of(class))
    };
    assert!(watts > 0.0);
    assert_eq!((classes(Precision::F32), classes(Precision::F64)), ([80, 1, 0], [80, 0, 1]));
}

#[test]
fn a_ground_truth_is_held_to_the_sums_of_its_pencils() {
    let scene = walls(FluxModel::Radiometric);
    let right = GroundTruth::certified(&scene, &Silent);
    assert_eq!(right.first_uncertified(JudgeShare::All).0, None);
    // A change of 2^-51 is within the roundings of a sum of two or more; one of 1e-9 is not, by either model.
    let pixel = right.answers().light[0].returns.pixel.as_ref().unwrap().at(2, 1).get().unwrap();
    let found = |is_other_model: bool, factor: f64| {
        let mut answers = right.answers().clone();
        let light = &mut answers.light[0];
        let image = if is_other_model { &mut light.other_image } else { &mut light.image };
        let image = image.as_mut().unwrap();
        let sum = image.at(pixel.i, pixel.j);
        image.set(pixel.i, pixel.j, sum * factor);
        GroundTruth::of_answers(&scene, answers).first_uncertified(JudgeShare::Sample).0
    };
    for is_other_model in [false, true] {
        assert_eq!(found(is_other_model, 1.0 + 2.0 * f64::EPSILON), None);
        for factor in [1.0 - 1e-9, 1.0 + 1e-9] {
            let uncertified = found(is_other_model, factor).unwrap();
            assert_eq!(uncertified.part, "the sum over its pencils");
            let Place { sensor, i, j } = uncertified.place;
            assert_eq!((sensor, i, j), (SensorId::Camera, pixel.i, pixel.j));
        }
    }
}

#[test]
fn rays_that_a_rule_of_the_paper_loses_are_approximations() {
    // In place of the wall at 4 m a triangle with corners on the image, sqrt(16 + 0.81 + 4) = 4.56 m, 4.56 m and 4.52 m
    // away. The longest range is 4.4 m: rule 3b of the paper, as printed, loses the whole triangle. Its inner points are
    // nearer: pixel (6, 4) meets it in (1, 0, 4), 4.12 m away.
    let walls = walls(FluxModel::Radiometric);
    let corners =
        [walls.mesh().vertices()[..3].to_vec(), vec![[0.9, -2.0, 4.0], [0.9, 2.0, 4.0], [2.1, 0.0, 4.0]]];
    let materials = walls.mesh().materials().to_vec();
    let mesh =
        Mesh::new(DVec3::ZERO, corners.concat(), vec![[0, 1, 2], [3, 4, 5]], vec![0; 2], materials).unwrap();
    let mut camera = *walls.camera();
    camera.sensor.max_range = 4.4;
    let scene = Scene::new(Arc::new(mesh), camera, vec![], walls.atmosphere(), walls.flux_model()).unwrap();

    let right = exact(&scene);
    let mut lost = right.clone();
    let mut count = 0;
    for (j, i) in (0..9).flat_map(|j| (0..9).map(move |i| (j, i))) {
        let maps = lost.camera.as_mut().unwrap();
        if maps.face.as_ref().unwrap().at(i, j).get() == Some(FaceId(1)) {
            maps.face.as_mut().unwrap().set(i, j, Maybe::NONE);
            maps.range.as_mut().unwrap().set(i, j, Maybe::NONE);
            count += 1;
        }
    }
    let judge = Judge::new(&scene, JudgeShare::Sample);
    let rule = Switches { skip_rules: Fidelity::Paper, ..Switches::EXACT };
    // Without the rule the renderer is exact.
    let rerender = |_: Switches, request: Request| ExactRenderer.render(&scene, &request);
    let found = Attributions::find(&judge, &lost, rule, Precision::F64, &rerender);
    let cause = |i| found.cause(Place { sensor: SensorId::Camera, i, j: 4 }).map(|cause| cause.switches);
    assert_eq!((cause(3), cause(6)), (None, Some(rule)));

    let side = |name, output, attributions| Side { name, output, precision: Precision::F64, attributions };
    let [camera] =
        &compare_judged(&judge, side("paper", &lost, Some(&found)), side("exact", &right, None))[..]
    else {
        panic!("one sensor")
    };
    assert_eq!((camera.of(Class::Approximation), camera.of(Class::Agree)), (count, 81 - count));
    let tally = &camera.approximations[&rule];
    assert_eq!((tally.rays, tally.lost, tally.added, &tally.worst_range), (count, count, 0, &None));
    // Without a cause they are defects.
    let unexplained = compare_judged(&judge, side("paper", &lost, None), side("exact", &right, None));
    assert_eq!(unexplained[0].of(Class::Defect), count);
}

#[test]
fn tallies_of_approximations_add_up() {
    let part = |rays, lost, added, flux_changed| ApproximationTally {
        rays,
        lost,
        added,
        flux_changed,
        ..ApproximationTally::default()
    };
    let mut all = part(1, 2, 3, 4.0);
    all.add(&part(10, 20, 30, 40.0));
    assert_eq!(all, part(11, 22, 33, 44.0));
}

#[test]
fn channels_of_files_and_their_items() {
    // The names of docs/formats/files.md. The scene's model is the radiometric one.
    let scene = walls(FluxModel::Radiometric);
    let beam = |name| item_of_channel(&scene, SensorId::Beam(0), name);
    let camera = |name| item_of_channel(&scene, SensorId::Camera, name);
    let of_both = [
        ("range.T", Quantity::Range),
        ("depth.Z", Quantity::Depth),
        ("P.Y", Quantity::Point),
        ("N.Z", Quantity::Normal),
        ("incidence.V", Quantity::CosIncidence),
        ("face.I", Quantity::Face),
    ];
    for (name, quantity) in of_both {
        assert_eq!((beam(name), camera(name)), (Some(quantity.into()), Some(quantity.into())), "{name}");
    }
    let of_pencils = [
        ("visible.V", Quantity::Visible),
        ("pixel.I", Quantity::Pixel),
        ("pixel.J", Quantity::Pixel),
        ("view.Z", Quantity::CameraDepth),
        ("offAxis.V", Quantity::CosOffAxis),
        ("emission.V", Quantity::CosView),
        ("flux.V", Quantity::PencilFlux),
    ];
    for (name, quantity) in of_pencils {
        assert_eq!((beam(name), camera(name)), (Some(quantity.into()), None), "{name}");
    }
    let other = |item: Item| Some(Item { is_other_model: true, ..item });
    assert_eq!(beam("flux.eq1.V"), other(Quantity::PencilFlux.into()));
    assert_eq!(camera("flux.beam0"), Some(Item::of_image(0)));
    assert_eq!(camera("flux.eq1.beam0"), other(Item::of_image(0)));
    for name in ["flux.beam1", "flux.radiometric.beam0", "flux.V", "range"] {
        assert_eq!(camera(name), None, "{name}");
    }
}

#[test]
fn names_of_quantities() {
    let names = Quantity::ALL.map(|quantity| quantity.to_string());
    let expected = [
        "hit/miss",
        "face",
        "range",
        "depth",
        "point",
        "normal",
        "incidence",
        "visible",
        "pixel",
        "camera depth",
        "cos(phi)",
        "cos(theta)",
        "pencil flux",
        "pixel flux",
    ];
    assert_eq!(names, expected);
}

/// Two renderers of different arithmetic may differ by the bound of each, whichever is named first: neither is held to the other's.
#[test]
fn each_side_is_held_to_its_own_arithmetic() {
    let scene = walls(FluxModel::Radiometric);
    let output = exact(&scene);
    let camera = output.camera.as_ref().unwrap();
    let places = (0..9).flat_map(|j| (0..9).map(move |i| Place { sensor: SensorId::Camera, i, j }));
    for precisions in [[Precision::F64, Precision::F32], [Precision::F32, Precision::F64]] {
        for (share, defects) in [(0.9, 0), (1.1, 81)] {
            // The side in single precision is off.
            let mut off = output.clone();
            let ranges = off.camera.as_mut().unwrap().range.as_mut().unwrap();
            for place in places.clone() {
                let hit = camera.hit(place.i, place.j).unwrap();
                let bound = range_bound(&scene, place, hit.face, hit.range, precisions).unwrap();
                ranges.set(place.i, place.j, Maybe::some(hit.range + share * bound));
            }
            let side = |name, output, precision| Side { name, output, precision, attributions: None };
            let outputs = if precisions[0] == Precision::F32 { [&off, &output] } else { [&output, &off] };
            let (a, b) = (side("one", outputs[0], precisions[0]), side("other", outputs[1], precisions[1]));
            let found = &compared_sides(&scene, a, b)[0];
            let range = found.items.get(Quantity::Range.into()).unwrap();
            assert_eq!(range.of(Class::Defect), defects, "{precisions:?} {share}");
        }
    }
}
