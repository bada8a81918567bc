//! The faces sorted by their distance from a ray: the order in which a search tries them. Rounding errors change only
//! this order, so `f64` suffices.

use glam::{DVec3, Vec3};
use raypencil_scene::SensorId;

use crate::reduction::Reduction;

/// All faces, the nearest first. A face's distance is that from the ray in question; for a pencil also that from the
/// line of sight between its hit and the camera, if that is smaller. `None`: no ray is in question.
pub(crate) fn faces_by_distance(reduction: &Reduction) -> Option<Vec<u32>> {
    let place = reduction.place?;
    let scene = reduction.scene().ok()?;
    let ray = scene.ray(place.sensor, place.i, place.j)?;
    let far = scene.max_range(place.sensor)?;
    let corners =
        |face: &[u32; 3]| face.map(|v| Vec3::from_array(scene.mesh().vertices()[v as usize]).as_dvec3());
    let faces: Vec<[DVec3; 3]> = scene.mesh().faces().iter().map(corners).collect();

    let end = ray.origin + ray.direction * (far / ray.direction.length()).max(1.0);
    let mut segments = vec![[ray.origin, end]];
    if let SensorId::Beam(_) = place.sensor {
        let nearest = faces.iter().filter_map(|face| crossing(&segments[0], face)).fold(1.0, f64::min);
        let point = ray.origin + (end - ray.origin) * nearest;
        segments.push([point, scene.camera().scene_from_sensor.position]);
    }
    let nearest_distance = |face: &[DVec3; 3]| {
        segments.iter().map(|segment| distance(segment, face)).fold(f64::INFINITY, f64::min)
    };
    let distances: Vec<f64> = faces.iter().map(nearest_distance).collect();
    let mut order: Vec<u32> = (0..faces.len() as u32).collect();
    order.sort_by(|&a, &b| distances[a as usize].total_cmp(&distances[b as usize]).then(a.cmp(&b)));
    Some(order)
}

/// Where a segment crosses a face, from 0 at its start to 1 at its end. (T. Möller and B. Trumbore, 1997)
fn crossing([from, to]: &[DVec3; 2], &[a, b, c]: &[DVec3; 3]) -> Option<f64> {
    let (along, ab, ac) = (to - from, b - a, c - a);
    let p = along.cross(ac);
    let determinant = ab.dot(p);
    let s = from - a;
    let q = s.cross(ab);
    let (u, v, t) = (s.dot(p) / determinant, along.dot(q) / determinant, ac.dot(q) / determinant);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..=1.0).contains(&t)).then_some(t)
}

/// Distance of a segment from a face, metres: 0 if it crosses the face, else the distance from the nearest edge.
fn distance(segment: &[DVec3; 2], face: &[DVec3; 3]) -> f64 {
    if crossing(segment, face).is_some() {
        return 0.0;
    }
    let edges = [[face[0], face[1]], [face[1], face[2]], [face[2], face[0]]];
    edges.iter().map(|edge| segment_distance(segment, edge)).fold(f64::INFINITY, f64::min)
}

/// Distance of two segments, metres. (C. Ericson, "Real-Time Collision Detection", 2005, §5.1.9)
fn segment_distance(&[p, p_end]: &[DVec3; 2], &[q, q_end]: &[DVec3; 2]) -> f64 {
    let (d, e, r) = (p_end - p, q_end - q, p - q);
    let (dd, ee, f) = (d.length_squared(), e.length_squared(), e.dot(r));
    if ee == 0.0 {
        let s = (-d.dot(r) / dd).clamp(0.0, 1.0);
        return (r + d * s).length();
    }
    let (c, b) = (d.dot(r), d.dot(e));
    let denominator = dd * ee - b * b;
    let s = if denominator > 0.0 { ((b * f - c * ee) / denominator).clamp(0.0, 1.0) } else { 0.0 };
    let t = ((b * s + f) / ee).clamp(0.0, 1.0);
    let s = ((b * t - c) / dd).clamp(0.0, 1.0);
    (r + d * s - e * t).length()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEGMENT: [DVec3; 2] = [DVec3::ZERO, DVec3::new(0.0, 0.0, 10.0)];

    #[test]
    fn a_face_is_as_near_as_its_nearest_edge_and_0_away_if_crossed() {
        let face = |x: f64| [[x, -1.0, 4.0], [x + 2.0, -1.0, 4.0], [x, 3.0, 4.0]].map(DVec3::from_array);
        assert_eq!(crossing(&SEGMENT, &face(-0.5)), Some(0.4));
        assert_eq!(distance(&SEGMENT, &face(-0.5)), 0.0);
        // Its left edge is the line x = 3.
        assert_eq!(crossing(&SEGMENT, &face(3.0)), None);
        assert!((distance(&SEGMENT, &face(3.0)) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn the_distance_is_that_from_the_end_of_a_segment() {
        // An edge 3 m beyond the end and 4 m beside it; then an edge that is a point.
        let edge = [DVec3::new(4.0, 0.0, 13.0), DVec3::new(9.0, 0.0, 13.0)];
        assert!((segment_distance(&SEGMENT, &edge) - 5.0).abs() < 1e-12);
        assert!((segment_distance(&SEGMENT, &[edge[0]; 2]) - 5.0).abs() < 1e-12);
    }
}
