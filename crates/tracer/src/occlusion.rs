//! Does any face stand between a point that a pencil hits and the camera? (Paper, §6; contract: visible)
//!
//! The segment is c + u (P - c), f_c / r <= u < 1: from the crossing of the image plane up to, but without,
//! the point. Any face counts, from its front or its back, except those that the point lies on.
//!
//! # The end at the point
//!
//! u < 1 is not asked of a quotient. With u = n.(a - c) / n.(P - c) it is 1 - u = n.(P - a) / n.(P - c), so
//! u < 1 says: *the point lies strictly behind the face's plane, as the camera sees it*. The sign of n.(P - a)
//! is as good as P itself; no threshold is needed, and a lid one step of f32 above the ground hides it.
//!
//! What is left is the rounding of P: some 2^-52 of its coordinates and of R, and along the pencil, that is
//! within the hit face at grazing incidence, 1 / cos(psi) times that; 1e-14 m at 20 m. A face whose plane passes
//! as close to P as that may be put on the wrong side of it: it hides the point or not, by rounding. For most
//! such faces that cannot happen, because they are known to hold P itself:
//!
//! * the hit face;
//! * those that the pencil meets, from either side, at the very same bits of t: duplicates and reversed
//!   duplicates always, and neighbours where the pencil runs into their common edge and t comes out alike;
//! * those whose corners lie in the plane of the hit face. The segment leaves that plane in P and meets it nowhere
//!   else, so they either hold P or are not met. (Faces that overlap without sharing corners: their t differ by
//!   rounding although they are equal. The corners' f64 distance from the plane is exactly 0 for planes along
//!   the axes; where it is 0 by rounding, the face lies within rounding of the plane, as above.)
//!
//! So there remains a pencil within rounding of an edge between two faces of different slope. Which way it is
//! decided there is a matter of rounding, not of definition: a ray displaced by as little decides otherwise.

use glam::DVec3;
use obvhs::faststack::{FastStack, HeapStack};
use obvhs::ray::RayHit;

use crate::hierarchy::{Hierarchy, round_up};
use crate::nearest::Found;
use crate::rays::TracedRay;
use crate::triangle::{Triangle, widen};

/// The line of sight from the camera to a point that a pencil hits.
#[derive(Debug)]
pub(crate) struct Sight<'a> {
    /// From the projection centre along P - c: the point is at u = 1.
    ray: TracedRay,
    /// P, scene frame, metres.
    point: DVec3,
    /// u where the ray crosses the image plane is f_c / r: the two apart, metres.
    focal_length: f64,
    depth: f64,
    /// The pencil, and the face it hits.
    pencil: &'a TracedRay,
    met: &'a Found,
}

impl<'a> Sight<'a> {
    /// From the camera's `centre` to `point`, at a `depth` beyond the focal length, where `pencil` has `met` a
    /// face.
    pub(crate) fn new(
        centre: DVec3,
        focal_length: f64,
        point: DVec3,
        depth: f64,
        pencil: &'a TracedRay,
        met: &'a Found,
    ) -> Self {
        Self { ray: TracedRay::new(centre, point - centre), point, focal_length, depth, pencil, met }
    }

    /// Whether this face hides the point.
    #[inline]
    pub(crate) fn is_blocked_by(&self, triangle: &Triangle) -> bool {
        let Some(crossing) = triangle.crosses(&self.ray) else { return false };
        // Both inequalities are multiplied by |n.(P - c)|, the first by r too: no division rounds.
        let side = crossing.along.signum();
        let beyond_image_plane =
            side * crossing.to_plane * self.depth >= self.focal_length * (side * crossing.along);
        let before_point = side * crossing.normal.dot(self.point - widen(triangle.vertices[0])) > 0.0;
        beyond_image_plane && before_point && !self.holds_point(triangle)
    }

    /// Whether the point is known to lie on this face. Few faces get as far as being asked.
    #[cold]
    fn holds_point(&self, triangle: &Triangle) -> bool {
        let hit = &self.met.triangle;
        if triangle.face == hit.face {
            return true;
        }
        let tied = triangle.crosses(self.pencil).is_some_and(|at| at.to_plane / at.along == self.met.t);
        let (normal, corner) = (hit.normal(), widen(hit.vertices[0]));
        tied || triangle.vertices.iter().all(|&v| normal.dot(widen(v) - corner) == 0.0)
    }
}

/// A search for anything in the way, with a stack of its own, for many points on one thread.
pub(crate) struct Occlusion<'a> {
    hierarchy: &'a Hierarchy,
    stack: HeapStack<u32>,
}

impl<'a> Occlusion<'a> {
    pub(crate) fn new(hierarchy: &'a Hierarchy) -> Self {
        Self { hierarchy, stack: HeapStack::new_with_capacity(hierarchy.stack_size()) }
    }

    /// Whether any face hides the point at the end of `sight`.
    pub(crate) fn hides(&mut self, sight: &Sight) -> bool {
        let distance = sight.ray.metres_per_t;
        debug_assert!(distance <= self.hierarchy.reach(), "{distance} m: the boxes are too narrow");
        // obvhs enters a box only if it begins strictly before the far end, hence rounded up; it knows no near
        // end, so faces before the image plane are proposed and refused.
        let box_ray = sight.ray.for_boxes(round_up(distance));
        // What an early end left on the stack belongs to another ray.
        self.stack.clear();
        let mut hidden = false;
        self.hierarchy.tree().ray_traverse_dynamic(
            &mut self.stack,
            box_ray,
            &mut RayHit::none(),
            |node, _, _| {
                let triangles = self.hierarchy.triangles_of(node.first_index, node.prim_count);
                hidden = triangles.iter().any(|triangle| sight.is_blocked_by(triangle));
                !hidden
            },
        );
        hidden
    }
}

#[cfg(test)]
#[path = "../tests/unit/occlusion.rs"]
mod tests;
