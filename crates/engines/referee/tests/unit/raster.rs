//! Conditions of the paper's image, by hand.

use raypencil_scene::{FaceId, Mounted, Pose};

use super::*;
use crate::small_camera::small_camera;

fn at(x: f64, y: f64) -> Projected {
    Projected { x: Interval::of(x), y: Interval::of(y) }
}

/// The triangle is closed: its corners and sides belong to it, as far as intervals tell, and nothing beyond them does.
#[test]
fn a_triangle_contains_its_corners() {
    let corners = [at(0.0, 0.0), at(1.0, 0.0), at(0.5, 1.0)];
    let turned = [corners[0], corners[2], corners[1]];
    for triangle in [corners, turned] {
        for inside in corners.iter().chain(&[at(0.5, 0.0), at(0.25, 0.5)]) {
            assert!(is_within_lines(inside, &triangle).may_hold, "{inside:?}");
        }
        assert_eq!(is_within_lines(&at(0.5, 0.5), &triangle), Kleene::TRUE);
        let least = f64::MIN_POSITIVE;
        for outside in
            [at(-least, 0.0), at(1.0_f64.next_up(), 0.0), at(0.5, -least), at(0.5, 1.0_f64.next_up())]
        {
            assert_eq!(is_within_lines(&outside, &triangle), Kleene::FALSE, "{outside:?}");
        }
    }
}

/// A camera 1/32 m above level ground looks at the horizon, by rays that may be off by a pixel: they sink by up to 1/8. So the ground's plane
/// is met from 1/4 m on, but the image plane is 1/2 m away, and nothing before it counts, whichever side of the ground is the front.
#[test]
fn nothing_is_met_nearer_than_the_image_plane() {
    let sensor = MountedSensor::camera(Mounted { scene_from_sensor: Pose::IDENTITY, sensor: small_camera() });
    let tolerance = Tolerance { lateral: 1.0, depth: 0.0, position: 0.0, unit_roundoff: 0.0 };
    let with = Approximations { beam_edges: false, skip_rules: false };
    let ray = PaperRay::new(&sensor, Aim { i: 4, j: 4, dx: 0.0, dy: 0.0 }, with, tolerance);
    // y points down.
    let corners = [[-64.0, 0.03125, -1.0], [0.0, 0.03125, 64.0], [64.0, 0.03125, -1.0]];
    for corners in [corners, [corners[0], corners[2], corners[1]]] {
        let ground = Face { id: FaceId(0), corners };
        let nearer_than = |distance: f64| ray.meets_nearer_than(&ground, Interval::of(distance));
        assert_eq!(nearer_than(0.125), Kleene::FALSE);
        assert!(nearer_than(2.0).may_hold && nearer_than(2.0).may_fail);
        // A back is not met at all.
        let is_front = corners[2][2] > 0.0;
        assert_eq!(ray.plane(&ground).is_met_as_asked, Kleene { may_hold: is_front, may_fail: true });
    }
}
