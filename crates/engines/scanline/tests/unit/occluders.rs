//! Unit tests of `occluders`: the bounds of clusters and of faces on the SPP.

use std::sync::Mutex;

use raypencil_scene::{Mounted, Pose};

use super::*;
use crate::fixtures::{camera, mesh};
use crate::tables::CameraTables;

/// A face whose box is -1 to 3 m in x, -2 to 1 m in y and 2 to 4 m in z.
const FACE: [[f32; 3]; 3] = [[-1.0, -2.0, 2.0], [3.0, 0.0, 2.0], [0.0, 1.0, 4.0]];

/// Bounds as numbers: left, right, top, bottom, and the largest 1/t.
fn numbers(of: &ProjectedBounds) -> [f64; 5] {
    [of.low.x, of.high.x, of.low.y, of.high.y, of.max_inverse_t]
}

#[test]
fn a_box_and_a_face_have_their_bounds_on_the_spp() {
    let ground = mesh(&[FACE]);
    let tables = CameraTables::new(&camera());
    let mounted = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera() };
    let perspective = Perspective::new(&mounted, &tables);
    let clusters = Clusters::new(&ground);
    let occluders = Occluders::new(&ground, &clusters, &perspective, Facing::Every, f64::INFINITY);
    // The corners of the box at z = 2 and 4 project to halves and quarters of x and y.
    let asked = Mutex::new(Vec::new());
    let seen = occluders.clusters(|bounds| {
        asked.lock().expect("a lock").push(numbers(bounds));
        true
    });
    assert_eq!(seen, [0]);
    let asked = asked.into_inner().expect("a lock");
    for found in &asked {
        for (found, expected) in found.iter().zip([-0.5, 1.5, -1.0, 0.5, 0.5]) {
            assert!((found - expected).abs() < 1e-9, "{asked:?}");
        }
    }
    // The group and the cluster.
    assert_eq!(asked.len(), 2);
    assert_eq!(occluders.clusters(|_| false), [0; 0]);

    let transformed = occluders.transformed(&seen);
    let mut visited = Vec::new();
    occluders.visit_face(
        FaceId(0),
        transformed.vertices_of(transformed.faces[0]),
        |_| true,
        |occluder| visited.push((numbers(&occluder.bounds), occluder.min_inverse_t)),
    );
    // The vertices are at (-1/2, -1), (3/2, 0) and (0, 1/4) on the SPP.
    assert_eq!(visited, [([-0.5, 1.5, -1.0, 0.25, 0.5], 0.25)]);
}
