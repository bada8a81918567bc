//! An honest program in single precision: the planes of all faces, one after the other, in `f32` but for the ray, which it gets
//! rounded.

use glam::Vec3;
use raypencil::{FaceId, Mesh, Ray};

/// The face that this program hits first along a ray, by the contract's conditions, each as its formula stands there:
/// n = e1 x e2, t = n.(a - o) / n.q, and the side of each edge.
pub fn first_hit(mesh: &Mesh, ray: &Ray, max_range: f64) -> Option<FaceId> {
    let (o, q) = (ray.origin.as_vec3(), ray.direction.as_vec3());
    let mut first: Option<(f32, FaceId)> = None;
    for (index, face) in mesh.faces().iter().enumerate() {
        let corners = face.map(|v| Vec3::from_array(mesh.vertices()[v as usize]));
        let n = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let approach = n.dot(q);
        if approach >= 0.0 {
            continue;
        }
        let t = n.dot(corners[0] - o) / approach;
        let is_within = t >= 1.0 && t * q.length() <= max_range as f32;
        let is_inside = (0..3).all(|k| {
            let (a, along) = (corners[k] - o, corners[(k + 1) % 3] - corners[k]);
            q.dot(a.cross(along)) <= 0.0
        });
        if is_within && is_inside && first.is_none_or(|(nearest, _)| t < nearest) {
            first = Some((t, FaceId(index as u32)));
        }
    }
    first.map(|(_, face)| face)
}
