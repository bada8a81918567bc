//! The quick crossing against exact arithmetic: its numbers lie within their errors, which are small.

use super::super::tests::holds;
use super::*;
use crate::numbers::number::Dyadic;
use crate::numbers::vector::Vector;
use crate::splitmix::SplitMix64;

fn point(random: &mut SplitMix64) -> DVec3 {
    DVec3::new(random.part(), random.part(), random.part())
}

#[test]
fn all_parts_lie_within_their_errors() {
    let mut random = SplitMix64(12);
    let mut known = 0;
    for k in 0..20_000 {
        let size = [1.0, 1e-18, 1e19, 1e-7][k % 4];
        let slender = [1.0, 1e-9, 1e-15][k % 3];
        let (a, b) = (size * point(&mut random), size * point(&mut random));
        let c = a.lerp(b, random.part()) + slender * size * point(&mut random);
        // Some corners in single precision, of which differences are f64 numbers.
        let corners = [a, b, c].map(|corner| if k % 5 == 0 { corner.as_vec3().as_dvec3() } else { corner });
        let origin = [1.0, 1e-3, 5.0][k % 3] * size * point(&mut random);
        // Some rays run along the face.
        let aside = [1.0, 1e-12][k % 2] * point(&mut random);
        let direction = (b - a) * random.part() + size * aside;
        let Some(PlaneCrossing { normal, height, approach }) = PlaneCrossing::of(origin, direction, corners)
        else {
            continue;
        };
        known += 1;
        let [ab, ac] = [1, 2].map(|k| Vector::<Dyadic>::of(corners[k]).sub(&Vector::of(corners[0])));
        let exact = ab.cross(&ac);
        for (part, exact) in normal.iter().zip(&exact.0) {
            assert!(holds(part, exact), "{part:?} {corners:?}");
        }
        let offset = Vector::of(corners[0]).sub(&Vector::of(origin));
        assert!(holds(&height, &exact.dot(&offset)), "{height:?} {corners:?} {origin}");
        assert!(holds(&approach, &exact.dot(&Vector::of(direction))), "{approach:?} {corners:?} {direction}");
        let long = (b - a).abs().max((c - a).abs()).max_element();
        let far = (a - origin).abs().max_element();
        let [_, _, error] = height.parts();
        assert!(error < 1e-28 * long * long * far, "{error} of {height:?}");
    }
    assert!(known > 15_000, "{known}");
}

#[test]
fn what_is_out_of_bounds_or_may_be_zero_is_unknown() {
    let corners = [DVec3::new(0.1, 0.2, 0.3), DVec3::new(1.4, 0.1, 0.2), DVec3::new(0.5, 1.7, 0.9)];
    let (origin, direction) = (DVec3::new(0.3, 0.7, 3.0), DVec3::new(0.1, 0.2, -1.0));
    assert!(PlaneCrossing::of(origin, direction, corners).is_some());
    assert!(PlaneCrossing::of(origin * 1e30, direction, corners).is_none());
    assert!(PlaneCrossing::of(origin, direction * 1e-30, corners).is_none());
    assert!(PlaneCrossing::of(origin, direction, corners.map(|corner| corner * 1e-30)).is_none());
    // A ray that starts on the plane, and a face across an axis.
    assert!(PlaneCrossing::of(corners[0], direction, corners).is_none());
    assert!(PlaneCrossing::of(origin, direction, corners.map(|corner| corner.with_z(0.5))).is_none());
}
