//! A ray's own frame, in which moving the ray sideways is moving a point in a plane.
//!
//! With u, v the stored vectors across the ray (`CastRay::across`) and d its direction, every point V is
//! o + a u + b v + t d for one (a, b, t), by Cramer's rule, r = V - o:
//!
//! ```text
//! a = r.(v x d) / D     b = r.(d x u) / D     t = r.(u x v) / D     D = u.(v x d)
//! ```
//!
//! The ray displaced by (a', b') is the line of all points with a = a' and b = b', and t is its parameter. So a face is
//! a triangle in the plane of a and b, and t a linear function on it. D is positive, for u, v and d are right-handed up
//! to rounding. All that follows is evaluated in (D a, D b, D t), which are polynomials of stored numbers.
//!
//! d is divided by a power of two near its size first, and t multiplied by it: then D is near 1, and products of many
//! such numbers neither overflow nor vanish.

use std::cell::OnceCell;

use glam::{DVec2, DVec3};
use raypencil_scene::CastRay;

use super::super::query_ray::QueryRay;
use crate::numbers::number::{Dyadic, Interval, Number};
use crate::numbers::rounding::quotient;
use crate::numbers::vector::Vector;

/// A point in the frame: D a, D b, D t.
#[derive(Debug, Clone)]
pub(super) struct Point<T>(pub(super) [T; 3]);

/// The frame's polynomials in one kind of numbers.
#[derive(Debug, Clone)]
pub(super) struct FrameNumbers<T> {
    origin: Vector<T>,
    /// v x d, d x u, u x v.
    rows: [Vector<T>; 3],
    /// D.
    pub(super) scale: T,
    /// D t_min.
    pub(super) from: T,
    /// D t_max, unless the ray has no end.
    pub(super) to: Option<T>,
}

impl<T: Number> FrameNumbers<T> {
    fn of(ray: &CastRay) -> Self {
        let [u, v] = ray.across().map(Vector::<T>::of);
        // Exponents beyond 1000 would leave f64; such a direction keeps its size.
        let exponent = libm::ilogb(ray.direction.abs().max_element()).clamp(-1000, 1000);
        let (smaller, larger) = (T::of(libm::scalbn(1.0, -exponent)), T::of(libm::scalbn(1.0, exponent)));
        let d = Vector::of(ray.direction).scaled(&smaller);
        let scale = u.dot(&v.cross(&d));
        let end = |t: f64| T::of(t).mul(&larger).mul(&scale);
        Self {
            origin: Vector::of(ray.origin),
            from: end(ray.t_min),
            to: (ray.t_max < f64::INFINITY).then(|| end(ray.t_max)),
            rows: [v.cross(&d), d.cross(&u), u.cross(&v)],
            scale,
        }
    }

    pub(super) fn point(&self, vertex: DVec3) -> Point<T> {
        let from_origin = Vector::of(vertex).sub(&self.origin);
        Point(std::array::from_fn(|k| self.rows[k].dot(&from_origin)))
    }
}

/// The frame of a ray in both numbers, and rounded.
pub(in super::super) struct Frame<'r> {
    pub(super) ray: &'r CastRay,
    pub(super) fast: FrameNumbers<Interval>,
    exact: OnceCell<FrameNumbers<Dyadic>>,
    rounded: RoundedFrame,
    length: f64,
}

/// The frame in f64, for lower bounds with slack. Lengths here are a, b and t |d| themselves: D is divided out.
struct RoundedFrame {
    origin: DVec3,
    rows: [DVec3; 3],
}

/// Far more than the relative error of a coordinate in [`RoundedFrame`], a few 2^-53 of the distances that it is
/// computed from.
const ROUNDED_SLACK: f64 = 1.0 / (1u64 << 44) as f64;

impl<'r> Frame<'r> {
    pub(in super::super) fn new(ray: &'r CastRay) -> Self {
        let fast = FrameNumbers::<Interval>::of(ray);
        let scale = fast.scale.middle();
        let row = |k: usize| DVec3::from_array(fast.rows[k].0.each_ref().map(Interval::middle)) / scale;
        let mut rows = [row(0), row(1), row(2)];
        // t times the length of the direction that was divided by a power of two: a length.
        rows[2] *= 1.0 / rows[2].length();
        let rounded = RoundedFrame { origin: ray.origin, rows };
        let exponent = libm::ilogb(ray.direction.abs().max_element()).clamp(-1000, 1000);
        let length = libm::scalbn(QueryRay::length(ray), -exponent);
        Self { ray, fast, exact: OnceCell::new(), rounded, length }
    }

    /// The length of the direction after its division by a power of two: a range over D t / D.
    pub(super) fn length(&self) -> f64 {
        self.length
    }

    pub(super) fn exact(&self) -> &FrameNumbers<Dyadic> {
        self.exact.get_or_init(|| FrameNumbers::of(self.ray))
    }

    /// The displacement that brings the ray to a vertex, each part correctly rounded.
    pub(in super::super) fn displacement_to(&self, vertex: DVec3) -> DVec2 {
        let numbers = self.exact();
        let Point([a, b, _]) = numbers.point(vertex);
        DVec2::new(quotient(&a, &numbers.scale).double, quotient(&b, &numbers.scale).double)
    }

    /// The intervals of a, b and the range that contain all points of a box.
    #[inline]
    pub(super) fn span(&self, low: DVec3, high: DVec3) -> [[f64; 2]; 3] {
        let (middle, half) = (0.5 * low + 0.5 * high, 0.5 * high - 0.5 * low);
        let from_origin = middle - self.rounded.origin;
        let size = low.abs().max(high.abs()).max(self.rounded.origin.abs());
        let slack = ROUNDED_SLACK * (size.x + size.y + size.z);
        self.rounded.rows.map(|row| {
            let (at, reach) = (row.dot(from_origin), row.abs().dot(half) + slack);
            [at - reach, at + reach]
        })
    }

    /// A vertex in plain f64: a, b and the range, each off by less than [`slack`](Self::slack).
    #[inline]
    pub(super) fn shown(&self, vertex: DVec3) -> DVec3 {
        let from_origin = vertex - self.rounded.origin;
        DVec3::from_array(self.rounded.rows.map(|row| row.dot(from_origin)))
    }

    /// More than the error of what [`shown`](Self::shown) gives, if no coordinate of a vertex is above `largest`.
    pub(super) fn slack(&self, largest: f64) -> f64 {
        3.0 * ROUNDED_SLACK * largest.max(self.rounded.origin.abs().max_element())
    }

    /// Whether a face's picture may contain the displacement (a, b), or come as near as `slack`.
    #[inline]
    pub(super) fn may_show(&self, corners: &[DVec3; 3], [a, b]: [f64; 2], slack: f64) -> bool {
        let shown = corners.map(|corner| {
            let from_origin = corner - self.rounded.origin;
            DVec2::new(self.rounded.rows[0].dot(from_origin), self.rounded.rows[1].dot(from_origin))
        });
        let [p, q, r] = corners.map(DVec3::abs);
        let size = p.max(q).max(r).max(self.rounded.origin.abs());
        let slack = slack + ROUNDED_SLACK * (size.x + size.y + size.z);
        let low = shown[0].min(shown[1]).min(shown[2]) - slack;
        let high = shown[0].max(shown[1]).max(shown[2]) + slack;
        low.x <= a && a <= high.x && low.y <= b && b <= high.y
    }

    /// |d|: a range over t.
    pub(super) fn length_of_direction(&self) -> f64 {
        QueryRay::length(self.ray)
    }

    /// A range that is not before the start of the ray.
    pub(super) fn range_after_start(&self) -> f64 {
        self.ray.t_min * self.length_of_direction() * (1.0 + ROUNDED_SLACK)
    }

    /// The least and the greatest range of a hit within the ray's ends, with slack.
    pub(super) fn ranges(&self) -> [f64; 2] {
        let length = self.length_of_direction();
        let slack = ROUNDED_SLACK;
        [self.ray.t_min * length * (1.0 - slack), self.ray.t_max * length * (1.0 + slack)]
    }

    /// Whether anything has asked for the exact frame.
    #[cfg(test)]
    pub(super) fn has_exact(&self) -> bool {
        self.exact.get().is_some()
    }
}

/// Whether an end of the ray may cut what lies between these ranges, by the ray's own [`ranges`](Frame::ranges).
#[inline]
pub(super) fn is_cut([near, far]: [f64; 2], [first, last]: [f64; 2]) -> bool {
    near <= first || far >= last
}

/// A lower bound of the size of a displacement to a box that spans these intervals.
#[inline]
pub(super) fn least_size([a, b, _]: &[[f64; 2]; 3]) -> f64 {
    let gap = |&[low, high]: &[f64; 2]| low.max(-high).max(0.0);
    gap(a).max(gap(b))
}
