//! Unit tests of `cast`: its bounds by their formulas, and what lies at them.

use std::cell::Cell;

use glam::{DVec3, Vec3A};
use obvhs::ray::Ray as BoxRay;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use raypencil_scene::FaceId;

use super::super::super::frame::Frame;
use super::super::super::in_box::{doubtful_below, moved_into_box};
use super::super::super::quad::Quad;
use super::super::*;
use super::{compare_many, mesh_of, within_one};
use crate::traced_ray::TracedRay;

/// The way from where a ray is traced: what is longer costs time, and what is shorter loses hits.
#[test]
fn the_way_to_a_hit_is_longer_than_it_by_little() {
    // Of short ways single precision has finer steps than the 2^-24 that is added.
    for (range, entry) in [(5.0, 3.0), (1.5, 0.0), (1e6, 1e6 - 2.5), (3.0, -1.0), (3.25, 3.0), (1.0, 1.0)] {
        let way = f64::from(way_to(range, entry));
        assert!(way >= range - entry && way < range - entry + 1e-5, "{way} from {entry} to {range}");
    }
    assert!(way_to(1e9, 0.0) < 6.001);
}

#[test]
fn a_ray_far_from_the_origin_of_coordinates_goes_through_the_tree_as_any_other() {
    let square = |at: f64| [[at - 1.0, at - 1.0, 0.0], [at + 1.0, at - 1.0, 0.0], [at, at + 1.0, 0.0]];
    for (at, from, expected) in [(0.0, 1e6, true), (1e5, -1e5, true), (1e6, 1e6, true), (0.0, 1e9, false)] {
        let frame = Frame::of(&mesh_of(&[square(at)]));
        let origin = DVec3::new(from, at, 1.0);
        let ray = CastRay::new(origin, DVec3::new(at, at, 0.0) - origin);
        let walk = frame.walk(&ray, &frame.ray(&ray));
        assert_eq!(matches!(walk, Walk::Tree { .. }), expected, "{walk:?} at {at} from {from}");
    }
    // Beside the box, and along an axis that keeps it there.
    let frame = Frame::of(&mesh_of(&[square(0.0)]));
    for along in [DVec3::X, DVec3::Y, DVec3::new(1.0, 1e-40, 0.0)] {
        let beside = CastRay::new(DVec3::new(0.0, 0.0, 3.0) - 4.0 * along, along);
        assert!(matches!(frame.walk(&beside, &frame.ray(&beside)), Walk::Nothing), "{along}");
    }
}

/// Where a face's t may be off, by the formula of its page; and a ray along a side of a face's box is not beside it.
#[test]
fn a_grazing_ray_is_judged_by_the_bound_and_by_the_box() {
    let corners = [[0.0, 0.0, 0.0], [2.0, 0.5, 0.0], [1.0, -4.0, 0.25]].map(DVec3::from_array);
    let [e, f, w] = [2.0, 4.0, 8.0];
    let bound = doubtful_below(corners, DVec3::new(-8.0, 1.0, 3.0));
    let expected = e * f * (w + e + f) / f64::from(1_u32 << 22);
    assert!((bound / expected - 1.0).abs() < 1e-12, "{bound:e}, {expected:e}");

    let (low, high) = (DVec3::new(0.0, -4.0, 0.0), DVec3::new(2.0, 0.5, 0.25));
    for (y, z) in [(low.y, low.z), (high.y, low.z), (low.y, high.z), (high.y, high.z)] {
        let origin = DVec3::new(-8.0, y, z);
        let along = |t: f64| moved_into_box(t, corners, origin, DVec3::X);
        let (before, within, behind) = (along(-3.0), along(9.0), along(99.0));
        assert!((before - 8.0).abs() < 1e-12 && within == 9.0 && (behind - 10.0).abs() < 1e-12, "{y}, {z}");
        assert!(
            moved_into_box(9.0, corners, origin + 1e-9 * DVec3::NEG_Y, DVec3::X).is_nan() == (y == low.y)
        );
        assert!(moved_into_box(9.0, corners, origin + 1e-9 * DVec3::Y, DVec3::X).is_nan() == (y == high.y));
    }
}

/// A quad refuses a face only beyond the bound of its page, 8 u s^2 + 96 u s + 1024 u^2 for corners at most s across the ray.
#[test]
fn a_quad_refuses_a_face_beyond_its_bound_and_not_before() {
    let u = 1.0 / f64::from(1 << 24);
    let down = TracedRay::new(DVec3::ZERO, DVec3::NEG_Z);
    let box_ray = BoxRay::new(Vec3A::ZERO, Vec3A::NEG_Z, 0.0, 6.0);
    // The side nearest to the ray is d beside it, and 2 s long: its edge function is 2 d s, those of the others are s^2.
    let is_asked = |d: f64, s: f64, is_turned: bool| {
        let (one, other) = if is_turned { (s, -s) } else { (-s, s) };
        let mesh = mesh_of(&[[[d, one, -2.0], [d, other, -2.0], [s, 0.0, -2.0]]]);
        let face = CastFace::of(&mesh, FaceId(0), 1.0);
        Quad::new(0, &[face], DVec3::ZERO).may_meet(&Sheared::new(&down, &box_ray)) == 1
    };
    for s in [1.0, 256.0 * u] {
        let bound = (8.0 * s * s + 96.0 * s + 1024.0 * u) * u;
        for is_turned in [false, true] {
            assert!(is_asked(0.99 * bound / (2.0 * s), s, is_turned), "{s} {is_turned}");
            assert!(!is_asked(1.01 * bound / (2.0 * s), s, is_turned), "{s} {is_turned}");
        }
    }
}

/// Roundings of coordinates grow with the distance from their origin: so do the boxes, up to where rays are traced without them.
#[test]
fn boxes_are_padded_by_the_roundings_of_their_place() {
    let square = |at: f64| [[at - 1.0, at - 1.0, 0.0], [at + 1.0, at - 1.0, 0.0], [at, at + 1.0, 0.0]];
    let few_roundings = 4.0 * f64::EPSILON;
    for at in [0.0, libm::scalbn(1.0, 30), libm::scalbn(1.0, 36)] {
        let frame = Frame::of(&mesh_of(&[square(at)]));
        let corners = square(at).map(|corner| frame.scale * DVec3::from_array(corner));
        let lowest = corners[0].x - frame.middle.x;
        let padding = lowest - f64::from(frame.padded_box(corners).min.x);
        // 64 u for the way and the point of entry; the box's side is rounded to f32, downward.
        let expected = 64.0 / f64::from(1 << 24) + few_roundings * frame.scale * (at + 1.0);
        assert!(padding >= expected && padding < expected + 1.0 / f64::from(1 << 22), "{at}: {padding:e}");
    }
    // Rays from one point start where the roundings are at most u: up to coordinates of 2^26, scaled.
    for (share, expected) in [(0.99, true), (1.01, false)] {
        let scaled = libm::scalbn(share, 26);
        let at = scaled / Frame::of(&mesh_of(&[square(0.0)])).scale;
        let frame = Frame::of(&mesh_of(&[square(at)]));
        let start = frame.start(DVec3::new(at, at, 1.0));
        assert_eq!(start.is_some(), expected, "{at:e}");
    }
}

/// A face whose box ends in one of its corners along the ray, and rays to it and little before it that graze the face by `share` of the
/// bound up to which its t may be off.
fn rays_that_graze_a_face(along: DVec3, beside: DVec3, share: f64) -> (Triangles, Vec<CastRay>) {
    let across = 0.2 * along.cross(beside).normalize();
    let (tip, end) = (0.7 * along, -0.8 * along);
    let mesh = mesh_of(&[[tip, end + across, end - across].map(|corner| corner.to_array())]);
    let face = CastFace::of(&mesh, FaceId(0), 1.0);
    let [a, b, c] = face.corners;
    let normal = (b - a).cross(c - a);
    let bound = doubtful_below(face.corners, a - (tip - 2.0 * along)) * along.length();
    let origin = tip - 2.0 * (along + share * bound / normal.length_squared() * normal);
    let ray = |k: u32| CastRay::new(origin, tip - 1e-10 * f64::from(k) * along - origin);
    (mesh, (0..16).map(ray).map(|ray| CastRay { direction: 0.5 * ray.direction, ..ray }).collect())
}

/// Up to the bound a t that is off is moved into the box, and beyond it is what it is, whichever way a ray is asked.
#[test]
fn a_ray_that_grazes_a_face_up_to_the_bound_meets_it_within_its_box() {
    let met = [Cell::new(0), Cell::new(0)];
    let mut ran = TestRunner::deterministic();
    let along = [0.8_f64..0.99, 0.8_f64..0.99, 0.8_f64..0.99].prop_map(DVec3::from_array);
    let share = prop_oneof![0.6_f64..0.9, 1.1_f64..1.3];
    ran.run(&(along, within_one(), share), |(along, beside, share)| {
        let (mesh, rays) = rays_that_graze_a_face(along, beside, share);
        let cast = TracerCast::new(&mesh);
        let high = mesh.bounds().unwrap()[1];
        for ray in &rays {
            let (face, scaled) = (&cast.tree.faces[0], cast.tree.frame.ray(ray));
            let [a, b, c] = face.corners;
            let (normal, offset) = ((b - a).cross(c - a), a - scaled.ray.origin);
            let (n_dot_q, length) = (normal.dot(scaled.ray.direction), scaled.ray.metres_per_t);
            let bound = doubtful_below(face.corners, offset);
            prop_assert_eq!(n_dot_q.abs() <= bound * length, share < 1.0);
            prop_assert!(n_dot_q.abs() > bound / length);
            let Some(hit) = cast.traverser().first(ray, Sides::Both) else { continue };
            let is_beyond = (hit.point - high).max_element() > 1e-13;
            match share < 1.0 {
                true => prop_assert!(!is_beyond, "{hit:?}"),
                false => prop_assert_eq!(hit.t, normal.dot(offset) / n_dot_q * scaled.t_per_t),
            }
            let counted = &met[usize::from(is_beyond)];
            counted.set(counted.get() + 1);
        }
        compare_many(&cast, &rays)
    })
    .unwrap();
    assert!(met[0].get() > 500 && met[1].get() > 50, "{met:?} rays met the face within the box and beyond");
}

/// What a packet has met shortens its way to that hit and not further: a nearer face may be just before it.
#[test]
fn a_packet_goes_on_up_to_the_nearest_hit_so_far() {
    // Corners beside a point of the diagonal, in the plane across it.
    let across = |at: f64, size: f64| {
        [0, 1, 2].map(|axis| [0, 1, 2].map(|k| if k == axis { at + 2.0 * size } else { at - size }))
    };
    // Four faces in one box that is entered early and met late; one in a small box before them; and two that make the mesh wide.
    let (far, near) = (across(-0.8, 0.19), across(-0.7, 0.05));
    let corner = [[0.99, 0.99, -0.99], [0.99, 0.9, -0.99], [0.9, 0.99, -0.99]];
    let other = [[-0.99, -0.99, 0.99], [-0.99, -0.9, 0.99], [-0.9, -0.99, 0.99]];
    let mesh = mesh_of(&[far, far, far, far, near, corner, other]);
    let cast = TracerCast::new(&mesh);
    // As long as a direction can be.
    let ray =
        |k: u32| CastRay::new(DVec3::splat(2.4), DVec3::new(-0.99, -0.99, -0.985 - 0.0005 * f64::from(k)));
    let rays: Vec<CastRay> = (0..16).map(ray).collect();
    assert_eq!(how_many_together(&rays), 16);
    let mut packet = Packet::EMPTY;
    assert!(packet.seek(&cast.tree, &mut cast.tree.boxes.stack(), &rays, Sides::Both));
    for (lane, ray) in rays.iter().enumerate() {
        assert_eq!(cast.traverser().all(ray, Sides::Both).len(), 5);
        assert_eq!(packet.nearest(lane, &cast.tree).map(|met| met.face.id), Some(FaceId(4)), "{lane}");
    }
}

/// Rays from one point are traced from it up to where the farthest box is 6 away, that distance included.
#[test]
fn rays_start_up_to_six_away_from_all_boxes() {
    let frame = Frame::of(&mesh_of(&[[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]]]));
    assert_eq!((frame.scale, frame.middle), (0.5, DVec3::ZERO));
    // The box of the mesh, with 64 u and the roundings of its coordinates, both twice.
    let padding = 63.0 / f64::from(1 << 24) + 1.0 / f64::from(1 << 24) + 4.0 * f64::EPSILON * 0.5;
    let half_width = DVec3::new(0.5, 0.5, 0.0) + DVec3::splat(2.0 * padding);
    let last = 6.0 - half_width.length();
    assert_eq!(last + half_width.length(), 6.0);
    assert!(frame.start(DVec3::Z * last / 0.5).is_some());
    assert!(frame.start(DVec3::Z * last.next_up() / 0.5).is_none());
}
