//! Unit tests of `agreeing`: what is entered quickly is what `compare_ray` enters.

use std::sync::Arc;

use raypencil_referee::ExactRenderer;
use raypencil_scene::{
    Atmosphere, FluxModel, Maybe, Precision, RenderOutput, Renderer, Request, Scene, SensorId, rig,
};
use raypencil_terrain::builtin;

use super::*;
use crate::compare::compare_beams;
use crate::compare::ray::compare_ray;
use crate::judge::JudgeShare;

/// The next f64 but a few, up or down.
fn moved(value: f64, steps: i64) -> f64 {
    if value == 0.0 { value } else { f64::from_bits((value.to_bits() as i64 + steps) as u64) }
}

/// The pyramids through a camera of 64 x 64 pixels and two beams.
fn scene() -> Scene {
    let mesh = builtin("pyramids", 0.25).unwrap().into_mesh().unwrap();
    let (camera, beams) = rig::default_rig(16, DVec3::ZERO, 0.0);
    Scene::new(Arc::new(mesh), camera, beams, Atmosphere { attenuation: 0.0 }, FluxModel::Radiometric)
        .unwrap()
}

/// The same output with values off by a few ulps, so that largest errors change from pixel to pixel; and, with `faults`, with
/// values far off, lost hits, faces of others, and a NaN.
fn disturbed(output: &RenderOutput, faults: bool) -> RenderOutput {
    let mut other = output.clone();
    let camera = other.camera.as_mut().unwrap();
    let (width, height) = (camera.width, camera.height);
    for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
        let place = i * 31 + j * 17;
        let steps = i64::from(place % 7) - 3;
        let move_scalar = |image: &mut Option<Image<Maybe<f64>>>, by: i64| {
            let image = image.as_mut().unwrap();
            if let Some(value) = image.at(i, j).get() {
                image.set(i, j, Maybe::some(moved(value, by)));
            }
        };
        move_scalar(&mut camera.range, steps);
        move_scalar(&mut camera.depth, -steps);
        move_scalar(&mut camera.cos_incidence, 2 * steps);
        for image in [&mut camera.point, &mut camera.normal] {
            let image = image.as_mut().unwrap();
            if let Some(value) = image.at(i, j).get() {
                image.set(i, j, Maybe::some(DVec3 { x: moved(value.x, steps), ..value }));
            }
        }
        match place % 97 {
            5 if faults => camera.range.as_mut().unwrap().set(i, j, Maybe::some(1.0)),
            6 if faults => camera.face.as_mut().unwrap().set(i, j, Maybe::some(FaceId(3))),
            7 if faults => camera.point.as_mut().unwrap().set(i, j, Maybe::NONE),
            8 if faults => {
                camera.range.as_mut().unwrap().set(i, j, Maybe::NONE);
                camera.face.as_mut().unwrap().set(i, j, Maybe::NONE);
            }
            9 if faults => {
                let infinite = DVec3::new(0.0, f64::NAN, 0.0);
                camera.normal.as_mut().unwrap().set(i, j, Maybe::some(infinite));
            }
            10 if faults => camera.face.as_mut().unwrap().set(i, j, Maybe::some(FaceId(u32::MAX - 1))),
            11 if faults => other.flux[0].set(i, j, 1e-9),
            _ => {}
        }
    }
    other
}

#[test]
fn quick_pixels_are_entered_as_all_others_are() {
    let scene = scene();
    let judge = Judge::new(&scene, JudgeShare::Sample);
    let output = ExactRenderer.render(&scene, &Request::EVERYTHING);
    for faults in [false, true] {
        let other = disturbed(&output, faults);
        let side = |name, output| Side { name, output, precision: Precision::F64, attributions: None };
        let (a, b) = (side("a", &output), side("b", &other));
        let (_, light) = compare_beams(&judge, a, b);
        let maps = [a, b].map(|side| side.output.camera.as_ref().unwrap());
        let [of_a, of_b] = [(maps[0], a), (maps[1], b)];
        let mut quick = 0;
        for j in 0..maps[0].height {
            let (mut row, mut slow_row) =
                (ComparedRays::none(SensorId::Camera), ComparedRays::none(SensorId::Camera));
            let mut agreeing = AgreeingPixels::new(&judge, of_a, of_b, &light).unwrap();
            for i in 0..maps[0].width {
                let place = Place { sensor: SensorId::Camera, i, j };
                if agreeing.enter(place, &mut row) {
                    quick += 1;
                } else {
                    compare_ray(&judge, place, of_a, of_b, &light, &mut row);
                }
                compare_ray(&judge, place, of_a, of_b, &light, &mut slow_row);
            }
            // Also the places of the largest errors, and of NaN.
            assert_eq!(format!("{:?}", row.result), format!("{:?}", slow_row.result), "row {j}");
            assert_eq!(format!("{:?}", row.range_differences), format!("{:?}", slow_row.range_differences));
        }
        assert!(quick > 2000, "{quick}");
    }
    // A map that leaves out a quantity, or an image that is missing, is none of these.
    let mut without = output.clone();
    without.camera.as_mut().unwrap().normal = None;
    let side = |output| Side { name: "a", output, precision: Precision::F64, attributions: None };
    let maps = (output.camera.as_ref().unwrap(), without.camera.as_ref().unwrap());
    let (_, light) = compare_beams(&judge, side(&output), side(&output));
    assert!(AgreeingPixels::new(&judge, (maps.0, side(&output)), (maps.1, side(&without)), &light).is_none());
    assert!(
        AgreeingPixels::new(&judge, (maps.0, side(&output)), (maps.0, side(&output)), &light[..1]).is_none()
    );
}
