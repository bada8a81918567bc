//! The tree with eight boxes a node, collapsed from obvhs's trees of two, and the walk of many rays at once.
//!
//! # Why no ray loses a box
//!
//! The rays of a [`Bundle`] start in one point and run the same way along their longest axis. For a single ray obvhs would
//! compute, along each axis, `(bound - origin) * inverse` in f32. Rounding is monotonic: a product with any inverse between
//! two others lies between the two products, as computed. So with the least and the greatest inverse of the rays, the bundle
//! enters a box no later, and leaves it no sooner, than each of its rays would by itself. The padding of `hierarchy` is
//! derived for that single ray. An axis along which the rays run both ways does not limit the bundle.

use bytemuck::Zeroable;
use glam::{Vec3A, Vec4};
use obvhs::aabb::Aabb;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::ray::{Ray, safe_inverse};
use rayon::prelude::*;

use crate::grouped_build::Forest;

mod steps;

pub(crate) use steps::{At, Steps};

/// Boxes of a node.
const WIDTH: usize = 8;

/// Entries of a box that are a face's: above this many nodes nothing else of a tree would fit into memory.
const LEAF: u32 = 1 << 31;

/// Eight boxes, and what is in each.
#[derive(Debug, Clone, Copy, Zeroable)]
#[repr(C, align(64))]
struct Node {
    /// Lower bounds along x, y, z, then upper bounds. A box that does not exist has a lower bound above its upper.
    bounds: [[f32; WIDTH]; 6],
    /// A node; or [`LEAF`] and the first entry of a leaf.
    child: [u32; WIDTH],
    /// End of the entries of a leaf.
    end: [u32; WIDTH],
}

const EMPTY: Node = Node {
    bounds: [
        [f32::MAX; WIDTH],
        [f32::MAX; WIDTH],
        [f32::MAX; WIDTH],
        [f32::MIN; WIDTH],
        [f32::MIN; WIDTH],
        [f32::MIN; WIDTH],
    ],
    child: [LEAF; WIDTH],
    end: [0; WIDTH],
};

/// Which bounds of a node are entered along each axis; those three farther on are left.
#[inline(always)]
fn entered(inverse: &[f32; 3]) -> [usize; 3] {
    [0, 1, 2].map(|axis: usize| if inverse[axis] > 0.0 { axis } else { axis + 3 })
}

impl Node {
    /// Where a ray enters and leaves each box.
    #[inline(always)]
    fn passed(
        &self,
        origin: &[f32; 3],
        inverse: &[f32; 3],
        entered: &[usize; 3],
        far: f32,
    ) -> ([Vec4; 2], [Vec4; 2]) {
        let mut enter = [Vec4::ZERO; 2];
        let mut leave = [Vec4::splat(far); 2];
        for axis in 0..3 {
            let (first, last) = (&self.bounds[entered[axis]], &self.bounds[(entered[axis] + 3) % 6]);
            let [origin, inverse] = [origin[axis], inverse[axis]].map(Vec4::splat);
            for half in 0..2 {
                let of = |bounds: &[f32; WIDTH]| (Vec4::from_slice(&bounds[4 * half..]) - origin) * inverse;
                enter[half] = enter[half].max(of(first));
                leave[half] = leave[half].min(of(last));
            }
        }
        (enter, leave)
    }
}

/// The numbers of two halves.
#[inline(always)]
fn joined([lower, upper]: [Vec4; 2]) -> [f32; WIDTH] {
    let mut all = [0.0; WIDTH];
    lower.write_to_slice(&mut all[..4]);
    upper.write_to_slice(&mut all[4..]);
    all
}

/// A tree of boxes; its leaves are ranges of the forest's faces.
pub(crate) struct WideTree {
    nodes: Box<[Node]>,
    /// Entries that can wait on a walk's stack.
    stack_size: usize,
}

impl std::fmt::Debug for WideTree {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { nodes, stack_size } = self;
        f.debug_struct("WideTree").field("nodes", &nodes.len()).field("stack_size", stack_size).finish()
    }
}

/// Rays from one point, as the boxes are asked for them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bundle {
    pub(crate) origin: [f32; 3],
    /// Least and greatest inverse of the rays' unit directions along each axis; `None` where they run both ways.
    pub(crate) inverse: [Option<[f32; 2]>; 3],
    /// Length of the longest ray.
    pub(crate) far: f32,
}

impl Bundle {
    /// Rays from `origin` whose unit directions have components from `least` to `greatest`.
    pub(crate) fn new(origin: Vec3A, least: Vec3A, greatest: Vec3A, far: f32) -> Self {
        let inverse = |k: usize| {
            // A component of 0 counts as one along the axis for a single ray; here it does not limit the bundle.
            (least[k] > 0.0 || greatest[k] < 0.0).then(|| [safe_inverse(greatest[k]), safe_inverse(least[k])])
        };
        Self { origin: origin.to_array(), inverse: [0, 1, 2].map(inverse), far }
    }
}

/// Who looks at the leaves of a walk. A trait and not a closure: a closure would not be compiled for the wide lanes of
/// its caller.
pub(crate) trait Visitor {
    /// Looks at the entries of a leaf. May shorten the bundle, which is `far` long.
    fn leaf(&mut self, entries: std::ops::Range<usize>, far: &mut f32) -> Next;
}

/// What the entries of a leaf make of a walk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Next {
    On,
    Stop,
}

/// A node that waits, or a leaf, and where the bundle enters it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Waiting {
    near: f32,
    child: u32,
    end: u32,
}

impl WideTree {
    /// Collapses the trees of `forest`, each group by itself. The faces of group k begin at `first_faces[k]`; they are the entries.
    pub(crate) fn collapse(forest: &Forest, first_faces: &[u32]) -> Self {
        Self::collapse_to(forest, |group, leaf| {
            let face = first_faces[group] + leaf.first_index;
            [face, face + leaf.prim_count]
        })
    }

    /// The same where `entries` gives the first entry of a leaf of a group, and the end.
    pub(crate) fn collapse_to(
        forest: &Forest,
        entries: impl Fn(usize, &Bvh2Node) -> [u32; 2] + Sync,
    ) -> Self {
        if forest.upper.is_empty() {
            return Self { nodes: Box::default(), stack_size: 0 };
        }
        let upper = Plan::of(&forest.upper);
        let plans: Vec<Plan> = forest.groups.par_iter().map(|group| Plan::of(&group.nodes)).collect();
        let depth = upper.depth + plans.iter().map(|plan| plan.depth).max().unwrap_or(0);
        let count = upper.nodes.len() + plans.iter().map(|plan| plan.nodes.len()).sum::<usize>();
        // Each group fills its own part of the nodes, on any thread.
        let mut nodes: Box<[Node]> = bytemuck::zeroed_slice_box(count);
        let (of_upper, mut rest) = nodes.split_at_mut(upper.nodes.len());
        let mut end = of_upper.len() as u32;
        let mut parts = Vec::with_capacity(plans.len());
        for (plan, group) in plans.iter().zip(&forest.groups) {
            let (part, others) = rest.split_at_mut(plan.nodes.len());
            parts.push((part, plan, group, end));
            end += plan.nodes.len() as u32;
            rest = others;
        }
        let roots: Vec<u32> = parts.iter().map(|(_, _, _, first)| *first).collect();
        upper.fill(of_upper, &forest.upper, 0, |leaf| [roots[leaf.first_index as usize], 0]);
        parts.into_par_iter().enumerate().for_each(|(k, (part, plan, group, first))| {
            plan.fill(part, &group.nodes, first, |leaf| {
                let [first, end] = entries(k, leaf);
                [LEAF | first, end]
            });
        });
        Self { nodes, stack_size: depth * WIDTH + 1 }
    }

    #[cfg(test)]
    pub(crate) fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// A stack for walks.
    pub(crate) fn stack(&self) -> Vec<Waiting> {
        Vec::with_capacity(self.stack_size)
    }

    /// Shows the leaves that any ray of the bundle may meet, nearer boxes first, until it is enough.
    #[inline(always)]
    pub(crate) fn walk(&self, stack: &mut Vec<Waiting>, bundle: &mut Bundle, visitor: &mut impl Visitor) {
        if self.nodes.is_empty() {
            return;
        }
        let origin = bundle.origin;
        stack.clear();
        stack.push(Waiting { near: 0.0, child: 0, end: 0 });
        while let Some(Waiting { near, child, end }) = stack.pop() {
            if near > bundle.far {
                continue;
            }
            if child & LEAF != 0 {
                if visitor.leaf((child & !LEAF) as usize..end as usize, &mut bundle.far) == Next::Stop {
                    return;
                }
                continue;
            }
            let node = &self.nodes[child as usize];
            let mut enter = [0.0_f32; WIDTH];
            let mut leave = [bundle.far; WIDTH];
            for axis in 0..3 {
                let Some([least, greatest]) = bundle.inverse[axis] else { continue };
                let (first, last) = if least > 0.0 { (axis, axis + 3) } else { (axis + 3, axis) };
                let (first, last) = (&node.bounds[first], &node.bounds[last]);
                for lane in 0..WIDTH {
                    let to_first = first[lane] - origin[axis];
                    let to_last = last[lane] - origin[axis];
                    let (a, b) = (to_first * least, to_first * greatest);
                    let nearest = if a < b { a } else { b };
                    let (a, b) = (to_last * least, to_last * greatest);
                    let farthest = if a > b { a } else { b };
                    enter[lane] = if nearest > enter[lane] { nearest } else { enter[lane] };
                    leave[lane] = if farthest < leave[lane] { farthest } else { leave[lane] };
                }
            }
            Self::wait(node, &enter, &leave, stack);
        }
    }

    /// The same for a single ray, as obvhs would walk: a direction's small component counts as one that is not, so that the ray
    /// is limited along each axis.
    #[inline(always)]
    pub(crate) fn walk_ray(&self, stack: &mut Vec<Waiting>, ray: &Ray, visitor: &mut impl Visitor) {
        if self.nodes.is_empty() {
            return;
        }
        let (origin, inverse, mut far) = (ray.origin.to_array(), ray.inv_direction.to_array(), ray.tmax);
        let entered = entered(&inverse);
        stack.clear();
        stack.push(Waiting { near: 0.0, child: 0, end: 0 });
        while let Some(Waiting { near, child, end }) = stack.pop() {
            if near > far {
                continue;
            }
            if child & LEAF != 0 {
                if visitor.leaf((child & !LEAF) as usize..end as usize, &mut far) == Next::Stop {
                    return;
                }
                continue;
            }
            let node = &self.nodes[child as usize];
            let (enter, leave) = node.passed(&origin, &inverse, &entered, far);
            Self::wait(node, &joined(enter), &joined(leave), stack);
        }
    }

    /// Lets the boxes of a node wait that are entered before they are left, the nearest on top of the stack.
    #[inline(always)]
    fn wait(node: &Node, enter: &[f32; WIDTH], leave: &[f32; WIDTH], stack: &mut Vec<Waiting>) {
        let bottom = stack.len();
        for lane in 0..WIDTH {
            if enter[lane] <= leave[lane] {
                let waiting = Waiting { near: enter[lane], child: node.child[lane], end: node.end[lane] };
                stack.push(waiting);
                let mut at = stack.len() - 1;
                while at > bottom && stack[at - 1].near < waiting.near {
                    stack[at] = stack[at - 1];
                    at -= 1;
                }
                stack[at] = waiting;
            }
        }
    }
}

/// No node.
const NONE: u32 = u32::MAX;

/// Which nodes of a tree of two are the boxes of each wide node. Below the boxes that are not leaves, the next wide nodes
/// follow in their order.
struct Plan {
    nodes: Vec<[u32; WIDTH]>,
    depth: usize,
}

impl Plan {
    /// The first node is the root. A root that is a leaf becomes the only box of a wide node.
    fn of(tree: &[Bvh2Node]) -> Self {
        let root =
            if tree[0].is_leaf() { [0, NONE, NONE, NONE, NONE, NONE, NONE, NONE] } else { widened(tree, 0) };
        let mut nodes = vec![root];
        let (mut at, mut depth) = (0, 0);
        while at < nodes.len() {
            // All wide nodes of one depth.
            depth += 1;
            let end = nodes.len();
            while at < end {
                for child in nodes[at] {
                    if child != NONE && !tree[child as usize].is_leaf() {
                        nodes.push(widened(tree, child));
                    }
                }
                at += 1;
            }
        }
        Self { nodes, depth }
    }

    /// Writes the nodes, of which the first has the index `first`. `leaf` gives what is in the box of a leaf.
    fn fill(&self, nodes: &mut [Node], tree: &[Bvh2Node], first: u32, leaf: impl Fn(&Bvh2Node) -> [u32; 2]) {
        let mut next = first;
        for (node, children) in nodes.iter_mut().zip(&self.nodes) {
            let mut filled = EMPTY;
            for (lane, &child) in children.iter().enumerate().filter(|(_, child)| **child != NONE) {
                let from = &tree[child as usize];
                let Aabb { min, max } = from.aabb();
                for (axis, bound) in [min.x, min.y, min.z, max.x, max.y, max.z].into_iter().enumerate() {
                    filled.bounds[axis][lane] = bound;
                }
                [filled.child[lane], filled.end[lane]] = if from.is_leaf() {
                    leaf(from)
                } else {
                    next += 1;
                    [next, 0]
                };
            }
            *node = filled;
        }
    }
}

/// The up to eight nodes below `node` that become one wide node: the largest is opened first.
fn widened(tree: &[Bvh2Node], node: u32) -> [u32; WIDTH] {
    let first = tree[node as usize].first_index;
    let area = |child: u32| {
        let child = &tree[child as usize];
        if child.is_leaf() { -1.0 } else { child.aabb().half_area() }
    };
    let (mut children, mut areas) = ([NONE; WIDTH], [-1.0; WIDTH]);
    let put = |children: &mut [u32; WIDTH], areas: &mut [f32; WIDTH], lane: usize, child: u32| {
        (children[lane], areas[lane]) = (child, area(child));
    };
    put(&mut children, &mut areas, 0, first);
    put(&mut children, &mut areas, 1, first + 1);
    for count in 2..WIDTH {
        let largest =
            (0..count).fold(0, |largest, lane| if areas[lane] > areas[largest] { lane } else { largest });
        if areas[largest] < 0.0 {
            break;
        }
        let first = tree[children[largest] as usize].first_index;
        put(&mut children, &mut areas, largest, first);
        put(&mut children, &mut areas, count, first + 1);
    }
    children
}

#[cfg(test)]
#[path = "../tests/unit/wide_tree.rs"]
mod tests;
