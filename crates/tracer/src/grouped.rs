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
mod tests {
    use super::*;

    /// Unit boxes scattered over 1 x 8 x 2 km (multiples of odd numbers modulo a power of two).
    fn scattered(count: u32) -> Vec<Aabb> {
        let at = |k: u32, step: u32| (k.wrapping_mul(step) % 8192) as f32;
        let corner = |k: u32| Vec3A::new(at(k, 5003) / 8.0, at(k, 3571), at(k, 7919) / 4.0);
        (0..count).map(|k| Aabb::new(corner(k), corner(k) + 1.0)).collect()
    }

    fn holds(outer: &Aabb, inner: &Aabb) -> bool {
        outer.contains_point(inner.min) && outer.contains_point(inner.max)
    }

    /// The boxes below a node, each of which its own box must hold.
    fn below(tree: &Bvh2, index: usize, boxes: &[Aabb]) -> Vec<u32> {
        let node = &tree.nodes[index];
        let first = node.first_index as usize;
        let found = if node.is_leaf() {
            tree.primitive_indices[first..first + node.prim_count as usize].to_vec()
        } else {
            [below(tree, first, boxes), below(tree, first + 1, boxes)].concat()
        };
        assert!(found.iter().all(|&of| holds(node.aabb(), &boxes[of as usize])), "node {index}");
        found
    }

    #[test]
    fn every_box_is_found_once_inside_of_all_that_lead_to_it() {
        for count in [1, 2, 3, 2047, 2048, 2049, 4097, 9001] {
            let boxes = scattered(count);
            let tree = build(&boxes);
            let mut found = below(&tree, 0, &boxes);
            found.sort_unstable();
            assert!(found.into_iter().eq(0..count), "{count}");
        }
        assert!(build(&[]).nodes.is_empty());
    }

    #[test]
    fn boxes_are_halved_by_their_centres_along_the_axis_on_which_those_spread_most() {
        let boxes = |along: [[f32; 2]; 2], across: [[f32; 2]; 2]| {
            let corner = |k: usize, end: usize| Vec3A::new(along[k][end], across[k][end], 0.0);
            [0, 1].map(|k| Aabb::new(corner(k, 0), corner(k, 1)))
        };
        let halved = |boxes: &[Aabb]| {
            let mut order = [0, 1];
            halve(boxes, &mut order, 1);
            order
        };
        // Centres 2, -3 along x and 1, 1.5 along y, farther from 0 but nearer each other.
        assert_eq!(halved(&boxes([[1.0, 3.0], [-4.0, -2.0]], [[0.5, 1.5], [1.0, 2.0]])), [1, 0]);
        // Centres -6, 4 and 100, 101: y has the larger sum and the larger quotient.
        assert_eq!(halved(&boxes([[3.0, 5.0], [-7.0, -5.0]], [[99.0, 101.0], [100.0, 102.0]])), [1, 0]);
        // Centres -2.5, 1.5: the products of the ends, 6 and 2, are the other way round.
        assert_eq!(halved(&boxes([[1.0, 2.0], [-3.0, -2.0]], [[0.0, 0.0]; 2])), [1, 0]);
    }

    #[test]
    fn what_is_too_much_for_one_group_is_halved_along_its_longest_axis() {
        let boxes = scattered(9001);
        let tree = build(&boxes);
        assert!(!tree.nodes[0].is_leaf());
        let child = tree.nodes[0].first_index as usize;
        let [lower, upper] = [child, child + 1].map(|node| below(&tree, node, &boxes));
        assert_eq!((lower.len(), upper.len()), (4500, 4501));
        let y = |of: &u32| boxes[*of as usize].min.y;
        let highest = lower.iter().map(y).fold(f32::NEG_INFINITY, f32::max);
        assert!(upper.iter().map(y).all(|y| y >= highest));
        // What fits one group is left to obvhs.
        let (few, whole) = (scattered(GROUP as u32), build(&scattered(GROUP as u32)));
        let mut time = Duration::default();
        let alone = build_bvh2(&few, BvhBuildParams::fast_build(), &mut time);
        assert_eq!(whole.primitive_indices, alone.primitive_indices);
        let ways = |tree: &Bvh2| -> Vec<u32> { tree.nodes.iter().map(|node| node.first_index).collect() };
        assert_eq!(ways(&whole), ways(&alone));
    }
}
