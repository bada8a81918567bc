//! Which faces are near a ray: the order in which a search tries them. It proposes only, so that plain `f64` will do.

use glam::{DVec3, Vec3};

use crate::draft::Draft;
use raypencil_scene::SensorId;

/// All faces, the nearest first: to the ray in question and, if it is a pencil's, to the way from what it meets to the
/// camera. `None` if no ray is.
pub(crate) fn by_nearness(draft: &Draft) -> Option<Vec<u32>> {
    let place = draft.place?;
    let scene = draft.scene().ok()?;
    let ray = scene.ray(place.sensor, place.i, place.j)?;
    let far = scene.max_range(place.sensor)?;
    let corners =
        |face: &[u32; 3]| face.map(|v| Vec3::from_array(scene.mesh().vertices()[v as usize]).as_dvec3());
    let faces: Vec<[DVec3; 3]> = scene.mesh().faces().iter().map(corners).collect();

    let end = ray.origin + ray.direction * (far / ray.direction.length()).max(1.0);
    let mut ways = vec![[ray.origin, end]];
    if let SensorId::Beam(_) = place.sensor {
        let met = faces.iter().filter_map(|face| crossing(&ways[0], face)).fold(1.0, f64::min);
        let point = ray.origin + (end - ray.origin) * met;
        ways.push([point, scene.camera().scene_from_sensor.position]);
    }
    let distance =
        |face: &[DVec3; 3]| ways.iter().map(|way| distance(way, face)).fold(f64::INFINITY, f64::min);
    let distances: Vec<f64> = faces.iter().map(distance).collect();
    let mut order: Vec<u32> = (0..faces.len() as u32).collect();
    order.sort_by(|&a, &b| distances[a as usize].total_cmp(&distances[b as usize]).then(a.cmp(&b)));
    Some(order)
}

/// Where a segment crosses a face, from 0 at its start to 1 at its end. (T. Moeller and B. Trumbore 1997)
fn crossing([from, to]: &[DVec3; 2], &[a, b, c]: &[DVec3; 3]) -> Option<f64> {
    let (along, ab, ac) = (to - from, b - a, c - a);
    let p = along.cross(ac);
    let determinant = ab.dot(p);
    let s = from - a;
    let q = s.cross(ab);
    let (u, v, t) = (s.dot(p) / determinant, along.dot(q) / determinant, ac.dot(q) / determinant);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..=1.0).contains(&t)).then_some(t)
}

/// How far a segment passes a face, metres: 0 if it crosses it, else from the nearest edge.
fn distance(way: &[DVec3; 2], face: &[DVec3; 3]) -> f64 {
    if crossing(way, face).is_some() {
        return 0.0;
    }
    let edges = [[face[0], face[1]], [face[1], face[2]], [face[2], face[0]]];
    edges.iter().map(|edge| between(way, edge)).fold(f64::INFINITY, f64::min)
}

/// The distance of two segments, metres. (C. Ericson, "Real-Time Collision Detection", 2005, §5.1.9)
fn between(&[p, p_end]: &[DVec3; 2], &[q, q_end]: &[DVec3; 2]) -> f64 {
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

    const WAY: [DVec3; 2] = [DVec3::ZERO, DVec3::new(0.0, 0.0, 10.0)];

    #[test]
    fn a_face_is_as_near_as_its_nearest_edge_and_0_away_if_crossed() {
        let face = |x: f64| [[x, -1.0, 4.0], [x + 2.0, -1.0, 4.0], [x, 3.0, 4.0]].map(DVec3::from_array);
        assert_eq!(crossing(&WAY, &face(-0.5)), Some(0.4));
        assert_eq!(distance(&WAY, &face(-0.5)), 0.0);
        // Its left edge is the line x = 3.
        assert_eq!(crossing(&WAY, &face(3.0)), None);
        assert!((distance(&WAY, &face(3.0)) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn segments_end() {
        // Beyond the end of the way, 3 m further and 4 m beside it; and an edge that is a point.
        let edge = [DVec3::new(4.0, 0.0, 13.0), DVec3::new(9.0, 0.0, 13.0)];
        assert!((between(&WAY, &edge) - 5.0).abs() < 1e-12);
        assert!((between(&WAY, &[edge[0]; 2]) - 5.0).abs() < 1e-12);
    }
}
