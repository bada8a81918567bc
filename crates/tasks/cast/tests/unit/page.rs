use raypencil_scene::pattern::Mounting;
use raypencil_scene::{RaySet, Reading, Sides};

use super::*;

fn layout(shape: &[u64]) -> Layout {
    Layout::of(shape, None)
}

#[test]
fn an_array_has_its_own_rows_and_a_list_is_wrapped() {
    let of_array = layout(&[2, 3]);
    assert_eq!((of_array.width, of_array.height), (3, 2));
    assert_eq!(of_array.rays, (0..6).map(Some).collect::<Vec<_>>());
    let of_more = layout(&[2, 3, 4]);
    assert_eq!((of_more.width, of_more.height, of_more.rays.len()), (12, 2, 24));
    // Seven rays: rows of three, and two cells without a ray.
    let of_list = layout(&[7]);
    assert_eq!((of_list.width, of_list.height), (3, 3));
    assert_eq!(of_list.rays[6..], [Some(6), None, None]);
    let of_one = layout(&[]);
    assert_eq!((of_one.width, of_one.height, of_one.rays), (1, 1, vec![Some(0)]));
}

#[test]
fn a_head_has_a_row_for_each_channel_with_the_highest_on_top() {
    // Two firings of three channels; the second channel looks highest, the first lowest.
    let ray = CastRay::new(glam::DVec3::ZERO, glam::DVec3::X);
    let set = NamedRaySet {
        name: "head".into(),
        shape: vec![2, 3],
        set: RaySet::new(vec![ray; 6], Sides::Both).unwrap(),
        times: None,
        weights: None,
        elevations_deg: Some(vec![-15.0, 15.0, 0.0]),
        mounting: Mounting::HERE,
    };
    let found = Layout::of(&set.shape, Some(&set));
    assert_eq!((found.width, found.height), (2, 3));
    assert_eq!(found.rays, [1, 4, 2, 5, 0, 3].map(Some));
}

#[test]
fn what_finds_no_room_is_named() {
    // A million rays on one side: six channels of a million numbers, of thirteen.
    let rays = vec![CastRay::new(glam::DVec3::ZERO, glam::DVec3::X); 1_000_000];
    let answers = Answers {
        first: vec![Reading::Miss; rays.len()],
        any: None,
        all: None,
        margins: None,
        decided: None,
    };
    let page = CastPage {
        title: "many",
        facts: &[],
        shape: &[1000, 1000],
        rays: &rays,
        answers: &answers,
        set: None,
        compared: None,
    };
    let (group, words) = page.group(&Layout::of(page.shape, None));
    let names: Vec<&str> = group.channels.iter().map(|(name, _, _)| name.as_str()).collect();
    assert_eq!(names, ["range.T", "face.I", "incidence.V", "ray", "side", "faces at this t"]);
    assert_eq!(words, "Not among the maps for want of room: t, P.X, P.Y, P.Z, N.X, N.Y, N.Z.");
}
