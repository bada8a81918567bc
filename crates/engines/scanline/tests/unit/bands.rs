//! Unit tests of `bands`: the rows in which a face is scanned, and the faces that are skipped.

use raypencil_scene::{Mounted, Pose};

use super::*;
use crate::fixtures::{camera, mesh};
use crate::perspective::Perspective;
use crate::tables::CameraTables;

/// The rows that a face may touch, for a camera at the origin that looks along +z.
fn rows_of(corners: [[f32; 3]; 3], skip_unseen: bool) -> Option<std::ops::Range<u32>> {
    let (camera, mesh) = (camera(), mesh(&[corners]));
    let tables = CameraTables::new(&camera);
    let mounted = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera };
    let transformation = Perspective::new(&mounted, &tables);
    let clusters = Clusters::new(&mesh);
    let transformed = TransformedClusters::new(&mesh, &clusters, &clusters.all(), false, |in_scene| {
        let position = widen(in_scene);
        let (projection, outside) = (transformation.project(position), transformation.outside(position));
        SensorVertex { in_scene, position, projection, outside }
    });
    let faces = FaceScanner {
        transformation: &transformation,
        skip_unseen,
        screen: SensorScreen::new(transformation.columns(), transformation.rows()),
    };
    faces.rows(&transformed, transformed.faces[0])
}

/// A face at depth z that shows its front. The corners are given on the SPP.
fn front(z: f32, corners: [[f32; 2]; 3]) -> [[f32; 3]; 3] {
    corners.map(|[x, y]| [x * z, y * z, z])
}

#[test]
fn a_band_has_as_many_rows_as_fit() {
    for ((width, height), rows) in
        [((1024, 1024), 32), ((1000, 1000), 32), ((64, 48), 48), ((40_000, 5), 1), ((1, 1), 1)]
    {
        assert_eq!(rows_per_band(width, height), rows, "{width} {height}");
    }
}

#[test]
fn a_face_is_scanned_in_the_rows_that_it_touches() {
    // The row centres are -7/8, -5/8, ... 7/8. Those from y = -0.3 to 0.4 are -1/8, 1/8, 3/8.
    let face = front(2.0, [[-0.5, -0.3], [0.0, 0.4], [0.5, -0.3]]);
    for skip_unseen in [true, false] {
        assert_eq!(rows_of(face, skip_unseen), Some(3..6));
    }
    // A face between two row centres touches no row, with and without skipping.
    let thin = front(2.0, [[-0.5, -0.3], [0.0, -0.2], [0.5, -0.3]]);
    assert_eq!((rows_of(thin, true), rows_of(thin, false)), (None, None));
}

#[test]
fn unseen_faces_are_skipped_only_if_asked_for() {
    let across = |x: f32, y: f32| front(2.0, [[x - 0.5, y - 0.3], [x, y + 0.4], [x + 0.5, y - 0.3]]);
    let [a, b, c] = across(0.0, 0.0);
    let unseen = [
        ("left (3a)", across(-1.6, 0.0)),
        ("right (3a)", across(1.6, 0.0)),
        ("deeper than the maximum range (3b)", front(101.0, [[-0.5, -0.3], [0.0, 0.4], [0.5, -0.3]])),
        ("a back (1b)", [a, c, b]),
        // x from -0.09 to 0.09: between the centres -1/8 and 1/8.
        ("between two columns", front(2.0, [[-0.09, -0.3], [0.0, 0.4], [0.09, -0.3]])),
        // Partly above and partly left of the screen's corner (-1, -1). The side x + y = -2.5 passes outside it.
        ("beyond one side (3c)", front(2.0, [[-2.2, -2.2], [-2.2, -0.3], [-0.3, -2.2]])),
        ("beyond one side (3c)", front(2.0, [[2.2, 2.2], [2.2, 0.3], [0.3, 2.2]])),
    ];
    for (why, face) in unseen {
        assert_eq!(rows_of(face, true), None, "{why}");
        assert!(rows_of(face, false).is_some(), "{why}");
    }
    // Above and below the screen there are no rows, with and without skipping.
    for y in [-1.6, 1.6] {
        assert_eq!((rows_of(across(0.0, y), true), rows_of(across(0.0, y), false)), (None, None));
    }
    // A face across the corner of the screen, and faces partly beyond each of its sides, are not skipped.
    let corner = front(2.0, [[-2.0, -2.0], [-2.0, 1.5], [1.5, -2.0]]);
    assert_eq!(rows_of(corner, true), Some(0..8));
    for (x, y) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)] {
        assert!(rows_of(across(x, y), true).is_some(), "{x} {y}");
    }
}

#[test]
fn a_face_that_the_spp_cuts_may_touch_any_row() {
    let cut = [[-0.5, -0.3, 2.0], [0.0, 0.4, 0.5], [0.5, -0.3, 2.0]];
    // Two of three vertices are behind it, whichever they are.
    let [a, b, c] = [[-0.5, -0.3, 0.5], [0.0, 0.4, 0.5], [0.5, -0.3, 2.0]];
    let behind = [[-0.5, -0.3, 0.9], [0.0, 0.4, 0.5], [0.5, -0.3, 0.9]];
    for skip_unseen in [true, false] {
        for cut in [cut, [a, b, c], [b, c, a], [c, a, b]] {
            assert_eq!(rows_of(cut, skip_unseen), Some(0..8), "{cut:?}");
        }
        assert_eq!(rows_of(behind, skip_unseen), None);
    }
}

#[test]
fn of_equally_near_faces_the_lowest_is_kept_whichever_comes_first() {
    // Two faces in the plane z = 2 that both cover the pixel at (1/8, 1/8). The one with the higher index is the first along
    // the clusters' curve, and so the first that is scanned.
    let right = front(2.0, [[-0.5, -0.25], [1.0, 4.0], [1.5, -0.25]]);
    let left = front(2.0, [[-4.0, -0.25], [0.0, 1.0], [0.5, -0.25]]);
    let tables = CameraTables::new(&camera());
    let mounted = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera() };
    let transformation = Perspective::new(&mounted, &tables);
    for faces in [[right, left], [left, right]] {
        let mesh = mesh(&faces);
        let clusters = Clusters::new(&mesh);
        let quantities = Quantities::RANGE_MAP;
        let options = ScanlineOptions::EXACT;
        let map = render(
            &mesh,
            &clusters,
            &transformation,
            SensorId::Camera,
            (quantities, MetSide::Fronts),
            options,
        );
        assert_eq!(map.face.unwrap().at(4, 4).get(), Some(FaceId(0)));
    }
}
