//! On which side of a face's edges a ray passes, in plain f64: most faces that a box proposes are refused here.
//!
//! The side of the edge from a to b is the sign of F = D.((a - o) x e), e = b - a: `face` evaluates it in intervals, s times
//! as large, and `cast` as it is. Here o and D are the middles of their enclosures, off by at most r_o and r_D in each component. With u =
//! 2^-53, |.| the largest component, A = |a - o| as computed and E = |e|:
//!
//! ```text
//! a - o       r_o + u A             e           u E
//! a product   (r_o + u A) E + u A E + u A E     and its rounding u A E;  two of them and their difference:
//! a part of the cross product, at most 2 A E,   is off by 2 (r_o E + 3 u A E) + 2 u A E
//! F, three products with |D|:                   3 |D| (2 r_o E + 8 u A E) + 3 r_D 2 A E + 4 u 6 |D| A E
//!                                            =  6 E (|D| (r_o + 8 u A) + r_D A)
//! ```
//!
//! The bound takes 8 for 6 and 16 u for 8 u: that covers products of two errors and the roundings of the bound itself, and
//! a number far below any of these that underflow leaves.
//!
//! # Where the plane is met
//!
//! At t = h / g, h = n.(a - o), g = n.D, n = (b - a) x (c - a), of a ray whose numbers are exact (r_o = r_D = 0):
//!
//! ```text
//! a part of n, at most 2 E E    twice u E E + u E E + u E E, and 2 u E E        =  8 u E E
//! g                             3 (8 u E E |D| + u 2 E E |D|) + 10 u E E |D|    = 40 u E E |D|
//! h, where u A is off besides   3 (8 u E E A + 2 u E E A + 2 u E E A) + 10 u E E A  = 46 u E E A
//! ```
//!
//! Both bounds take 64 u. With g off by at most G < |g| and h by at most H, t is off by at most (H + |h / g| G) / (|g| - G).

use std::cmp::Ordering;

use glam::DVec3;

use crate::numbers::number::Interval;
use crate::rays::ray::ScaledRay;

/// Added to each bound: more than underflow can lose in a dozen operations.
const UNDERFLOW: f64 = 1e-290;

/// Where a ray passes a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Passes {
    /// Outside an edge, certainly.
    Outside,
    /// Inside all edges, certainly.
    Inside,
    /// Too near an edge to tell.
    Near,
}

/// A ray as the filter asks it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EdgeFilter {
    origin: DVec3,
    direction: DVec3,
    /// |D|.
    size: f64,
    /// r_o and r_D.
    errors: [f64; 2],
}

impl EdgeFilter {
    pub(crate) fn new(ray: &ScaledRay<Interval>) -> Self {
        let half = |of: &Interval| 0.5 * (of.high - of.low) * (1.0 + 4.0 * f64::EPSILON);
        let scale = ray.origin_scale;
        let s = scale.middle();
        let of_scale = half(&scale) / scale.low;
        let [mut origin, mut direction] = [[0.0; 3]; 2];
        let [mut of_origin, mut of_direction] = [0.0_f64; 2];
        for k in 0..3 {
            let [o, d] = [ray.origin.0[k], ray.direction.0[k]];
            origin[k] = o.middle() / s;
            direction[k] = d.middle();
            // |O / s - o| <= (|O - middle| + |o| |s - middle|) / s, and roundings of the middles and of the quotient.
            let rounding = 4.0 * f64::EPSILON * origin[k].abs();
            of_origin = of_origin.max(half(&o) / scale.low + 2.0 * of_scale * origin[k].abs() + rounding);
            of_direction = of_direction.max(half(&d) + f64::EPSILON * direction[k].abs());
        }
        let direction = DVec3::from_array(direction);
        Self {
            origin: DVec3::from_array(origin),
            direction,
            size: direction.abs().max_element(),
            errors: [2.0 * of_origin, 2.0 * of_direction],
        }
    }

    /// The filter of a ray whose origin and direction are these numbers.
    pub(crate) fn exactly(origin: DVec3, direction: DVec3) -> Self {
        Self { origin, direction, size: direction.abs().max_element(), errors: [0.0; 2] }
    }

    /// On which side of the edge from corner `k` the line passes; `None` if it is too near to tell.
    #[inline]
    pub(crate) fn sign(&self, corners: [DVec3; 3], k: usize) -> Option<Ordering> {
        let [side, bound] = self.side(corners, k);
        if side > bound {
            Some(Ordering::Greater)
        } else if side < -bound {
            Some(Ordering::Less)
        } else {
            None
        }
    }

    /// Where the ray passes a face with these corners, which shows its front.
    #[inline]
    pub(crate) fn passes(&self, corners: [DVec3; 3]) -> Passes {
        let mut passes = Passes::Inside;
        for k in 0..3 {
            let [side, bound] = self.side(corners, k);
            if side > bound {
                return Passes::Outside;
            }
            if !(side < -bound) {
                passes = Passes::Near;
            }
        }
        passes
    }

    /// Whether the line certainly passes beside a face with these corners, whichever side that shows: the sides of two of
    /// its edges differ.
    #[inline]
    pub(crate) fn passes_beside(&self, corners: [DVec3; 3]) -> bool {
        let sides = [0, 1, 2].map(|k| self.side(corners, k));
        sides.iter().any(|[side, bound]| side > bound) && sides.iter().any(|[side, bound]| *side < -bound)
    }

    /// What contains the t at which the line meets the plane of a face with these corners; `None` if too little is certain.
    #[inline]
    pub(crate) fn t_of_plane(&self, [a, b, c]: [DVec3; 3]) -> Option<Interval> {
        let (ab, ac, offset) = (b - a, c - a, a - self.origin);
        let normal = ab.cross(ac);
        let (height, approach) = (normal.dot(offset), normal.dot(self.direction));
        let long = ab.abs().max(ac.abs()).max_element();
        let unit = 32.0 * f64::EPSILON * (long * long);
        let of_height = unit * offset.abs().max_element() + UNDERFLOW;
        let of_approach = unit * self.size + UNDERFLOW;
        let least = approach.abs() - of_approach;
        if self.errors != [0.0; 2] || !(least > 0.0) {
            return None;
        }
        let t = height / approach;
        let error = (of_height + t.abs() * of_approach) / least * (1.0 + 8.0 * f64::EPSILON);
        let error = error + 2.0 * f64::EPSILON * t.abs() + f64::MIN_POSITIVE;
        Some(Interval::between(t - error, t + error))
    }

    /// F of the edge from corner `k`, and its bound.
    #[inline]
    fn side(&self, corners: [DVec3; 3], k: usize) -> [f64; 2] {
        let [of_origin, of_direction] = self.errors;
        let offset = corners[k] - self.origin;
        let edge = corners[(k + 1) % 3] - corners[k];
        let side = self.direction.dot(offset.cross(edge));
        let (far, long) = (offset.abs().max_element(), edge.abs().max_element());
        let of_offset = of_origin + 16.0 * f64::EPSILON * far;
        [side, 8.0 * long * (self.size * of_offset + of_direction * far) + UNDERFLOW]
    }
}

#[cfg(test)]
#[path = "../../tests/unit/edge_filter.rs"]
mod tests;
