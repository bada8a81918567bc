//! Unit tests of `grouped`.

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
