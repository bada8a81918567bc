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

use glam::{BVec4A, DVec3, Vec3, Vec4};
use rayon::prelude::*;
use raypencil_scene::{CastRay, FaceId};

use super::triangle::Triangle;

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
    /// A bit for each face that there is.
    present: u32,
    /// The faces as they are. They lie beside what is asked before, for a ray comes here from far away in memory.
    faces: [Triangle; WIDTH],
}

const NO_FACES: Leaf = Leaf {
    corners: [[Vec4::ZERO; 3]; 3],
    longest: 0.0,
    present: 0,
    faces: [Triangle { id: FaceId(u32::MAX), corners: [DVec3::ZERO; 3] }; WIDTH],
};

/// A hierarchy of faces for rays.
#[derive(Debug)]
pub(super) struct Quads {
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

impl Frame {
    fn of(faces: &[Triangle]) -> Self {
        let none = || (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let with = |(low, high): (DVec3, DVec3), face: &Triangle| {
            face.corners.iter().fold((low, high), |(low, high), corner| (low.min(*corner), high.max(*corner)))
        };
        let both = |a: (DVec3, DVec3), b: (DVec3, DVec3)| (a.0.min(b.0), a.1.max(b.1));
        let (low, high) = faces.par_iter().fold(none, with).reduce(none, both);
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

impl Quads {
    /// The hierarchy of faces, built on all threads. It does not depend on their number, nor on the order of the faces.
    pub(super) fn of(faces: &[Triangle]) -> Self {
        if faces.is_empty() {
            let frame = Frame { middle: DVec3::ZERO, scale: 1.0 };
            return Self { nodes: Vec::new(), leaves: Vec::new(), frame };
        }
        let frame = Frame::of(faces);
        let item = |(place, face): (usize, &Triangle)| Item::of(&frame, place as u32, face);
        let mut items: Vec<Item> = faces.par_iter().enumerate().map(item).collect();
        let quads = items.len().div_ceil(WIDTH);
        // A root has a node in any case.
        let mut nodes = vec![EMPTY; nodes_of(quads)[0].max(1)];
        let mut leaves = vec![NO_FACES; quads];
        let whole = Part { items: &mut items, nodes: &mut nodes, leaves: &mut leaves, node: 0, leaf: 0 };
        whole.fill(&frame, faces);
        Self { nodes, leaves, frame }
    }

    /// A ray in the frame; `None` if it is too far away for it.
    #[inline]
    pub(super) fn ray(&self, ray: &CastRay) -> Option<FrameRay> {
        let origin = self.frame.of_point(ray.origin);
        let size = origin.abs().max_element();
        let longest = ray.direction.abs().max_element();
        let per_t = longest * self.frame.scale;
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

    /// Shows each face that the ray may meet, nearer leaves first, until it is enough.
    #[inline]
    pub(super) fn walk(&self, ray: &FrameRay, mut visit: impl FnMut(&Triangle) -> Next) {
        if self.nodes.is_empty() {
            return;
        }
        let mut walk = Walk::new(*ray);
        while walk.step(self, &mut visit) {}
    }

    /// The same for several rays, which take steps in turns: while one waits for memory, others go on. `visit` gets the index of the
    /// ray, too; a ray that is `None` is left out.
    #[inline]
    pub(super) fn walk_together(
        &self,
        rays: &[Option<FrameRay>],
        mut visit: impl FnMut(usize, &Triangle) -> Next,
    ) {
        debug_assert!(rays.len() <= TOGETHER, "{} rays together", rays.len());
        if self.nodes.is_empty() {
            return;
        }
        let mut walks = [const { None }; TOGETHER];
        let (mut on_the_way, mut count) = ([0; TOGETHER], 0);
        for (index, ray) in rays.iter().enumerate() {
            if let Some(ray) = ray {
                walks[index] = Some(Walk::new(*ray));
                on_the_way[count] = index;
                count += 1;
            }
        }
        while count > 0 {
            let mut k = 0;
            while k < count {
                let index = on_the_way[k];
                let goes_on = walks[index].as_mut().is_some_and(|walk| {
                    let goes_on = walk.step(self, &mut |face: &Triangle| visit(index, face));
                    if goes_on {
                        walk.look_ahead(self);
                    }
                    goes_on
                });
                if goes_on {
                    k += 1;
                } else {
                    count -= 1;
                    on_the_way[k] = on_the_way[count];
                }
            }
        }
    }
}

/// Rays that walk together.
pub(super) const TOGETHER: usize = 8;

/// A ray on its way.
struct Walk {
    ray: FrameRay,
    far: f32,
    /// Which plane of each axis is entered.
    entered: [usize; 3],
    /// Where it goes next.
    next: u32,
    /// What waits, the nearest on top, and how many do.
    stack: [(f32, u32); STACK],
    waiting: usize,
    /// Something of where it goes next, which is on its way from memory.
    ahead: f32,
}

impl Walk {
    #[inline]
    fn new(ray: FrameRay) -> Self {
        let entered = [0, 1, 2].map(|axis: usize| if ray.is_down[axis] { axis + 3 } else { axis });
        Self { far: ray.far, ray, entered, next: 0, stack: [(0.0, 0); STACK], waiting: 0, ahead: 0.0 }
    }

    /// Enters the next node or leaf; says whether there is another.
    #[inline(always)]
    fn step(&mut self, quads: &Quads, visit: &mut impl FnMut(&Triangle) -> Next) -> bool {
        let Self { ray, far, entered, next, stack, waiting, .. } = self;
        if *next & LEAF == 0 {
            let node = &quads.nodes[*next as usize];
            let (mut enter, mut leave) = (Vec4::splat(ray.near), Vec4::splat(*far));
            for axis in 0..3 {
                let inverse = Vec4::splat(ray.inverse[axis]);
                let first = &node.planes[entered[axis]];
                let last = &node.planes[(entered[axis] + 3) % 6];
                enter = enter.max((*first - Vec4::splat(ray.origins[0][axis])) * inverse);
                leave = leave.min((*last - Vec4::splat(ray.origins[1][axis])) * inverse);
            }
            let mut lanes = enter.cmple(leave * GROWN).bitmask();
            let enter = enter.to_array();
            let bottom = *waiting;
            while lanes != 0 {
                let lane = lanes.trailing_zeros() as usize;
                lanes &= lanes - 1;
                // The nearest on top.
                let mut at = *waiting;
                while at > bottom && stack[at - 1].0 < enter[lane] {
                    stack[at] = stack[at - 1];
                    at -= 1;
                }
                stack[at] = (enter[lane], node.children[lane]);
                *waiting += 1;
            }
        } else {
            let leaf = &quads.leaves[(*next & !LEAF) as usize];
            let mut lanes = leaf.may_meet(ray);
            while lanes != 0 {
                let lane = lanes.trailing_zeros() as usize;
                lanes &= lanes - 1;
                match visit(&leaf.faces[lane]) {
                    Next::On => {}
                    Next::UpTo(t) => *far = quads.way(t, ray.per_t).min(*far),
                    Next::Stop => return false,
                }
            }
        }
        while *waiting > 0 {
            *waiting -= 1;
            let (enter, child) = stack[*waiting];
            if enter <= *far * GROWN {
                *next = child;
                return true;
            }
        }
        false
    }

    /// Asks memory for where it goes next, and does not wait for it.
    #[inline(always)]
    fn look_ahead(&mut self, quads: &Quads) {
        self.ahead = if self.next & LEAF == 0 {
            quads.nodes[self.next as usize].planes[0].x
        } else {
            quads.leaves[(self.next & !LEAF) as usize].corners[0][0].x
        };
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

/// A face as the build orders it.
#[derive(Debug, Clone, Copy)]
struct Item {
    /// Three times the middle, in the frame.
    middle: [f32; 3],
    /// Where it is among the faces.
    place: u32,
}

impl Item {
    fn of(frame: &Frame, place: u32, face: &Triangle) -> Self {
        let [a, b, c] = face.corners.map(|corner| frame.of_point(corner).as_vec3());
        Self { middle: (a + b + c).to_array(), place }
    }
}

/// Faces of which a part of the nodes and leaves is made, and the indices of the first of these.
struct Part<'p> {
    items: &'p mut [Item],
    nodes: &'p mut [Node],
    leaves: &'p mut [Leaf],
    node: u32,
    leaf: u32,
}

/// How many nodes the hierarchies of `leaves` leaves and of one more have: none for one leaf, which is a child.
fn nodes_of(leaves: usize) -> [usize; 2] {
    if leaves < 2 {
        return [0, usize::from(leaves == 1)];
    }
    // The quarters of both have a quarter of the leaves, rounded down, or one more.
    let least = leaves / 4;
    let below = nodes_of(least);
    [leaves, leaves + 1].map(|leaves| {
        let quarters = of_halves(leaves).into_iter().flat_map(of_halves);
        1 + quarters.map(|quarter| if quarter == 0 { 0 } else { below[quarter - least] }).sum::<usize>()
    })
}

/// How many leaves the halves of `leaves` have.
fn of_halves(leaves: usize) -> [usize; 2] {
    if leaves == 1 { [0, 1] } else { [leaves / 2, leaves - leaves / 2] }
}

/// A box in the frame.
type Bounds = [[f32; 3]; 2];

/// Faces of which one thread builds the hierarchy by itself.
const FACES_PER_PIECE: usize = 4096;

impl Part<'_> {
    /// Fills the first node, and all below it. Gives the box.
    fn fill(self, frame: &Frame, faces: &[Triangle]) -> Bounds {
        let Part { items, nodes, leaves, node: first, leaf } = self;
        let is_large = items.len() > FACES_PER_PIECE;
        let (node, nodes) = nodes.split_first_mut().expect("a node of a part");
        let below = Part { items, nodes, leaves, node: first + 1, leaf };
        let mut children = Vec::with_capacity(WIDTH);
        for half in below.split(|leaves| of_halves(leaves).into_iter().map(|half| nodes_of(half)[0]).sum()) {
            children.extend(half.split(|leaves| nodes_of(leaves)[0]));
        }
        let what: Vec<u32> = children
            .iter()
            .map(|part| if part.leaves.len() == 1 { LEAF | part.leaf } else { part.node })
            .collect();
        let fill = |part: Part<'_>| {
            if part.leaves.len() == 1 { part.fill_leaf(frame, faces) } else { part.fill(frame, faces) }
        };
        let boxes: Vec<Bounds> = if is_large {
            children.into_par_iter().map(fill).collect()
        } else {
            children.into_iter().map(fill).collect()
        };
        let mut all = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
        for (lane, ([low, high], child)) in boxes.iter().zip(what).enumerate() {
            for axis in 0..3 {
                node.planes[axis][lane] = low[axis];
                node.planes[axis + 3][lane] = high[axis];
                all[0][axis] = all[0][axis].min(low[axis]);
                all[1][axis] = all[1][axis].max(high[axis]);
            }
            node.children[lane] = child;
        }
        all
    }

    /// The halves along the longest side, of which the first has full leaves; or itself, if it is one leaf.
    /// `nodes` says how many nodes a half of so many leaves has.
    fn split(self, nodes: impl Fn(usize) -> usize) -> Vec<Self> {
        let quads = self.leaves.len();
        if quads == 1 {
            return vec![self];
        }
        let (of_first, middle) = (nodes(quads / 2), WIDTH * (quads / 2));
        let Part { items, nodes, leaves, node, leaf } = self;
        let mut bounds = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for item in &*items {
            let middle = Vec3::from_array(item.middle);
            bounds = (bounds.0.min(middle), bounds.1.max(middle));
        }
        let axis = (bounds.1 - bounds.0).max_position();
        items.select_nth_unstable_by(middle, |a, b| {
            a.middle[axis].total_cmp(&b.middle[axis]).then(a.place.cmp(&b.place))
        });
        let (items, other_items) = items.split_at_mut(middle);
        let (leaves, other_leaves) = leaves.split_at_mut(quads / 2);
        let (nodes, other_nodes) = nodes.split_at_mut(of_first);
        vec![
            Part { items, nodes, leaves, node, leaf },
            Part {
                items: other_items,
                nodes: other_nodes,
                leaves: other_leaves,
                node: node + of_first as u32,
                leaf: leaf + (quads / 2) as u32,
            },
        ]
    }

    /// Fills the only leaf. Gives the box.
    fn fill_leaf(self, frame: &Frame, faces: &[Triangle]) -> Bounds {
        let leaf = &mut self.leaves[0];
        let mut bounds = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        // What belongs together, whatever the order of the split.
        self.items.sort_unstable_by_key(|item| item.place);
        for (lane, item) in self.items.iter().enumerate() {
            let face = faces[item.place as usize];
            leaf.faces[lane] = face;
            let framed = face.corners.map(|corner| frame.of_point(corner));
            let corners = framed.map(|corner| corner.as_vec3());
            for k in 0..3 {
                bounds = (bounds.0.min(framed[k]), bounds.1.max(framed[k]));
                for axis in 0..3 {
                    leaf.corners[k][axis][lane] = corners[k][axis];
                }
                // The very difference that walks form.
                let edge = corners[(k + 1) % 3] - corners[k];
                leaf.longest = leaf.longest.max(edge.abs().max_element());
            }
            leaf.present |= 1 << lane;
        }
        [bounds.0.to_array().map(down), bounds.1.to_array().map(up)]
    }
}

#[cfg(test)]
#[path = "../../tests/unit/quads.rs"]
mod tests;
