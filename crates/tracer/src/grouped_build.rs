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

/// A box by its index, with twice its centre, which has the order of the centre.
#[derive(Debug, Clone, Copy)]
struct Member {
    centre: [f32; 3],
    index: u32,
}

impl Member {
    fn of(boxes: &[Aabb], index: u32) -> Self {
        let Aabb { min, max } = boxes[index as usize];
        Self { centre: (min + max).to_array(), index }
    }
}

/// Part of the tree: its own nodes, the root first, and its boxes in the order of its leaves.
struct Part {
    nodes: Vec<Bvh2Node>,
    order: Vec<u32>,
}

/// Builds the tree.
pub(crate) fn build(boxes: &[Aabb]) -> Bvh2 {
    if boxes.is_empty() {
        return Bvh2::default();
    }
    let mut members: Vec<Member> =
        (0..boxes.len() as u32).into_par_iter().map(|index| Member::of(boxes, index)).collect();
    let Part { nodes, order } = build_part(boxes, &mut members);
    Bvh2 { nodes, primitive_indices: order, ..Bvh2::default() }
}

/// Splits until the groups are small, the halves on two threads if there are. The result does not depend on that.
fn build_part(boxes: &[Aabb], members: &mut [Member]) -> Part {
    if members.len() <= MAX_GROUP_BOXES {
        return build_group(boxes, members);
    }
    let middle = members.len() / 2;
    split_at_median(members, middle);
    let (lower, upper) = members.split_at_mut(middle);
    let (lower, upper) = rayon::join(|| build_part(boxes, lower), || build_part(boxes, upper));
    // Children are neighbours: both roots first, then the other nodes of the lower half, then those of the upper.
    let (of_lower, of_upper) = (lower.nodes.len() as u32, upper.nodes.len() as u32);
    let first_box = lower.order.len() as u32;
    let mut nodes = Vec::with_capacity(1 + (of_lower + of_upper) as usize);
    let around = lower.nodes[0].aabb().union(upper.nodes[0].aabb());
    nodes.push(Bvh2Node::new(around, 0, 1));
    nodes.push(rebased(lower.nodes[0], 0, 3));
    nodes.push(rebased(upper.nodes[0], first_box, 2 + of_lower));
    nodes.extend(lower.nodes[1..].iter().map(|&node| rebased(node, 0, 3)));
    nodes.extend(upper.nodes[1..].iter().map(|&node| rebased(node, first_box, 2 + of_lower)));
    let mut order = lower.order;
    order.extend(upper.order);
    Part { nodes, order }
}

/// The tree of a small group, by obvhs alone.
fn build_group(boxes: &[Aabb], members: &[Member]) -> Part {
    let of_members: Vec<Aabb> = members.iter().map(|member| boxes[member.index as usize]).collect();
    // The preset `fast` measured best between build time and rays per second.
    let tree = build_bvh2(&of_members, BvhBuildParams::fast_build(), &mut Duration::default());
    let order = tree.primitive_indices.iter().map(|&member| members[member as usize].index).collect();
    Part { nodes: tree.nodes, order }
}

/// A node of a group's tree with the indices of the whole tree. The group's boxes begin at `first_box`, its nodes
/// other than the root at `first_node`.
fn rebased(mut node: Bvh2Node, first_box: u32, first_node: u32) -> Bvh2Node {
    node.first_index =
        if node.is_leaf() { node.first_index + first_box } else { node.first_index - 1 + first_node };
    node
}

/// Moves the `middle` boxes with the lowest centres to the front. The centres are compared along the axis on which they
/// spread most.
fn split_at_median(members: &mut [Member], middle: usize) {
    let centres = members.iter().map(|member| Vec3A::from_array(member.centre));
    let (low, high) = centres
        .fold((Vec3A::splat(f32::INFINITY), Vec3A::splat(f32::NEG_INFINITY)), |(low, high), centre| {
            (low.min(centre), high.max(centre))
        });
    let axis = (high - low).max_position();
    // Equal centres are ordered by index, so the halves have the same sizes in any case.
    members.select_nth_unstable_by(middle, |a, b| {
        a.centre[axis].total_cmp(&b.centre[axis]).then(a.index.cmp(&b.index))
    });
}

#[cfg(test)]
#[path = "../tests/unit/grouped_build.rs"]
mod tests;
