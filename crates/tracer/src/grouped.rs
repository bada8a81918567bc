//! An obvhs tree whose building time is bounded for any input: built in groups, joined by median splits.
//!
//! obvhs merges nearest neighbours along a space-filling curve (PLOC). Where boxes lie inside one another, each
//! has the next smaller one for its nearest neighbour, every pass merges one pair, and the build is quadratic:
//! 143 s for 100,000 nested triangles. So boxes are first halved along their longest axis until no more than
//! [`GROUP`] are left together, which takes n log n whatever they are; obvhs builds each group, and the halves
//! become the upper nodes. The bad case is then quadratic within a group only.

use std::time::Duration;

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::bvh2::node::Bvh2Node;
use rayon::prelude::*;

/// The most boxes that obvhs builds at once. Tuned: the worst group takes 15 ms, and ordinary terrain is walked
/// as fast as with one group.
const GROUP: usize = 2048;

/// Some boxes, as a range of the order, and the node that will stand for them.
struct Part {
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

    // Halve until the groups are small; an inner node's children lie side by side.
    let mut waiting = vec![Part { node: 0, first: 0, count: boxes.len() }];
    let mut groups = Vec::new();
    while let Some(part) = waiting.pop() {
        let Part { node, first, count } = part;
        if count <= GROUP {
            groups.push(part);
            continue;
        }
        let range = &mut order[first..first + count];
        let middle = count / 2;
        halve(boxes, range, middle);
        let children = nodes.len();
        nodes[node] = Bvh2Node::new(around(boxes, range), 0, children as u32);
        nodes.extend([Bvh2Node::default(); 2]);
        waiting.push(Part { node: children, first, count: middle });
        waiting.push(Part { node: children + 1, first: first + middle, count: count - middle });
    }

    // `fast` is the sweet spot measured between build time and rays per second.
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

    // A group's root takes its place among the upper nodes; its other nodes follow at the end.
    for (Part { node, first, count }, tree) in groups.into_iter().zip(trees) {
        let end = nodes.len() as u32;
        nodes[node] = placed(tree.nodes[0], first as u32, end);
        nodes.extend(tree.nodes[1..].iter().map(|&of_group| placed(of_group, first as u32, end)));
        let members = order[first..first + count].to_vec();
        for (place, &member) in order[first..first + count].iter_mut().zip(&tree.primitive_indices) {
            *place = members[member as usize];
        }
    }
    Bvh2 { nodes, primitive_indices: order, ..Bvh2::default() }
}

/// A node of a group, whose boxes begin at `first` and whose nodes but for the root at `end`.
fn placed(mut node: Bvh2Node, first: u32, end: u32) -> Bvh2Node {
    node.first_index = if node.is_leaf() { node.first_index + first } else { node.first_index - 1 + end };
    node
}

/// Brings the lower half of some boxes, by their centres along the longest axis, before the upper half.
fn halve(boxes: &[Aabb], range: &mut [u32], middle: usize) {
    // Twice the centre orders as the centre does.
    let centre = |index: u32| boxes[index as usize].min + boxes[index as usize].max;
    let (low, high) = range
        .iter()
        .map(|&index| centre(index))
        .fold((Vec3A::splat(f32::INFINITY), Vec3A::splat(f32::NEG_INFINITY)), |(low, high), centre| {
            (low.min(centre), high.max(centre))
        });
    let axis = (high - low).max_position();
    // By the index where centres are equal: halves of equal number in any case.
    range
        .select_nth_unstable_by(middle, |&a, &b| centre(a)[axis].total_cmp(&centre(b)[axis]).then(a.cmp(&b)));
}

/// The box around some boxes.
fn around(boxes: &[Aabb], range: &[u32]) -> Aabb {
    range.iter().map(|&index| boxes[index as usize]).reduce(|a, b| a.union(&b)).unwrap_or(Aabb::INVALID)
}

#[cfg(test)]
#[path = "../tests/unit/grouped.rs"]
mod tests;
