//! The scaled frame of a mesh: its boxes, and rays in it.
//!
//! # Padding
//!
//! In the scaled frame, moved to the middle of the mesh, the boxes lie within |x| <= 1. A ray is traced from the point in
//! which it enters the box of all of them, so that both that point and all hits lie within 2 sqrt(3) < 3.5 of each other; rays
//! from one point are traced from it if all boxes lie within [`MAX_WAY`] of it.
//! By the bound of `hierarchy`, f32 traversal misses a box by at most 8 u (|P| + s) with u = 2^-24, |P| <= 1 and s <= [`MAX_WAY`].
//! Two things come to it, both in f64:
//!
//! * moving a vertex to the middle: 2^-53 of its coordinate and of the middle's, charged as 2^-50 of the largest
//!   coordinate;
//! * the point of entry: six roundings, each 2^-53 of the distance from the origin or of a coordinate. A ray for which
//!   2^-50 of these is more than [`MAX_ENTRY_ERROR`] is not traced through the tree: all faces are asked.

use glam::{DVec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::ray::Ray as BoxRay;
use raypencil_scene::{CastRay, Triangles};

use crate::hierarchy::{round_down, round_up};
use crate::traced_ray::TracedRay;

/// u = 2^-24: the unit roundoff of f32.
const U: f64 = 1.0 / (1u32 << 24) as f64;
/// 2^-50: more than the roundings of a few f64 operations.
const FEW_ROUNDINGS: f64 = 4.0 * f64::EPSILON;
/// Largest error of the point of entry that the boxes allow for: the origin is then 2^26 times as far away as the mesh is
/// wide.
const MAX_ENTRY_ERROR: f64 = U;
/// Longest way of a ray from where it is traced.
const MAX_WAY: f64 = 6.0;

/// How a mesh's coordinates become those in which rays are traced.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    /// A power of two: scaled coordinates per unit of the mesh.
    pub(super) scale: f64,
    /// The middle of the mesh, scaled.
    pub(super) middle: DVec3,
    /// Half the width of the box of all faces, scaled, with the padding of a face's box and as much again.
    half_width: DVec3,
    /// What is added to each side of a face's box.
    padding: f64,
    /// The largest scaled coordinate of the mesh.
    largest: f64,
}

/// A ray in the scaled frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct ScaledRay {
    pub(super) ray: TracedRay,
    /// A power of two: t of the given ray per t of this one.
    pub(super) t_per_t: f64,
    /// A power of two: the length of one in the scaled frame, in the mesh's unit.
    pub(super) unit: f64,
}

/// How the tree is walked.
#[derive(Debug, Clone, Copy)]
pub(super) enum Walk {
    /// The ray does not meet the box of all faces.
    Nothing,
    /// From the point of entry, which is `entry` away from the origin.
    Tree { box_ray: BoxRay, entry: f64 },
    /// The origin is too far away for boxes in f32.
    AllFaces,
}

/// The least exponents of two by which a mesh and a direction are divided, so that all numbers stay finite: a direction's largest
/// component is 1e-270 at least, which is above 2^-900.
const LEAST_OF_MESH: i32 = -300;
const LEAST_OF_DIRECTION: i32 = -900;

/// The power of two from which `size` is less than a factor of two away, upward; not below 2^least, nor above 2^300. Of a size that is
/// not normal it is 1.
#[inline]
fn power_of_two_above(size: f64, least: i32) -> f64 {
    let exponent = if size.is_normal() {
        (size.to_bits() >> (f64::MANTISSA_DIGITS - 1)) as i32 - (f64::MAX_EXP - 2)
    } else {
        // Of a mesh that is less wide no face has an area, at any scale.
        0
    };
    f64::from_bits(((exponent.clamp(least, 300) + f64::MAX_EXP - 1) as u64) << (f64::MANTISSA_DIGITS - 1))
}

impl Frame {
    pub(super) fn of(mesh: &Triangles) -> Self {
        let [low, high] = mesh.bounds().unwrap_or([DVec3::ZERO; 2]);
        // Halved before they are added, so that no sum overflows.
        let (middle, half) = (low * 0.5 + high * 0.5, high * 0.5 - low * 0.5);
        let scale = 1.0 / power_of_two_above(half.max_element(), LEAST_OF_MESH);
        let largest = low.abs().max(high.abs()).max_element() * scale;
        let padding = 9.0 * U * (1.0 + MAX_WAY) + MAX_ENTRY_ERROR + FEW_ROUNDINGS * largest;
        let half_width = half * scale + DVec3::splat(2.0 * padding);
        Self { scale, middle: middle * scale, half_width, padding, largest }
    }

    /// The padded box of a face, from its scaled corners.
    pub(super) fn padded_box(&self, corners: [DVec3; 3]) -> Aabb {
        let [a, b, c] = corners.map(|corner| corner - self.middle);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let down = |x: f64| round_down(x - self.padding);
        let up = |x: f64| round_up(x + self.padding);
        Aabb::new(Vec3A::from(low.to_array().map(down)), Vec3A::from(high.to_array().map(up)))
    }

    /// A ray in this frame.
    #[inline]
    pub(super) fn ray(&self, given: &CastRay) -> ScaledRay {
        let (direction, t_per_t) = self.scaled_direction(given);
        let ray = TracedRay::new(given.origin * self.scale, direction);
        ScaledRay { ray, t_per_t, unit: 1.0 / self.scale }
    }

    /// Its direction in this frame, and t of the given ray per t of that one.
    #[inline]
    pub(super) fn scaled_direction(&self, given: &CastRay) -> (DVec3, f64) {
        let shrink = 1.0 / power_of_two_above(given.direction.abs().max_element(), LEAST_OF_DIRECTION);
        // o + t d, scaled: o scale + (t scale / shrink) (d shrink).
        (given.direction * shrink, shrink / self.scale)
    }

    /// The point, where the boxes are, if rays from it can be traced from there: if no box is too far away.
    pub(super) fn start(&self, origin: DVec3) -> Option<DVec3> {
        let start = origin * self.scale - self.middle;
        let is_near = FEW_ROUNDINGS * (start.abs().max_element() + self.largest) <= MAX_ENTRY_ERROR
            && start.length() + self.half_width.length() <= MAX_WAY;
        is_near.then_some(start)
    }

    /// How a ray goes through the tree.
    pub(super) fn walk(&self, given: &CastRay, scaled: &ScaledRay) -> Walk {
        let ray = &scaled.ray;
        let (t_min, t_max) = (given.t_min / scaled.t_per_t, given.t_max / scaled.t_per_t);
        let start = ray.origin - self.middle;
        let unit = ray.direction / ray.metres_per_t;
        // Slabs in f64, around a box that is wider than those of the faces by far more than their rounding, unless the
        // origin is too far away.
        let (mut entry, mut exit) = (t_min * ray.metres_per_t, t_max * ray.metres_per_t);
        let far = start.abs().max_element() + self.largest;
        if !(FEW_ROUNDINGS * (2.0 * far + entry) <= MAX_ENTRY_ERROR) {
            return Walk::AllFaces;
        }
        for k in 0..3 {
            // By a part of 0 the quotients are infinite: of opposite signs if the ray stays inside, and else of the same.
            // On the border itself one of them is NaN, and the ray is let go: the faces' boxes end before it.
            let (a, b) =
                ((-self.half_width[k] - start[k]) / unit[k], (self.half_width[k] - start[k]) / unit[k]);
            entry = entry.max(a.min(b));
            exit = exit.min(a.max(b));
        }
        if entry > exit {
            return Walk::Nothing;
        }
        let from = start + unit * entry;
        let narrow = |v: DVec3| Vec3A::new(v.x as f32, v.y as f32, v.z as f32);
        let way = round_up(exit - entry + MAX_ENTRY_ERROR);
        Walk::Tree { box_ray: BoxRay::new(narrow(from), narrow(unit), 0.0, way), entry }
    }
}

/// The way from the point of entry to a hit at `range` from the origin, rounded up by more than its errors. Nothing is
/// farther away than [`MAX_WAY`].
pub(super) fn way_to(range: f64, entry: f64) -> f32 {
    round_up((range - entry + MAX_ENTRY_ERROR).min(MAX_WAY))
}
