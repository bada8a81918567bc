//! The closest hit of a ray: obvhs walks the tree, `triangle` decides, and ties go to the lowest face index.

use std::ops::Range;

use raypencil_scene::Hit;

use crate::hierarchy::{Hierarchy, round_up};
use crate::tile::{BLOCK, BLOCKS, Nearest, SeenFace, Tile};
use crate::traced_ray::TracedRay;
use crate::triangle::Triangle;
use crate::wide_tree::{Next, Visitor, Waiting};

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
        let mut seeker = RaySeeker { faces: hierarchy.faces(), ray, max_range, closest: None };
        hierarchy.boxes().walk(stack, &mut ray.bundle(round_up(max_range)), &mut seeker);
        seeker.closest
    }

    /// The nearest front that each ray of `tile` in the lanes of `active` meets between the SPP and `max_range` metres.
    #[inline(always)]
    pub(crate) fn closest_hits(
        &mut self,
        tile: &mut Tile,
        active: u64,
        max_range: f64,
        nearest: &mut [Nearest; BLOCKS],
    ) {
        let Self { hierarchy, stack } = self;
        *nearest = [Nearest::NOTHING; BLOCKS];
        let mut left = active;
        while left != 0 {
            let lanes = tile.begin(left);
            left &= !lanes;
            for (b, nearest) in nearest.iter_mut().enumerate() {
                nearest.begin(lanes >> (b * BLOCK), max_range);
            }
            let mut bundle = tile.bundle(round_up(max_range));
            let far = [max_range; BLOCKS];
            let mut seeker = TileSeeker { faces: hierarchy.faces(), tile, nearest, far };
            hierarchy.boxes().walk(stack, &mut bundle, &mut seeker);
        }
    }
}

/// How long a bundle stays whose hits so far are at most `range` metres away. A face at the same t may still have the lower
/// index, so it is rounded up: the padding makes the box of such a face begin at or before the true range.
#[inline(always)]
fn still_to_seek(range: f64) -> f32 {
    round_up(range * (1.0 + f64::EPSILON))
}

/// Seeks the closest hit of one ray.
struct RaySeeker<'a> {
    faces: &'a [Triangle],
    ray: &'a TracedRay,
    max_range: f64,
    closest: Option<Intersection>,
}

impl Visitor for RaySeeker<'_> {
    #[inline(always)]
    fn leaf(&mut self, entries: Range<usize>, far: &mut f32) -> Next {
        for triangle in &self.faces[entries] {
            if update_closest(&mut self.closest, triangle, self.ray, self.max_range) {
                let range = self.closest.map_or(self.max_range, |hit| hit.t * self.ray.metres_per_t);
                *far = still_to_seek(range);
            }
        }
        Next::On
    }
}

/// Seeks the closest hits of a tile's rays.
struct TileSeeker<'a> {
    faces: &'a [Triangle],
    tile: &'a Tile,
    nearest: &'a mut [Nearest; BLOCKS],
    /// The largest range at which a hit of a block would still count, metres.
    far: [f64; BLOCKS],
}

impl Visitor for TileSeeker<'_> {
    #[inline(always)]
    fn leaf(&mut self, entries: Range<usize>, bundle_far: &mut f32) -> Next {
        let Self { faces, tile, nearest, far } = self;
        for triangle in &faces[entries] {
            let face = SeenFace::new(triangle.corners(), tile);
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
                *bundle_far = still_to_seek(far[0].max(far[1]).max(far[2].max(far[3])));
            }
        }
        Next::On
    }
}

#[cfg(test)]
#[path = "../tests/unit/closest_hit.rs"]
mod tests;
