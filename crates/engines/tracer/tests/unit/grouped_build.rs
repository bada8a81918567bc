//! Unit tests of `grouped_build`.

use obvhs::bvh2::Bvh2;

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

fn built(boxes: &[Aabb]) -> Forest {
    Forest::build(boxes.len(), |face| Some(boxes[face as usize]))
}

/// The faces below a node. Asserts that the node's own box contains those of each. `faces` gives those of a leaf.
fn below(
    nodes: &[Bvh2Node],
    index: usize,
    boxes: &[Aabb],
    faces: &impl Fn(Range<usize>) -> Vec<u32>,
) -> Vec<u32> {
    let node = &nodes[index];
    let first = node.first_index as usize;
    let members = if node.is_leaf() {
        faces(first..first + node.prim_count as usize)
    } else {
        [below(nodes, first, boxes, faces), below(nodes, first + 1, boxes, faces)].concat()
    };
    assert!(members.iter().all(|&face| contains(node.aabb(), &boxes[face as usize])), "node {index}");
    members
}

/// The faces below a node of the upper tree, down to the leaves of the groups.
fn below_upper(forest: &Forest, index: usize, boxes: &[Aabb]) -> Vec<u32> {
    below(&forest.upper, index, boxes, &|groups| {
        assert_eq!(groups.len(), 1);
        let group = &forest.groups[groups.start];
        below(&group.nodes, 0, boxes, &|faces| group.faces[faces].to_vec())
    })
}

#[test]
fn every_box_is_in_one_leaf_and_inside_all_nodes_above_it() {
    for count in [1, 2, 3, 2047, 2048, 2049, 4097, 9001] {
        let boxes = scattered(count);
        let forest = built(&boxes);
        let mut members = below_upper(&forest, 0, &boxes);
        let (faces, first_faces) = forest.faces();
        for (group, &first) in forest.groups.iter().zip(&first_faces) {
            assert_eq!(faces[first as usize..][..group.faces.len()], group.faces);
        }
        assert_eq!((faces.len(), first_faces.len()), (members.len(), forest.groups.len()));
        members.sort_unstable();
        assert!(members.into_iter().eq(0..count), "{count}");
    }
    let none = built(&[]);
    assert!(none.upper.is_empty() && none.groups.is_empty());
    let none = Forest::build(3, |_| None);
    assert!(none.upper.is_empty() && none.groups.is_empty() && none.faces().0.is_empty());
}

#[test]
fn few_faces_below_a_node_become_a_leaf() {
    for count in [1, 4, 5, 2049, 9001] {
        let boxes = scattered(count);
        let forest = built(&boxes).with_leaves_of(4);
        let mut members = below_upper(&forest, 0, &boxes);
        members.sort_unstable();
        assert!(members.into_iter().eq(0..count), "{count}");
        for group in &forest.groups {
            let leaves = group.leaves();
            let box_of = |at: u32| boxes[group.faces[at as usize] as usize];
            let are_equal = |leaf: &Range<u32>| leaf.clone().all(|at| box_of(at) == box_of(leaf.start));
            // obvhs has leaves of up to eight boxes.
            assert!(leaves.iter().all(|leaf| (1..=8).contains(&leaf.len()) || are_equal(leaf)));
            assert_eq!(leaves.iter().map(|leaf| leaf.len()).sum::<usize>(), group.faces.len());
            // No two leaves that would fit one leave their parent a node.
            let below = |node: &Bvh2Node| [0, 1].map(|k| group.nodes[(node.first_index + k) as usize]);
            let inner = group.nodes.iter().filter(|node| !node.is_leaf());
            let is_full =
                |[a, b]: [Bvh2Node; 2]| !(a.is_leaf() && b.is_leaf()) || a.prim_count + b.prim_count > 4;
            assert!(inner.map(below).all(is_full));
        }
    }
}

#[test]
fn boxes_are_split_by_their_centres_along_the_axis_of_largest_spread() {
    let boxes = |along: [[f32; 2]; 2], across: [[f32; 2]; 2]| {
        let corner = |k: usize, end: usize| Vec3A::new(along[k][end], across[k][end], 0.0);
        [0, 1].map(|k| Aabb::new(corner(k, 0), corner(k, 1)))
    };
    let split = |boxes: &[Aabb]| {
        let mut members = [0, 1].map(|face| Member::of(boxes, face));
        split_at_median(&mut members, 1);
        members.map(|member| member.face)
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
    let forest = built(&boxes);
    assert!(!forest.upper[0].is_leaf());
    let child = forest.upper[0].first_index as usize;
    let [lower, upper] = [child, child + 1].map(|node| below_upper(&forest, node, &boxes));
    assert_eq!((lower.len(), upper.len()), (4500, 4501));
    let y = |of: &u32| boxes[*of as usize].min.y;
    let highest = lower.iter().map(y).fold(f32::NEG_INFINITY, f32::max);
    assert!(upper.iter().map(y).all(|y| y >= highest));
    // Boxes that fit one group are built by obvhs alone.
    let few = scattered(MAX_GROUP_BOXES as u32);
    let alone = build_bvh2(&few, BvhBuildParams::fast_build(), &mut Duration::default());
    let forest = built(&few);
    assert_eq!((forest.upper.len(), forest.groups.len()), (1, 1));
    let links = |nodes: &[Bvh2Node]| -> Vec<[u32; 2]> {
        nodes
            .iter()
            .map(|node| [node.prim_count, if node.is_leaf() { 0 } else { node.first_index }])
            .collect()
    };
    assert_eq!(links(&forest.groups[0].nodes), links(&alone.nodes));
    let leaves = |tree: &Bvh2| tree.nodes.iter().filter(|node| node.is_leaf()).copied().collect::<Vec<_>>();
    let faces =
        |leaf: &Bvh2Node| &alone.primitive_indices[leaf.first_index as usize..][..leaf.prim_count as usize];
    assert_eq!(forest.groups[0].faces, leaves(&alone).iter().map(faces).collect::<Vec<_>>().concat());
}

#[test]
fn equal_boxes_fill_a_leaf_and_not_a_tree() {
    // Every group has one box only, however many faces have it.
    let boxes = vec![scattered(1)[0]; 5000];
    let forest = built(&boxes);
    assert!(forest.groups.len() > 2 && forest.groups.iter().all(|group| group.nodes.len() == 1));
    let mut members = below_upper(&forest, 0, &boxes);
    members.sort_unstable();
    assert!(members.into_iter().eq(0..5000));
}

#[test]
fn the_tree_is_the_same_on_any_number_of_threads() {
    let boxes = scattered(20_000);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let forest = pool.install(|| built(&boxes));
        let groups = forest.groups.iter().map(|group| &group.nodes);
        let nodes = std::iter::once(&forest.upper).chain(groups);
        let nodes: Vec<_> = nodes
            .map(|nodes| {
                let parts = nodes.iter().map(|node| (node.first_index, node.prim_count, *node.aabb()));
                parts.collect::<Vec<_>>()
            })
            .collect();
        (nodes, forest.faces())
    };
    let alone = on(1);
    assert!(alone.0.len() > 8);
    assert_eq!(on(2), alone);
    assert_eq!(on(8), alone);
}
