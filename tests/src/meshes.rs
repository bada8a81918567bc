//! The same ground in other meshes: other faces, other vertices.

use std::sync::Arc;

use raypencil::Mesh;

/// A mesh with the origin and the materials of `original`. Every face gets the first material.
pub fn remeshed(original: &Mesh, vertices: Vec<[f32; 3]>, faces: Vec<[u32; 3]>) -> Arc<Mesh> {
    let kinds = vec![0; faces.len()];
    let materials = original.materials().to_vec();
    Arc::new(Mesh::new(original.origin(), vertices, faces, kinds, materials).expect("a mesh"))
}

/// The same faces, each on three vertices of its own.
pub fn unindexed(original: &Mesh) -> Arc<Mesh> {
    let corners = original.faces().iter().flatten();
    let vertices = corners.map(|&v| original.vertices()[v as usize]).collect();
    let faces = (0..original.faces().len() as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]);
    remeshed(original, vertices, faces.collect())
}
