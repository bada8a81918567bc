//! Unit tests of `box_tree`.

use glam::Vec3A;

use super::*;

fn cube(x: f32) -> Aabb {
    Aabb::new(Vec3A::splat(x), Vec3A::splat(x + 1.0))
}

/// The faces of each box, in the order of the boxes.
fn faces_of(distinct: &Distinct) -> Vec<&[u32]> {
    let ends = distinct.first_face.windows(2);
    ends.map(|ends| &distinct.faces[ends[0] as usize..ends[1] as usize]).collect()
}

#[test]
fn faces_with_one_box_share_it_and_faces_without_are_left_out() {
    let boxes = [cube(3.0), cube(1.0), Aabb::INVALID, cube(3.0), cube(2.0), cube(1.0), cube(3.0)];
    let distinct = Distinct::of(boxes.to_vec());
    assert_eq!(distinct.boxes, [cube(3.0), cube(1.0), cube(2.0)]);
    assert_eq!(faces_of(&distinct), [&[0, 3, 6][..], &[1, 5], &[4]]);
    // -0 is not 0 here: two entries more are no mistake.
    assert_eq!(Distinct::of(vec![cube(0.0), cube(-0.0)]).boxes.len(), 2);
    let differ = Distinct::of((0..1000).map(|k| cube(k as f32)).collect());
    assert_eq!((differ.boxes.len(), differ.faces.len()), (1000, 1000));
    assert_eq!(faces_of(&differ)[999], [999]);
    let one_out = Distinct::of(vec![cube(3.0), Aabb::INVALID, cube(1.0)]);
    assert_eq!(faces_of(&one_out), [[0], [2]]);
    for empty in [vec![], vec![Aabb::INVALID], vec![Aabb::INVALID; 3]] {
        let none = Distinct::of(empty);
        assert_eq!((none.boxes.len(), none.faces.len(), none.first_face), (0, 0, vec![0]));
    }
}

#[test]
fn a_table_of_a_few_boxes_keeps_thousands_of_repetitions_together() {
    let boxes = (0..50_000).map(|k| cube((k % 7) as f32)).collect();
    let distinct = Distinct::of(boxes);
    assert_eq!(distinct.boxes.len(), 7);
    assert!(faces_of(&distinct).iter().all(|faces| faces.is_sorted() && faces.len() >= 7142));
}

#[test]
fn every_face_is_once_in_a_leaf_beside_those_of_its_box() {
    let x = |index: u32| if index.is_multiple_of(5) { 0.0 } else { (index * 37 % 1024) as f32 };
    let box_of = |index: u32| (!index.is_multiple_of(11)).then(|| cube(x(index)));
    let tree = BoxTree::build(3000, box_of, |index| index);
    let mut all = tree.faces().to_vec();
    all.sort_unstable();
    assert!(all.into_iter().eq((0..3000_u32).filter(|index| !index.is_multiple_of(11))));
    for node in tree.tree().nodes.iter().filter(|node| node.is_leaf()) {
        for &face in tree.leaf_faces(node.first_index, node.prim_count) {
            let bounds = box_of(face).unwrap();
            assert!(node.aabb().contains_point(bounds.min) && node.aabb().contains_point(bounds.max));
        }
    }
}
