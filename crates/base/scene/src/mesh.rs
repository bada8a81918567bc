//! The terrain: triangles with a reflectivity each, stored as `f32` offsets from one `f64` origin.

use glam::DVec3;

use crate::SceneError;

/// A kind of ground: its name and its reflectivity.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name, for reports and files.
    pub name: String,
    /// Reflectivity r_d of the Lambertian surface, 0 to 1.
    pub reflectivity: f64,
}

/// The terrain as triangles, counter-clockwise seen from outside.
///
/// The normal of a face is n = (b - a) x (c - a). Faces of zero area are kept and counted, and never hit.
///
/// ```
/// use glam::DVec3;
/// use raypencil_scene::{Material, Mesh};
///
/// let ground = Material { name: "sand".into(), reflectivity: 0.25 };
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let mesh = Mesh::from_global(&corners, vec![[0, 1, 2], [0, 0, 1]], vec![0, 0], vec![ground])?;
/// // The second face has two corners in one place: it is kept, counted, and never hit.
/// assert_eq!((mesh.faces().len(), mesh.zero_area_faces()), (2, 1));
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Mesh {
    origin: DVec3,
    vertices: Vec<[f32; 3]>,
    faces: Vec<[u32; 3]>,
    face_materials: Vec<u16>,
    materials: Vec<Material>,
    zero_area_faces: usize,
    rounding: VertexRounding,
}

/// Vertices that moved when they were stored as `f32` offsets.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct VertexRounding {
    /// Number of vertices whose offset is no `f32` number.
    pub vertices: usize,
    /// Largest distance along an axis by which one was moved, metres.
    pub largest: f64,
}

/// Meshes are equal if all that a renderer can see of them is: how their vertices came about is not.
impl PartialEq for Mesh {
    fn eq(&self, other: &Self) -> bool {
        let parts = |mesh: &'_ Self| (mesh.origin, mesh.zero_area_faces);
        parts(self) == parts(other)
            && self.vertices == other.vertices
            && self.faces == other.faces
            && self.face_materials == other.face_materials
            && self.materials == other.materials
    }
}

impl VertexRounding {
    /// What storing these global vertices as `offsets` from the origin moved.
    fn of(vertices: &[DVec3], origin: DVec3, offsets: &[[f32; 3]]) -> Self {
        let moved = |(&vertex, offset): (&DVec3, &[f32; 3])| {
            // The difference in f64, and what it lost: exact (Knuth's two-sum of v and -o).
            let difference = vertex - origin;
            let of_origin = difference - vertex;
            let lost = (vertex - (difference - of_origin)) - (origin + of_origin);
            let stored = DVec3::from_array(offset.map(f64::from));
            ((difference - stored) + lost).abs().max_element()
        };
        let moved = vertices.iter().zip(offsets).map(moved).filter(|moved| *moved > 0.0);
        moved.fold(Self::default(), |kept, moved| Self {
            vertices: kept.vertices + 1,
            largest: kept.largest.max(moved),
        })
    }
}

/// Greatest distance of a vertex from the scene origin along an axis, metres: three radii of Mars. It keeps every product of
/// four coordinates far inside the range of `f64`, and box arithmetic inside that of `f32`.
const MAX_VERTEX_OFFSET_M: f32 = 1e7;

/// Global coordinates beyond this, metres, move the scene origin: `f32` offsets of 1 km are good to 0.06 mm.
const MAX_COORDINATE_WITHOUT_ORIGIN_M: f64 = 1e3;

impl Mesh {
    /// Builds a mesh from vertices that are already `f32` offsets from `origin` (global frame).
    ///
    /// `face_materials` holds an index into `materials` for each face.
    ///
    /// # Errors
    /// Names the first vertex that is not finite or beyond 1e7 m, the first face with an index out of
    /// bounds, the first material index out of bounds, the first reflectivity outside 0 to 1.
    pub fn new(
        origin: DVec3,
        vertices: Vec<[f32; 3]>,
        faces: Vec<[u32; 3]>,
        face_materials: Vec<u16>,
        materials: Vec<Material>,
    ) -> Result<Self, SceneError> {
        if !origin.is_finite() || origin.abs().max_element() > 1e12 {
            return Err(SceneError::new("mesh.origin", origin, "three numbers within 1e12 m"));
        }
        if let Some((index, [x, y, z])) = vertices
            .iter()
            .enumerate()
            .find(|(_, v)| !v.iter().all(|coordinate| coordinate.abs() <= MAX_VERTEX_OFFSET_M))
        {
            return Err(SceneError::new(
                format!("mesh.vertices[{index}]"),
                format!("({x}, {y}, {z})"),
                "three finite numbers within 1e7 m of the scene origin",
            ));
        }
        if faces.len() >= u32::MAX as usize {
            return Err(SceneError::new("mesh.faces", faces.len(), "fewer than 4294967295 faces"));
        }
        if let Some((index, face)) =
            faces.iter().enumerate().find(|(_, face)| !face.iter().all(|&v| (v as usize) < vertices.len()))
        {
            return Err(SceneError::new(
                format!("mesh.faces[{index}]"),
                format!("{face:?}"),
                format!("three vertex indices below {}", vertices.len()),
            ));
        }
        if face_materials.len() != faces.len() {
            return Err(SceneError::new(
                "mesh.face_materials",
                format!("{} entries", face_materials.len()),
                format!("one for each of the {} faces", faces.len()),
            ));
        }
        if let Some((index, material)) =
            face_materials.iter().enumerate().find(|(_, m)| **m as usize >= materials.len())
        {
            return Err(SceneError::new(
                format!("mesh.face_materials[{index}]"),
                material,
                format!("an index below {}", materials.len()),
            ));
        }
        if let Some((index, material)) =
            materials.iter().enumerate().find(|(_, m)| !(0.0..=1.0).contains(&m.reflectivity))
        {
            return Err(SceneError::new(
                format!("mesh.materials[{index}].reflectivity ({})", material.name),
                material.reflectivity,
                "0 to 1",
            ));
        }
        let zero_area_faces = faces.iter().filter(|face| has_zero_area(&vertices, face)).count();
        let rounding = VertexRounding::default();
        Ok(Self { origin, vertices, faces, face_materials, materials, zero_area_faces, rounding })
    }

    /// Builds a mesh from global `f64` vertices, placing the scene origin by the rule of
    /// [`Mesh::origin_for`] and rounding each offset once to `f32`.
    ///
    /// # Errors
    /// As [`Mesh::new`].
    pub fn from_global(
        vertices: &[DVec3],
        faces: Vec<[u32; 3]>,
        face_materials: Vec<u16>,
        materials: Vec<Material>,
    ) -> Result<Self, SceneError> {
        if let Some((index, vertex)) = vertices.iter().enumerate().find(|(_, v)| !v.is_finite()) {
            return Err(SceneError::new(format!("mesh.vertices[{index}]"), vertex, "three finite numbers"));
        }
        let origin = Self::origin_for(vertices);
        let offsets: Vec<[f32; 3]> = vertices.iter().map(|&v| (v - origin).as_vec3().to_array()).collect();
        let rounding = VertexRounding::of(vertices, origin, &offsets);
        Ok(Self { rounding, ..Self::new(origin, offsets, faces, face_materials, materials)? })
    }

    /// The scene origin for these global vertices: the whole metres nearest the centre of their bounding
    /// box if any |coordinate| exceeds 1 km, else 0.
    pub fn origin_for(vertices: &[DVec3]) -> DVec3 {
        let farthest = vertices.iter().fold(0.0_f64, |far, v| far.max(v.abs().max_element()));
        if farthest <= MAX_COORDINATE_WITHOUT_ORIGIN_M {
            return DVec3::ZERO;
        }
        let low = vertices.iter().fold(DVec3::INFINITY, |low, v| low.min(*v));
        let high = vertices.iter().fold(DVec3::NEG_INFINITY, |high, v| high.max(*v));
        // Halved before they are added, so that no sum overflows.
        (low * 0.5 + high * 0.5).round()
    }

    /// The scene origin in the global frame, metres.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// The vertices that moved when they were stored; none if they were offsets already.
    ///
    /// ```
    /// use glam::DVec3;
    /// use raypencil_scene::{Material, Mesh};
    ///
    /// // 0.1 is no f32 number: the nearest one is larger by 1.49e-9.
    /// let corners = [DVec3::ZERO, DVec3::new(0.1, 0.0, 0.0), DVec3::Y];
    /// let ground = Material { name: "sand".into(), reflectivity: 0.25 };
    /// let mesh = Mesh::from_global(&corners, vec![[0, 1, 2]], vec![0], vec![ground])?;
    /// assert_eq!(mesh.rounding().vertices, 1);
    /// assert!((mesh.rounding().largest - 1.49e-9).abs() < 1e-11);
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn rounding(&self) -> VertexRounding {
        self.rounding
    }

    /// Vertices in the scene frame, metres.
    pub fn vertices(&self) -> &[[f32; 3]] {
        &self.vertices
    }

    /// Three vertex indices per face, counter-clockwise from outside.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// Index into [`Mesh::materials`] of each face.
    pub fn face_materials(&self) -> &[u16] {
        &self.face_materials
    }

    /// The kinds of ground.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// How many faces have no area, judged in `f64` from the stored vertices.
    pub fn zero_area_faces(&self) -> usize {
        self.zero_area_faces
    }

    /// The smallest and largest coordinates in the scene frame, or `None` for a mesh without vertices.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        let widen = |v: &[f32; 3]| DVec3::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2]));
        let first = widen(self.vertices.first()?);
        let grow = |[low, high]: [DVec3; 2], v: &[f32; 3]| [low.min(widen(v)), high.max(widen(v))];
        Some(self.vertices.iter().fold([first, first], grow))
    }
}

/// Whether (b - a) x (c - a) vanishes.
fn has_zero_area(vertices: &[[f32; 3]], face: &[u32; 3]) -> bool {
    let [a, b, c] = face.map(|v| {
        let [x, y, z] = vertices[v as usize];
        DVec3::new(f64::from(x), f64::from(y), f64::from(z))
    });
    (b - a).cross(c - a) == DVec3::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ground() -> Vec<Material> {
        vec![Material { name: "ground".into(), reflectivity: 0.25 }]
    }

    fn triangle_at(offset: f64) -> Vec<DVec3> {
        [DVec3::ZERO, DVec3::X, DVec3::Y].map(|v| v + DVec3::new(offset, 0.0, 0.0)).to_vec()
    }

    #[test]
    fn the_origin_moves_only_for_far_ground() {
        assert_eq!(Mesh::origin_for(&triangle_at(999.0)), DVec3::ZERO);
        // Box centre (1000000.25, 0.5, 0), whole metres nearest: (1000000, 1, 0) (halves round away from 0).
        let far = triangle_at(999_999.75);
        assert_eq!(Mesh::origin_for(&far), DVec3::new(1_000_000.0, 1.0, 0.0));
        let mesh = Mesh::from_global(&far, vec![[0, 1, 2]], vec![0], ground()).unwrap();
        assert_eq!(mesh.vertices()[0], [-0.25, -1.0, 0.0]);
    }

    #[test]
    fn faces_without_area_are_kept_and_counted() {
        let faces = vec![[0, 1, 2], [0, 0, 1], [1, 2, 1]];
        let mesh = Mesh::from_global(&triangle_at(0.0), faces, vec![0; 3], ground()).unwrap();
        assert_eq!((mesh.faces().len(), mesh.zero_area_faces()), (3, 2));
    }

    #[test]
    fn each_wrong_field_is_named() {
        let build = |vertices: Vec<DVec3>, faces, materials: Vec<u16>, kinds| {
            Mesh::from_global(&vertices, faces, materials, kinds).unwrap_err().to_string()
        };
        let mut nan = triangle_at(0.0);
        nan[1].y = f64::NAN;
        assert!(build(nan, vec![[0, 1, 2]], vec![0], ground()).starts_with("mesh.vertices[1]"));
        let mut wide = triangle_at(0.0);
        wide[2].x = 1e9;
        assert!(build(wide, vec![[0, 1, 2]], vec![0], ground()).contains("within 1e7 m"));
        let message = build(triangle_at(0.0), vec![[0, 1, 2], [0, 1, 3]], vec![0, 0], ground());
        assert!(
            message.starts_with("mesh.faces[1] is [0, 1, 3]") && message.contains("below 3"),
            "{message}"
        );
        assert!(build(triangle_at(0.0), vec![[0, 1, 2]], vec![], ground()).contains("0 entries"));
        assert!(build(triangle_at(0.0), vec![[0, 1, 2]], vec![1], ground()).contains("face_materials[0]"));
        let bright = vec![Material { name: "chalk".into(), reflectivity: 1.5 }];
        assert!(build(triangle_at(0.0), vec![[0, 1, 2]], vec![0], bright).contains("(chalk) is 1.5"));
    }
}
