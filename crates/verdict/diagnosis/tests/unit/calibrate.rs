//! Numbers of a sensor as they are told.

use std::sync::Arc;

use super::*;
use crate::it::candidates::pyramids;

#[test]
fn the_fan_of_a_beam_is_the_angle_of_its_grid_at_any_distance() {
    let scene = pyramids().scene;
    let mut beams = scene.beams().to_vec();
    // Half of the grid is a quarter of its distance: 2 atan(1/4).
    (beams[0].sensor.half_width, beams[0].sensor.grid_distance) = (0.5, 2.0);
    let scene =
        Scene::new(Arc::clone(scene.mesh()), *scene.camera(), beams, scene.atmosphere(), scene.flux_model());
    let scene = scene.expect("a scene");
    // A fan of 30 degrees in its place: tan(15 degrees) times as wide, but for the last digits.
    let factor = libm::tan(15_f64.to_radians()) / 0.25;
    let numbers = Numbers { fan: factor + 1e-12, ..Numbers::SCENE };
    let fit = Fit { model: vec![Fan], numbers, uncertainty: vec![1e-9], left: 0.0 };
    let (mistake, rules) = told(&scene, SensorId::Beam(0), &fit).expect("a mistake");
    let Mistake::Fan { stated, truth } = mistake else { panic!("{mistake}") };
    assert_eq!(stated, 30.0);
    assert!((truth - 28.072_486_935_852_96).abs() < 1e-11, "{truth}");
    assert!((rules.numbers.fan - factor).abs() < 1e-14, "{} {factor}", rules.numbers.fan);
}
