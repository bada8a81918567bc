//! Faces in the order of the leaves of an obvhs `Bvh2`.

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;
use rayon::prelude::*;

use crate::grouped_build::Forest;

/// Faces in a tree of boxes that their owner has drawn around them, as wide as its rays need.
pub(crate) struct BoxTree<F> {
    tree: Bvh2,
    /// Faces in the order of the tree's leaves, which are ranges of them.
    faces: Vec<F>,
    stack_size: usize,
}

impl<F> std::fmt::Debug for BoxTree<F> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { tree, faces, stack_size } = self;
        f.debug_struct("BoxTree")
            .field("nodes", &tree.nodes.len())
            .field("faces", &faces.len())
            .field("stack_size", stack_size)
            .finish()
    }
}

impl<F: Send> BoxTree<F> {
    /// Builds the tree of `count` faces. `box_of` gives the box of a face; faces without one are left out. `face` makes
    /// the face itself.
    pub(crate) fn build(
        count: usize,
        box_of: impl Fn(u32) -> Option<Aabb> + Sync,
        face: impl Fn(u32) -> F + Sync,
    ) -> Self {
        let forest = Forest::build(count, box_of);
        let (order, first_faces) = forest.faces();
        let tree = joined(&forest, &first_faces);
        // The fixed stacks of obvhs overflow silently, so the traversals bring one that fits the tree's depth.
        let stack_size = max_depth(&tree) + 1;
        Self { tree, faces: order.par_iter().map(|&index| face(index)).collect(), stack_size }
    }
}

/// One tree of all groups. The faces of group k begin at `first_faces[k]`.
fn joined(forest: &Forest, first_faces: &[u32]) -> Bvh2 {
    let mut nodes = forest.upper.clone();
    for at in 0..forest.upper.len() {
        if !nodes[at].is_leaf() {
            continue;
        }
        // The root takes the place of the leaf; the group's other nodes follow at the end.
        let index = nodes[at].first_index as usize;
        let (group, by_faces, by_nodes) =
            (&forest.groups[index].nodes, first_faces[index], nodes.len() as u32 - 1);
        nodes[at] = moved(group[0], by_faces, by_nodes);
        nodes.extend(group[1..].iter().map(|&node| moved(node, by_faces, by_nodes)));
    }
    Bvh2 { nodes, ..Bvh2::default() }
}

/// A node of a group with the indices of the whole.
fn moved(mut node: Bvh2Node, by_faces: u32, by_nodes: u32) -> Bvh2Node {
    node.first_index += if node.is_leaf() { by_faces } else { by_nodes };
    node
}

impl<F> BoxTree<F> {
    /// The tree of boxes.
    pub(crate) fn tree(&self) -> &Bvh2 {
        &self.tree
    }

    /// The `count` faces of a leaf, from the `first` on.
    #[inline]
    pub(crate) fn leaf_faces(&self, first: u32, count: u32) -> &[F] {
        &self.faces[first as usize..(first + count) as usize]
    }

    /// All faces.
    pub(crate) fn faces(&self) -> &[F] {
        &self.faces
    }

    /// The number of entries that a traversal stack must hold.
    pub(crate) fn stack_size(&self) -> usize {
        self.stack_size
    }
}

/// The largest number of inner nodes between the root and a leaf. As many entries can wait on the stack.
pub(crate) fn max_depth(tree: &Bvh2) -> usize {
    let mut max_depth = 0;
    let mut stack: Vec<(u32, usize)> = tree.nodes.first().map(|_| (0, 0)).into_iter().collect();
    while let Some((index, depth)) = stack.pop() {
        let node = &tree.nodes[index as usize];
        max_depth = max_depth.max(depth);
        if !node.is_leaf() {
            stack.push((node.first_index, depth + 1));
            stack.push((node.first_index + 1, depth + 1));
        }
    }
    max_depth
}

#[cfg(test)]
#[path = "../tests/unit/box_tree.rs"]
mod tests;
