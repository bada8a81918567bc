//! Mistakes of the rays: candidates of a small tracer that has them.

use glam::DVec3;
use raypencil_judge::{Quantity, Recorded};
use raypencil_scene::{FaceId, Maybe, SensorId};

use super::candidates::*;
use super::one::assert_explained;

/// How a tracer goes wrong.
#[derive(Debug, Clone, Copy)]
pub struct Tracer {
    pub backs: bool,
    pub t_min: f64,
    pub max_range: f64,
    pub offset: [f64; 2],
}

pub const RIGHT: Tracer = Tracer { backs: false, t_min: 1.0, max_range: 40.0, offset: [0.0; 2] };

/// Faces, ranges and depths of the walls by a tracer. The camera stands at the origin and looks along z, so that the
/// ray of pixel (i, j) is written down at once; a face is hit where the barycentric coordinates are positive.
pub fn traced(tracer: Tracer) -> Recorded {
    let bench = walls();
    let mut candidate =
        only(&bench.exact, &[Quantity::Face, Quantity::Range, Quantity::Depth, Quantity::Point]);
    let camera = &bench.scene.camera().sensor;
    let mesh = bench.scene.mesh();
    let vertex = |index: u32| DVec3::from_array(mesh.vertices()[index as usize].map(f64::from));
    for j in 0..camera.height {
        for i in 0..camera.width {
            let q = DVec3::new(
                (f64::from(i) + 0.5 + tracer.offset[0] - 32.0) * 0.0625,
                (f64::from(j) + 0.5 + tracer.offset[1] - 24.0) * 0.0625,
                2.0,
            );
            let hits = mesh.faces().iter().enumerate().filter_map(|(index, face)| {
                let [a, b, c] = face.map(vertex);
                let n = (b - a).cross(c - a);
                let t = n.dot(a) / n.dot(q);
                let p = q * t;
                let is_inside =
                    [(a, b), (b, c), (c, a)].iter().all(|(u, v)| (*v - *u).cross(p - *u).dot(n) >= 0.0);
                let is_hit = is_inside
                    && (tracer.backs || n.dot(q) < 0.0)
                    && t >= tracer.t_min
                    && t * q.length() <= tracer.max_range;
                is_hit.then_some((t, index as u32))
            });
            let nearest = hits.min_by(|a, b| a.0.total_cmp(&b.0));
            let map = &mut candidate.answers.maps[0];
            let t = nearest.map(|(t, _)| t);
            map.face.as_mut().unwrap().set(i, j, nearest.map(|(_, face)| FaceId(face)).into());
            map.range.as_mut().unwrap().set(i, j, t.map(|t| t * q.length()).into());
            map.depth.as_mut().unwrap().set(i, j, t.map(|t| t * 2.0).into());
            map.point.as_mut().unwrap().set(i, j, t.map(|t| q * t).into());
        }
    }
    candidate
}

/// The same without faces.
pub fn without_faces(candidate: &Recorded) -> Recorded {
    only(candidate, &[Quantity::Range, Quantity::Depth, Quantity::Point])
}

#[test]
fn the_small_tracer_is_right_without_a_mistake() {
    let found = raypencil_judge::check(&walls().truth, &traced(RIGHT), &raypencil_scene::Silent);
    assert!(found.passes(), "{:?}", found.sensors[0].defects.first());
    assert_eq!(walls().explanation(&traced(RIGHT)), None);
}

#[test]
fn wrong_rules_of_rays_are_named() {
    for (tracer, key) in [
        (Tracer { backs: true, ..RIGHT }, "backs_hit"),
        (Tracer { t_min: 0.0, ..RIGHT }, "near_plane_ignored"),
        (Tracer { max_range: 1e9, ..RIGHT }, "maximum_range_ignored"),
        (Tracer { offset: [-0.5, -0.5], ..RIGHT }, "corner_rays"),
        (Tracer { offset: [0.5, 0.5], ..RIGHT }, "corner_rays"),
    ] {
        let candidate = traced(tracer);
        assert_explained(walls(), &candidate, &[key]);
        assert_explained(walls(), &without_faces(&candidate), &[key]);
        assert_explained(walls(), &only(&candidate, &[Quantity::Range]), &[key]);
    }
}

#[test]
fn a_wrong_rule_and_another_mistake_are_named_together() {
    let mut backs = traced(Tracer { backs: true, ..RIGHT });
    moved(&mut backs, |_, h, i, j| (i, h - 1 - j));
    assert_explained(walls(), &backs, &["rows_reversed", "backs_hit"]);
    let mut far = traced(Tracer { max_range: 1e9, ..RIGHT });
    super::one::in_units(&mut far, 1e3);
    assert_explained(walls(), &far, &["millimetres", "maximum_range_ignored"]);
    // Two rules of rays.
    for (tracer, keys) in [
        (Tracer { backs: true, t_min: 0.0, ..RIGHT }, ["backs_hit", "near_plane_ignored"]),
        (Tracer { backs: true, max_range: 1e9, ..RIGHT }, ["backs_hit", "maximum_range_ignored"]),
        (Tracer { t_min: 0.0, max_range: 1e9, ..RIGHT }, ["near_plane_ignored", "maximum_range_ignored"]),
        (Tracer { backs: true, offset: [-0.5, -0.5], ..RIGHT }, ["backs_hit", "corner_rays"]),
    ] {
        assert_explained(walls(), &traced(tracer), &keys);
    }
    let mut near = traced(Tracer { t_min: 0.0, ..RIGHT });
    near.answers.maps[0].range = near.answers.maps[0].depth.clone();
    assert_explained(walls(), &near, &["depth_for_range", "near_plane_ignored"]);
}

#[test]
fn a_face_that_random_rays_lose_is_no_rule() {
    let mut candidate = traced(RIGHT);
    let map = &mut candidate.answers.maps[0];
    assert_eq!(map.sensor, SensorId::Camera);
    for index in (0..64 * 48).step_by(5) {
        map.face.as_mut().unwrap().cells_mut()[index] = Maybe::NONE;
        map.range.as_mut().unwrap().cells_mut()[index] = Maybe::NONE;
        map.depth.as_mut().unwrap().cells_mut()[index] = Maybe::NONE;
        map.point.as_mut().unwrap().cells_mut()[index] = Maybe::NONE;
    }
    assert_eq!(walls().explanation(&candidate), None);
}
