//! The build of the obvhs tree in bounded time for any input: small groups, joined by median splits.
//!
//! obvhs merges nearest neighbours along a space-filling curve (PLOC). Where boxes lie inside one another, each
//! box has the next smaller one for its nearest neighbour. Every pass then merges one pair, and the build is
//! quadratic: 143 s for 100,000 nested triangles. So the boxes are first split at the median along their longest
//! axis until at most [`MAX_GROUP_BOXES`] are left together; that takes n log n steps for any boxes. obvhs builds
//! each group, and the splits become the upper nodes. The worst case is then quadratic within a group only.

use std::time::Duration;

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::bvh2::node::Bvh2Node;
use rayon::prelude::*;

/// Maximum number of boxes that obvhs builds at once. Tuned: the worst group takes 15 ms, and traversal of
/// ordinary terrain is as fast as with one group.
const MAX_GROUP_BOXES: usize = 2048;

/// A range of boxes in the order array, and the index of the node that will hold them.
struct Group {
    node: usize,
    first: usize,
    count: usize,
}

/// Builds the tree.
pub(crate) fn build(boxes: &[Aabb]) -> Bvh2 {
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
    let mut nodes = vec![Bvh2Node::default()];
    if boxes.is_empty() {
        return Bvh2::default();
    }

    // Split until the groups are small. The children of an inner node are neighbours in `nodes`.
    let mut stack = vec![Group { node: 0, first: 0, count: boxes.len() }];
    let mut groups = Vec::new();
    while let Some(group) = stack.pop() {
        let Group { node, first, count } = group;
        if count <= MAX_GROUP_BOXES {
            groups.push(group);
            continue;
        }
        let range = &mut order[first..first + count];
        let middle = count / 2;
        split_at_median(boxes, range, middle);
        let children = nodes.len();
        nodes[node] = Bvh2Node::new(bounding_box(boxes, range), 0, children as u32);
        nodes.extend([Bvh2Node::default(); 2]);
        stack.push(Group { node: children, first, count: middle });
        stack.push(Group { node: children + 1, first: first + middle, count: count - middle });
    }

    // The preset `fast` measured best between build time and rays per second.
    let trees: Vec<Bvh2> = groups
        .par_iter()
        .map(|group| {
            let members: Vec<Aabb> = order[group.first..group.first + group.count]
                .iter()
                .map(|&index| boxes[index as usize])
                .collect();
            build_bvh2(&members, BvhBuildParams::fast_build(), &mut Duration::default())
        })
        .collect();

    // The root of a group's tree goes to the group's node; the tree's other nodes are appended.
    for (Group { node, first, count }, tree) in groups.into_iter().zip(trees) {
        let end = nodes.len() as u32;
        nodes[node] = rebased(tree.nodes[0], first as u32, end);
        nodes.extend(tree.nodes[1..].iter().map(|&of_group| rebased(of_group, first as u32, end)));
        let members = order[first..first + count].to_vec();
        for (entry, &member) in order[first..first + count].iter_mut().zip(&tree.primitive_indices) {
            *entry = members[member as usize];
        }
    }
    Bvh2 { nodes, primitive_indices: order, ..Bvh2::default() }
}

/// A node of a group's tree with the indices of the whole tree. The group's boxes begin at `first_box`, its nodes
/// other than the root at `first_node`.
fn rebased(mut node: Bvh2Node, first_box: u32, first_node: u32) -> Bvh2Node {
    node.first_index =
        if node.is_leaf() { node.first_index + first_box } else { node.first_index - 1 + first_node };
    node
}

/// Moves the `middle` boxes with the lowest centres to the front of `range`. The centres are compared along the
/// axis on which they spread most.
fn split_at_median(boxes: &[Aabb], range: &mut [u32], middle: usize) {
    // Twice the centre, which has the same order.
    let centre = |index: u32| boxes[index as usize].min + boxes[index as usize].max;
    let (low, high) = range
        .iter()
        .map(|&index| centre(index))
        .fold((Vec3A::splat(f32::INFINITY), Vec3A::splat(f32::NEG_INFINITY)), |(low, high), centre| {
            (low.min(centre), high.max(centre))
        });
    let axis = (high - low).max_position();
    // Equal centres are ordered by index, so the halves have the same sizes in any case.
    range
        .select_nth_unstable_by(middle, |&a, &b| centre(a)[axis].total_cmp(&centre(b)[axis]).then(a.cmp(&b)));
}

/// The union of the boxes in `range`.
fn bounding_box(boxes: &[Aabb], range: &[u32]) -> Aabb {
    range.iter().map(|&index| boxes[index as usize]).reduce(|a, b| a.union(&b)).unwrap_or(Aabb::INVALID)
}

#[cfg(test)]
#[path = "../tests/unit/grouped_build.rs"]
mod tests;
