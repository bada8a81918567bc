//! Tolerances by hand, and the sample of rays.

use std::sync::Arc;

use super::*;
use glam::DVec3;
use raypencil_scene::{Atmosphere, Beam, Camera, FluxModel, Material, Mesh, Mounted, Pose, rig};

/// A roundoff so coarse that no tolerance is the smallest one.
const U: f64 = 1.0 / (1 << 20) as f64;
const COARSE: Precision = Precision { unit_roundoff: U };

/// kappa of sides of 6, 8 and 10 m.
const KAPPA: f64 = 8.0 * 10.0 / 48.0;

/// Face 0: a right triangle of 6, 8 and 10 m in the plane z = 2 m. Face 1: the same behind all sensors, at z = -9 m.
/// Faces 2 and 3 are face 0 from its other corners.
/// The camera stands at z = -1 m, a beam 0.75 m beside it in row 1; both look along z.
fn scene(thickness: f64) -> Scene {
    let triangle = |z: f32| [[-2.0, -2.0, z], [4.0, -2.0, z], [-2.0, 6.0, z]];
    let corners = [triangle(2.0), triangle(-9.0)].concat();
    let ground = Material { name: "ground".into(), reflectivity: 0.25 };
    let mesh = Mesh::new(
        DVec3::ZERO,
        corners,
        vec![[0, 2, 1], [3, 4, 5], [2, 1, 0], [1, 0, 2]],
        vec![0; 4],
        vec![ground],
    )
    .unwrap();
    let sensor = Camera {
        pixel_pitch: [0.0625, 0.03125],
        principal_point: [4.5, 4.5],
        max_range: 20.0,
        ..rig::camera(16, 9, 0.0625, 0.5)
    };
    let at = |y| Pose::from_position(DVec3::new(0.0, y, -1.0));
    let camera = Mounted { scene_from_sensor: at(0.0), sensor };
    let beam = Beam { half_width: 0.5, thickness, max_range: 30.0, ..rig::beam(4, 2, [0.25, 0.125], 0.5) };
    // Row 1 of 2 starts a quarter of the thickness below the middle.
    let beam = Mounted { scene_from_sensor: at(0.75 - 0.25 * thickness), sensor: beam };
    Scene::new(Arc::new(mesh), camera, vec![beam], Atmosphere { attenuation: 0.0 }, FluxModel::Radiometric)
        .unwrap()
}

#[track_caller]
fn assert_tolerance(found: Tolerance, lateral: f64, depth: f64, position: f64) {
    for (found, expected) in [(found.lateral, lateral), (found.depth, depth), (found.position, position)] {
        assert!((found - expected).abs() <= 1e-14 * expected, "{found} is not {expected}");
    }
}

/// Pixel (10, 4): x = 6/16 and z = 1/2, |q| = 5/8 m. Column 3 of the beam has the same direction.
const PIXEL: Place = Place { sensor: SensorId::Camera, i: 10, j: 4 };
const PENCIL: Place = Place { sensor: SensorId::Beam(0), i: 3, j: 1 };

#[test]
fn tolerances_of_a_pixel() {
    let scene = scene(0.25);
    let judge = Judge::new(&scene, JudgeShare::All);
    // The plane of face 0 is 3 m ahead: R = 6 |q| = 3.75 m, S = 3.75 + 10 + 1 m. A pixel is at least p f / |q|^2 =
    // 0.04 wide as an angle. epsilon is 36 kappa u S / cos(psi), with kappa = 8 * 10 / 48 and cos(psi) = 0.8.
    let scale = 3.75 + 10.0 + 1.0;
    for stated in [None, Some(1000.0)] {
        let found = judge.tolerance(PIXEL, Some(FaceId(0)), stated, COARSE);
        let lateral = 21.0 * U * scale / 3.75 / 0.04;
        assert_tolerance(found, lateral, 36.0 * KAPPA * U * scale / 0.8, 21.0 * U * scale);
    }
    // Without a known face it is the stated range, and without that, or if it is none, the longest one: 20 m.
    for (stated, range) in [(Some(5.0), 5.0), (None, 20.0), (Some(-5.0), 20.0), (Some(f64::INFINITY), 20.0)] {
        for face in [None, Some(FaceId(4))] {
            let found = judge.tolerance(PIXEL, face, stated, COARSE);
            let position = 21.0 * U * (range + 1.0);
            assert_tolerance(found, position / range / 0.04, 0.0, position);
        }
    }
    // Of a face behind the sensor it is the distance of its plane, 16 |q|, whatever is stated.
    for stated in [None, Some(1e17)] {
        let found = judge.tolerance(PIXEL, Some(FaceId(1)), stated, COARSE);
        let scale = 10.0 + 10.0 + 1.0;
        assert_tolerance(
            found,
            21.0 * U * scale / 10.0 / 0.04,
            36.0 * KAPPA * U * scale / 0.8,
            21.0 * U * scale,
        );
    }
    // Never below 1e-9 cells, and never more than one.
    assert_eq!(judge.tolerance(PIXEL, None, None, Precision::F64).lateral, 1e-9);
    assert_eq!(judge.tolerance(PIXEL, None, None, Precision { unit_roundoff: 0.25 }).lateral, 1.0);
}

#[test]
fn tolerances_of_a_pencil() {
    // |o| = 1.25 m: S = 3.75 + 10 + 1.25 m. A row is half the thickness. A column is 0.25 m wide, which is at least
    // 0.25 g / |q|^2 = 0.32 as an angle.
    let scale = 15.0;
    for (thickness, lateral) in [(0.25, scale / 0.125), (100.0, scale / 3.75 / 0.32)] {
        let scene = scene(thickness);
        let found = Judge::new(&scene, JudgeShare::All).tolerance(PENCIL, Some(FaceId(0)), None, COARSE);
        assert_tolerance(found, 21.0 * U * lateral, 36.0 * KAPPA * U * scale / 0.8, 21.0 * U * scale);
    }
}

#[test]
fn the_longest_edge_is_that_between_any_two_corners() {
    let scene = scene(0.25);
    assert_eq!([0, 2, 3].map(|face| longest_edge(&scene, FaceId(face))), [10.0; 3]);
}

#[test]
fn a_plane_behind_the_sensor_is_not_hit() {
    let scene = scene(0.25);
    let judge = Judge::new(&scene, JudgeShare::All);
    for place in [PIXEL, PENCIL] {
        assert_eq!(judge.plane_hit(place, FaceId(0)).unwrap().range, 3.75);
        assert_eq!(judge.plane_hit(place, FaceId(1)), None);
    }
}

#[test]
fn the_sample_is_one_ray_in_64_by_the_finaliser_of_splitmix64() {
    let at = |sensor, i, j| Place { sensor, i, j };
    // The generator's first outputs for the seed 0, as its author publishes them: its state grows by the factor that
    // tells the sensors apart.
    assert_eq!(hash(at(SensorId::Beam(0), 0, 0)), 0xe220_a839_7b1d_cdaf);
    assert_eq!(hash(at(SensorId::Beam(1), 0, 0)), 0x6e78_9e6a_a1b9_65f4);
    assert_eq!(hash(at(SensorId::Camera, 0, 0)), 0);
    assert_ne!(hash(at(SensorId::Camera, 1, 2)), hash(at(SensorId::Camera, 2, 1)));

    let scene = scene(0.25);
    let sampled = |share| {
        let judge = Judge::new(&scene, share);
        let cells = (0..256).flat_map(|j| (0..256).map(move |i| at(SensorId::Camera, i, j)));
        cells.filter(|place| judge.samples(*place)).count()
    };
    assert_eq!(sampled(JudgeShare::All), 65_536);
    // 1024 are expected, with a standard deviation of 32.
    assert!(sampled(JudgeShare::Sample).abs_diff(1024) < 128);
}
