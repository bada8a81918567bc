//! Unit tests of `distinct`.

use glam::Vec3A;

use super::*;

fn cube(x: f32) -> Aabb {
    Aabb::new(Vec3A::splat(x), Vec3A::splat(x + 1.0))
}

/// The members of each box, in the order of the boxes.
fn members_of(distinct: &Distinct) -> Vec<&[u32]> {
    (0..distinct.boxes.len()).map(|k| distinct.members(k)).collect()
}

#[test]
fn equal_boxes_are_one() {
    let boxes = [cube(3.0), cube(1.0), cube(3.0), cube(2.0), cube(1.0), cube(3.0)];
    let distinct = Distinct::of(boxes.to_vec());
    assert_eq!(distinct.boxes, [cube(3.0), cube(1.0), cube(2.0)]);
    assert_eq!(members_of(&distinct), [&[0, 2, 5][..], &[1, 4], &[3]]);
    // -0 is not 0 here: two entries more are no mistake.
    assert_eq!(Distinct::of(vec![cube(0.0), cube(-0.0)]).boxes.len(), 2);
    let differ = Distinct::of((0..1000).map(|k| cube(k as f32)).collect());
    assert_eq!((differ.boxes.len(), differ.members.len()), (1000, 1000));
    assert_eq!(members_of(&differ)[999], [999]);
    let none = Distinct::of(vec![]);
    assert_eq!((none.boxes.len(), none.members.len()), (0, 0));
}

#[test]
fn a_table_of_a_few_boxes_keeps_thousands_of_repetitions_together() {
    let boxes = (0..50_000).map(|k| cube((k % 7) as f32)).collect();
    let distinct = Distinct::of(boxes);
    assert_eq!(distinct.boxes.len(), 7);
    assert!(members_of(&distinct).iter().all(|members| members.is_sorted() && members.len() >= 7142));
}

/// The finaliser of SplitMix64 three times, as another program computes it: from 2^64 divided by the golden ratio it makes
/// e220a8397b1dcdaf, the first number of that generator from the seed 0.
#[test]
fn the_hash_of_a_box_is_that_of_splitmix() {
    let bounds = Aabb::new(Vec3A::new(1.5, -2.25, 3.0), Vec3A::new(4.75, 5.5, -0.0));
    assert_eq!(hash(&bounds), 0xace1_cb91_964a_decd);
}
