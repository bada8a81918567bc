//! The room that rounding gets around a moved ray, and lengths that are too small for squares.

use super::*;
use crate::numbers::number::{Dyadic, Number};
use crate::numbers::vector::Vector;
use crate::splitmix::SplitMix64;

/// The origin of the bundle is rounded. Where the ray begins exactly is within its radius, with room to spare.
#[test]
fn the_exact_origin_of_a_moved_ray_is_within_the_radius_of_its_bundle() {
    let mut random = SplitMix64(11);
    for _ in 0..1000 {
        let mut point = || DVec3::new(random.part(), random.part(), random.part());
        let (origin, direction) = (point(), point());
        let [far, by] = [0, 1].map(|_| [0.0, 1e-9, 1.0, 1e9][random.below(4) as usize]);
        let ray = CastRay { t_max: 2.0, ..CastRay::new(origin * far, direction) };
        let by = [random.part() * by, random.part() * by];
        let bundle = moved_bundle(&ray, by);
        let [u, v] = ray.across().map(Vector::<Dyadic>::of);
        let exact =
            Vector::of(ray.origin).add(&u.scaled(&Dyadic::of(by[0]))).add(&v.scaled(&Dyadic::of(by[1])));
        let most = Dyadic::of(0.25 * bundle.start_radius);
        for off in exact.sub(&Vector::of(bundle.origin)).0 {
            for off in [off.clone(), Dyadic::of(0.0).sub(&off)] {
                assert_ne!(most.sub(&off).sign(), Some(std::cmp::Ordering::Less), "{ray:?} {by:?}");
            }
        }
        // The ray's end is as far off.
        let end = super::bundle(&ray).max_range + bundle.start_radius;
        assert_eq!(bundle.max_range, end, "{ray:?} {by:?}");
    }
}

#[test]
fn the_length_of_a_vector_whose_squares_vanish_is_no_less_exact() {
    for size in [1.0, 1e-130, 1e-150, 1e-170, 1e-300] {
        let expected = 5.0 * size;
        let found = length(DVec3::new(3.0 * size, 0.0, -4.0 * size));
        assert!((found - expected).abs() <= 4.0 * f64::EPSILON * expected, "{found} is not {expected}");
    }
    assert_eq!(length(DVec3::ZERO), 0.0);
}
