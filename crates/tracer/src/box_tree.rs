//! Faces in the order of the leaves of an obvhs `Bvh2`.

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use rayon::prelude::*;

use crate::grouped_build;
use crate::wide_tree::WideTree;

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

impl<F: Send> BoxTree<F> {
    /// Builds the tree of `count` faces. `box_of` gives the box of a face; faces without one are left out. `face` makes
    /// the face itself.
    pub(crate) fn build(
        count: usize,
        box_of: impl Fn(u32) -> Option<Aabb> + Sync,
        face: impl Fn(u32) -> F + Sync,
    ) -> Self {
        let boxes = (0..count as u32).into_par_iter().map(|index| box_of(index).unwrap_or(Aabb::INVALID));
        // Faces with identical boxes share one leaf entry: many identical boxes would make the build quadratic.
        let Distinct { boxes, faces, first_face } = Distinct::of(boxes.collect());
        let tree = grouped_build::build(&boxes);
        // The fixed stacks of obvhs overflow silently, so the traversals bring one that fits the tree's depth.
        let stack_size = max_depth(&tree) + 1;

        // Lay the faces out in the order of the leaves; faces of one box stay in their order.
        let of_box = |&index: &u32| first_face[index as usize]..first_face[index as usize + 1];
        let mut first = Vec::with_capacity(first_face.len());
        first.push(0);
        first.extend(tree.primitive_indices.iter().map(of_box).scan(0, |end, range| {
            *end += range.len() as u32;
            Some(*end)
        }));
        let members = tree.primitive_indices.iter().flat_map(of_box);
        let order: Vec<u32> = members.map(|member| faces[member as usize]).collect();
        let faces = order.par_iter().map(|&index| face(index)).collect();
        Self { tree, faces, first_face: first, stack_size }
    }
}

/// Places of the table that are tried for a box. In a table that is half full hardly any box needs a dozen. A repetition
/// that is not found has an entry of its own, so that no choice of boxes makes the search slow.
const MAX_PLACES_TRIED: usize = 64;

/// The boxes of some faces without repetitions, in the order of their first faces.
struct Distinct {
    boxes: Vec<Aabb>,
    /// The faces of the k-th box, in their order, are `faces[first_face[k]..first_face[k + 1]]`.
    faces: Vec<u32>,
    first_face: Vec<u32>,
}

impl Distinct {
    /// `boxes` of the faces 0, 1 ... Invalid ones are left out.
    fn of(boxes: Vec<Aabb>) -> Self {
        let is_valid = |bounds: &Aabb| bounds.min.x <= bounds.max.x;
        // The face with the same box that comes first, for each.
        const FREE: u32 = u32::MAX;
        let places = (2 * boxes.len()).next_power_of_two();
        let start = |bounds: &Aabb| (hash(bounds) >> 32) as u32 & (places as u32 - 1);
        let starts: Vec<u32> = boxes.par_iter().map(start).collect();
        let mut table = vec![FREE; places];
        let mut leaders: Vec<u32> = Vec::with_capacity(boxes.len());
        let mut all_differ = true;
        for (face, (bounds, start)) in boxes.iter().zip(starts).enumerate() {
            let mut leader = face as u32;
            let tried = (0..MAX_PLACES_TRIED).map(|step| (start as usize + step) & (places - 1));
            for place in tried {
                let other = table[place];
                if other == FREE {
                    table[place] = leader;
                    break;
                }
                if bits(&boxes[other as usize]) == bits(bounds) {
                    leader = other;
                    break;
                }
            }
            all_differ &= leader == face as u32 && is_valid(bounds);
            leaders.push(leader);
        }
        let count = boxes.len() as u32;
        if all_differ {
            return Self { boxes, faces: leaders, first_face: (0..=count).collect() };
        }
        let kept: Vec<u32> = (0..count).filter(|&face| is_valid(&boxes[face as usize])).collect();
        let mut faces = kept;
        // The sort is stable: faces of one box stay in their order.
        faces.sort_by_key(|&face| leaders[face as usize]);
        let is_first =
            |&at: &usize| at == 0 || leaders[faces[at] as usize] != leaders[faces[at - 1] as usize];
        let mut first_face: Vec<u32> = (0..faces.len()).filter(is_first).map(|at| at as u32).collect();
        let boxes = first_face.iter().map(|&at| boxes[faces[at as usize] as usize]).collect();
        first_face.push(faces.len() as u32);
        Self { boxes, faces, first_face }
    }
}

fn bits(bounds: &Aabb) -> [u32; 6] {
    let Aabb { min, max } = bounds;
    [min.x, min.y, min.z, max.x, max.y, max.z].map(f32::to_bits)
}

/// A hash of a box's bits, by the finaliser of SplitMix64 (Steele, Lea, Flood 2014).
fn hash(bounds: &Aabb) -> u64 {
    let [a, b, c, d, e, f] = bits(bounds).map(u64::from);
    let mixed = |z: u64| {
        let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    mixed(mixed(mixed(a << 32 | b) ^ (c << 32 | d)) ^ (e << 32 | f))
}

impl<F> BoxTree<F> {
    /// The same with eight boxes a node, and the faces in the order of its entries.
    pub(crate) fn into_wide(self) -> (WideTree, Vec<F>) {
        (WideTree::collapse(&self.tree, &self.first_face), self.faces)
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

#[cfg(test)]
#[path = "../tests/unit/box_tree.rs"]
mod tests;
