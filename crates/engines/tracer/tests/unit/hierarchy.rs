//! Unit tests of `hierarchy`: trace distance, padding.

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{Atmosphere, Camera, FluxModel, Lens, Material, Pose, Profile};

use super::*;

#[test]
fn the_trace_distance_is_the_length_of_the_longest_ray() {
    let camera = |max_range: f64| Camera {
        width: 2,
        height: 2,
        pixel_pitch: [1e-3; 2],
        focal_length: 1e-2,
        principal_point: [1.0; 2],
        aperture: 1e-3,
        lens: Lens::CLEAR,
        max_range,
    };
    let beam = |max_range: f64| Beam {
        columns: 1,
        rows: 1,
        thickness: 0.5,
        grid_distance: 0.1,
        half_width: 0.1,
        max_range,
        power: 1.0,
        wavelength: 8e-7,
        profile: Profile::Paper,
    };
    // By the maximum ranges of the camera and of the two beams.
    let distance = |of_camera: f64, of_beams: [f64; 2]| {
        let ground = vec![Material { name: "ground".into(), reflectivity: 0.5 }];
        let mesh = Mesh::new(DVec3::ZERO, vec![[0.0; 3]; 3], vec![[0, 1, 2]], vec![0], ground).unwrap();
        let at = Pose::from_position(DVec3::new(1.0, 1.0, 1.0));
        // At sqrt(4 + 4 + 1) = 3 m from the camera, and at 9 m.
        let poses = [DVec3::new(3.0, -1.0, 2.0), DVec3::new(1.0, 10.0, 1.0)].map(Pose::from_position);
        let beams = [0, 1].map(|k| Mounted { scene_from_sensor: poses[k], sensor: beam(of_beams[k]) });
        let camera = Mounted { scene_from_sensor: at, sensor: camera(of_camera) };
        let air = Atmosphere { attenuation: 0.0 };
        max_trace_distance(
            &Scene::new(Arc::new(mesh), camera, beams.into(), air, FluxModel::Radiometric).unwrap(),
        )
    };
    // The camera's own range; or a beam's range, half its thickness of 0.5 m, and its distance from the camera.
    assert_eq!(distance(20.0, [5.0, 5.0]), 20.0);
    assert_eq!(distance(10.0, [8.0, 1.0]), 11.25);
    assert_eq!(distance(10.0, [1.0, 8.0]), 17.25);
}

#[test]
fn a_box_is_padded_by_the_derived_bound() {
    // 9 x 2^-24 of the largest coordinate, 9 m, plus the maximum trace distance, 100 m.
    let padded = padded_box(&[[1.0, 2.0, 3.0], [-4.0, 5.0, 6.0], [7.0, -8.0, 9.0]], 100.0);
    let padding = 9.0 / f64::from(1 << 24) * 109.0;
    // Rounded outward by at most two f32 steps; below 16 a step is 2^-20.
    let outward = |wider: f64| (padding..=padding + 2.0 / f64::from(1 << 20)).contains(&wider);
    for (axis, low, high) in [(0, -4.0, 7.0), (1, -8.0, 5.0), (2, 3.0, 9.0)] {
        let (min, max) = (f64::from(padded.min[axis]), f64::from(padded.max[axis]));
        assert!(outward(low - min) && outward(max - high), "{axis}: {min} to {max}");
    }
    // The coordinate of largest magnitude may be negative.
    let other = padded_box(&[[-1.0, -2.0, -3.0], [4.0, -5.0, -6.0], [-7.0, 8.0, -9.0]], 100.0);
    assert_eq!((other.min, other.max), (-padded.max, -padded.min));
}
