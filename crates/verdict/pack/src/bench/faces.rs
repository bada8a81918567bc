//! Faces that are added to a scene's mesh, given in the frame of a sensor.

use glam::DVec3;
use raypencil_scene::{Material, Mesh, Pose, SceneError};

/// A triangle in a sensor's frame (x right, y down, z forward), metres.
pub(super) type Triangle = [DVec3; 3];

/// Which side of a face the sensor's origin sees.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Front,
    Back,
}

/// The same triangle with its corners in the order in which `viewer` sees the given side.
pub(super) fn showing(side: Side, [a, b, c]: Triangle, viewer: DVec3) -> Triangle {
    let is_front = (b - a).cross(c - a).dot(a - viewer) < 0.0;
    if is_front == (side == Side::Front) { [a, b, c] } else { [a, c, b] }
}

/// The two triangles of a quadrilateral whose corners follow one another, cut from its first corner.
pub(super) fn halves([a, b, c, d]: [DVec3; 4]) -> [Triangle; 2] {
    [[a, b, c], [a, c, d]]
}

/// The same triangle with another corner first: corner `turn` of it.
pub(super) fn turned(triangle: Triangle, turn: usize) -> Triangle {
    [0, 1, 2].map(|k: usize| triangle[(k + turn) % 3])
}

/// Faces in the scene's frame, to be added to a mesh.
#[derive(Debug, Default)]
pub(super) struct AddedFaces {
    triangles: Vec<[[f32; 3]; 3]>,
}

impl AddedFaces {
    /// Adds triangles of a sensor's frame. Each coordinate is rounded to f32 once.
    pub(super) fn extend(&mut self, pose: &Pose, triangles: impl IntoIterator<Item = Triangle>) {
        let vertex = |corner: DVec3| (pose.position + pose.rotate(corner)).as_vec3().to_array();
        self.triangles.extend(triangles.into_iter().map(|triangle| triangle.map(vertex)));
    }

    /// Adds triangles of the scene's frame whose corners are numbers of f32.
    pub(super) fn extend_scene(&mut self, triangles: impl IntoIterator<Item = Triangle>) {
        let vertex = |corner: DVec3| corner.as_vec3().to_array();
        self.triangles.extend(triangles.into_iter().map(|triangle| triangle.map(vertex)));
    }

    /// A mesh with these faces after its own, of a material of this reflectivity.
    pub(super) fn added_to(&self, mesh: &Mesh, reflectivity: f64) -> Result<Mesh, SceneError> {
        let (mut vertices, mut faces) = (mesh.vertices().to_vec(), mesh.faces().to_vec());
        let (mut of_faces, mut materials) = (mesh.face_materials().to_vec(), mesh.materials().to_vec());
        let material = materials.len() as u16;
        materials.push(Material { name: "bench".into(), reflectivity });
        for triangle in &self.triangles {
            let first = vertices.len() as u32;
            vertices.extend(triangle);
            faces.push([first, first + 1, first + 2]);
            of_faces.push(material);
        }
        Mesh::new(mesh.origin(), vertices, faces, of_faces, materials)
    }
}
