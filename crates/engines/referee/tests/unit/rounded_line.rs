//! Edges beside a line of sight, at 0.9 and at 1.1 of what each error explains.

use raypencil_scene::FaceId;

use super::*;

/// From a point at the origin 8 m along z to the camera, whose image plane is 1/8 of the way before it.
const LINE: RoundedLine = RoundedLine {
    ends: [DVec3::ZERO, DVec3::new(0.0, 0.0, 8.0)],
    position: 0.0,
    hit: 0.0,
    image_plane: 0.125,
    unit_roundoff: 0.0,
};

/// A right triangle with legs of 1 m in the plane at this height, whose leg along y passes the line at this distance; it lies
/// beyond that leg, or around the line.
fn plate(distance: f32, z: f32, is_around: bool) -> Face {
    let end = if is_around { distance - 1.0 } else { distance + 1.0 };
    Face { id: FaceId(0), corners: [[distance, -0.5, z], [distance, 0.5, z], [end, -0.5, z]] }
}

/// Whether the plate's edge at 1/64 m is uncertain, where the error is this share of the distance.
fn is_uncertain(face: &Face, line: RoundedLine) -> bool {
    line.uncertain_edge(face).is_some()
}

#[test]
fn an_edge_may_seem_displaced_by_each_error_and_no_farther() {
    let distance = 1.0 / 64.0;
    for is_around in [false, true] {
        for z in [2.0, 6.0] {
            let face = plate(distance as f32, z, is_around);
            for (share, expected) in [(0.9, true), (1.1, false)] {
                let error = distance / share;
                let what = format!("{is_around} {z} {share}");
                assert_eq!(is_uncertain(&face, RoundedLine { position: error, ..LINE }), expected, "{what}");
                // The hit's error falls to 0 towards the camera.
                let hit = error / (1.0 - f64::from(z) / 8.0);
                assert_eq!(is_uncertain(&face, RoundedLine { hit, ..LINE }), expected, "{what}");
                let halves = RoundedLine { hit: 0.5 * hit, position: 0.5 * error, ..LINE };
                assert_eq!(is_uncertain(&face, halves), expected, "{what}");
            }
        }
    }
}

#[test]
fn a_slanting_edge_may_slip_and_one_that_is_met_head_on_not() {
    let distance = 1.0 / 64.0;
    // Turned about its leg by 45 degrees: the sine is sqrt 1/2. Legs of 1 m and sqrt 2 m: kappa = sqrt 3 sqrt 2 / sqrt 2.
    let mut slanting = plate(distance as f32, 2.0, false);
    slanting.corners[2][2] = 3.0;
    let (kappa, longest) = (3.0_f64.sqrt(), 3.0_f64.sqrt());
    // The larger end is 8 m from the scene's origin, and the line 8 m long.
    let size = 8.0 + 8.0 + longest;
    let per_roundoff = (10.0 * kappa + 27.0) * size * 0.5_f64.sqrt();
    for (share, expected) in [(0.9, true), (1.1, false)] {
        let unit_roundoff = distance / share / per_roundoff;
        let line = RoundedLine { unit_roundoff, ..LINE };
        assert_eq!(is_uncertain(&slanting, line), expected);
        assert!(!is_uncertain(&plate(distance as f32, 2.0, false), line));
    }
}

#[test]
fn an_edge_beyond_an_end_is_not_on_the_way() {
    let (distance, position) = (1.0 / 64.0, 1.0 / 32.0);
    let line = RoundedLine { position, ..LINE };
    // The way ends 1/8 before the camera, at z = 7. At both ends up to 1/32 m more, without
    // rounding, is within the error.
    for (z, expected) in [(-0.9, true), (-1.0, true), (-1.1, false), (0.0, true)] {
        assert_eq!(is_uncertain(&plate(distance, position as f32 * z, false), line), expected, "{z}");
        let beyond = 7.0 - position as f32 * z;
        assert_eq!(is_uncertain(&plate(distance, beyond, false), line), expected, "{beyond}");
    }
}

#[test]
fn a_line_is_free_only_past_the_edge() {
    for is_around in [false, true] {
        let face = plate(0.25, 2.0, is_around);
        let meets = |x: f64| LINE.moved(DVec3::new(x, 0.0, 0.0)).meets(&face);
        assert_eq!((meets(0.125), meets(0.375)), (is_around, !is_around));
        // On the edge, or where f64 cannot tell, it is met.
        assert!(meets(0.25) && meets(0.25_f64.next_down()) && meets(0.25_f64.next_up()));
    }
    // At its ends: the point itself is not on the way, the image plane is.
    let at = |z: f32| LINE.meets(&plate(0.25, z, true));
    assert_eq!([at(0.0), at(0.125), at(7.0), at(7.125)], [false, true, true, false]);
}
