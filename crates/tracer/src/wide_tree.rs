//! The tree with eight boxes a node, collapsed from obvhs's tree of two, and the walk of many rays at once.
//!
//! # Why no ray loses a box
//!
//! The rays of a [`Bundle`] start in one point and run the same way along their longest axis. For a single ray obvhs would
//! compute, along each axis, `(bound - origin) * inverse` in f32. Rounding is monotonic: a product with any inverse between
//! two others lies between the two products, as computed. So with the least and the greatest inverse of the rays, the bundle
//! enters a box no later, and leaves it no sooner, than each of its rays would by itself. The padding of `hierarchy` is
//! derived for that single ray. An axis along which the rays run both ways does not limit the bundle.

use glam::Vec3A;
use obvhs::bvh2::Bvh2;
use obvhs::ray::safe_inverse;

/// Boxes of a node.
const WIDTH: usize = 8;

/// Entries of a box that are a face's: above this many nodes nothing else of a tree would fit into memory.
const LEAF: u32 = 1 << 31;

/// Eight boxes, and what is in each.
#[derive(Debug, Clone, Copy)]
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

/// A tree of boxes; its leaves are ranges of entries in the order of obvhs's tree.
pub(crate) struct WideTree {
    nodes: Vec<Node>,
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
#[derive(Debug, Clone, Copy)]
pub(crate) struct Waiting {
    near: f32,
    child: u32,
    end: u32,
}

impl WideTree {
    /// Collapses `tree`; `first_entry[k]` is the first entry of the k-th box of its order.
    pub(crate) fn collapse(tree: &Bvh2, first_entry: &[u32]) -> Self {
        let mut nodes = Vec::new();
        let mut depth = 0;
        if let Some(root) = tree.nodes.first() {
            // A root that is a leaf becomes the only box of a node.
            let children = if root.is_leaf() { vec![0] } else { widened(tree, 0) };
            nodes.push(EMPTY);
            let mut to_fill = vec![(0_usize, children, 1)];
            while let Some((at, children, level)) = to_fill.pop() {
                depth = depth.max(level);
                for (lane, &child) in children.iter().enumerate() {
                    let from = &tree.nodes[child as usize];
                    let (min, max) = (from.aabb().min, from.aabb().max);
                    let bounds = [min.x, min.y, min.z, max.x, max.y, max.z];
                    for (axis, bound) in bounds.into_iter().enumerate() {
                        nodes[at].bounds[axis][lane] = bound;
                    }
                    if from.is_leaf() {
                        let first = from.first_index as usize;
                        nodes[at].child[lane] = LEAF | first_entry[first];
                        nodes[at].end[lane] = first_entry[first + from.prim_count as usize];
                    } else {
                        let next = nodes.len();
                        nodes[at].child[lane] = next as u32;
                        nodes.push(EMPTY);
                        to_fill.push((next, widened(tree, child), level + 1));
                    }
                }
            }
        }
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
            // The nearest on top of the stack.
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
}

/// The up to eight nodes below `node` that become one wide node: the largest is opened first.
fn widened(tree: &Bvh2, node: u32) -> Vec<u32> {
    let first = tree.nodes[node as usize].first_index;
    let mut children = vec![first, first + 1];
    while children.len() < WIDTH {
        let area = |child: u32| tree.nodes[child as usize].aabb().half_area();
        let inner = children.iter().enumerate().filter(|(_, child)| !tree.nodes[**child as usize].is_leaf());
        let largest = inner.max_by(|a, b| area(*a.1).total_cmp(&area(*b.1)));
        let Some((at, _)) = largest else { break };
        let first = tree.nodes[children[at] as usize].first_index;
        children[at] = first;
        children.push(first + 1);
    }
    children
}
