//! The quick t against exact arithmetic: it lies within its error, which is small; the same with fused operations and without.

use std::cmp::Ordering;

use super::super::tests::holds_quotient;
use super::*;
use crate::numbers::number::{Dyadic, Number};
use crate::numbers::vector::Vector;
use crate::splitmix::SplitMix64;

fn point(random: &mut SplitMix64) -> DVec3 {
    DVec3::new(random.part(), random.part(), random.part())
}

#[test]
fn t_lies_within_its_error() {
    let mut random = SplitMix64(12);
    let (mut known, mut plain, mut rounded) = (0, 0, 0);
    for k in 0..20_000 {
        let size = [1.0, 1e-18, 1e17, 1e-7][k % 4];
        let slender = [1.0, 1e-9, 1e-13][k % 3];
        let (a, b) = (size * point(&mut random), size * point(&mut random));
        let c = a.lerp(b, random.part()) + slender * size * point(&mut random);
        // Some corners in single precision, of which differences are f64 numbers; some faces across an axis, as flat ground has them.
        let mut corners =
            [a, b, c].map(|corner| if k % 5 == 0 { corner.as_vec3().as_dvec3() } else { corner });
        if k % 7 == 0 {
            corners = corners.map(|corner| corner.with_z(a.z));
        }
        let origin = [1.0, 1e-3, 5.0][k % 3] * size * point(&mut random);
        // Some rays run nearly along the face.
        let aside = [1.0, 1e-12][k % 2] * point(&mut random);
        let direction = (b - a) * random.part() + size * aside;
        let crossing = || Crossing { origin, direction, corners };
        let quick = crossing_parameter(origin, direction, corners);
        assert_eq!(crossing().run::<true>(), quick, "fused: {corners:?}");
        assert_eq!(crossing().run::<false>(), quick, "not fused: {corners:?}");
        let Some(quick) = quick else { continue };
        known += 1;
        let [ab, ac] = [1, 2].map(|k| Vector::<Dyadic>::of(corners[k]).sub(&Vector::of(corners[0])));
        let normal = ab.cross(&ac);
        let height = normal.dot(&Vector::of(corners[0]).sub(&Vector::of(origin)));
        let approach = normal.dot(&Vector::of(direction));
        assert!(holds_quotient(&quick, &height, &approach), "{quick:?} {corners:?} {origin} {direction}");
        // What is neither slender nor grazed is decided.
        if k % 6 == 0 && size > 1e-10 {
            plain += 1;
            rounded += usize::from(quick.rounded().is_some());
        }
    }
    assert!(
        known > 13_000 && plain > 1600 && rounded > plain - 20,
        "{known} known, {rounded} of {plain} rounded"
    );
}

#[test]
fn what_is_out_of_bounds_or_uncertain_is_unknown() {
    let corners = [DVec3::new(0.1, 0.2, 0.3), DVec3::new(1.4, 0.1, 0.2), DVec3::new(0.5, 1.7, 0.9)];
    let (origin, direction) = (DVec3::new(0.3, 0.7, 3.0), DVec3::new(0.1, 0.2, -1.0));
    assert!(crossing_parameter(origin, direction, corners).is_some());
    assert!(crossing_parameter(origin * 1e30, direction, corners).is_none());
    assert!(crossing_parameter(origin, direction * 1e-30, corners).is_none());
    assert!(crossing_parameter(origin, direction, corners.map(|corner| corner * 1e-30)).is_none());
    // A ray that starts on the plane, and one along it.
    assert!(crossing_parameter(corners[0], direction, corners).is_none());
    assert!(crossing_parameter(origin, corners[1] - corners[0], corners).is_none());
}

/// The error is no less than (R + 2 u |r| + |r / g| G) / (|g| - G), whose own roundings it covers, too. Along the axis w is what rounding
/// leaves of t; beside it t is a whole number, and w lies in the plane: r = 0.
#[test]
fn the_error_of_t_is_no_less_than_its_formula() {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let of = Dyadic::of;
    let u = 0.5 * f64::EPSILON;
    let mut inexact = 0;
    for (far, aside, down) in (1..50).flat_map(|k| [(f64::from(k), 0.0, 3.0), (f64::from(k), 1.0, 1.0)]) {
        let t =
            crossing_parameter(far * DVec3::Z, DVec3::new(aside, 0.0, -down), corners).expect("a crossing");
        let [high, _, error] = t.parts();
        // The first quotient is the nearest number. n = (0, 0, 1), so g = -down, and r is the last part of w.
        let r = of(high).mul(&of(down)).sub(&of(far));
        let r = if r.sign() == Some(Ordering::Less) { of(0.0).sub(&r) } else { r };
        inexact += u32::from(r.sign() != Some(Ordering::Equal));
        let largest = if aside == 0.0 { r.clone() } else { of(high * aside) };
        let of_rest = of(256.0 * u * u).mul(&largest).add(&of(2.0 * u).mul(&r));
        let of_approach = of(64.0 * u * down);
        // Times |g|.
        let asked = of(down).mul(&of_rest).add(&r.mul(&of_approach));
        let given = of(error).mul(&of(down).sub(&of_approach)).mul(&of(down));
        assert_ne!(asked.sub(&given).sign(), Some(Ordering::Greater), "{far}, {aside}: {error}");
    }
    assert!(inexact > 20, "{inexact}");
}
