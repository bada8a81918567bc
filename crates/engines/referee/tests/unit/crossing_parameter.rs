//! The quick t against exact arithmetic: it lies within its error, which is small; the same with fused operations and without.

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

/// The error covers the roundings of its own quotient, too. t is a whole number here, and w lies in the plane: r = 0, and what is left of
/// the error is R / (|g| - G) with R = 256 u^2 W, which is no f64 number.
#[test]
fn the_error_of_t_is_no_less_than_its_formula() {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
    for far in (1..50).map(f64::from) {
        let t = crossing_parameter(far * DVec3::Z, DVec3::new(1.0, 0.0, -1.0), corners).expect("a crossing");
        let [high, low, error] = t.parts();
        assert_eq!((high, low), (far, 0.0));
        let least = Dyadic::of(1.0).sub(&Dyadic::of(32.0 * f64::EPSILON));
        let of_rest = 64.0 * f64::EPSILON * f64::EPSILON * far;
        let missing = Dyadic::of(of_rest).sub(&Dyadic::of(error).mul(&least));
        assert_ne!(missing.sign(), Some(std::cmp::Ordering::Greater), "{far}: {error}");
    }
}
