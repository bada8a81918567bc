//! The plane of a face and where a ray meets it, in pairs of f64 without a branch: n, h = n.a' and g = n.d, each with one proven
//! error for all its operations.
//!
//! With u = 2^-53, E, A and D the largest parts of the edges, of a' = a - o and of d. Differences of corners are exact as
//! pairs, and so are products of two f64; a product of pairs errs by 8 u^2 of it, a sum by 4 u^2 (`double_double`):
//!
//! ```text
//! a part of n   two products of at most E E, and their difference       2 * 8 u^2 E E + 4 u^2 2 E E        =  24 u^2 E E
//! h             three products with A, two sums                         3 (24 + 16) u^2 E E A + 40 u^2 E E A  = 160 u^2 E E A
//! g             the same with D                                                                            160 u^2 E E D
//! ```
//!
//! Each bound takes 256 u^2. Where a product of two parts underflows, it loses less than 1e-300; with sizes up to [`MOST`] that is
//! less than 1e-250 of h, which [`UNDERFLOW`] covers. With sizes from [`LEAST`] on that is nothing beside the rest.

use glam::DVec3;

use super::{DoubleDouble, fast_two_sum, two_product, two_sum};
use crate::lanes::{Work, run};

/// 256 u^2.
pub(super) const ERROR: f64 = 1.0 / (1_u128 << 98) as f64;

pub(super) const UNDERFLOW: f64 = 1e-190;
const LEAST: f64 = 1e-20;
const MOST: f64 = 1e20;

/// hi + lo.
pub(super) type Pair = (f64, f64);

/// n, h and g.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlaneCrossing {
    pub(crate) normal: [DoubleDouble; 3],
    pub(crate) height: DoubleDouble,
    pub(crate) approach: DoubleDouble,
}

impl PlaneCrossing {
    /// That of the ray from `origin` along `direction` and a face with these corners; `None` if a size is out of bounds, and where a
    /// number may be exactly 0, of which no error but 0 would do.
    pub(crate) fn of(origin: DVec3, direction: DVec3, [a, b, c]: [DVec3; 3]) -> Option<Self> {
        run(Planes { origin, direction, corners: [a, b, c] })
    }
}

struct Planes {
    origin: DVec3,
    direction: DVec3,
    corners: [DVec3; 3],
}

impl Work for Planes {
    type Output = Option<PlaneCrossing>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Option<PlaneCrossing> {
        let Differences { ab, ac, offset, long, far, fast } =
            Differences::of(self.origin, self.direction, self.corners)?;
        let normal = normal_of::<FUSED>(&ab, &ac);
        let height = dot::<FUSED>(&normal, &offset);
        let approach = dot::<FUSED>(&normal, &self.direction.to_array().map(|part| (part, 0.0)));
        if normal.iter().chain([&height, &approach]).any(|(high, _)| *high == 0.0) {
            return None;
        }
        let of = |(high, low): Pair, size: f64| DoubleDouble::constant(high, low, ERROR * size + UNDERFLOW);
        let area = long * long;
        Some(PlaneCrossing {
            normal: normal.map(|part| of(part, area)),
            height: of(height, area * far),
            approach: of(approach, area * fast),
        })
    }
}

/// b - a, c - a and a', exactly, and the sizes E, A and D of the bounds.
pub(super) struct Differences {
    pub(super) ab: [Pair; 3],
    pub(super) ac: [Pair; 3],
    pub(super) offset: [Pair; 3],
    pub(super) long: f64,
    pub(super) far: f64,
    pub(super) fast: f64,
}

impl Differences {
    /// `None` if a size is out of bounds.
    #[inline(always)]
    pub(super) fn of(origin: DVec3, direction: DVec3, [a, b, c]: [DVec3; 3]) -> Option<Self> {
        let minus = |p: DVec3, q: DVec3| [0, 1, 2].map(|k: usize| two_sum(p[k], -q[k]));
        let [ab, ac, offset] = [minus(b, a), minus(c, a), minus(a, origin)];
        let (long, far, fast) = (size(&ab).max(size(&ac)), size(&offset), direction.abs().max_element());
        (fits(long) && fits(far) && fits(fast)).then_some(Self { ab, ac, offset, long, far, fast })
    }
}

/// Whether the bounds hold for numbers of this size.
#[inline(always)]
pub(super) fn fits(size: f64) -> bool {
    (LEAST..MOST).contains(&size)
}

/// The largest part.
#[inline(always)]
pub(super) fn size(of: &[Pair; 3]) -> f64 {
    of[0].0.abs().max(of[1].0.abs()).max(of[2].0.abs())
}

/// n of two edges.
#[inline(always)]
pub(super) fn normal_of<const FUSED: bool>(ab: &[Pair; 3], ac: &[Pair; 3]) -> [Pair; 3] {
    let minor = |k: usize, l: usize| {
        let (high, low) = pair_product::<FUSED>(ab[l], ac[k]);
        sum(pair_product::<FUSED>(ab[k], ac[l]), (-high, -low))
    };
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

#[inline(always)]
pub(super) fn dot<const FUSED: bool>(a: &[Pair; 3], b: &[Pair; 3]) -> Pair {
    let [x, y, z] = [0, 1, 2].map(|k: usize| pair_product::<FUSED>(a[k], b[k]));
    sum(sum(x, y), z)
}

/// AccurateDWPlusDW.
#[inline(always)]
pub(super) fn sum(a: Pair, b: Pair) -> Pair {
    let (high, rest) = two_sum(a.0, b.0);
    let (low, last) = two_sum(a.1, b.1);
    let (high, rest) = fast_two_sum(high, rest + low);
    fast_two_sum(high, last + rest)
}

#[inline(always)]
fn pair_product<const FUSED: bool>(a: Pair, b: Pair) -> Pair {
    let (high, rest) = two_product::<FUSED>(a.0, b.0);
    fast_two_sum(high, rest + (a.0 * b.1 + a.1 * b.0))
}

#[cfg(test)]
#[path = "../../../tests/unit/plane_crossing.rs"]
mod tests;
