//! The way to the faces that a ray may meet: boxes four a node, and the faces of a leaf four at once, both in f32.
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
//! [`UNDERFLOW`].

use glam::{BVec4A, DVec3, Vec4};
use raypencil_scene::CastRay;

use super::triangle::Triangle;
use crate::bvh::{Bvh, NodeContent};

/// Boxes of a node, and faces of a leaf.
const WIDTH: usize = 4;

/// u.
const U: f32 = 1.0 / (1 << 24) as f32;

/// 1 + 16 u.
const GROWN: f32 = 1.0 + 16.0 * U;

/// 2^-60.
const WIDENED: f32 = 1.0 / (1_u64 << 60) as f32;

/// 2^-100.
const LEAST_PART: f64 = 1.0 / (1_u128 << 100) as f64;

/// 2^-100, too.
const UNDERFLOW: f32 = 1.0 / (1_u128 << 100) as f32;

/// The largest part of an origin, in the frame. Of rays from farther away little would be certain in f32.
const MAX_ORIGIN: f64 = (1 << 16) as f64;

/// A child that is a leaf.
const LEAF: u32 = 1 << 31;

/// Entries that can wait. Halves of equal number make a tree of at most 30 nodes one below the other, every second one of
/// which leaves 3 that wait.
const STACK: usize = 48;

/// Four boxes, and what is in each.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
struct Node {
    /// Lower planes across x, y, z, then the upper ones. A box that does not exist is beyond all rays.
    planes: [Vec4; 6],
    /// A node, or [`LEAF`] and a leaf.
    children: [u32; WIDTH],
}

const EMPTY: Node = Node {
    planes: [
        Vec4::splat(1e30),
        Vec4::splat(1e30),
        Vec4::splat(1e30),
        Vec4::splat(-1e30),
        Vec4::splat(-1e30),
        Vec4::splat(-1e30),
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
    /// The first face of the hierarchy.
    first: u32,
    /// A bit for each face that there is.
    present: u32,
}

/// A hierarchy of faces for rays.
#[derive(Debug)]
pub(super) struct Quads {
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    middle: DVec3,
    /// A power of two.
    scale: f64,
}

/// A ray in the frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct FrameRay {
    origin: [f32; 3],
    direction: [f32; 3],
    /// With which origin the entered plane of each axis is asked, and with which the left one.
    origins: [[f32; 3]; 2],
    inverse: [f32; 3],
    /// Whether the upper plane of an axis is entered.
    is_down: [bool; 3],
    /// 48 u A and 32 u A.
    reach: [f32; 2],
    near: f32,
    far: f32,
    /// tau per t.
    per_t: f64,
}

/// What a face makes of a walk.
pub(super) enum Next {
    On,
    /// Nothing beyond this t matters.
    UpTo(f64),
    Stop,
}

impl Quads {
    /// The same hierarchy as `bvh`, with every second floor.
    pub(super) fn of(bvh: &Bvh<Triangle>) -> Self {
        let mut quads = Self { nodes: Vec::new(), leaves: Vec::new(), middle: DVec3::ZERO, scale: 1.0 };
        if bvh.is_empty() {
            return quads;
        }
        let [low, high] = bvh.bounds(0);
        quads.middle = 0.5 * low + 0.5 * high;
        let half = (high - quads.middle).max(quads.middle - low).max_element();
        // Below 2^1000, so that it is finite; a smaller mesh is smaller in the frame, too.
        quads.scale = libm::scalbn(1.0, (-libm::frexp(half).1).min(1000));
        quads.nodes.push(EMPTY);
        let mut to_fill = vec![(0, 0)];
        while let Some((at, node)) = to_fill.pop() {
            for (lane, child) in inside(bvh, node).enumerate() {
                let what = match bvh.content(child) {
                    NodeContent::Faces(_) => quads.add_leaf(bvh, child),
                    NodeContent::Children(_) => {
                        let index = quads.nodes.len() as u32;
                        quads.nodes.push(EMPTY);
                        to_fill.push((index as usize, child));
                        index
                    }
                };
                let [low, high] = bvh.bounds(child).map(|corner| quads.framed(corner));
                let into = &mut quads.nodes[at];
                for axis in 0..3 {
                    into.planes[axis][lane] = down(low[axis]);
                    into.planes[axis + 3][lane] = up(high[axis]);
                }
                into.children[lane] = what;
            }
        }
        quads.nodes.shrink_to_fit();
        quads.leaves.shrink_to_fit();
        quads
    }

    /// A point in the frame.
    fn framed(&self, point: DVec3) -> DVec3 {
        (point - self.middle) * self.scale
    }

    /// Adds the faces of a node; gives it as a child.
    fn add_leaf(&mut self, bvh: &Bvh<Triangle>, node: u32) -> u32 {
        let faces = bvh.faces_below(node);
        let mut leaf =
            Leaf { corners: Default::default(), longest: 0.0, first: bvh.first_face(node), present: 0 };
        for (lane, face) in faces.iter().enumerate() {
            let corners = face.corners.map(|corner| self.framed(corner).as_vec3());
            for k in 0..3 {
                for axis in 0..3 {
                    leaf.corners[k][axis][lane] = corners[k][axis];
                }
                // The very difference that walks form.
                let edge = corners[(k + 1) % 3] - corners[k];
                leaf.longest = leaf.longest.max(edge.abs().max_element());
            }
            leaf.present |= 1 << lane;
        }
        self.leaves.push(leaf);
        LEAF | (self.leaves.len() as u32 - 1)
    }

    /// A ray in the frame; `None` if it is too far away for it.
    #[inline]
    pub(super) fn ray(&self, ray: &CastRay) -> Option<FrameRay> {
        let origin = self.framed(ray.origin);
        let size = origin.abs().max_element();
        let longest = ray.direction.abs().max_element();
        let per_t = longest * self.scale;
        // !(a <= b) also holds for NaN.
        if !(size <= MAX_ORIGIN) || !(1e-250..1e250).contains(&per_t) || longest < 1e-250 {
            return None;
        }
        let direction = ray.direction / longest;
        let inverse = direction.to_array().map(|part| {
            let part = if part.abs() < LEAST_PART { LEAST_PART.copysign(part) } else { part };
            (1.0 / part) as f32
        });
        let is_down = inverse.map(|inverse| inverse < 0.0);
        let [lower, upper] = [origin.to_array().map(down), origin.to_array().map(up)];
        let either = |down: &[f32; 3], up: &[f32; 3]| {
            [0, 1, 2].map(|k: usize| if is_down[k] { down[k] } else { up[k] })
        };
        let reach = size as f32 + 1.001;
        Some(FrameRay {
            origin: origin.as_vec3().to_array(),
            direction: direction.as_vec3().to_array(),
            origins: [either(&lower, &upper), either(&upper, &lower)],
            inverse,
            is_down,
            reach: [48.0 * U * reach, 32.0 * U * reach],
            near: (ray.t_min * per_t) as f32 * (1.0 - 16.0 * U),
            far: self.way(ray.t_max, per_t),
            per_t,
        })
    }

    /// At least the way to what is met at `t`.
    #[inline]
    fn way(&self, t: f64, per_t: f64) -> f32 {
        (t * per_t) as f32 * GROWN + WIDENED
    }

    /// Shows the index of each face that the ray may meet, nearer leaves first, until it is enough.
    #[inline]
    pub(super) fn walk(&self, ray: &FrameRay, mut visit: impl FnMut(u32) -> Next) {
        if self.nodes.is_empty() {
            return;
        }
        let mut far = ray.far;
        let entered = [0, 1, 2].map(|axis: usize| if ray.is_down[axis] { axis + 3 } else { axis });
        let mut stack = [(0.0_f32, 0_u32); STACK];
        let mut waiting = 0;
        let mut next = 0;
        loop {
            if next & LEAF == 0 {
                let node = &self.nodes[next as usize];
                let (mut enter, mut leave) = (Vec4::splat(ray.near), Vec4::splat(far));
                for axis in 0..3 {
                    let inverse = Vec4::splat(ray.inverse[axis]);
                    let first = &node.planes[entered[axis]];
                    let last = &node.planes[(entered[axis] + 3) % 6];
                    enter = enter.max((*first - Vec4::splat(ray.origins[0][axis])) * inverse);
                    leave = leave.min((*last - Vec4::splat(ray.origins[1][axis])) * inverse);
                }
                let mut lanes = enter.cmple(leave * GROWN).bitmask();
                let enter = enter.to_array();
                let bottom = waiting;
                while lanes != 0 {
                    let lane = lanes.trailing_zeros() as usize;
                    lanes &= lanes - 1;
                    // The nearest on top.
                    let mut at = waiting;
                    while at > bottom && stack[at - 1].0 < enter[lane] {
                        stack[at] = stack[at - 1];
                        at -= 1;
                    }
                    stack[at] = (enter[lane], node.children[lane]);
                    waiting += 1;
                }
            } else {
                let leaf = &self.leaves[(next & !LEAF) as usize];
                let mut lanes = leaf.may_meet(ray);
                while lanes != 0 {
                    let lane = lanes.trailing_zeros();
                    lanes &= lanes - 1;
                    match visit(leaf.first + lane) {
                        Next::On => {}
                        Next::UpTo(t) => far = self.way(t, ray.per_t).min(far),
                        Next::Stop => return,
                    }
                }
            }
            next = loop {
                if waiting == 0 {
                    return;
                }
                waiting -= 1;
                let (enter, child) = stack[waiting];
                if enter <= far * GROWN {
                    break child;
                }
            };
        }
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
        let rest = (2.0 * self.longest + of_size) * per_size + of_edge * self.longest + UNDERFLOW;
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

/// The up to four nodes in a node: its children's children, or a child that is a leaf. A root that is a leaf is in itself.
fn inside(bvh: &Bvh<Triangle>, node: u32) -> impl Iterator<Item = u32> {
    let children = move |node: u32| match bvh.content(node) {
        NodeContent::Children([first, _]) => first..first + 2,
        NodeContent::Faces(_) => node..node + 1,
    };
    children(node).flat_map(children)
}

#[cfg(test)]
#[path = "../../tests/unit/quads.rs"]
mod tests;
