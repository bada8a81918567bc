//! The search for the nearest hit: obvhs walks the tree, `triangle` decides, ties go to the lowest face.

use obvhs::faststack::HeapStack;
use obvhs::ray::RayHit;
use raypencil_scene::Hit;

use crate::hierarchy::{Hierarchy, round_up};
use crate::rays::TracedRay;
use crate::triangle::Triangle;

/// A face that a ray meets, at t.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Found {
    pub(crate) triangle: Triangle,
    pub(crate) t: f64,
}

impl Found {
    /// The hit in the contract's words.
    pub(crate) fn hit(&self, ray: &TracedRay, depth_per_t: f64) -> Hit {
        let normal = self.triangle.normal().normalize();
        Hit {
            face: self.triangle.face,
            range: self.t * ray.metres_per_t,
            point: ray.origin + ray.direction * self.t,
            normal,
            depth: self.t * depth_per_t,
            incidence: -normal.dot(ray.direction) / ray.metres_per_t,
        }
    }

    /// Whether this is the hit to report rather than `other`.
    fn is_before(&self, other: &Self) -> bool {
        self.t < other.t || (self.t == other.t && self.triangle.face < other.triangle.face)
    }
}

/// Keeps the better of the nearest hit so far and what `triangle` offers.
#[inline]
pub(crate) fn offer(
    nearest: &mut Option<Found>,
    triangle: &Triangle,
    ray: &TracedRay,
    max_range: f64,
) -> bool {
    let Some(t) = triangle.meets(ray) else { return false };
    // At or beyond the SPP, and within the range, which is distance along the ray.
    if !(t >= 1.0 && t * ray.metres_per_t <= max_range) {
        return false;
    }
    let found = Found { triangle: *triangle, t };
    if nearest.as_ref().is_some_and(|kept| !found.is_before(kept)) {
        return false;
    }
    *nearest = Some(found);
    true
}

/// A search with a stack of its own, for many rays on one thread.
pub(crate) struct Search<'a> {
    hierarchy: &'a Hierarchy,
    stack: HeapStack<u32>,
}

impl<'a> Search<'a> {
    pub(crate) fn new(hierarchy: &'a Hierarchy) -> Self {
        Self { hierarchy, stack: HeapStack::new_with_capacity(hierarchy.stack_size()) }
    }

    /// The nearest front that `ray` meets between the SPP and `max_range`.
    #[inline]
    pub(crate) fn nearest(&mut self, ray: &TracedRay, max_range: f64) -> Option<Found> {
        let mut nearest = None;
        self.hierarchy.tree().ray_traverse_dynamic(
            &mut self.stack,
            ray.for_boxes(round_up(max_range)),
            &mut RayHit::none(),
            |node, box_ray, _| {
                for triangle in self.hierarchy.triangles_of(node.first_index, node.prim_count) {
                    if offer(&mut nearest, triangle, ray, max_range) {
                        // obvhs enters a box only if it begins strictly before tmax. A face at the very
                        // same t may still have the lower index, so the bound is rounded up: the padding
                        // makes the box of such a face begin at or before the true range.
                        let range = nearest.map_or(max_range, |found: Found| found.t * ray.metres_per_t);
                        box_ray.tmax = round_up(range * (1.0 + f64::EPSILON));
                    }
                }
                true
            },
        );
        nearest
    }
}

#[cfg(test)]
#[path = "../tests/unit/nearest.rs"]
mod tests;
