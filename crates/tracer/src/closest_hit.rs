//! The closest hit of a ray: obvhs walks the tree, `triangle` decides, and ties go to the lowest face index.

use obvhs::faststack::HeapStack;
use obvhs::ray::RayHit;
use raypencil_scene::Hit;

use crate::hierarchy::{Hierarchy, round_up};
use crate::rays::TracedRay;
use crate::triangle::Triangle;

/// The intersection of a ray with a face, at t.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Intersection {
    pub(crate) triangle: Triangle,
    pub(crate) t: f64,
}

impl Intersection {
    /// The hit as the contract defines it.
    pub(crate) fn hit(&self, ray: &TracedRay, depth_per_t: f64) -> Hit {
        let normal = self.triangle.normal().normalize();
        Hit {
            face: self.triangle.face,
            range: self.t * ray.metres_per_t,
            point: ray.origin + ray.direction * self.t,
            normal,
            depth: self.t * depth_per_t,
            cos_incidence: -normal.dot(ray.direction) / ray.metres_per_t,
        }
    }

    /// Whether this intersection is reported rather than `other`: it is nearer, or as near with a lower face index.
    fn is_before(&self, other: &Self) -> bool {
        self.t < other.t || (self.t == other.t && self.triangle.face < other.triangle.face)
    }
}

/// Intersects `ray` with `triangle` and updates the `closest` intersection so far. Returns whether it changed.
#[inline]
pub(crate) fn update_closest(
    closest: &mut Option<Intersection>,
    triangle: &Triangle,
    ray: &TracedRay,
    max_range: f64,
) -> bool {
    let Some(t) = triangle.intersect_front(ray) else { return false };
    // At or beyond the SPP, and within the maximum range, which is a distance along the ray.
    if !(t >= 1.0 && t * ray.metres_per_t <= max_range) {
        return false;
    }
    let candidate = Intersection { triangle: *triangle, t };
    if closest.as_ref().is_some_and(|closest| !candidate.is_before(closest)) {
        return false;
    }
    *closest = Some(candidate);
    true
}

/// A closest-hit traversal with its own stack, for many rays on one thread.
pub(crate) struct ClosestHitTraverser<'a> {
    hierarchy: &'a Hierarchy,
    stack: HeapStack<u32>,
}

impl<'a> ClosestHitTraverser<'a> {
    pub(crate) fn new(hierarchy: &'a Hierarchy) -> Self {
        Self { hierarchy, stack: HeapStack::new_with_capacity(hierarchy.boxes().stack_size()) }
    }

    /// The nearest front that `ray` meets between the SPP and `max_range` metres.
    #[inline]
    pub(crate) fn closest_hit(&mut self, ray: &TracedRay, max_range: f64) -> Option<Intersection> {
        let mut closest = None;
        self.hierarchy.boxes().tree().ray_traverse_dynamic(
            &mut self.stack,
            ray.box_ray(round_up(max_range)),
            &mut RayHit::none(),
            |node, box_ray, _| {
                for triangle in self.hierarchy.boxes().leaf_faces(node.first_index, node.prim_count) {
                    if update_closest(&mut closest, triangle, ray, max_range) {
                        // obvhs enters a box only if it begins strictly before tmax. A face at the same t may
                        // still have the lower index, so the bound is rounded up: the padding makes the box of
                        // such a face begin at or before the true range.
                        let range = closest.map_or(max_range, |hit: Intersection| hit.t * ray.metres_per_t);
                        box_ray.tmax = round_up(range * (1.0 + f64::EPSILON));
                    }
                }
                true
            },
        );
        closest
    }
}

#[cfg(test)]
#[path = "../tests/unit/closest_hit.rs"]
mod tests;
