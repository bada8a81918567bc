//! `setup.json` and `camera_info.yaml` against the text of the scene.

use serde_json::Value;

use super::driven::CLEAN;
use super::geometry::Pose;
use super::ground::{
    FOCAL, FRAME_RATE, OBSTACLES_EVERY, PITCH, PRINCIPAL, SCAN, SIZE, THICKNESS, sensors, true_pose,
};
use super::readers::yaml;

fn list(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

fn pose(value: &Value) -> Pose {
    Pose::of(&[list(&value["position"]), list(&value["quaternion"])].concat())
}

fn near(value: &Value, expected: f64) -> bool {
    (value.as_f64().unwrap() - expected).abs() <= 1e-12 * expected.abs().max(1.0)
}

#[test]
fn the_setup_has_the_sensors_where_the_scene_puts_them() {
    let setup = CLEAN.json("recording/setup.json");
    let camera = &setup["camera"];
    assert_eq!([&camera["width"], &camera["height"]].map(|side| side.as_u64().unwrap() as usize), SIZE);
    for axis in 0..2 {
        assert!(near(&camera["pixel_pitch"][axis], PITCH[axis]), "{camera}");
        assert!(near(&camera["principal_point"][axis], PRINCIPAL[axis]), "{camera}");
    }
    assert!(near(&camera["focal_length"], FOCAL) && near(&camera["max_range"], 20.0));
    let [of_camera, of_beams @ ..] = sensors();
    assert!(pose(&camera["vehicle_from_sensor"]).apart(&of_camera) < 1e-12);
    for (beam, expected) in setup["beams"].as_array().unwrap().iter().zip(of_beams) {
        assert!(pose(&beam["vehicle_from_sensor"]).apart(&expected) < 1e-12, "{beam}");
        assert!(near(&beam["thickness"], THICKNESS) && near(&beam["grid_distance"], 0.1));
        // Half of a fan of 60 degrees on a grid 0.1 m away.
        assert!(near(&beam["half_width"], 0.1 / 3.0_f64.sqrt()) && near(&beam["max_range"], 20.0), "{beam}");
    }
    assert!(near(&setup["frame_rate"], FRAME_RATE));
    assert_eq!(setup["obstacles_every"], OBSTACLES_EVERY);
    let ([from, to], steps) = SCAN;
    assert!(
        near(&setup["scan"]["from"], from)
            && near(&setup["scan"]["to"], to)
            && setup["scan"]["steps"] == steps
    );
    // The vehicle is told the height at which it truly stands.
    assert!((setup["start_elevation"].as_f64().unwrap() - true_pose(0).position[2]).abs() < 1e-9);
    assert!(near(&setup["grid"]["half_angle"], 30.0_f64.to_radians()) && near(&setup["grid"]["first"], 0.7));
}

#[test]
fn the_calibration_for_ros_counts_from_the_middle_of_the_first_pixel() {
    let text = std::fs::read_to_string(CLEAN.file("camera_info.yaml")).unwrap();
    assert_eq!([yaml(&text, "image_width")[0], yaml(&text, "image_height")[0]], [240.0, 144.0]);
    let lists: Vec<Vec<f64>> = text
        .lines()
        .filter_map(|line| line.strip_prefix("  data: ["))
        .map(|list| list.trim_end_matches(']').split(", ").map(|number| number.parse().unwrap()).collect())
        .collect();
    let [fx, fy] = PITCH.map(|pitch| FOCAL / pitch);
    let [cx, cy] = PRINCIPAL.map(|point| point - 0.5);
    let camera = [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0];
    let projection = [fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0];
    let is_near = |list: &[f64], expected: &[f64]| {
        list.len() == expected.len() && list.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9)
    };
    assert!(is_near(&lists[0], &camera) && is_near(&lists[3], &projection), "{text}");
    assert_eq!(lists[1], [0.0; 5]);
    assert_eq!(lists[2], [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
}
