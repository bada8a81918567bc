//! Faces one by one: without area, slender, looking down.

use glam::DVec3;
use raypencil_scene::Mesh;

/// The mesh, as places in `f64`.
#[derive(Clone, Copy)]
pub(crate) struct MeshGeometry<'a> {
    pub(crate) mesh: &'a Mesh,
}

impl MeshGeometry<'_> {
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
