//! Unit tests of `box_tree`.

use glam::Vec3A;

use super::*;

fn cube(x: f32) -> Aabb {
    Aabb::new(Vec3A::splat(x), Vec3A::splat(x + 1.0))
}

#[test]
fn every_face_is_once_in_a_leaf_beside_those_of_its_box() {
    let x = |index: u32| if index.is_multiple_of(5) { 0.0 } else { (index * 37 % 1024) as f32 };
    let box_of = |index: u32| (!index.is_multiple_of(11)).then(|| cube(x(index)));
    // One group, and several.
    for count in [300, 9000] {
        let tree = BoxTree::build(count, box_of, |index| index);
        let mut all = Vec::new();
        for node in tree.tree().nodes.iter().filter(|node| node.is_leaf()) {
            for &face in tree.leaf_faces(node.first_index, node.prim_count) {
                let bounds = box_of(face).unwrap();
                assert!(node.aabb().contains_point(bounds.min) && node.aabb().contains_point(bounds.max));
                all.push(face);
            }
        }
        all.sort_unstable();
        assert!(all.into_iter().eq((0..count as u32).filter(|index| !index.is_multiple_of(11))), "{count}");
        assert_eq!(tree.faces().len(), count - count.div_ceil(11));
    }
}

#[test]
fn groups_of_one_box_are_leaves_with_faces_of_their_own() {
    // Three groups and more, each of them a single leaf.
    let tree = BoxTree::build(6000, |_| Some(cube(1.0)), |index| index);
    let leaves = tree.tree().nodes.iter().filter(|node| node.is_leaf());
    let mut all: Vec<u32> =
        leaves.flat_map(|leaf| tree.leaf_faces(leaf.first_index, leaf.prim_count)).copied().collect();
    assert_eq!(all.len(), 6000);
    all.sort_unstable();
    assert!(all.into_iter().eq(0..6000));
}
