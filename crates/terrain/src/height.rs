//! How high the terrain stands above a point of the plane: what wheels and a rover's start need.

use glam::{DVec2, DVec3};
use raypencil_scene::Mesh;

/// Highest point of the terrain above the global point (x, y), global z in metres, from faces whose normal
/// points up; `None` where there is no such face. Triangles are closed: edges and vertices belong to them.
///
/// Under an overhang this is the overhang's upper surface. Vertical faces and undersides do not count, nor
/// do faces without area. A point over an edge that two faces share is never missed: see the source.
///
/// Goes through all faces: for a few points; [`crate::HeightIndex`] is for many.
pub fn height_at(mesh: &Mesh, x: f64, y: f64) -> Option<f64> {
    let origin = mesh.origin();
    let point = DVec2::new(x - origin.x, y - origin.y);
    let vertices = mesh.vertices();
    let mut highest: Option<f64> = None;
    for face in mesh.faces() {
        let corners = face.map(|v| {
            let [x, y, z] = vertices[v as usize];
            DVec3::new(f64::from(x), f64::from(y), f64::from(z))
        });
        if let Some(z) = height_on_triangle(corners, point) {
            highest = Some(highest.map_or(z, |top| top.max(z)));
        }
    }
    highest.map(|z| origin.z + z)
}

/// Height of one closed triangle above a point, all in the scene frame.
pub(crate) fn height_on_triangle([a, b, c]: [DVec3; 3], point: DVec2) -> Option<f64> {
    // Reject faces that do not look up.
    if !((b - a).perp_dot_xy(c - a) > 0.0) {
        return None;
    }
    // The corners seen from the point: one rounding each, the same in every face that shares the corner.
    let [p, q, r] = [a, b, c].map(|corner| corner.truncate() - point);
    // Twice the areas of the triangles that the point cuts the face into, each opposite its corner. Products
    // are rounded monotonically, so the difference of two has the sign that the exact one has, or is zero;
    // and it is antisymmetric, so the neighbour across an edge finds the opposite sign. Zero counts as
    // inside: hence no crack between faces.
    let [of_a, of_b, of_c] = [q.perp_dot(r), r.perp_dot(p), p.perp_dot(q)];
    if !(of_a >= 0.0 && of_b >= 0.0 && of_c >= 0.0) {
        return None;
    }
    // All three are zero only if the face is thinner than an f64 can tell from here: no height to give.
    let whole = of_a + of_b + of_c;
    if whole == 0.0 {
        return None;
    }
    Some(a.z + ((b.z - a.z) * of_b + (c.z - a.z) * of_c) / whole)
}

/// The z component of a cross product.
trait PerpDotXy {
    fn perp_dot_xy(self, other: Self) -> f64;
}

impl PerpDotXy for DVec3 {
    fn perp_dot_xy(self, other: Self) -> f64 {
        self.x * other.y - self.y * other.x
    }
}

#[cfg(test)]
#[path = "../tests/unit/height.rs"]
mod tests;
