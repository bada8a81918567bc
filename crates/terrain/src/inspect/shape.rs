//! Faces one by one: without area, slender, looking down.

use glam::DVec3;
use raypencil_scene::Mesh;

use super::{Fate, Inspection, at_face};

/// The mesh, as places in `f64`.
#[derive(Clone, Copy)]
pub(crate) struct Shapes<'a> {
    pub(crate) mesh: &'a Mesh,
}

impl Shapes<'_> {
    /// A vertex in the scene frame.
    pub(super) fn vertex(&self, vertex: u32) -> DVec3 {
        let [x, y, z] = self.mesh.vertices()[vertex as usize].map(f64::from);
        DVec3::new(x, y, z)
    }

    /// The corners of a face in the scene frame.
    pub(super) fn corners(&self, face: u32) -> [DVec3; 3] {
        self.mesh.faces()[face as usize].map(|vertex| self.vertex(vertex))
    }

    /// (b - a) x (c - a): twice the area long, and 0 exactly where the mesh says that there is no area.
    pub(super) fn normal(&self, face: u32) -> DVec3 {
        let [a, b, c] = self.corners(face);
        (b - a).cross(c - a)
    }

    /// The middle of a face in the global frame.
    pub(super) fn middle(&self, face: u32) -> DVec3 {
        let [a, b, c] = self.corners(face);
        self.global((a + b + c) / 3.0)
    }

    /// From the scene frame to the global frame.
    pub(super) fn global(&self, place: DVec3) -> DVec3 {
        self.mesh.origin() + place
    }

    /// Numbers of all faces: a mesh has fewer than 2^32 of them.
    pub(super) fn faces(&self) -> std::ops::Range<u32> {
        0..self.mesh.faces().len() as u32
    }
}

/// Sets faces without area aside.
pub(super) fn find_zero_area(shapes: &Shapes, welded: &[u32], inspection: &mut Inspection) -> Vec<Fate> {
    let twice = |[a, b, c]: [u32; 3]| a == b || b == c || c == a;
    let fate = |face| {
        if shapes.normal(face) != DVec3::ZERO {
            return Fate::Sound;
        }
        let corners = shapes.mesh.faces()[face as usize];
        let kinds = &mut inspection.zero_area_kinds;
        let kind = if twice(corners) {
            &mut kinds.repeated_vertex
        } else if twice(corners.map(|vertex| welded[vertex as usize])) {
            &mut kinds.coincident_vertices
        } else {
            &mut kinds.collinear
        };
        *kind += 1;
        inspection.zero_area.add(|| at_face(face, shapes.middle(face)));
        Fate::ZeroArea
    };
    shapes.faces().map(fate).collect()
}

/// Measures the faces that stay.
pub(super) fn measure(shapes: &Shapes, fates: &[Fate], inspection: &mut Inspection) {
    for face in shapes.faces().filter(|&face| fates[face as usize].stays()) {
        let normal = shapes.normal(face);
        let twice_area = normal.length();
        let example = || at_face(face, shapes.middle(face));
        inspection.area += 0.5 * twice_area;
        // Only faces of less than 1e-150 m a side have a length of 0 here: they are no measure of anything.
        let [a, b, c] = shapes.corners(face);
        let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
        if twice_area > 0.0 {
            // length / width, and width = twice the area / length.
            let aspect = longest / twice_area;
            inspection.worst_aspect = inspection.worst_aspect.max(aspect);
            if aspect > Inspection::SLENDER {
                inspection.slender.add(example);
            }
        }
        if normal.z < 0.0 {
            inspection.down_area += 0.5 * twice_area;
            inspection.down.add(example);
        }
    }
}
