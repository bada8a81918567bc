//! What the screen calls "before" is so by more than the bound of its page.

use std::cmp::Ordering;

use raypencil_scene::CastRay;

use super::*;
use crate::numbers::number::{Dyadic, Number};

#[test]
fn a_face_is_before_a_place_if_it_is_so_by_more_than_the_bound() {
    // In the frame r = 1 + a + b, so at (1/4, 1/4) the face is met at 3/2, without rounding.
    let corners = [DVec3::new(0.0, 0.0, 1.0), DVec3::new(1.0, 0.0, 2.0), DVec3::new(0.0, 1.0, 2.0)];
    let face = ShownFace { id: FaceId(0), corners, turn: 1.0 };
    let ray = CastRay::new(DVec3::ZERO, DVec3::Z);
    let frame = Frame::new(&ray);
    let screen = Screen::new(&frame, 2.0).expect("a frame of this size");
    let e = screen.slack;
    // The weights are 1/2, 1/4 and 1/4 of W = 1, each off by 3 E (s + 3 E), where s is the sum of the parts of both differences.
    let off = 3.0 * e * ((1.0 + 0.5) + (2.0 + 1.0) + (1.0 + 1.0));
    let bound = 2.0 * off + ROUNDINGS + 4.0 * e;
    let is_before = |r: f64| screen.is_before(&face, DVec3::new(0.25, 0.25, r));
    for not_so in [1.4, 1.5 - bound, 1.5, 1.5 + 0.5 * bound, 1.5 + 0.99 * bound] {
        assert!(!is_before(not_so), "{not_so}");
    }
    for so in [1.5 + 1.01 * bound, 1.6, 2.5] {
        assert!(is_before(so), "{so}");
    }
}

/// The bound lies below the distance to the segment's line, and not far below.
#[test]
fn the_least_size_of_a_segment_is_hardly_less_than_the_way_to_its_line() {
    let ray = CastRay::new(DVec3::ZERO, DVec3::Z);
    let frame = Frame::new(&ray);
    let screen = Screen::new(&frame, 4.0).expect("a frame of this size");
    // Ends, and the least |a| or |b| at which a + b = 3, b = -2, or 0.
    let cases =
        [([3.0, 0.0], [0.0, 3.0], 1.5), ([-0.5, -2.0], [0.25, -2.0], 2.0), ([-1.0, -1.0], [2.0, 2.0], 0.0)];
    for (p, q, expected) in cases {
        let [p, q] = [p, q].map(|[a, b]| DVec3::new(a, b, 1.0));
        let size = screen.least_size_of_segment([p, q]);
        assert!(size <= expected && size >= expected - 1e3 * screen.slack, "{size} is not {expected}");
        // (|turn| - bound) / (|q - p| + 5 E) without rounding is no less.
        let Bounded { value, bound } = screen.turn(DVec3::ZERO, p, q);
        let of = Dyadic::of;
        let along = of((q.x - p.x).abs() + (q.y - p.y).abs()).add(&of(5.0).mul(&of(screen.slack)));
        let left = of(value.abs()).sub(&of(bound)).sub(&along.mul(&of(size)));
        assert!(size == 0.0 || left.sign() != Some(Ordering::Less), "{size}");
    }
}

/// x / (x + y) is off by no more than the larger bound over the sum.
#[test]
fn a_part_of_a_sum_is_off_by_the_bound_over_the_sum() {
    for size in [0.25, 1.0, 4.0] {
        let of = |value: f64, bound: f64| Bounded { value: size * value, bound: size * bound };
        let Bounded { value, bound } = of(1.0, 0.01).part_of_sum(of(3.0, 0.02));
        assert_eq!(value, 0.25);
        assert!((0.0..1e-11).contains(&(bound - 0.005)), "{bound}");
        // Both ends of x and y.
        for (x, y) in [(1.01, 2.98), (0.99, 3.02)] {
            assert!((x / (x + y) - value).abs() <= bound);
        }
    }
}
