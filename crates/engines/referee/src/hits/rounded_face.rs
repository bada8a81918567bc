//! How wrong a program in rounded arithmetic may be about one face, and still be honest.
//!
//! Such a program forms n = e1 x e2, n.(a - o) and n.q, for a ray from o along q and a face with a corner a. To first order in
//! its unit roundoff u, with kappa the [aspect] of the face, L its longest edge, R its range along the ray, c the cosine between
//! ray and normal, and S = R + L + |o|:
//!
//! * n.q has an error of at most (5 kappa + 15) u |n| |q|: 5 kappa u of the normal, 15 u of the direction and of the product. So
//!   where c is smaller than that, the face is *edge-on*: the program cannot tell its front from its back;
//! * n.(a - o) has one of (5 kappa + 6) u |n| S, so the range, their quotient times |q| and three roundings more, has one of at
//!   most ((5 kappa + 6) S + (5 kappa + 18 + 3) R) u / c, which is below (10 kappa + 27) u S / c.
//!
//! Of an edge-on face the second is more than (10 kappa + 27) / (5 kappa + 15) S, which is larger than R.
//!
//! Multiplied by c, the second says how far the point that the program finds is off the face's plane, along the normal: e =
//! (10 kappa + 27) u S, however the face is seen. A program that forms this point first, and then its side of each edge, sees it
//! beside its place as well. The point is off by e / c along the ray, of which e sin(psi) / c lies in the plane; seen along the
//! ray, which the plane meets under the cosine c, that is e sin(psi). By so much the program's edges [seem displaced](edge_slip).
//!
//! The judge's bounds derive both, step by step; a range that is stated may be off by 36 kappa u S / c, which is more, as kappa is
//! at least 1.15.
//! A face in the way gets the smaller bound: of a slender one the other would excuse too much.

use std::cmp::Ordering;

use glam::DVec3;

use crate::hits::aspect::aspect;
use crate::hits::face::{ExactRay, Face};
use crate::numbers::number::{Dyadic, Interval, Number};
use crate::numbers::rounding::quotient;
use crate::numbers::vector::Vector;
use crate::trees::bvh::InBox;

/// Roundings of a stated range: |dR| <= RANGE_ROUNDINGS kappa u S / c.
pub const RANGE_ROUNDINGS: f64 = 36.0;

/// Roundings of n.q that grow with the aspect: those of the normal.
const NORMAL_ROUNDINGS: f64 = 5.0;
/// The other roundings of n.q: the rotation of q, and a dot product.
const APPROACH_ROUNDINGS: f64 = 15.0;
/// Roundings of the range that do not grow with the aspect: 6 S, and 21 R.
const QUOTIENT_ROUNDINGS: f64 = 27.0;
/// Roundings of n.(a - o) beside the normal's: a subtraction, and a dot product.
const HEIGHT_ROUNDINGS: f64 = 6.0;

/// A face whose plane a ray crosses, as a program in rounded arithmetic may see it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RoundedFace {
    /// R, metres, to nine digits; negative behind the ray's start.
    pub(crate) range: f64,
    /// The error of R, metres: more than R itself if the face is edge-on.
    pub(crate) range_error: f64,
    /// Whether the ray comes from behind.
    pub(crate) is_back: bool,
    /// Whether the program may take the front for the back.
    pub(crate) is_edge_on: bool,
}

impl RoundedFace {
    /// What a program with this unit roundoff may make of a face; `None` if the ray is exactly parallel to the face.
    pub(crate) fn of(face: &Face, ray: &ExactRay<'_>, unit_roundoff: f64) -> Option<Self> {
        let fast = ray.fast();
        let middle = |v: &Vector<Interval>| DVec3::from_array(std::array::from_fn(|k| v.0[k].middle()));
        let (direction, scale) = (middle(&fast.direction), fast.origin_scale.middle());
        let (height, approach) = height_and_approach(face, ray)?;
        let normal = middle(&face.normal::<Interval>());
        let length = direction.length();
        let range = height * length / (approach * scale);
        let size = range.abs() + face.longest_edge() + middle(&fast.origin).length() / scale;
        let cosine = approach.abs() / (normal.length() * length);
        let kappa = aspect(face.corners());
        let range_error =
            (2.0 * NORMAL_ROUNDINGS * kappa + QUOTIENT_ROUNDINGS) * unit_roundoff * size / cosine;
        Some(Self {
            range,
            // Not a number for a face whose normal is too small for f64.
            range_error: if range_error.is_nan() { f64::INFINITY } else { range_error },
            is_back: approach > 0.0,
            is_edge_on: cosine <= least_cosine(kappa, unit_roundoff),
        })
    }
}

/// How far an edge may seem displaced, metres, square to it and to a line that passes it, to a program with this unit roundoff that
/// forms the point on the plane first. The face, whose normal is `normal`, seems to slip in the plane of incidence alone: an edge that
/// runs in this plane, as that of a plank seen along its length, stays where it is. `size` is S.
pub fn edge_slip(aspect: f64, normal: DVec3, edge: DVec3, line: DVec3, size: f64, unit_roundoff: f64) -> f64 {
    let across = |v: DVec3| v - line * (v.dot(line) / line.length_squared());
    // Across the line the normal is as long as the sine of the angle of incidence, and shows where the face slips to.
    let slip = across(normal) / normal.length();
    let square = line.cross(edge).normalize_or_zero();
    (2.0 * NORMAL_ROUNDINGS * aspect + QUOTIENT_ROUNDINGS) * unit_roundoff * size * slip.dot(square).abs()
}

/// The cosine up to which a face of this aspect is edge-on for a program with this unit roundoff.
pub(crate) fn least_cosine(kappa: f64, unit_roundoff: f64) -> f64 {
    (NORMAL_ROUNDINGS * kappa + APPROACH_ROUNDINGS) * unit_roundoff
}

/// n.a' and n.D, each to nine digits also where they are tiny; `None` if n.D is 0.
fn height_and_approach(face: &Face, ray: &ExactRay<'_>) -> Option<(f64, f64)> {
    let fast = face.crossing(ray.fast());
    let is_sharp = |x: &Interval| x.high - x.low <= 1e-9 * x.magnitude();
    if is_sharp(&fast.height) && is_sharp(&fast.approach) {
        return Some((fast.height.middle(), fast.approach.middle()));
    }
    let exact = face.crossing(ray.exact());
    let nearest = |x: &Dyadic| quotient(x, &Dyadic::of(1.0)).double;
    (exact.approach.sign() != Some(Ordering::Equal))
        .then(|| (nearest(&exact.height), nearest(&exact.approach)))
}

/// How far from its place the plane of a face may seem, metres, to a program with this unit roundoff: seen from a point p,
/// n.(p - a) has an error of (5 kappa + 6) u |n| S. `size` is S, at least |p| and |p - a|.
pub(crate) fn plane_error(face: &Face, size: f64, unit_roundoff: f64) -> f64 {
    (NORMAL_ROUNDINGS * aspect(face.corners()) + HEIGHT_ROUNDINGS) * unit_roundoff * size
}

#[cfg(test)]
#[path = "../../tests/unit/rounded_face.rs"]
mod tests;
