//! What a check says of rays and of the points of a cloud, by counts that are given.

use raypencil_files::RayArray;
use raypencil_referee::ExactCast;
use raypencil_scene::{CastRay, Precision, Sides, Silent, Triangles};

use super::*;
use crate::cloud::CloudFrame;
use crate::comparison::{CastValue, Stated};
use crate::pack::{AskedBy, CastGround, CloudFacts, check_stated_rays};

/// Four rays on a square, and one beside it: the first on its diagonal, the second with the face that is stated of it.
fn checked(face: u32) -> RayPackChecked {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let mesh = Triangles::new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).expect("a square");
    let places = [(0.5, 0.5), (0.75, 0.25), (0.875, 0.25), (0.25, 0.75), (5.0, 0.0)];
    let rays = places.map(|(x, y)| CastRay::new(glam::DVec3::new(x, y, 1.0), -glam::DVec3::Z));
    let exact = ExactCast::new(&mesh);
    let ground = CastGround { mesh: &mesh, exact: &exact, sides: Sides::Both };
    let faces = [Some(0), Some(face), Some(0), Some(1), None];
    let stated = Stated { face: Some(faces.map(|face| face.map(FaceId)).to_vec()), ..Stated::default() };
    let asked_by = AskedBy { name: "a".into(), sha256: "b".into(), cast_command: "c".into() };
    let rays = RayArray { shape: vec![5], rays: rays.to_vec() };
    check_stated_rays(asked_by, (ground, rays), ("mine".into(), stated), Precision::F64, &Silent)
}

/// A cloud of four points, with rays whose keys and numbers are wrong, and points that are of no ray.
fn of_cloud(checked: RayPackChecked, [wrong_keys, wrong_numbers, strays]: [&[usize]; 3]) -> RayPackChecked {
    let cloud = CloudFacts {
        frame: CloudFrame::Mesh,
        source: None,
        points: 4 + strays.len(),
        returns_of_beam: None,
        assigned: "by direction",
        strays: strays.to_vec(),
        has_range: false,
        steps: None,
        excused: 0,
        keys: Vec::new(),
        unjudged: Vec::new(),
        wrong_keys: wrong_keys.to_vec(),
        keys_why: None,
        numbered: 4,
        number_field: None,
        wrong_numbers: wrong_numbers.to_vec(),
        numbers_why: None,
    };
    RayPackChecked { cloud: Some(cloud), ..checked }
}

#[test]
fn the_headline_of_a_cloud_counts_what_is_more_than_wrong_rays() {
    let right = || checked(0);
    assert_eq!(right().headline(), None);
    // Of rays alone the check speaks by itself.
    assert_eq!(of_cloud(checked(1), [&[], &[], &[]]).headline(), None);
    for (found, words) in [
        (of_cloud(right(), [&[2], &[], &[]]), "Ring, channel or time of 1 point are those of another ray."),
        (of_cloud(right(), [&[], &[2, 3], &[]]), "The number of return of 2 points is another."),
        (of_cloud(right(), [&[], &[], &[4]]), "1 point is of no ray, or of one that has another."),
        (
            of_cloud(checked(1), [&[0, 2], &[3], &[4, 5]]),
            "1 of 5 rays is wrong; ring, channel or time of 2 points are those of another ray; the number of return of 1 point \
             is another; 2 points are of no ray, or of one that has another.",
        ),
    ] {
        assert_eq!(found.headline().as_deref(), Some(words));
    }
}

#[test]
fn a_ray_with_a_wrong_field_is_wrong_once_and_a_stray_point_beside_all_rays() {
    let classes = |found: &RayPackChecked| {
        let bundle = found.bundle("rays");
        let of = |class: Class| bundle.by_class[class as usize];
        [of(Class::Agree), of(Class::Tie), of(Class::Rounding), of(Class::Defect)]
    };
    assert_eq!(classes(&checked(0)), [4, 1, 0, 0]);
    assert_eq!(classes(&checked(1)), [3, 1, 0, 1]);
    // A tie, one that is wrong already, and one that has both fields wrong.
    assert_eq!(classes(&of_cloud(checked(1), [&[0, 1, 2], &[2], &[]])), [2, 0, 0, 3]);
    assert_eq!(classes(&of_cloud(checked(1), [&[], &[], &[4, 5]])), [3, 1, 0, 3]);
    let bundle = of_cloud(checked(1), [&[2], &[3], &[4, 5]]).bundle("rays");
    assert!(bundle.hits_anything && bundle.must_hit && bundle.ruled == 1);
    // What is right and wrong of the hits, the keys, the numbers and the points.
    let items: Vec<(&str, u64, u64)> = bundle
        .items
        .iter()
        .map(|item| {
            let of = |class: Class| item.by_class[class as usize];
            (item.key.as_str(), of(Class::Agree), of(Class::Defect))
        })
        .collect();
    assert_eq!(items, [("hit", 3, 1), (KEYS, 3, 1), (NUMBERS, 3, 1), (STRAYS, 4, 2)]);
    assert_eq!(bundle.listed.len(), 5);
}

#[test]
fn what_is_said_stands_beside_what_is_true() {
    let hit = Reading::Hit(FaceId(7));
    for (wrong, said, exact) in [
        (Wrong::Hit { stated: Reading::Miss, exact: hit }, "no hit", Some("face 7")),
        (Wrong::Hit { stated: hit, exact: Reading::TooNear }, "face 7", Some("too near")),
        (Wrong::Distance { stated: 2.5, exact: Reading::Hit(0.5) }, "2.5", Some("0.5")),
        (Wrong::Distance { stated: 2.5, exact: Reading::TooNear }, "2.5", Some("too near")),
        (Wrong::Distance { stated: 2.5, exact: Reading::Miss }, "2.5", Some("no hit")),
        (Wrong::Something { exact: Reading::Miss }, "a hit", Some("no hit")),
        (Wrong::Contradiction, "too near in one of t and range", None),
        (Wrong::Disagreement { by: "face", is_hit: true, of: "t", number: 1.5 }, "t 1.5", None),
        (Wrong::Value { value: CastValue::Normal, error: 1.0, bound: 0.5 }, "normal", None),
    ] {
        assert_eq!(said_and_true(&wrong), (said.to_string(), exact.map(str::to_string)), "{wrong:?}");
    }
}
