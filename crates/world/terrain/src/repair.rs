//! Repair of the faults that can be mended without a guess.

use raypencil_scene::Mesh;

use crate::inspect::{FaceStatus, MeshAnalysis, analyse};

/// Changes made by a repair.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Repairs {
    /// Number of faces without area that were dropped.
    pub zero_area_faces: usize,
    /// Number of duplicate faces that were dropped; the first of each stays.
    pub duplicate_faces: usize,
    /// Number of these whose material differs from that of the face that stays.
    pub duplicate_faces_of_other_material: usize,
    /// Number of faces that were turned round.
    pub turned_faces: usize,
    /// Number of vertices that were merged into an earlier one in the same place.
    pub welded_vertices: usize,
    /// Number of dropped vertices: no face used them, or only dropped faces did.
    pub unused_vertices: usize,
}

impl Repairs {
    /// Whether anything was changed.
    pub fn any(&self) -> bool {
        *self != Self::default()
    }
}

/// Repairs a mesh where no guess is needed, and reports the changes.
///
/// * Faces without area and duplicate faces are dropped. The first of all duplicates stays: it is the one that
///   renderers report, so no hit moves and no reflectivity changes.
/// * Vertices in one place become one, and vertices without a face are dropped.
/// * Faces that [`crate::Inspection::inverted`] counts are turned round.
///
/// No vertex moves and no hole is filled. The remaining parts keep their order. A second repair changes nothing.
///
/// ```
/// use raypencil_terrain::{RandomGround, inspect, repair};
///
/// let nasty = RandomGround::nasty(7, 1_000);
/// let (mesh, repairs) = repair(&nasty.build().into_mesh()?);
/// // Every vertex that the generator left unused is gone, and the second repair finds nothing.
/// assert!(repairs.unused_vertices >= nasty.unreferenced_vertices);
/// assert_eq!(inspect(&mesh).unused_vertices.count, 0);
/// assert!(!repair(&mesh).1.any());
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
pub fn repair(mesh: &Mesh) -> (Mesh, Repairs) {
    let MeshAnalysis { inspection, welded, statuses } = analyse(mesh);
    let mut repairs = Repairs {
        zero_area_faces: inspection.zero_area.count,
        duplicate_faces: inspection.duplicates.count,
        duplicate_faces_of_other_material: inspection.duplicate_faces_of_other_material,
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

    // New numbers of the vertices that a face still uses.
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
