//! Positions and normals of a mesh in f64.

use glam::DVec3;
use raypencil_scene::Mesh;

/// The mesh with its geometry in `f64`.
#[derive(Clone, Copy)]
pub(crate) struct MeshGeometry<'a> {
    pub(crate) mesh: &'a Mesh,
}

impl MeshGeometry<'_> {
    /// Vertex, scene frame, metres.
    pub(super) fn vertex(&self, vertex: u32) -> DVec3 {
        let [x, y, z] = self.mesh.vertices()[vertex as usize].map(f64::from);
        DVec3::new(x, y, z)
    }

    /// Corners of a face, scene frame, metres.
    pub(super) fn corners(&self, face: u32) -> [DVec3; 3] {
        self.mesh.faces()[face as usize].map(|vertex| self.vertex(vertex))
    }

    /// Normal (b - a) x (c - a), of twice the area: 0 exactly where the mesh reports no area.
    pub(super) fn normal(&self, face: u32) -> DVec3 {
        let [a, b, c] = self.corners(face);
        (b - a).cross(c - a)
    }

    /// Centroid of a face, global frame, metres.
    pub(super) fn middle(&self, face: u32) -> DVec3 {
        let [a, b, c] = self.corners(face);
        self.global((a + b + c) / 3.0)
    }

    /// Conversion from the scene frame to the global frame.
    pub(super) fn global(&self, place: DVec3) -> DVec3 {
        self.mesh.origin() + place
    }

    /// Numbers of all faces. A mesh has fewer than 2^32.
    pub(super) fn faces(&self) -> std::ops::Range<u32> {
        0..self.mesh.faces().len() as u32
    }
}
