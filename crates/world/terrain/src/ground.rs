//! Triangles under construction, and the shapes they are added as: height fields, boxes, pyramids, rocks,
//! mushrooms.

use glam::{DVec2, DVec3};
use raypencil_scene::{Material, Mesh, SceneError};

use crate::random_stream::RandomStream;

/// Triangles under construction, with global `f64` vertices. Faces are counter-clockwise from outside.
///
/// ```
/// use glam::DVec3;
/// use raypencil_scene::Material;
/// use raypencil_terrain::{Ground, height_at};
///
/// let ground = Ground {
///     vertices: vec![DVec3::ZERO, DVec3::new(4.0, 0.0, 0.0), DVec3::new(0.0, 4.0, 2.0)],
///     faces: vec![[0, 1, 2]],
///     face_materials: vec![0],
///     materials: vec![Material { name: "sand".into(), reflectivity: 0.25 }],
/// };
/// // The face is z = y / 2.
/// assert_eq!(height_at(&ground.into_mesh()?, 1.0, 1.0), Some(0.5));
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ground {
    /// Vertices in the global frame (z up), metres.
    pub vertices: Vec<DVec3>,
    /// Three vertex indices per face, counter-clockwise from outside.
    pub faces: Vec<[u32; 3]>,
    /// Index into `materials` for each face.
    pub face_materials: Vec<u16>,
    /// Materials of the ground.
    pub materials: Vec<Material>,
}

impl Ground {
    /// Mesh for the renderers: each vertex is rounded once to an `f32` offset from the scene origin.
    ///
    /// # Errors
    /// As [`Mesh::from_global`]: names the first invalid vertex, face or material.
    pub fn into_mesh(self) -> Result<Mesh, SceneError> {
        Mesh::from_global(&self.vertices, self.faces, self.face_materials, self.materials)
    }

    /// Adds a vertex and returns its index.
    pub(crate) fn add_vertex(&mut self, position: DVec3) -> u32 {
        let index = self.next_vertex();
        self.vertices.push(position);
        index
    }

    pub(crate) fn add_face(&mut self, corners: [u32; 3], material: u16) {
        self.faces.push(corners);
        self.face_materials.push(material);
    }

    fn next_vertex(&self) -> u32 {
        u32::try_from(self.vertices.len()).expect("a ground has fewer than 2^32 vertices")
    }

    /// Adds a height field of `columns x rows` cells, two faces each. `place` gives the position of the grid's
    /// corner (column, row).
    ///
    /// If columns run to the right and rows away, seen from above, all normals point up.
    ///
    /// `falling` chooses the diagonal of each cell: true for the one from the far left to the near right corner.
    pub(crate) fn add_height_field(
        &mut self,
        columns: u32,
        rows: u32,
        mut place: impl FnMut(u32, u32) -> DVec3,
        mut falling: impl FnMut() -> bool,
        mut material: impl FnMut() -> u16,
    ) {
        let first = self.next_vertex();
        for row in 0..=rows {
            for column in 0..=columns {
                self.vertices.push(place(column, row));
            }
        }
        for row in 0..rows {
            for column in 0..columns {
                // Corners a b c d of the cell, counter-clockwise from the near left one.
                let a = first + row * (columns + 1) + column;
                let (b, c, d) = (a + 1, a + columns + 2, a + columns + 1);
                let halves = if falling() { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] };
                for half in halves {
                    self.add_face(half, material());
                }
            }
        }
    }

    /// Adds a closed box of 12 faces: its centre, and the vectors from there to the centres of three sides. The
    /// three vectors must be right-handed; they need not be at right angles.
    pub(crate) fn add_box(&mut self, centre: DVec3, [u, v, w]: [DVec3; 3], material: u16) {
        // Corner 4k + 2j + i lies on the sides of u, v, w that the bits i, j, k choose.
        let first = self.next_vertex();
        let side = |bit: u32| if bit == 0 { -1.0 } else { 1.0 };
        for corner in 0..8 {
            let (i, j, k) = (side(corner & 1), side(corner >> 1 & 1), side(corner >> 2));
            self.vertices.push(centre + u * i + v * j + w * k);
        }
        // The sides, counter-clockwise from outside.
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        for [a, b, c, d] in sides.map(|side| side.map(|corner| first + corner)) {
            self.add_face([a, b, c], material);
            self.add_face([a, c, d], material);
        }
    }

    /// Adds a closed square pyramid of 6 faces: the centre of its base, half the side of the base, its height
    /// (metres), and its rotation about the vertical (radians).
    pub(crate) fn add_pyramid(
        &mut self,
        base: DVec3,
        half_side: f64,
        height: f64,
        rotation: f64,
        material: u16,
    ) {
        let (sin, cos) = libm::sincos(rotation);
        let first = self.next_vertex();
        for corner in [DVec2::new(-1.0, -1.0), DVec2::new(1.0, -1.0), DVec2::ONE, DVec2::new(-1.0, 1.0)] {
            let DVec2 { x, y } = corner * half_side;
            self.vertices.push(base + DVec3::new(cos * x - sin * y, sin * x + cos * y, 0.0));
        }
        let apex = self.add_vertex(base + DVec3::new(0.0, 0.0, height));
        for corner in 0..4 {
            self.add_face([first + corner, first + (corner + 1) % 4, apex], material);
        }
        // The base looks down.
        self.add_face([first, first + 2, first + 1], material);
        self.add_face([first, first + 3, first + 2], material);
    }

    /// Adds a closed, irregular rock of 32 faces: an octahedron with every face cut in four, projected onto a
    /// sphere. Each vertex then moves along its own radius, and `half_axes` stretch the whole.
    ///
    /// Each vertex keeps its direction from the centre. The rock therefore stays star-shaped, and its faces look
    /// outward.
    pub(crate) fn add_rock(
        &mut self,
        centre: DVec3,
        half_axes: DVec3,
        random: &mut RandomStream,
        material: u16,
    ) {
        // The six corners +x -x +y -y +z -z, then the midpoints of the twelve edges.
        let corner = |index: usize| DVec3::AXES[index / 2] * if index & 1 == 0 { 1.0 } else { -1.0 };
        const OCTAHEDRON_EDGES: [[usize; 2]; 12] =
            [[0, 2], [0, 3], [0, 4], [0, 5], [1, 2], [1, 3], [1, 4], [1, 5], [2, 4], [2, 5], [3, 4], [3, 5]];
        // A random orientation, so that no two rocks look alike: an orthonormal frame about a random axis.
        let z = random.unit_vector();
        let x = z.cross(random.unit_vector()).normalize_or(z.any_orthonormal_vector());
        let y = z.cross(x);
        let first = self.next_vertex();
        let middles = OCTAHEDRON_EDGES.iter().map(|&[a, b]| (corner(a) + corner(b)) / f64::sqrt(2.0));
        for unit in (0..6).map(corner).chain(middles) {
            let turned = x * unit.x + y * unit.y + z * unit.z;
            self.vertices.push(centre + turned * half_axes * random.between(0.75, 1.1));
        }
        let middle_of = |a: usize, b: usize| {
            let edge = [a.min(b), a.max(b)];
            6 + OCTAHEDRON_EDGES.iter().position(|e| *e == edge).expect("an edge of the octahedron")
        };
        for octant in 0..8_usize {
            // The bits choose the corners on the x, y and z axes. Mirroring one axis reverses the order.
            let (a, b, c) = (octant & 1, 2 + (octant >> 1 & 1), 4 + (octant >> 2));
            let (b, c) = if octant.count_ones() % 2 == 0 { (b, c) } else { (c, b) };
            let (ab, bc, ca) = (middle_of(a, b), middle_of(b, c), middle_of(c, a));
            for quarter in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
                self.add_face(quarter.map(|v| first + v as u32), material);
            }
        }
    }

    /// Adds a closed mushroom of `8 sides` faces: a stem under a wider cap, a body of revolution about the
    /// vertical through `foot`, with `sides` sides and a rough rim.
    pub(crate) fn add_mushroom(
        &mut self,
        foot: DVec3,
        height: f64,
        cap_radius: f64,
        sides: u32,
        random: &mut RandomStream,
        material: u16,
    ) {
        // The profile from bottom to top, as fractions of (radius, height): stem, underside, rim, top.
        const PROFILE: [(f64, f64); 4] = [(0.40, 0.0), (0.30, 0.60), (1.0, 0.72), (0.60, 0.95)];
        let rotation = random.uniform();
        let rim: Vec<f64> = (0..sides).map(|_| random.between(0.8, 1.0)).collect();
        let bottom = self.add_vertex(foot);
        let first = self.next_vertex();
        for (radius, level) in PROFILE {
            for side in 0..sides {
                let angle = std::f64::consts::TAU * ((f64::from(side) + rotation) / f64::from(sides));
                let (sin, cos) = libm::sincos(angle);
                // One factor for each meridian, so that neighbouring rings never cross.
                let r = cap_radius * radius * rim[side as usize];
                self.vertices.push(foot + DVec3::new(r * cos, r * sin, level * height));
            }
        }
        let top = self.add_vertex(foot + DVec3::new(0.0, 0.0, height));
        let ring = |level: u32, side: u32| first + level * sides + side % sides;
        let last = PROFILE.len() as u32 - 1;
        for side in 0..sides {
            self.add_face([bottom, ring(0, side + 1), ring(0, side)], material);
            for level in 0..last {
                let (a, b) = (ring(level, side), ring(level, side + 1));
                let (c, d) = (ring(level + 1, side + 1), ring(level + 1, side));
                self.add_face([a, b, c], material);
                self.add_face([a, c, d], material);
            }
            self.add_face([ring(last, side), ring(last, side + 1), top], material);
        }
    }
}

#[cfg(test)]
#[path = "../tests/unit/ground.rs"]
pub(crate) mod tests;
