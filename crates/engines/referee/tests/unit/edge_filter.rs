//! The sides of edges in plain f64 against the same in exact arithmetic.

use std::cmp::Ordering;

use super::*;
use crate::numbers::number::{Dyadic, Number};
use crate::numbers::vector::Vector;
use crate::splitmix::SplitMix64;

/// A line from a point of f64 along a direction of f64, and a face of f32.
struct Case {
    origin: DVec3,
    direction: DVec3,
    corners: [DVec3; 3],
}

impl Case {
    /// A line through the middle of an edge, beside it by so much of the edge's length.
    fn beside_an_edge(random: &mut SplitMix64, by: f64) -> Self {
        // Parts from 1/2 to 1 on either side of 0: each product is nearly as large as the bound takes it for.
        let mut part = || {
            let signed = random.part();
            signed.signum() * (0.5 + 0.5 * signed.abs())
        };
        let mut point = || DVec3::new(part(), part(), part());
        let corners = [point(), point(), point()].map(|corner| corner.as_vec3().as_dvec3());
        let [a, b, c] = corners;
        // An origin of 0 has no rounding that would widen the bound.
        let origin =
            if random.below(4) == 0 { DVec3::new(random.part(), random.part(), 4.0) } else { DVec3::ZERO };
        let middle = 0.5 * a + 0.5 * b;
        Self { origin, direction: middle + by * (middle - c) - origin, corners }
    }

    fn filter(&self) -> EdgeFilter {
        let of = |v: DVec3| Vector::<Interval>::of(v);
        let one = Interval::of(1.0);
        EdgeFilter::new(&ScaledRay {
            origin: of(self.origin),
            origin_scale: one,
            direction: of(self.direction),
            direction_scale: one,
        })
    }

    /// The sign of F of each edge, exactly.
    fn signs(&self) -> [Ordering; 3] {
        let of = |v: DVec3| Vector::<Dyadic>::of(v);
        [0, 1, 2].map(|k| {
            let (a, b) = (of(self.corners[k]), of(self.corners[(k + 1) % 3]));
            let side = a.sub(&of(self.origin)).cross(&b.sub(&a));
            of(self.direction).dot(&side).sign().expect("an exact sign")
        })
    }
}

/// Within rounding of an edge the sums themselves have wrong signs, so a bound that is too small says what is not so: one that is
/// 64 times smaller is found out. (The largest error seen is a 46th of the bound.)
#[test]
fn what_the_filter_says_of_lines_within_rounding_of_an_edge_is_so() {
    let mut random = SplitMix64(11);
    let (mut beside, mut wrong_sums) = (0, 0);
    for _ in 0..60_000 {
        let size = libm::scalbn(1.0, -40 - random.below(20) as i32);
        let size = size * random.part();
        let case = Case::beside_an_edge(&mut random, size);
        let (filter, signs) = (case.filter(), case.signs());
        let is_beside = signs.contains(&Ordering::Less) && signs.contains(&Ordering::Greater);
        match filter.passes(case.corners) {
            Passes::Outside => assert!(signs.contains(&Ordering::Greater)),
            Passes::Inside => assert_eq!(signs, [Ordering::Less; 3]),
            Passes::Near => {}
        }
        if filter.passes_beside(case.corners) {
            assert!(is_beside, "{signs:?}");
            beside += 1;
        }
        wrong_sums +=
            (0..3).filter(|&k| filter.side(case.corners, k)[0].partial_cmp(&0.0) != Some(signs[k])).count();
    }
    assert!(beside > 1000 && wrong_sums > 1000, "{beside} {wrong_sums}");
}

/// A bound that is too wide is no mistake, but leaves all work to slower arithmetic.
#[test]
fn lines_a_hundred_billionth_of_an_edge_beside_it_are_decided() {
    let mut random = SplitMix64(12);
    let mut decided = 0;
    for _ in 0..2_000 {
        let case = Case::beside_an_edge(&mut random, 1e-11);
        decided += u32::from(case.filter().passes_beside(case.corners));
    }
    assert!(decided > 1900, "{decided}");
}

/// The t of a face lies in its interval, which is narrow unless the line runs along the face.
#[test]
fn the_t_of_a_face_is_in_a_narrow_interval() {
    let mut random = SplitMix64(13);
    let mut narrow = 0;
    for _ in 0..2_000 {
        let Case { origin, direction, corners } = Case::beside_an_edge(&mut random, 0.1);
        let (origin, direction) = (origin + DVec3::NEG_Z, direction + DVec3::Z);
        let [a, b, c] = corners.map(Vector::<Dyadic>::of);
        let normal = b.sub(&a).cross(&c.sub(&a));
        let height = normal.dot(&a.sub(&Vector::of(origin)));
        let approach = normal.dot(&Vector::of(direction));
        let Some(Interval { low, high }) = EdgeFilter::exactly(origin, direction).t_of_plane(corners) else {
            continue;
        };
        // (t - low) and (t - high), times n.d: their signs differ.
        let [after, before] = [low, high].map(|t| height.sub(&approach.mul(&Dyadic::of(t))).sign());
        assert!(after.is_some() && after == before.map(Ordering::reverse), "{low} {high}");
        let cosine = (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(direction).abs();
        if cosine > 0.1 {
            assert!(high - low < 1e-11 * (1.0 + high.abs()), "{low} {high}");
            narrow += 1;
        }
    }
    assert!(narrow > 1000, "{narrow}");
}

/// The bound of t covers the roundings of its own quotient, too. A ray that starts in the plane has t = 0, and A, E and |D| are whole
/// numbers here: the bound is 64 u A / (1 - 64 u), which is no f64 number.
#[test]
fn the_bound_of_t_is_no_less_than_its_formula() {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let of_each = 32.0 * f64::EPSILON;
    for far in (1..50).map(f64::from) {
        let t = EdgeFilter::exactly(far * DVec3::X, DVec3::Z).t_of_plane(corners).expect("an interval");
        assert_eq!(t.low, -t.high);
        let least = Dyadic::of(1.0).sub(&Dyadic::of(of_each));
        let missing = Dyadic::of(of_each * far).sub(&Dyadic::of(t.high).mul(&least));
        assert_ne!(missing.sign(), Some(Ordering::Greater), "{far}: {}", t.high);
    }
}
