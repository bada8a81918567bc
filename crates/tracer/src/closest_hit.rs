//! The closest hit of a ray: obvhs walks the tree, `triangle` decides, and ties go to the lowest face index.

use glam::DVec3;
use raypencil_scene::Hit;

use crate::hierarchy::{Hierarchy, round_up};
use crate::rays::TracedRay;
use crate::tile::{BLOCK, BLOCKS, Directions, Nearest, SeenFace, Tile};
use crate::triangle::Triangle;
use crate::wide_tree::{Next, Waiting};

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

/// A closest-hit traversal with its own stack, for many tiles of rays on one thread.
pub(crate) struct ClosestHitTraverser<'a> {
    hierarchy: &'a Hierarchy,
    stack: Vec<Waiting>,
}

impl<'a> ClosestHitTraverser<'a> {
    pub(crate) fn new(hierarchy: &'a Hierarchy) -> Self {
        Self { hierarchy, stack: hierarchy.boxes().stack() }
    }

    /// The nearest front that `ray` meets between the SPP and `max_range` metres.
    pub(crate) fn closest_hit(&mut self, ray: &TracedRay, max_range: f64) -> Option<Intersection> {
        let Self { hierarchy, stack } = self;
        let mut closest = None;
        hierarchy.boxes().walk(stack, &mut ray.bundle(round_up(max_range)), |leaf, far| {
            for triangle in &hierarchy.faces()[leaf] {
                if update_closest(&mut closest, triangle, ray, max_range) {
                    let range = closest.map_or(max_range, |hit: Intersection| hit.t * ray.metres_per_t);
                    *far = round_up(range * (1.0 + f64::EPSILON));
                }
            }
            Next::On
        });
        closest
    }

    /// The nearest front that each ray from `origin` meets between the SPP and `max_range` metres.
    #[inline(always)]
    pub(crate) fn closest_hits(
        &mut self,
        origin: DVec3,
        directions: &Directions,
        max_range: f64,
    ) -> [Nearest; BLOCKS] {
        let mut nearest = [Nearest::NOTHING; BLOCKS];
        directions.tiles(origin, |tile, lanes| {
            for (b, nearest) in nearest.iter_mut().enumerate() {
                let mask = lanes >> (b * BLOCK);
                for k in 0..BLOCK {
                    let takes_part = mask & (1 << k) != 0;
                    nearest.limit[k] = if takes_part { max_range } else { -1.0 };
                    let of_ray = tile.blocks[b].metres_per_t[k];
                    nearest.metres_per_t[k] = if takes_part { of_ray } else { nearest.metres_per_t[k] };
                }
            }
            self.walk(tile, &mut nearest, max_range);
        });
        nearest
    }

    #[inline(always)]
    fn walk(&mut self, tile: &Tile, nearest: &mut [Nearest; BLOCKS], max_range: f64) {
        let Self { hierarchy, stack } = self;
        let mut far = [max_range; BLOCKS];
        let mut bundle = tile.bundle(round_up(max_range));
        hierarchy.boxes().walk(stack, &mut bundle, |leaf, bundle_far| {
            for triangle in &hierarchy.faces()[leaf] {
                let face = SeenFace::new(triangle, tile);
                if tile.misses_front(&face) {
                    continue;
                }
                let mut changed = false;
                for b in 0..BLOCKS {
                    if tile.block_misses_front(b, &face) {
                        continue;
                    }
                    if tile.update_closest(b, &face, triangle, &mut nearest[b]) {
                        far[b] = nearest[b].far(&tile.blocks[b]);
                        changed = true;
                    }
                }
                if changed {
                    // A face at the same t may still have the lower index, so the bound is rounded up: the padding makes
                    // the box of such a face begin at or before the true range.
                    let farthest = far[0].max(far[1]).max(far[2].max(far[3]));
                    *bundle_far = round_up(farthest * (1.0 + f64::EPSILON));
                }
            }
            Next::On
        });
    }
}

#[cfg(test)]
#[path = "../tests/unit/closest_hit.rs"]
mod tests;
