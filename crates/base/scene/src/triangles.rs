//! A triangle mesh with the vertices that its file gives, for rays that belong to no sensor.

use glam::DVec3;

use crate::{FaceId, Mesh, SceneError};

/// Triangles with `f64` vertices, in the frame and the unit of the file. No material, no origin, no rounding.
///
/// Faces count from 0. The front of a face is where its vertices are seen counter-clockwise; its normal is
/// n = (b - a) x (c - a). Faces of zero area are kept and counted, and never hit.
///
/// ```
/// use raypencil_scene::Triangles;
///
/// // 0.1 is no f32 number: it stays the f64 nearest to it.
/// let vertices = vec![[0.1, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let mesh = Triangles::new(vertices, vec![[0, 1, 2], [0, 0, 1]])?;
/// assert_eq!((mesh.vertices()[0][0], mesh.zero_area_faces()), (0.1, 1));
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Triangles {
    vertices: Vec<[f64; 3]>,
    faces: Vec<[u32; 3]>,
    zero_area_faces: usize,
}

/// Greatest coordinate of a vertex or of a ray's origin. It keeps products of six lengths far inside the range of `f64`.
pub(crate) const MAX_COORDINATE: f64 = 1e30;

impl Triangles {
    /// Builds a mesh.
    ///
    /// # Errors
    /// Names the first vertex with a coordinate that is not finite or beyond 1e30, and the first face with an index
    /// out of bounds.
    pub fn new(vertices: Vec<[f64; 3]>, faces: Vec<[u32; 3]>) -> Result<Self, SceneError> {
        let is_wrong = |v: &[f64; 3]| !v.iter().all(|coordinate| coordinate.abs() <= MAX_COORDINATE);
        if let Some((index, [x, y, z])) = vertices.iter().enumerate().find(|(_, v)| is_wrong(v)) {
            return Err(SceneError::new(
                format!("vertices[{index}]"),
                format!("({x}, {y}, {z})"),
                "three finite numbers within 1e30",
            ));
        }
        if faces.len() >= u32::MAX as usize {
            return Err(SceneError::new("faces", faces.len(), "fewer than 4294967295 faces"));
        }
        let is_wrong = |face: &[u32; 3]| face.iter().any(|&v| v as usize >= vertices.len());
        if let Some((index, face)) = faces.iter().enumerate().find(|(_, face)| is_wrong(face)) {
            return Err(SceneError::new(
                format!("faces[{index}]"),
                format!("{face:?}"),
                format!("three vertex indices below {}", vertices.len()),
            ));
        }
        let mut mesh = Self { vertices, faces, zero_area_faces: 0 };
        mesh.zero_area_faces =
            (0..mesh.faces.len() as u32).filter(|&id| mesh.has_zero_area(FaceId(id))).count();
        Ok(mesh)
    }

    /// The vertices.
    pub fn vertices(&self) -> &[[f64; 3]] {
        &self.vertices
    }

    /// Three vertex indices per face, counter-clockwise seen from its front.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// The corners of a face. The face must exist.
    pub fn corners(&self, face: FaceId) -> [DVec3; 3] {
        self.faces[face.0 as usize].map(|v| DVec3::from_array(self.vertices[v as usize]))
    }

    /// How many faces have no area, judged in `f64`: reports only. A face too thin for `f64` may count here and be
    /// hit all the same.
    pub fn zero_area_faces(&self) -> usize {
        self.zero_area_faces
    }

    /// The smallest and largest coordinates, or `None` for a mesh without vertices.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        let first = DVec3::from_array(*self.vertices.first()?);
        let grow = |[low, high]: [DVec3; 2], v: &[f64; 3]| {
            let v = DVec3::from_array(*v);
            [low.min(v), high.max(v)]
        };
        Some(self.vertices.iter().fold([first, first], grow))
    }

    fn has_zero_area(&self, face: FaceId) -> bool {
        let [a, b, c] = self.corners(face);
        (b - a).cross(c - a) == DVec3::ZERO
    }
}

/// The terrain of a scene, in the scene frame.
impl From<&Mesh> for Triangles {
    fn from(mesh: &Mesh) -> Self {
        let vertices = mesh.vertices().iter().map(|v| v.map(f64::from)).collect();
        Self { vertices, faces: mesh.faces().to_vec(), zero_area_faces: mesh.zero_area_faces() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_wrong_part_is_named() {
        let corners = || vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let message = |vertices, faces| Triangles::new(vertices, faces).unwrap_err().to_string();
        let mut wrong = corners();
        wrong[1][2] = f64::NAN;
        assert_eq!(
            message(wrong, vec![]),
            "vertices[1] is (1, 0, NaN): expected three finite numbers within 1e30"
        );
        let mut wrong = corners();
        wrong[2][0] = -1.1e30;
        assert!(message(wrong, vec![]).starts_with("vertices[2] is (-1"));
        assert_eq!(
            message(corners(), vec![[0, 1, 2], [0, 3, 1]]),
            "faces[1] is [0, 3, 1]: expected three vertex indices below 3"
        );
    }

    #[test]
    fn bounds_are_those_of_all_vertices() {
        let mesh = Triangles::new(vec![[1.0, -2.0, 3.0], [-1.0, 5.0, 0.0]], vec![]).unwrap();
        assert_eq!(mesh.bounds(), Some([DVec3::new(-1.0, -2.0, 0.0), DVec3::new(1.0, 5.0, 3.0)]));
        assert_eq!(Triangles::new(vec![], vec![]).unwrap().bounds(), None);
    }
}
