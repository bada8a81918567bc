//! t of a crossing alone, in pairs of f64: what a plain quotient t0 is off by, and how exactly that is known.
//!
//! With h = n.a' and g = n.d, t = h / g is t0 + r / g for any f64 t0, where r = n.w and w = a' - t0 d. w leads from the point of the ray at
//! t0 to the corner a. r is small, for w lies nearly in the plane: a plain quotient of it is enough. That is half of the work of h, g and
//! their quotient in pairs.
//!
//! With u = 2^-53, E, A, D and W the largest parts of the edges, of a' = a - o, of d and of w. a' and t0 d are exact as pairs; a product of
//! pairs errs by 8 u^2 of it, a sum by 4 u^2 (`double_double`), and a part of n by 24 u^2 E E (`plane_crossing`):
//!
//! ```text
//! w                             4 u^2 W
//! r      three products         3 (24 u^2 E E W + 2 E E 4 u^2 W + 8 u^2 2 E E W)  = 144 u^2 E E W
//!        two sums               4 u^2 (4 E E W + 6 E E W)                        =  40 u^2 E E W
//! g      of the first numbers of n, each off by u 2 E E and little more:
//!                               3 (2 u E E D + 2 u E E D) + u (4 + 6) E E D      =  22 u E E D
//! ```
//!
//! The bounds take 256 u^2 for R of r, and 64 u for G of g. r without its second number is off by u |r| besides. So r / g as computed is off
//! by at most (R + 2 u |r| + |r / g| G) / (|g| - G), and its own rounding.

use glam::DVec3;

use super::plane_crossing::{Differences, ERROR, Pair, UNDERFLOW, dot, fits, normal_of, size, sum};
use super::{DoubleDouble, ROUNDED_UP, fast_two_sum, two_product};
use crate::lanes::{Work, run};

/// 64 u.
const OF_APPROACH: f64 = 32.0 * f64::EPSILON;

/// t of the ray from `origin` along `direction` on the plane of a face with these corners; `None` if a size is out of bounds, or if too
/// little is certain.
#[inline]
pub(crate) fn crossing_parameter(
    origin: DVec3,
    direction: DVec3,
    corners: [DVec3; 3],
) -> Option<DoubleDouble> {
    run(Crossing { origin, direction, corners })
}

struct Crossing {
    origin: DVec3,
    direction: DVec3,
    corners: [DVec3; 3],
}

impl Work for Crossing {
    type Output = Option<DoubleDouble>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Option<DoubleDouble> {
        let Self { origin, direction, corners } = self;
        let Differences { ab, ac, offset, long, fast, .. } = Differences::of(origin, direction, corners)?;
        let normal = normal_of::<FUSED>(&ab, &ac);
        let first = |of: &[Pair; 3]| DVec3::new(of[0].0, of[1].0, of[2].0);
        let approach = first(&normal).dot(direction);
        let area = long * long;
        let of_approach = OF_APPROACH * area * fast + UNDERFLOW;
        let least = approach.abs() - of_approach;
        let t = first(&normal).dot(first(&offset)) / approach;
        // !(a > b) also holds for NaN. The pairs of t d want a t of such a size, too.
        if !(least > 0.0) || !fits(t.abs()) {
            return None;
        }
        let beside = [0, 1, 2].map(|k: usize| {
            let (product, rest) = two_product::<FUSED>(t, direction[k]);
            sum(offset[k], (-product, -rest))
        });
        let (rest, _) = dot::<FUSED>(&normal, &beside);
        let of_rest = ERROR * area * size(&beside) + UNDERFLOW + f64::EPSILON * rest.abs();
        let more = rest / approach;
        if !(more.abs() <= t.abs()) {
            return None;
        }
        let error = (of_rest + more.abs() * of_approach) / least * ROUNDED_UP + f64::EPSILON * more.abs();
        let (high, low) = fast_two_sum(t, more);
        Some(DoubleDouble::constant(high, low, error + UNDERFLOW))
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/crossing_parameter.rs"]
mod tests;
