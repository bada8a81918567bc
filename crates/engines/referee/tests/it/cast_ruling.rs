//! What rounding excuses, and what it does not, on cases that are plain by hand.

use glam::DVec3;
use raypencil_referee::{ExactCast, Ruling};
use raypencil_scene::{CastRay, FaceId, Precision, Reading, Sides, Triangles};

fn down(x: f64, y: f64) -> CastRay {
    CastRay::new(DVec3::new(x, y, 3.0), DVec3::NEG_Z)
}

/// A square from 0 to 1 at a height, of two faces that share the diagonal from (0, 0) to (1, 1).
fn squares(heights: &[f64]) -> Triangles {
    let corners = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    let vertices = heights.iter().flat_map(|&z| corners(z)).collect();
    let faces = (0..heights.len() as u32)
        .flat_map(|k| [[4 * k, 4 * k + 1, 4 * k + 2], [4 * k, 4 * k + 2, 4 * k + 3]]);
    Triangles::new(vertices, faces.collect()).unwrap()
}

fn rule(mesh: &Triangles, ray: &CastRay, stated: Option<u32>) -> Ruling {
    let stated = stated.map_or(Reading::Miss, |face| Reading::Hit(FaceId(face)));
    ExactCast::new(mesh).rule(ray, Sides::Both, stated, Precision::F64)
}

fn rule_too_near(mesh: &Triangles, ray: &CastRay) -> Ruling {
    ExactCast::new(mesh).rule(ray, Sides::Both, Reading::TooNear, Precision::F64)
}

fn is_rounding(ruling: Ruling) -> bool {
    matches!(ruling, Ruling::Rounding(_))
}

#[test]
fn no_ray_slips_through_a_shared_edge() {
    let mesh = squares(&[0.0]);
    for share in [0.125, 0.5, 0.75] {
        let ray = down(share, share);
        assert_eq!(rule(&mesh, &ray, None), Ruling::Wrong);
        // Both faces tie.
        assert_eq!([0, 1].map(|face| rule(&mesh, &ray, Some(face))), [Ruling::Tie; 2]);
    }
    // One step of f64 beside it, the other face is as good; a micrometre beside it is not.
    assert!(is_rounding(rule(&mesh, &down(0.5_f64.next_up(), 0.5), Some(1))));
    assert_eq!(rule(&mesh, &down(0.5 + 1e-6, 0.5), Some(1)), Ruling::Wrong);
}

#[test]
fn on_the_outline_a_hit_may_be_missed_and_found() {
    let mesh = squares(&[0.0]);
    assert!(is_rounding(rule(&mesh, &down(0.5, 0.0), None)));
    assert!(is_rounding(rule(&mesh, &down(0.5, -1e-17), Some(0))));
    assert_eq!(rule(&mesh, &down(0.5, -1e-12), Some(0)), Ruling::Wrong);
    assert_eq!(rule(&mesh, &down(0.5, 1e-12), None), Ruling::Wrong);
    // In single precision, a thousand times as much.
    let exact = ExactCast::new(&mesh);
    let single = |y: f64| exact.rule(&down(0.5, y), Sides::Both, Reading::Hit(FaceId(0)), Precision::F32);
    assert!(is_rounding(single(-1e-12)));
    assert_eq!(single(-1e-4), Ruling::Wrong);
}

#[test]
fn a_witness_is_a_ray_with_that_answer() {
    let mesh = squares(&[0.0]);
    let exact = ExactCast::new(&mesh);
    let ray = down(0.5, 0.0);
    let Ruling::Rounding(by) = exact.rule(&ray, Sides::Both, Reading::Miss, Precision::F64) else {
        panic!("a miss on the outline is rounding")
    };
    let most = exact.lateral_error(&ray, Precision::F64);
    // S = 1 + 3.
    assert_eq!(most, 16.0 * 4.0 * f64::EPSILON / 2.0);
    assert!(by.max_norm() <= most);
    assert!(exact.first_moved(&ray, Sides::Both, by.to_array()).is_empty());
}

#[test]
fn faces_that_are_nearly_as_near_may_change_places() {
    let near = squares(&[0.0, -1e-16]);
    assert_eq!(rule(&near, &down(0.75, 0.25), Some(0)), Ruling::Exact);
    assert!(is_rounding(rule(&near, &down(0.75, 0.25), Some(2))));
    // 72 kappa u S / c = 72 x 1 x 2^-53 x 4 is 3.2e-14, for each of the two; kappa is sqrt(2) here.
    let apart = squares(&[0.0, -1e-12]);
    assert_eq!(rule(&apart, &down(0.75, 0.25), Some(2)), Ruling::Wrong);
}

#[test]
fn what_is_behind_the_first_hit_is_wrong() {
    let mesh = squares(&[0.0, -1.0]);
    assert_eq!(rule(&mesh, &down(0.75, 0.25), Some(2)), Ruling::Wrong);
    assert_eq!(rule(&mesh, &down(0.75, 0.25), None), Ruling::Wrong);
    // Faces that the mesh does not have.
    assert_eq!(rule(&mesh, &down(0.75, 0.25), Some(4)), Ruling::Wrong);
    // The lower square is seen past the outline of the upper one only from beside it.
    let mesh = Triangles::new(
        vec![
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [-9.0, -9.0, -1.0],
            [9.0, -9.0, -1.0],
            [0.0, 9.0, -1.0],
        ],
        vec![[0, 1, 2], [3, 4, 5]],
    )
    .unwrap();
    assert!(is_rounding(rule(&mesh, &down(0.5, 0.0), Some(1))));
    assert_eq!(rule(&mesh, &down(0.5, 1e-9), Some(1)), Ruling::Wrong);
    // At a corner of it too, over either edge.
    assert!(is_rounding(rule(&mesh, &down(0.0, 0.0), Some(1))));
}

#[test]
fn the_ends_of_a_ray_are_as_uncertain_as_ranges() {
    let mesh = squares(&[0.0]);
    let up_to = |t_max: f64| CastRay { t_max, ..down(0.75, 0.25) };
    let from = |t_min: f64| CastRay { t_min, ..down(0.75, 0.25) };
    assert_eq!(rule(&mesh, &up_to(3.0), Some(0)), Ruling::Exact);
    assert!(is_rounding(rule(&mesh, &up_to(3.0), None)));
    assert!(is_rounding(rule(&mesh, &up_to(3.0_f64.next_down()), Some(0))));
    assert_eq!(rule(&mesh, &up_to(3.0 - 1e-9), Some(0)), Ruling::Wrong);
    assert!(is_rounding(rule(&mesh, &from(3.0), None)));
    assert!(is_rounding(rule(&mesh, &from(3.0_f64.next_up()), Some(0))));
    assert_eq!(rule(&mesh, &from(3.0 + 1e-9), Some(0)), Ruling::Wrong);
    assert_eq!(rule(&mesh, &from(3.0 - 1e-9), None), Ruling::Wrong);
    // A face behind the start is not met, were it by the smallest length that counts.
    assert!(is_rounding(rule(&mesh, &CastRay::new(DVec3::new(0.75, 0.25, -1e-17), DVec3::NEG_Z), Some(0))));
    let behind = CastRay::new(DVec3::new(0.75, 0.25, -1e-9), DVec3::NEG_Z);
    assert_eq!(rule(&mesh, &behind, Some(0)), Ruling::Wrong);
}

#[test]
fn nobody_sees_through_what_is_too_near_or_misses_it() {
    // A plate 3 m below the ray's origin, and a floor 1 m below the plate.
    let mesh = squares(&[0.0, -1.0]);
    let blind = |t_blind: f64| CastRay { t_blind, ..down(0.75, 0.25) };
    for t_blind in [3.0 + 1e-9, 3.5, 4.0, 5.0] {
        let ray = blind(t_blind);
        assert_eq!(rule_too_near(&mesh, &ray), Ruling::Exact);
        // Neither the plate nor the floor, were it measured by itself, nor nothing.
        for stated in [Some(0), Some(2), None] {
            assert_eq!(rule(&mesh, &ray, stated), Ruling::Wrong, "{t_blind} {stated:?}");
        }
    }
    // The plate is measured: it is not too near, for a sensor or for none.
    for t_blind in [0.0, 1.0, 3.0 - 1e-9] {
        assert_eq!(rule(&mesh, &blind(t_blind), Some(0)), Ruling::Exact);
        assert_eq!(rule_too_near(&mesh, &blind(t_blind)), Ruling::Wrong, "{t_blind}");
    }
    // Beside the plates nothing is met.
    let beside = CastRay { t_blind: 3.5, ..down(2.0, 0.25) };
    assert_eq!(rule(&mesh, &beside, None), Ruling::Exact);
    assert_eq!(rule_too_near(&mesh, &beside), Ruling::Wrong);
}

#[test]
fn a_slit_beside_the_nearest_edge_excuses_a_miss() {
    // Two plates. Between them is a slit that is less wide than an eighth of what is charged, and not where one looks all around.
    let precision = Precision::F32;
    let ray = down(0.5, 0.0);
    let plates = |most: f64, width: f64| {
        let [from, to] = [0.7 * most, (0.7 + width) * most];
        let corners = [
            [0.0, -1.0],
            [1.0, -1.0],
            [1.0, from],
            [0.0, from],
            [0.0, to],
            [1.0, to],
            [1.0, 1.0],
            [0.0, 1.0],
        ];
        let faces = vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
        Triangles::new(corners.iter().map(|&[x, y]| [x, y, 0.0]).collect(), faces).unwrap()
    };
    let most = ExactCast::new(&plates(0.0, 0.0)).lateral_error(&ray, precision);
    for (width, is_excused) in [(0.1, true), (0.0, false)] {
        let mesh = plates(most, width);
        let ruling = ExactCast::new(&mesh).rule(&ray, Sides::Both, Reading::Miss, precision);
        assert_eq!(is_rounding(ruling), is_excused, "{width}: {ruling:?}");
    }
}

#[test]
fn a_speck_beside_the_ray_may_be_hit_if_it_is_within_what_is_charged() {
    let precision = Precision::F32;
    let ray = down(0.5, 0.0);
    let speck = |most: f64, near: f64| {
        let corners = [[-0.05, near], [0.05, near], [0.0, near + 0.1]];
        let corners = corners.map(|[x, y]| [0.5 + x * most, y * most, 0.0]);
        // The others only keep all sizes.
        let around = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, -0.5, 0.0]];
        Triangles::new([corners, around].concat(), vec![[0, 1, 2], [3, 4, 5]]).unwrap()
    };
    let most = ExactCast::new(&speck(1e-6, 0.0)).lateral_error(&ray, precision);
    // It is not where one looks all around.
    for (near, is_excused) in [(0.7, true), (-0.85, true), (1.01, false)] {
        let mesh = speck(most, near);
        let ruling = ExactCast::new(&mesh).rule(&ray, Sides::Both, Reading::Hit(FaceId(0)), precision);
        assert_eq!(is_rounding(ruling), is_excused, "{near}: {ruling:?}");
    }
}

#[test]
fn the_shortest_range_is_as_uncertain_as_ranges() {
    let mesh = squares(&[0.0, -1.0]);
    let blind = |t_blind: f64| CastRay { t_blind, ..down(0.75, 0.25) };
    // At exactly the shortest range it is measured, one step before it is too near; rounding may take either for the other.
    assert_eq!(rule(&mesh, &blind(3.0), Some(0)), Ruling::Exact);
    assert!(is_rounding(rule_too_near(&mesh, &blind(3.0))));
    assert_eq!(rule_too_near(&mesh, &blind(3.0_f64.next_up())), Ruling::Exact);
    assert!(is_rounding(rule(&mesh, &blind(3.0_f64.next_up()), Some(0))));
    // The bound is that of the range: 72 kappa u S / c, with kappa = sqrt(2), S = 1 + 3 and c = 1.
    let exact = ExactCast::new(&mesh);
    // In t it is that part of the direction's length.
    for length in [1.0, 1024.0, 1.0 / 1024.0] {
        let blind =
            |range: f64| CastRay { direction: length * DVec3::NEG_Z, t_blind: range / length, ..blind(0.0) };
        for precision in [Precision::F64, Precision::F32] {
            let bound = exact.range_error(&blind(3.0), FaceId(0), precision);
            let of = |t_blind: f64, stated| exact.rule(&blind(t_blind), Sides::Both, stated, precision);
            let (plate, near) = (Reading::Hit(FaceId(0)), Reading::TooNear);
            assert!(is_rounding(of(3.0 + 0.9 * bound, plate)) && is_rounding(of(3.0 - 0.9 * bound, near)));
            assert_eq!(of(3.0 + 1.1 * bound, plate), Ruling::Wrong);
            assert_eq!(of(3.0 - 1.1 * bound, near), Ruling::Wrong);
            // Whoever passes through the plate, or misses it, is wrong however near the limit is.
            for stated in [Reading::Hit(FaceId(2)), Reading::Miss] {
                assert_eq!(of(3.0 + 0.5 * bound, stated), Ruling::Wrong);
                assert_eq!(of(3.0 - 0.5 * bound, stated), Ruling::Wrong);
            }
        }
    }
}

#[test]
fn on_the_outline_of_what_is_too_near_a_ray_may_pass_it() {
    // The plate ends at y = 0; a floor 1 m below it goes on. Both ways, by one moved ray.
    let corners = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [-9.0, -9.0, -1.0],
        [9.0, -9.0, -1.0],
        [0.0, 9.0, -1.0],
    ];
    let mesh = Triangles::new(corners.to_vec(), vec![[0, 1, 2], [3, 4, 5]]).unwrap();
    let blind = |y: f64| CastRay { t_blind: 3.5, ..down(0.5, y) };
    assert_eq!(rule_too_near(&mesh, &blind(0.0)), Ruling::Exact);
    assert!(is_rounding(rule(&mesh, &blind(0.0), Some(1))));
    assert_eq!(rule(&mesh, &blind(1e-9), Some(1)), Ruling::Wrong);
    assert!(is_rounding(rule_too_near(&mesh, &blind(-1e-17))));
    assert_eq!(rule_too_near(&mesh, &blind(-1e-9)), Ruling::Wrong);
    // Past the tip of a needle too.
    let width = libm::scalbn(1.0, -40);
    let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, width, 0.0]];
    let needle = Triangles::new(corners, vec![[0, 1, 2]]).unwrap();
    let past = CastRay { t_blind: 3.5, ..down(-1e-16, 0.0) };
    assert!(is_rounding(rule_too_near(&needle, &past)));
}

#[test]
fn a_side_that_does_not_count_is_no_excuse() {
    let mesh = squares(&[0.0]);
    let exact = ExactCast::new(&mesh);
    let up = CastRay::new(DVec3::new(0.75, 0.25, -3.0), DVec3::Z);
    assert_eq!(exact.rule(&up, Sides::Fronts, Reading::Miss, Precision::F64), Ruling::Exact);
    assert_eq!(exact.rule(&up, Sides::Fronts, Reading::Hit(FaceId(0)), Precision::F64), Ruling::Wrong);
}

/// The back of a face does not count, unless the program cannot tell it from the front: up to a cosine of 2 (5 kappa + 15) u.
#[test]
fn the_back_of_a_face_that_is_edge_on_may_be_hit() {
    // n = (0, -4, 2 d), seen along z: the cosine is d/2 from behind, and kappa = sqrt 5 sqrt 5 / 4.
    let d = 1.0 / 1024.0;
    let corners = vec![[-1.0, -d / 2.0, 1.0], [1.0, -d / 2.0, 1.0], [0.0, d / 2.0, 3.0]];
    let mesh = Triangles::new(corners, vec![[0, 1, 2]]).unwrap();
    let ray = CastRay::new(DVec3::ZERO, DVec3::Z);
    let least = d / 2.0 / (2.0 * (5.0 * 1.25 + 15.0));
    let rule = |unit_roundoff: f64| {
        ExactCast::new(&mesh).rule(&ray, Sides::Fronts, Reading::Hit(FaceId(0)), Precision { unit_roundoff })
    };
    assert_eq!(rule(0.99 * least), Ruling::Wrong);
    assert!(is_rounding(rule(1.01 * least)));
}

/// A ray that far outside of one of the plate's sides, and the face that has the side.
type Beside = (fn(f64) -> CastRay, u32);

/// Every error of the rule, charged on both sides of what it may seem: at 0.9 of it an answer is excused, at 1.1 it is wrong.
#[test]
fn each_error_is_excused_up_to_its_size_and_not_beyond() {
    // The plate's corners are at most 1, and rays start 3 above it: S = 4. Legs of 1: kappa = sqrt 2. Head on: c = 1.
    for precision in [Precision::F64, Precision::F32] {
        let u = precision.unit_roundoff;
        let (across, along) = (16.0 * u * 4.0, 72.0 * 2.0_f64.sqrt() * u * 4.0);
        let plate = squares(&[0.0]);
        let exact = ExactCast::new(&plate);
        let of = |mesh: &Triangles, ray: &CastRay, stated: Option<u32>| {
            let stated = stated.map_or(Reading::Miss, |face| Reading::Hit(FaceId(face)));
            ExactCast::new(mesh).rule(ray, Sides::Both, stated, precision)
        };
        assert_eq!(exact.lateral_error(&down(0.5, 0.5), precision), across);
        for (share, expected) in [(0.9, true), (1.1, false)] {
            let excused = |ruling: Ruling| {
                assert!(!matches!(ruling, Ruling::Exact | Ruling::Tie), "{ruling:?}");
                is_rounding(ruling) == expected
            };
            // Beside each of the plate's sides, outside and inside. Face 0 is below its diagonal.
            let by = share * across;
            let beside: [Beside; 4] = [
                (|by| down(0.5, -by), 0),
                (|by| down(1.0 + by, 0.5), 0),
                (|by| down(0.5, 1.0 + by), 1),
                (|by| down(-by, 0.5), 1),
            ];
            for (at, face) in beside {
                assert!(excused(of(&plate, &at(by), Some(face))), "{face} {share} {u}");
                assert!(excused(of(&plate, &at(-by), None)), "{face} {share} {u}");
            }
            // Both ends of the ray, for the hit and for the miss.
            let by = share * along;
            let (up_to, from) = (
                |t_max: f64| CastRay { t_max, ..down(0.75, 0.25) },
                |t_min: f64| CastRay { t_min, ..down(0.75, 0.25) },
            );
            assert!(excused(of(&plate, &up_to(3.0 - by), Some(0))));
            assert!(excused(of(&plate, &up_to(3.0 + by), None)));
            assert!(excused(of(&plate, &from(3.0 + by), Some(0))));
            assert!(excused(of(&plate, &from(3.0 - by), None)));
            // A face behind the nearest: the errors of both.
            let two = squares(&[0.0, -2.0 * by]);
            assert!(excused(of(&two, &down(0.75, 0.25), Some(2))), "{share} {u}");
            // The nearest of the two has an error of its own: seen at 60 degrees, twice as much.
            let slanting = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.5, 0.75_f64.sqrt()]];
            let flat = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
            let middle = 0.25 * 3.0_f64.sqrt();
            let gap = share * (along + 2.0 * along);
            let corners = [slanting, flat(middle - gap)].concat();
            let two = Triangles::new(corners, vec![[0, 1, 2], [3, 4, 5]]).unwrap();
            let ray = down(0.25, 0.25);
            assert!(excused(of(&two, &ray, Some(1))), "{share} {u}");
        }
    }
}
