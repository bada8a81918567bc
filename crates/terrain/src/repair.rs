//! Mends what can be mended without a guess.

use raypencil_scene::Mesh;

use crate::inspect::{FaceStatus, MeshAnalysis, analyse};

/// What a repair did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Repairs {
    /// Faces without area that were dropped.
    pub zero_area_faces: usize,
    /// Copies of faces that were dropped; the first of each stays.
    pub duplicate_faces: usize,
    /// How many of these copies were of another material than the face that stays.
    pub duplicates_of_other_material: usize,
    /// Faces that were turned.
    pub turned_faces: usize,
    /// Vertices that gave way to an earlier one in the same place.
    pub welded_vertices: usize,
    /// Vertices of no face, or only of faces that were dropped, and dropped with them.
    pub unused_vertices: usize,
}

impl Repairs {
    /// Whether anything was changed.
    pub fn any(&self) -> bool {
        *self != Self::default()
    }
}

/// Repairs what needs no guess, and says what it did.
///
/// Faces without area and copies of faces are dropped: the first of all copies stays, which is the one that
/// renderers report, so that no hit moves and no reflectivity changes. Vertices in one place become one, vertices of
/// no face are dropped, faces that [`crate::Inspection::inverted`] counts are turned. No vertex moves, no hole
/// is filled; what stays keeps its order. A mesh that was repaired has nothing left to repair.
pub fn repair(mesh: &Mesh) -> (Mesh, Repairs) {
    let MeshAnalysis { inspection, welded, statuses } = analyse(mesh);
    let mut repairs = Repairs {
        zero_area_faces: inspection.zero_area.count,
        duplicate_faces: inspection.duplicates.count,
        duplicates_of_other_material: inspection.duplicates_of_other_material,
        turned_faces: inspection.inverted.count,
        welded_vertices: inspection.split_vertices.count,
        unused_vertices: 0,
    };
    let staying = inspection.faces - repairs.zero_area_faces - repairs.duplicate_faces;
    let (mut faces, mut face_materials) = (Vec::with_capacity(staying), Vec::with_capacity(staying));
    for ((corners, &material), status) in mesh.faces().iter().zip(mesh.face_materials()).zip(&statuses) {
        let [a, b, c] = corners.map(|vertex| welded[vertex as usize]);
        match status {
            FaceStatus::Sound => faces.push([a, b, c]),
            FaceStatus::Inverted => faces.push([a, c, b]),
            FaceStatus::ZeroArea | FaceStatus::Duplicate | FaceStatus::DuplicateOfOtherMaterial => continue,
        }
        face_materials.push(material);
    }
    drop(statuses);

    // Vertices that a face still uses, by their new numbers.
    let mut numbers = vec![u32::MAX; mesh.vertices().len()];
    for &vertex in faces.as_flattened() {
        numbers[vertex as usize] = 0;
    }
    let mut vertices = Vec::new();
    for (old, number) in numbers.iter_mut().enumerate() {
        if *number == 0 {
            *number = vertices.len() as u32;
            vertices.push(mesh.vertices()[old]);
        }
    }
    for vertex in faces.as_flattened_mut() {
        *vertex = numbers[*vertex as usize];
    }
    repairs.unused_vertices = mesh.vertices().len() - repairs.welded_vertices - vertices.len();
    let mesh = Mesh::new(mesh.origin(), vertices, faces, face_materials, mesh.materials().to_vec())
        .expect("parts of a mesh are a mesh");
    (mesh, repairs)
}
