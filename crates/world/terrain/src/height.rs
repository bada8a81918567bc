//! Height of the terrain above a point of the plane: where wheels and a rover's start position stand.

use glam::{DVec2, DVec3};
use raypencil_scene::Mesh;

/// Highest terrain point above the global point (x, y): global z in metres. `None` where no face looks up.
///
/// Only faces whose normal points up count. Vertical faces, undersides and faces without area do not. Under an
/// overhang the result is therefore the overhang's upper surface. Triangles are closed: edges and vertices belong
/// to them, and no point over a shared edge is missed (the source says why).
///
/// The search visits all faces. [`crate::HeightIndex`] is faster for many points.
///
/// ```
/// use raypencil_terrain::{builtin, height_at};
///
/// let mesh = builtin("pyramids", 0.25).expect("a built-in name").into_mesh()?;
/// // Ground within the plane of 40 x 40 m, none 300 m away.
/// assert_eq!(height_at(&mesh, 0.0, 0.0), Some(0.0));
/// assert_eq!(height_at(&mesh, 300.0, 0.0), None);
/// // One pyramid has its apex at (2.313, -0.827), 1.03 m high; `f32` rounding allows 5e-6 m.
/// let apex = height_at(&mesh, 2.313, -0.827).expect("ground");
/// assert!((apex - 1.03).abs() < 5e-6);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
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

/// Whether the normal (b - a) x (c - a) of a face points up.
pub(crate) fn looks_up([a, b, c]: &[DVec3; 3]) -> bool {
    (*b - *a).truncate().perp_dot((*c - *a).truncate()) > 0.0
}

/// Height of one closed triangle above a point, scene frame; `None` if it does not look up or lies elsewhere.
pub(crate) fn height_on_triangle([a, b, c]: [DVec3; 3], point: DVec2) -> Option<f64> {
    // Reject faces that do not look up.
    if !looks_up(&[a, b, c]) {
        return None;
    }
    // Corners relative to the point: one rounding each, the same in every face that shares the corner.
    let [p, q, r] = [a, b, c].map(|corner| corner.truncate() - point);
    // Twice the areas of the three triangles that the point forms with the sides, each named by the opposite
    // corner. Rounding is monotonic, so the difference of two rounded products has the sign of the exact one, or
    // is zero. It is also antisymmetric: the neighbour across an edge finds the opposite sign. Zero counts as
    // inside, hence there is no crack between faces.
    let [opposite_a, opposite_b, opposite_c] = [q.perp_dot(r), r.perp_dot(p), p.perp_dot(q)];
    if !(opposite_a >= 0.0 && opposite_b >= 0.0 && opposite_c >= 0.0) {
        return None;
    }
    // All three are zero only if the face is thinner than f64 resolves here: it has no height.
    let twice_area = opposite_a + opposite_b + opposite_c;
    if twice_area == 0.0 {
        return None;
    }
    Some(a.z + ((b.z - a.z) * opposite_b + (c.z - a.z) * opposite_c) / twice_area)
}

#[cfg(test)]
#[path = "../tests/unit/height.rs"]
mod tests;
