//! What rounding excuses, and what it does not, on cases that are plain by hand.

use glam::DVec3;
use raypencil_referee::{CastRuling, ExactCast};
use raypencil_scene::{CastRay, FaceId, Precision, Sides, Triangles};

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

fn rule(mesh: &Triangles, ray: &CastRay, stated: Option<u32>) -> CastRuling {
    ExactCast::new(mesh).rule(ray, Sides::Both, stated.map(FaceId), Precision::F64)
}

fn is_rounding(ruling: CastRuling) -> bool {
    matches!(ruling, CastRuling::Rounding { .. })
}

#[test]
fn no_ray_slips_through_a_shared_edge() {
    let mesh = squares(&[0.0]);
    for share in [0.125, 0.5, 0.75] {
        let ray = down(share, share);
        assert_eq!(rule(&mesh, &ray, None), CastRuling::Wrong);
        // Both faces tie.
        assert_eq!(rule(&mesh, &ray, Some(0)), CastRuling::Same);
        assert_eq!(rule(&mesh, &ray, Some(1)), CastRuling::Same);
    }
    // One step of f64 beside it, the other face is as good; a micrometre beside it is not.
    assert!(is_rounding(rule(&mesh, &down(0.5_f64.next_up(), 0.5), Some(1))));
    assert_eq!(rule(&mesh, &down(0.5 + 1e-6, 0.5), Some(1)), CastRuling::Wrong);
}

#[test]
fn on_the_outline_a_hit_may_be_missed_and_found() {
    let mesh = squares(&[0.0]);
    assert!(is_rounding(rule(&mesh, &down(0.5, 0.0), None)));
    assert!(is_rounding(rule(&mesh, &down(0.5, -1e-17), Some(0))));
    assert_eq!(rule(&mesh, &down(0.5, -1e-12), Some(0)), CastRuling::Wrong);
    assert_eq!(rule(&mesh, &down(0.5, 1e-12), None), CastRuling::Wrong);
    // In single precision, a thousand times as much.
    let exact = ExactCast::new(&mesh);
    let single = |y: f64| exact.rule(&down(0.5, y), Sides::Both, Some(FaceId(0)), Precision::F32);
    assert!(is_rounding(single(-1e-12)));
    assert_eq!(single(-1e-4), CastRuling::Wrong);
}

#[test]
fn a_witness_is_a_ray_with_that_answer() {
    let mesh = squares(&[0.0]);
    let exact = ExactCast::new(&mesh);
    let ray = down(0.5, 0.0);
    let CastRuling::Rounding { moved } = exact.rule(&ray, Sides::Both, None, Precision::F64) else {
        panic!("a miss on the outline is rounding")
    };
    let most = exact.lateral_error(&ray, Precision::F64);
    // S = 1 + 3.
    assert_eq!(most, 16.0 * 4.0 * f64::EPSILON / 2.0);
    assert!(moved.iter().all(|part| part.abs() <= most));
    assert!(exact.first_moved(&ray, Sides::Both, moved).is_empty());
}

#[test]
fn faces_that_are_nearly_as_near_may_change_places() {
    let near = squares(&[0.0, -1e-16]);
    assert_eq!(rule(&near, &down(0.75, 0.25), Some(0)), CastRuling::Same);
    assert!(is_rounding(rule(&near, &down(0.75, 0.25), Some(2))));
    // 72 kappa u S / c = 72 x 1 x 2^-53 x 4 is 3.2e-14, for each of the two; kappa is sqrt(2) here.
    let apart = squares(&[0.0, -1e-12]);
    assert_eq!(rule(&apart, &down(0.75, 0.25), Some(2)), CastRuling::Wrong);
}

#[test]
fn what_is_behind_the_first_hit_is_wrong() {
    let mesh = squares(&[0.0, -1.0]);
    assert_eq!(rule(&mesh, &down(0.75, 0.25), Some(2)), CastRuling::Wrong);
    assert_eq!(rule(&mesh, &down(0.75, 0.25), None), CastRuling::Wrong);
    // Faces that the mesh does not have.
    assert_eq!(rule(&mesh, &down(0.75, 0.25), Some(4)), CastRuling::Wrong);
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
    assert_eq!(rule(&mesh, &down(0.5, 1e-9), Some(1)), CastRuling::Wrong);
    // At a corner of it too, over either edge.
    assert!(is_rounding(rule(&mesh, &down(0.0, 0.0), Some(1))));
}

#[test]
fn the_ends_of_a_ray_are_as_uncertain_as_ranges() {
    let mesh = squares(&[0.0]);
    let up_to = |t_max: f64| CastRay { t_max, ..down(0.75, 0.25) };
    let from = |t_min: f64| CastRay { t_min, ..down(0.75, 0.25) };
    assert_eq!(rule(&mesh, &up_to(3.0), Some(0)), CastRuling::Same);
    assert!(is_rounding(rule(&mesh, &up_to(3.0), None)));
    assert!(is_rounding(rule(&mesh, &up_to(3.0_f64.next_down()), Some(0))));
    assert_eq!(rule(&mesh, &up_to(3.0 - 1e-9), Some(0)), CastRuling::Wrong);
    assert!(is_rounding(rule(&mesh, &from(3.0), None)));
    assert!(is_rounding(rule(&mesh, &from(3.0_f64.next_up()), Some(0))));
    assert_eq!(rule(&mesh, &from(3.0 + 1e-9), Some(0)), CastRuling::Wrong);
    assert_eq!(rule(&mesh, &from(3.0 - 1e-9), None), CastRuling::Wrong);
    // A face behind the start is not met, were it by the smallest length that counts.
    assert!(is_rounding(rule(&mesh, &CastRay::new(DVec3::new(0.75, 0.25, -1e-17), DVec3::NEG_Z), Some(0))));
    let behind = CastRay::new(DVec3::new(0.75, 0.25, -1e-9), DVec3::NEG_Z);
    assert_eq!(rule(&mesh, &behind, Some(0)), CastRuling::Wrong);
}

#[test]
fn a_side_that_does_not_count_is_no_excuse() {
    let mesh = squares(&[0.0]);
    let exact = ExactCast::new(&mesh);
    let up = CastRay::new(DVec3::new(0.75, 0.25, -3.0), DVec3::Z);
    assert_eq!(exact.rule(&up, Sides::Fronts, None, Precision::F64), CastRuling::Same);
    assert_eq!(exact.rule(&up, Sides::Fronts, Some(FaceId(0)), Precision::F64), CastRuling::Wrong);
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
        ExactCast::new(&mesh).rule(&ray, Sides::Fronts, Some(FaceId(0)), Precision { unit_roundoff })
    };
    assert_eq!(rule(0.99 * least), CastRuling::Wrong);
    assert!(is_rounding(rule(1.01 * least)));
}
