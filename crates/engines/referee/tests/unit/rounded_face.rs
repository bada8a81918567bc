//! Errors of a face by hand, and rulings on either side of each.

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{
    Atmosphere, Camera, FaceId, FluxModel, Lens, Material, Mesh, Mounted, Pose, Scene, SensorId,
};

use super::*;
use crate::rays::ray::{Aim, MountedSensor};
use crate::{Referee, Ruling, Tolerance};

const UNIT_ROUNDOFFS: [f64; 3] = [f64::EPSILON / 2.0, f32::EPSILON as f64 / 2.0, 1.0 / 1024.0];

/// Edges of 3, 4 and 5 m: kappa = 4 * 5 / 12.
const KAPPA: f64 = 5.0 / 3.0;
/// The longest edge, metres.
const LONGEST: f64 = 5.0;

/// Such a triangle at this depth, around the way of pixel (10, 4); its front shows to the camera, or its back.
fn triangle(depth: f32, is_back: bool) -> [[f32; 3]; 3] {
    let x = 0.75 * depth;
    let [a, b, c] = [[x - 1.0, 2.0, 4.0 + depth], [x - 1.0, 6.0, 4.0 + depth], [x + 2.0, 2.0, 4.0 + depth]];
    if is_back { [a, c, b] } else { [a, b, c] }
}

/// A camera 5 m from the origin, at (0, 3, 4), that looks along z. Pixel (10, 4) has q = (3, 0, 4) / 8: |q| = 5/8 m, and the cosine
/// to z is 0.8. A pixel is 1/16 m wide.
fn camera(max_range: f64) -> Mounted<Camera> {
    let sensor = Camera {
        width: 16,
        height: 9,
        pixel_pitch: [0.0625; 2],
        focal_length: 0.5,
        principal_point: [4.5; 2],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range,
    };
    Mounted { scene_from_sensor: Pose::from_position(DVec3::new(0.0, 3.0, 4.0)), sensor }
}

const AIM: Aim = Aim { i: 10, j: 4, dx: 0.0, dy: 0.0 };

fn assert_close(found: f64, derived: f64) {
    assert!((found / derived - 1.0).abs() < 1e-8, "{found} is not {derived}");
}

#[test]
fn the_errors_of_a_face_by_hand() {
    let sensor = MountedSensor::camera(camera(100.0));
    let ray = ExactRay::new(&sensor, AIM);
    for (depth, range) in [(6.0, 7.5), (100.0, 125.0), (-8.0, -10.0)] {
        for is_back in [false, true] {
            let face = Face { id: FaceId(0), corners: triangle(depth, is_back) };
            for u in UNIT_ROUNDOFFS {
                let seen = RoundedFace::of(&face, &ray, u).expect("a face that is crossed");
                assert_close(seen.range, range);
                // S = R + L + |o|.
                let size = range.abs() + LONGEST + 5.0;
                assert_close(seen.range_error, (10.0 * KAPPA + 27.0) * u * size / 0.8);
                assert_eq!((seen.is_back, seen.is_edge_on), (is_back, false));
            }
            let least = 0.8 / (5.0 * KAPPA + 15.0);
            let is_edge_on = |u: f64| RoundedFace::of(&face, &ray, u).expect("a face").is_edge_on;
            assert!(!is_edge_on(0.99 * least) && is_edge_on(1.01 * least));
        }
    }
    let face = Face { id: FaceId(0), corners: triangle(6.0, false) };
    for u in UNIT_ROUNDOFFS {
        assert_close(plane_error(&face, 7.0, u), (5.0 * KAPPA + 6.0) * u * 7.0);
        // The plane of incidence is that of x and z, and the sine 0.6: an edge along y slips by all of it, one along x not at all.
        let (normal, line) = (2.0 * DVec3::Z, DVec3::new(3.0, 0.0, 4.0));
        let slip = |edge: DVec3| edge_slip(KAPPA, normal, edge, line, 7.0, u);
        assert_close(slip(DVec3::Y), (10.0 * KAPPA + 27.0) * u * 7.0 * 0.6);
        assert!(slip(DVec3::X) < 1e-12 * u);
    }
}

/// Rulings on pixel (10, 4) before faces at these depths.
fn rule(depths: &[f32], max_range: f64, answer: Option<u32>, depth: f64, unit_roundoff: f64) -> Ruling {
    let vertices: Vec<[f32; 3]> = depths.iter().flat_map(|&depth| triangle(depth, false)).collect();
    let faces: Vec<[u32; 3]> = (0..depths.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let stone = Material { name: "stone".into(), reflectivity: 0.5 };
    let mesh = Mesh::new(DVec3::ZERO, vertices, faces, vec![0; depths.len()], vec![stone]).unwrap();
    let air = Atmosphere { attenuation: 0.0 };
    let scene = Scene::new(Arc::new(mesh), camera(max_range), vec![], air, FluxModel::Radiometric).unwrap();
    let tolerance = Tolerance { lateral: 0.0, depth, position: 0.0, unit_roundoff };
    Referee::new(&scene).rule(SensorId::Camera, 10, 4, answer.map(FaceId), tolerance).expect("a pixel")
}

/// A gap between two ranges is excused up to the errors of both, at 0.9 of them and not at 1.1: to a face behind the nearest, beyond
/// the longest range, before the shortest; and to a miss of a face that is as near to an end. All far from the scene's origin.
#[test]
fn a_gap_is_excused_up_to_the_errors_of_ranges_and_not_beyond() {
    // Gaps in range are 1.25 of those in depth. Depth 6 is R = 7.5 m, depth 1/2 that of the projection plane.
    let depth_gap = 1.0 / 1024.0;
    let gap = 1.25 * depth_gap;
    let error = |range: f64, u: f64| (10.0 * KAPPA + 27.0) * u * (range + LONGEST + 5.0) / 0.8;
    let excused = |ruling: Ruling| matches!(ruling, Ruling::Rounding(_));
    let two = [6.0, 6.0 + depth_gap as f32];
    let (near, far) = ([0.5 - depth_gap as f32], [6.0 + depth_gap as f32]);
    let start = [0.5 + depth_gap as f32];
    for (share, is_excused) in [(0.9, true), (1.1, false)] {
        // The part of the gap that each error has.
        let own = gap / share;
        assert_eq!(
            excused(rule(&two, 100.0, Some(1), own, 0.0)),
            is_excused,
            "behind, by the named face's error"
        );
        let u = own / error(7.5, 1.0);
        assert_eq!(excused(rule(&two, 100.0, Some(1), 0.0, u)), is_excused, "behind, by the other's error");
        let both = rule(&two, 100.0, Some(1), 0.5 * own, 0.5 * u);
        assert_eq!(excused(both), is_excused, "behind, by half of each");
        assert_eq!(excused(rule(&far, 7.5, Some(0), own, 0.0)), is_excused, "beyond the longest range");
        assert_eq!(excused(rule(&near, 100.0, Some(0), own, 0.0)), is_excused, "before the projection plane");
        let missed = rule(&[6.0], 7.5 + gap, None, 0.0, own / error(7.5, 1.0));
        assert_eq!(excused(missed), is_excused, "a miss before the longest range");
        let range = f64::from(start[0]) * 1.25;
        let missed = rule(&start, 100.0, None, 0.0, own / error(range, 1.0));
        assert_eq!(excused(missed), is_excused, "a miss beyond the projection plane");
    }
}
