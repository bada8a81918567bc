//! Ranges of grazing rays.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use raypencil_scene::{Atmosphere, Camera, FluxModel, Lens, Material, Mesh, Mounted, Pose, Scene, SensorId};

use super::*;

/// A camera 2^-13 m above level ground looks along x. Its middle pixel meets the ground 2 m away at a slope of 2^-14,
/// too oblique for f64 to tell the range.
#[test]
fn the_range_of_a_grazing_ray_is_that_of_the_displaced_ray() {
    let material = Material { name: "ground".into(), reflectivity: 0.25 };
    let vertices = vec![[-8.0, -8.0, 0.0], [24.0, 0.0, 0.0], [-8.0, 8.0, 0.0]];
    let mesh = Mesh::new(DVec3::ZERO, vertices, vec![[0, 1, 2]], vec![0], vec![material]).expect("a mesh");
    let slope = 1.0 / 16384.0;
    let camera = Camera {
        width: 3,
        height: 3,
        pixel_pitch: [slope / 8.0; 2],
        focal_length: 1.0,
        // The middle of pixel (1, 1) is 8 pitches below the horizon.
        principal_point: [1.5, 1.5 - 8.0],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    // z forward along x, y down along -z.
    let rotation = DQuat::from_xyzw(-0.5, 0.5, -0.5, 0.5);
    let pose = Pose { position: DVec3::new(0.0, 0.0, 1.0 / 8192.0), rotation };
    let camera = Mounted { scene_from_sensor: pose, sensor: camera };
    let scene =
        Scene::new(Arc::new(mesh), camera, vec![], Atmosphere { attenuation: 0.0 }, FluxModel::Radiometric)
            .expect("a scene");
    let referee = Referee::new(&scene);
    let sensor = MountedSensor::of(&scene, SensorId::Camera).expect("a camera");
    let mut near = Neighbourhood::new(&referee, &sensor, Aim { i: 1, j: 1, dx: 0.0, dy: 0.0 });
    near.find_distinct();
    let (_, doubt) = near.faces[0].range_at(&near.ray, [0.0; 2]);
    assert!(doubt >= 1.0 / (1u64 << 30) as f64, "{doubt:e}: not grazing enough to matter");
    for at in [[0.0, 0.0], [0.5, 0.0], [-0.25, 0.5], [1.0, -1.0]] {
        // The ray sinks by (8 + dy) / 8 slopes and turns by dx / 8 of them for each metre ahead.
        let ahead = 2.0 / (1.0 + at[1] / 8.0);
        let (aside, down) = (slope * at[0] / 8.0, slope * (1.0 + at[1] / 8.0));
        let expected = ahead * (1.0 + aside * aside + down * down).sqrt();
        let found = near.range_at(at).expect("the ground is met");
        assert!((found / expected - 1.0).abs() < 1e-14, "{at:?}: {found} {expected}");
    }
    // To the last bit, which f64 does not tell.
    let mut rounded_otherwise = 0;
    for at in (0..64).map(|k| [f64::from(k) / 67.0, f64::from(k % 9) / 9.0 - 0.5]) {
        let exact = ExactRay::new(&sensor, Aim { i: 1, j: 1, dx: at[0], dy: at[1] });
        assert_eq!(near.range_at(at), Some(near.faces[0].face.range(&exact)), "{at:?}");
        let (range, _) = near.faces[0].range_at(&near.ray, at);
        rounded_otherwise += u32::from(near.range_at(at) != Some(range));
    }
    assert!(rounded_otherwise > 8, "{rounded_otherwise}");
}
