//! Faces in the order of the leaves of an obvhs `Bvh2`.

use std::collections::HashMap;

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;

use crate::grouped_build;

/// Faces in a tree of boxes that their owner has drawn around them, as wide as its rays need.
pub(crate) struct BoxTree<F> {
    tree: Bvh2,
    /// Faces in the order of the tree's leaves.
    faces: Vec<F>,
    /// `first_face[k]..first_face[k + 1]` are the faces of the k-th box in the tree's order.
    first_face: Vec<u32>,
    stack_size: usize,
}

impl<F> std::fmt::Debug for BoxTree<F> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { tree, faces, stack_size, .. } = self;
        f.debug_struct("BoxTree")
            .field("nodes", &tree.nodes.len())
            .field("faces", &faces.len())
            .field("stack_size", stack_size)
            .finish()
    }
}

impl<F> BoxTree<F> {
    /// Builds the tree of some faces with their boxes.
    pub(crate) fn build(faces: impl Iterator<Item = (Aabb, F)>) -> Self {
        // Faces with identical boxes share one leaf entry: many identical boxes would make the build quadratic.
        let mut boxes: Vec<Aabb> = Vec::with_capacity(faces.size_hint().1.unwrap_or(0));
        let mut box_by_bounds: HashMap<[u32; 6], u32> = HashMap::with_capacity(boxes.capacity());
        let mut faces_with_box: Vec<(u32, F)> = Vec::with_capacity(boxes.capacity());
        for (bounds, face) in faces {
            let bits = [bounds.min.x, bounds.min.y, bounds.min.z, bounds.max.x, bounds.max.y, bounds.max.z]
                .map(f32::to_bits);
            let box_index = *box_by_bounds.entry(bits).or_insert_with(|| {
                boxes.push(bounds);
                boxes.len() as u32 - 1
            });
            faces_with_box.push((box_index, face));
        }
        drop(box_by_bounds);

        let tree = grouped_build::build(&boxes);
        // The fixed stacks of obvhs overflow silently, so the traversals bring one that fits the tree's depth.
        let stack_size = max_depth(&tree) + 1;

        // Lay the faces out in the order of the leaves.
        let mut rank_of_box = vec![0u32; boxes.len()];
        for (rank, &box_index) in tree.primitive_indices.iter().enumerate() {
            rank_of_box[box_index as usize] = rank as u32;
        }
        // The sort is stable: faces of one box stay in their order.
        faces_with_box.sort_by_key(|&(box_index, _)| rank_of_box[box_index as usize]);
        let mut first_face = vec![0u32; boxes.len() + 1];
        for (box_index, _) in &faces_with_box {
            first_face[rank_of_box[*box_index as usize] as usize + 1] += 1;
        }
        for rank in 0..boxes.len() {
            first_face[rank + 1] += first_face[rank];
        }
        let faces = faces_with_box.into_iter().map(|(_, face)| face).collect();
        Self { tree, faces, first_face, stack_size }
    }

    /// The tree of boxes.
    pub(crate) fn tree(&self) -> &Bvh2 {
        &self.tree
    }

    /// The faces of `count` boxes in the tree's order, from box `first` on.
    #[inline]
    pub(crate) fn leaf_faces(&self, first: u32, count: u32) -> &[F] {
        let start = self.first_face[first as usize] as usize;
        let end = self.first_face[(first + count) as usize] as usize;
        &self.faces[start..end]
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
