//! Occlusion: does any face stand between a pencil's hit point and the camera? (Paper, §6; contract: visible)
//!
//! The tested segment is c + u (P - c) with f_c / r <= u < 1. It runs from the crossing of the image plane up to the
//! point P, without P itself. Every face counts, from its front or its back, except those that P lies on.
//!
//! # The end at the point
//!
//! u < 1 is not tested on a quotient. From u = n.(a - c) / n.(P - c) follows 1 - u = n.(P - a) / n.(P - c). So
//! u < 1 means: *the point lies strictly behind the face's plane, as the camera sees it*. The sign of n.(P - a) is
//! as accurate as P itself. No threshold is needed, and a lid one f32 step above the ground hides it.
//!
//! What remains is the rounding of P. It is some 2^-52 of P's coordinates and of R; along the pencil, which is
//! within the hit face at grazing incidence, it is 1 / cos(psi) times that: 1e-14 m at 20 m. A face whose plane
//! passes P that closely may come out on the wrong side of P, and then hide it or not by rounding. For most such
//! faces this cannot happen, because they are known to contain P:
//!
//! * the hit face;
//! * faces that the pencil meets, from either side, at the very same bits of t: duplicates and reversed duplicates
//!   always, and neighbours where the pencil runs into their common edge and t comes out alike;
//! * faces whose vertices lie in the plane of the hit face. The segment leaves that plane in P and meets it nowhere
//!   else, so such a face either contains P or is not met. (Faces may overlap without sharing vertices. Their t
//!   are then equal, but differ as rounded. The vertices' f64 distance from the plane is exactly 0 for planes along
//!   the axes. Where it is 0 by rounding, the face lies within rounding of the plane, as above.)
//!
//! There remains a pencil within rounding of an edge between two faces of different slope. The definition does not
//! decide that case, rounding does: a ray displaced by as little gets the other answer.

use std::ops::Range;

use glam::DVec3;

use crate::closest_hit::Intersection;
use crate::hierarchy::{Hierarchy, round_up};
use crate::tile::{BLOCK, BLOCKS, SeenFace, Tile};
use crate::traced_ray::TracedRay;
use crate::triangle::{Triangle, widen};
use crate::wide_tree::{Next, Visitor, Waiting};

/// The line of sight from the camera to the point that a pencil hits.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LineOfSight {
    /// The ray from the projection centre along P - c. The point is at u = 1.
    ray: TracedRay,
    /// P, scene frame, metres.
    point: DVec3,
    /// f_c, metres. The ray crosses the image plane at u = f_c / r.
    focal_length: f64,
    /// r, metres.
    depth: f64,
    pencil: TracedRay,
    /// The pencil's hit.
    hit: Intersection,
}

impl LineOfSight {
    /// From the camera's `centre` to `point`, the `hit` of `pencil`. The point's `depth` exceeds `focal_length`.
    pub(crate) fn new(
        centre: DVec3,
        focal_length: f64,
        point: DVec3,
        depth: f64,
        pencil: TracedRay,
        hit: Intersection,
    ) -> Self {
        Self { ray: TracedRay::new(centre, point - centre), point, focal_length, depth, pencil, hit }
    }

    /// Whether this face hides the point.
    #[inline]
    pub(crate) fn is_blocked_by(&self, triangle: &Triangle) -> bool {
        let Some(crossing) = triangle.intersect_either_side(&self.ray) else { return false };
        // Both inequalities are multiplied by |n.(P - c)|, the first by r too: no division rounds.
        let side = crossing.n_dot_q.signum();
        let beyond_image_plane =
            side * crossing.n_dot_offset * self.depth >= self.focal_length * (side * crossing.n_dot_q);
        let before_point = side * crossing.normal.dot(self.point - widen(triangle.vertices[0])) > 0.0;
        beyond_image_plane && before_point && !self.is_point_on(triangle)
    }

    /// Whether the point is known to lie on this face. Few faces get this far.
    #[cold]
    fn is_point_on(&self, triangle: &Triangle) -> bool {
        let hit_face = &self.hit.triangle;
        if triangle.face == hit_face.face {
            return true;
        }
        let tied = triangle
            .intersect_either_side(&self.pencil)
            .is_some_and(|crossing| crossing.n_dot_offset / crossing.n_dot_q == self.hit.t);
        let (normal, vertex) = (hit_face.normal(), widen(hit_face.vertices[0]));
        tied || triangle.vertices.iter().all(|&v| normal.dot(widen(v) - vertex) == 0.0)
    }
}

/// An any-hit traversal with its own stack, for many tiles of points on one thread.
pub(crate) struct OcclusionTraverser<'a> {
    hierarchy: &'a Hierarchy,
    stack: Vec<Waiting>,
}

impl<'a> OcclusionTraverser<'a> {
    pub(crate) fn new(hierarchy: &'a Hierarchy) -> Self {
        Self { hierarchy, stack: hierarchy.boxes().stack() }
    }

    /// Which of the points at the ends of up to 64 lines of sight from one camera any face hides; lane by lane.
    #[inline(always)]
    pub(crate) fn occluded(&mut self, lines: &[Option<LineOfSight>]) -> u64 {
        let Some(first) = lines.iter().flatten().next() else { return 0 };
        let mut tile = Tile::EMPTY;
        tile.origin = first.ray.origin;
        let mut left = 0;
        for (lane, line) in lines.iter().enumerate() {
            if let Some(line) = line {
                let distance = line.ray.metres_per_t;
                debug_assert!(
                    distance <= self.hierarchy.max_trace_distance(),
                    "the line of sight is {distance} m long; the boxes are padded for {} m",
                    self.hierarchy.max_trace_distance()
                );
                tile.set_direction(lane, line.ray.direction);
                left |= 1 << lane;
            }
        }
        let Self { hierarchy, stack } = self;
        let mut occluded = 0_u64;
        tile.prepare();
        while left != 0 {
            let lanes = tile.begin(left);
            left &= !lanes;
            let mut far = 0.0;
            for (lane, line) in lines.iter().enumerate() {
                if let Some(line) = line
                    && lanes & (1 << lane) != 0
                {
                    far = f64::max(far, line.ray.metres_per_t);
                }
            }
            // A box is entered if it begins at or before the far end. There is no near end, so faces before the image plane
            // are proposed too, and refused by the exact test.
            let mut bundle = tile.bundle(round_up(far));
            let mut seeker = Seeker { faces: hierarchy.faces(), tile: &tile, lines, open: lanes };
            hierarchy.boxes().walk(stack, &mut bundle, &mut seeker);
            occluded |= lanes & !seeker.open;
        }
        occluded
    }
}

/// Seeks a face before each of a tile's points.
struct Seeker<'a> {
    faces: &'a [Triangle],
    tile: &'a Tile,
    lines: &'a [Option<LineOfSight>],
    /// Lanes of the points that nothing hides so far.
    open: u64,
}

impl Visitor for Seeker<'_> {
    #[inline(always)]
    fn leaf(&mut self, entries: Range<usize>, _: &mut f32) -> Next {
        let Self { faces, tile, lines, open } = self;
        for triangle in &faces[entries] {
            let face = SeenFace::new(triangle.corners(), tile);
            if tile.misses(&face) {
                continue;
            }
            for b in 0..BLOCKS {
                let of_block = *open >> (b * BLOCK) & ((1 << BLOCK) - 1);
                if of_block == 0 {
                    continue;
                }
                let mut inside = tile.inside(b, &face) & of_block;
                while inside != 0 {
                    let lane = b * BLOCK + inside.trailing_zeros() as usize;
                    inside &= inside - 1;
                    if lines[lane].as_ref().is_some_and(|line| line.is_blocked_by(triangle)) {
                        *open &= !(1 << lane);
                    }
                }
            }
        }
        if *open == 0 { Next::Stop } else { Next::On }
    }
}

#[cfg(test)]
#[path = "../tests/unit/occlusion.rs"]
mod tests;
