use raypencil_scene::pattern::Mounting;
use raypencil_scene::{RaySet, Reading, Sides};

use super::*;

fn layout(shape: &[u64]) -> Layout {
    Layout::of(shape, &[], None)
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
        returns: None,
        elevations_deg: Some(vec![-15.0, 15.0, 0.0]),
        mounting: Mounting::HERE,
    };
    let found = Layout::of(&set.shape, set.set.rays(), Some(&PageScan::of(&set)));
    assert_eq!((found.width, found.height), (2, 3));
    assert_eq!(found.rays, [1, 4, 2, 5, 0, 3].map(Some));
}

#[test]
fn a_head_has_its_angles_beside_it() {
    // A quarter of a turn to the right at each firing, over the whole turn and on.
    let elevations = [-10.0_f64, 5.0];
    let ray = |firing: usize, elevation: f64| {
        let (azimuth, elevation) = ((120.0 - 90.0 * firing as f64).to_radians(), elevation.to_radians());
        let level = libm::cos(elevation);
        let direction = [level * libm::cos(azimuth), level * libm::sin(azimuth), libm::sin(elevation)];
        CastRay::new(glam::DVec3::ZERO, direction.into())
    };
    let rays: Vec<CastRay> =
        (0..6).flat_map(|firing| elevations.map(|elevation| ray(firing, elevation))).collect();
    let mounting = Mounting::HERE;
    let scan = PageScan { name: "head", times: None, elevations_deg: Some(&elevations), mounting: &mounting };
    let axes = Layout::of(&[6, 2], &rays, Some(&scan)).axes.expect("a head has axes");
    assert_eq!(axes.rows.at, [5.0, -10.0]);
    let expected = [120.0, 30.0, -60.0, -150.0, -240.0, -330.0];
    assert!(axes.columns.at.iter().zip(expected).all(|(at, expected)| (at - expected).abs() < 1e-9));
    assert_eq!(scan.rings(), Some(vec![0, 1]));
}

#[test]
fn rays_without_room_are_joined_and_the_worst_stays() {
    let mounting = Mounting::HERE;
    let elevations = [-10.0, 5.0];
    let ray = CastRay::new(glam::DVec3::ZERO, glam::DVec3::X);
    let scan = PageScan { name: "head", times: None, elevations_deg: Some(&elevations), mounting: &mounting };
    let head = || Layout::of(&[10, 2], &[ray; 20], Some(&scan));
    assert_eq!(head().thinned(20, |_| 0).width, 10);
    // Ray 15 is the second channel's eighth firing.
    let found = head().thinned(8, |ray| u8::from(ray == 15));
    assert_eq!((found.width, found.height), (4, 2));
    // Of three firings the middle one; the last cell has one firing alone.
    assert_eq!(found.rays, [3, 9, 15, 19, 2, 8, 14, 18].map(Some));
    assert_eq!(found.axes.expect("axes").columns.at.len(), 4);
    assert!(
        found
            .words
            .ends_with("Each cell stands for 3 x 1 rays: the one that is worst, or that in their middle.")
    );
    // A raster is joined in both directions.
    let raster = layout(&[100, 100]).thinned(100, |_| 0);
    assert_eq!((raster.width, raster.height, raster.rays.len()), (10, 10, 100));
    assert_eq!(raster.rays[0], Some(505));
}

#[test]
fn what_finds_no_room_is_named() {
    // 450,000 rays on one side: eight channels of thirteen.
    let rays = vec![CastRay::new(glam::DVec3::ZERO, glam::DVec3::X); 450_000];
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
        shape: &[450, 1000],
        rays: &rays,
        answers: &answers,
        mesh: None,
        set: None,
        scan: None,
        compared: None,
    };
    let (group, words) = page.group(&page.layout());
    let names: Vec<&str> = group.channels.iter().map(|(name, _, _)| name.as_str()).collect();
    assert_eq!(names, ["range.T", "face.I", "ray", "P.X", "P.Y", "P.Z", "incidence.V", "side"]);
    assert_eq!(words, "Not among the maps for want of room: faces at this t, t, N.X, N.Y, N.Z.");
}
