//! Unit tests of `grouped_build`.

use super::*;

/// Boxes of 1 m scattered over 1 x 8 x 2 km: multiples of odd numbers modulo a power of two.
fn scattered(count: u32) -> Vec<Aabb> {
    let at = |k: u32, step: u32| (k.wrapping_mul(step) % 8192) as f32;
    let corner = |k: u32| Vec3A::new(at(k, 5003) / 8.0, at(k, 3571), at(k, 7919) / 4.0);
    (0..count).map(|k| Aabb::new(corner(k), corner(k) + 1.0)).collect()
}

fn contains(outer: &Aabb, inner: &Aabb) -> bool {
    outer.contains_point(inner.min) && outer.contains_point(inner.max)
}

/// The boxes below a node. Asserts that the node's own box contains each of them.
fn below(tree: &Bvh2, index: usize, boxes: &[Aabb]) -> Vec<u32> {
    let node = &tree.nodes[index];
    let first = node.first_index as usize;
    let members = if node.is_leaf() {
        tree.primitive_indices[first..first + node.prim_count as usize].to_vec()
    } else {
        [below(tree, first, boxes), below(tree, first + 1, boxes)].concat()
    };
    assert!(members.iter().all(|&index| contains(node.aabb(), &boxes[index as usize])), "node {index}");
    members
}

#[test]
fn every_box_is_in_one_leaf_and_inside_all_nodes_above_it() {
    for count in [1, 2, 3, 2047, 2048, 2049, 4097, 9001] {
        let boxes = scattered(count);
        let tree = build(&boxes);
        let mut members = below(&tree, 0, &boxes);
        members.sort_unstable();
        assert!(members.into_iter().eq(0..count), "{count}");
    }
    assert!(build(&[]).nodes.is_empty());
}

#[test]
fn boxes_are_split_by_their_centres_along_the_axis_of_largest_spread() {
    let boxes = |along: [[f32; 2]; 2], across: [[f32; 2]; 2]| {
        let corner = |k: usize, end: usize| Vec3A::new(along[k][end], across[k][end], 0.0);
        [0, 1].map(|k| Aabb::new(corner(k, 0), corner(k, 1)))
    };
    let split = |boxes: &[Aabb]| {
        let mut members = [0, 1].map(|index| Member::of(boxes, index));
        split_at_median(&mut members, 1);
        members.map(|member| member.index)
    };
    // Centres 2, -3 along x and 1, 1.5 along y, farther from 0 but nearer each other.
    assert_eq!(split(&boxes([[1.0, 3.0], [-4.0, -2.0]], [[0.5, 1.5], [1.0, 2.0]])), [1, 0]);
    // Centres -6, 4 and 100, 101: y has the larger sum and the larger quotient.
    assert_eq!(split(&boxes([[3.0, 5.0], [-7.0, -5.0]], [[99.0, 101.0], [100.0, 102.0]])), [1, 0]);
    // Centres -2.5, 1.5: the products of the ends, 6 and 2, are the other way round.
    assert_eq!(split(&boxes([[1.0, 2.0], [-3.0, -2.0]], [[0.0, 0.0]; 2])), [1, 0]);
}

#[test]
fn boxes_beyond_one_group_are_split_along_the_longest_axis() {
    let boxes = scattered(9001);
    let tree = build(&boxes);
    assert!(!tree.nodes[0].is_leaf());
    let child = tree.nodes[0].first_index as usize;
    let [lower, upper] = [child, child + 1].map(|node| below(&tree, node, &boxes));
    assert_eq!((lower.len(), upper.len()), (4500, 4501));
    let y = |of: &u32| boxes[*of as usize].min.y;
    let highest = lower.iter().map(y).fold(f32::NEG_INFINITY, f32::max);
    assert!(upper.iter().map(y).all(|y| y >= highest));
    // Boxes that fit one group are built by obvhs alone.
    let (few, built) = (scattered(MAX_GROUP_BOXES as u32), build(&scattered(MAX_GROUP_BOXES as u32)));
    let mut time = Duration::default();
    let alone = build_bvh2(&few, BvhBuildParams::fast_build(), &mut time);
    assert_eq!(built.primitive_indices, alone.primitive_indices);
    let links = |tree: &Bvh2| -> Vec<u32> { tree.nodes.iter().map(|node| node.first_index).collect() };
    assert_eq!(links(&built), links(&alone));
}

#[test]
fn the_tree_is_the_same_on_any_number_of_threads() {
    let boxes = scattered(20_000);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let tree = pool.install(|| build(&boxes));
        let nodes: Vec<_> =
            tree.nodes.iter().map(|node| (node.first_index, node.prim_count, *node.aabb())).collect();
        (nodes, tree.primitive_indices)
    };
    let alone = on(1);
    assert_eq!(alone.0.len(), 2 * alone.1.len() - 1 - repeated_leaves(&alone.0));
    assert_eq!(on(2), alone);
    assert_eq!(on(8), alone);
}

/// How many boxes share a leaf with another, each costing two nodes less.
fn repeated_leaves(nodes: &[(u32, u32, Aabb)]) -> usize {
    nodes.iter().filter(|node| node.1 > 1).map(|node| 2 * (node.1 as usize - 1)).sum()
}
