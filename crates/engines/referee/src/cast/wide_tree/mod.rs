//! The way to the faces that a ray may meet: boxes eight a node, and the faces of a leaf four at once, both in
//! f32.
//!
//! It proposes and never decides: what it leaves out is certainly not met. All is in a *frame* of the tree: relative to the
//! middle of all faces, times a power of two, so that no |coordinate| exceeds 1; and a direction is divided by its largest part.
//! A place of the ray is its way tau there, the largest part of what it went. With u = 2^-24, A = |o| + 1 for the largest
//! part |o| of the origin, which is at most 2^16:
//!
//! # Why no ray loses a box
//!
//! The planes of a box are rounded outward by two steps of f32 and [`WIDENED`], the origin o by as much down and up, and each
//! plane is asked with the one of the two for which it is entered earlier, or left later. So but for relative errors each tau
//! errs to the safe side. These errors are u of the difference, 1.01 u of the inverse and u of the product: 3.1 u of what is
//! entered and of what is left, for which [`GROWN`] takes 16 u. A ray that moves by less than [`LEAST_PART`] along an axis moves
//! there by less than 2^17 2^-100 in all, far below [`WIDENED`]: it gets the greatest inverse of all, and leaves a slab that it
//! is in after 2^39 or more, beyond all faces. Nothing is infinite or NaN.
//!
//! # Why no ray loses a face
//!
//! The ray passes the edge e from a corner a on the side that is the sign of F = e.(d x a'), a' = a - o, as in `edge_filter`. It
//! meets no face of which two edges have opposite signs. Here a corner is off by 1.1 u, o by 1.01 u |o| and d by 1.01 u, each
//! in the largest part. With C = |d x a'| and E = |e|, as computed:
//!
//! ```text
//! a'                  1.1 u + 1.01 u |o| + 1.01 u A                 at most  2.2 u A
//! a part of d x a'    twice 2.2 u A + 1.01 u A + u A, then 2 u A    at most  11 u A
//! e                   twice 1.1 u, and its rounding u E             2.2 u + u E
//! F                   3 (C (2.2 u + u E) + 11 u A E + u C E) + 5 u C E  =  C (6.6 u + 11 u E) + 33 u A E
//! ```
//!
//! The bound takes C (8 u + 16 u E) + 48 u A E. The edge to a is asked with a' too: e.(d x c') is the same, as c - a is along e. The
//! edge b c is asked with b'; its C is at most |d x a'| + 2 E + 32 u A, which stands for both. Products that underflow lose less than
//! 2^-100, which is nothing beside the 256 u^2 A of the bound.

mod build;
mod walk;

use glam::{BVec4A, DVec3, Vec4};
use rayon::prelude::*;
use raypencil_scene::{FaceId, Triangles};

use super::triangle::Triangle;

pub(super) use walk::{FrameRay, Next, Rays, TOGETHER, how_many_together};

/// Boxes of a node.
const WIDTH: usize = 8;

/// Faces of a leaf.
const LEAF_WIDTH: usize = 4;

/// u.
const U: f32 = 1.0 / (1 << 24) as f32;

/// 1 + 16 u.
const GROWN: f32 = 1.0 + 16.0 * U;

/// 2^-60.
const WIDENED: f32 = 1.0 / (1_u64 << 60) as f32;

/// 2^-100.
const LEAST_PART: f64 = 1.0 / (1_u128 << 100) as f64;

/// The largest part of an origin, in the frame. Of rays from farther away little would be certain in f32.
const MAX_ORIGIN: f64 = (1 << 16) as f64;

/// A child that is a leaf.
const LEAF: u32 = 1 << 31;

/// Eight boxes, and what is in each.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
struct Node {
    /// Lower planes across x, y, z, then the upper ones, of four boxes and of the other four. A box that does not exist is
    /// beyond all rays.
    planes: [[Vec4; 2]; 6],
    /// A node, or [`LEAF`] and a leaf.
    children: [u32; WIDTH],
}

const EMPTY: Node = Node {
    planes: [
        [Vec4::splat(1e30); 2],
        [Vec4::splat(1e30); 2],
        [Vec4::splat(1e30); 2],
        [Vec4::splat(-1e30); 2],
        [Vec4::splat(-1e30); 2],
        [Vec4::splat(-1e30); 2],
    ],
    children: [LEAF; WIDTH],
};

/// Up to four faces.
#[derive(Debug, Clone, Copy)]
struct Leaf {
    /// Corners a, b, c, each by its coordinates.
    corners: [[Vec4; 3]; 3],
    /// At least the largest part of an edge.
    longest: f32,
    /// A bit for each face that there is.
    present: u32,
    ids: [FaceId; LEAF_WIDTH],
    /// Which vertices are the corners of each face.
    vertices: [[u32; 3]; LEAF_WIDTH],
}

const NO_FACES: Leaf = Leaf {
    corners: [[Vec4::ZERO; 3]; 3],
    longest: 0.0,
    present: 0,
    ids: [FaceId(u32::MAX); LEAF_WIDTH],
    vertices: [[0; 3]; LEAF_WIDTH],
};

/// A hierarchy of faces for rays.
#[derive(Debug)]
pub(super) struct WideTree {
    nodes: Vec<Node>,
    /// All are full but the last.
    leaves: Vec<Leaf>,
    frame: Frame,
}

/// How coordinates become those of the frame.
#[derive(Debug, Clone, Copy)]
struct Frame {
    middle: DVec3,
    /// A power of two.
    scale: f64,
}

impl Frame {
    /// Around the faces of a mesh that have an area.
    fn of(mesh: &Triangles) -> Self {
        let none = || (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let with = |(low, high): (DVec3, DVec3), face: &Triangle| {
            face.corners.iter().fold((low, high), |(low, high), corner| (low.min(*corner), high.max(*corner)))
        };
        let both = |a: (DVec3, DVec3), b: (DVec3, DVec3)| (a.0.min(b.0), a.1.max(b.1));
        let faces =
            (0..mesh.faces().len() as u32).into_par_iter().map(|face| Triangle::of(mesh, FaceId(face)));
        let faces = faces.filter(Triangle::has_area);
        let (low, high) = faces.fold(none, |bounds, face| with(bounds, &face)).reduce(none, both);
        if low.x > high.x {
            return Self { middle: DVec3::ZERO, scale: 1.0 };
        }
        let middle = 0.5 * low + 0.5 * high;
        let half = (high - middle).max(middle - low).max_element();
        // Below 2^1000, so that it is finite; a smaller mesh is smaller in the frame, too.
        Self { middle, scale: libm::scalbn(1.0, (-libm::frexp(half).1).min(1000)) }
    }

    /// A point in the frame.
    #[inline]
    fn of_point(&self, point: DVec3) -> DVec3 {
        (point - self.middle) * self.scale
    }
}

impl Leaf {
    /// A bit for each face that the ray does not certainly pass beside.
    #[inline]
    fn may_meet(&self, ray: &FrameRay) -> u32 {
        let [a, b, c] = &self.corners;
        let [origin, direction] = [ray.origin, ray.direction].map(|of| of.map(Vec4::splat));
        let minus = |a: &[Vec4; 3], b: &[Vec4; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let dot = |a: &[Vec4; 3], b: &[Vec4; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let across = |a: &[Vec4; 3]| {
            let d = &direction;
            [d[1] * a[2] - d[2] * a[1], d[2] * a[0] - d[0] * a[2], d[0] * a[1] - d[1] * a[0]]
        };
        let [of_a, of_b] = [across(&minus(a, &origin)), across(&minus(b, &origin))];
        let ab = dot(&minus(b, a), &of_a);
        let bc = dot(&minus(c, b), &of_b);
        let ca = dot(&minus(a, c), &of_a);
        let size = of_a[0].abs().max(of_a[1].abs()).max(of_a[2].abs());
        let [of_edge, of_size] = ray.reach;
        let per_size = 8.0 * U + 16.0 * U * self.longest;
        let rest = (2.0 * self.longest + of_size) * per_size + of_edge * self.longest;
        let bound = size * per_size + Vec4::splat(rest);
        let [least, most] = [ab.min(bc).min(ca), ab.max(bc).max(ca)];
        let beside: BVec4A = most.cmpgt(bound) & least.cmplt(-bound);
        !beside.bitmask() & self.present
    }
}

/// An f32 below `x`, by more than the error of an f64 of that size.
#[inline]
fn down(x: f64) -> f32 {
    (x as f32).next_down().next_down() - WIDENED
}

/// An f32 above `x`, by as much.
#[inline]
fn up(x: f64) -> f32 {
    (x as f32).next_up().next_up() + WIDENED
}

#[cfg(test)]
#[path = "../../../tests/unit/wide_tree.rs"]
mod tests;
