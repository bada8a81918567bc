//! Scene origin that a file of this crate states: its node translates the ground by it.
//!
//! In other files the scene origin follows from the vertices. Those of a written file have been rounded to single
//! precision. If the middle of the ground lies between two whole metres, another origin could follow from the rounded
//! vertices, and the mesh would differ from the one that was written.

use glam::{DAffine3, DMat3, DVec3};
use gltf::json::Root;
use raypencil_scene::{Material, Mesh, SceneError};
use serde::Deserialize;

use crate::gltf::nodes::PlacedNode;

/// `asset.extras.originM`, if the only node with a mesh does nothing but translate it by that origin.
pub(super) fn origin(root: &Root, placed: &[PlacedNode]) -> Option<DVec3> {
    #[derive(Deserialize)]
    struct Extras {
        #[serde(rename = "originM")]
        origin: [f64; 3],
    }
    // The extras of other writers may be anything.
    let extras: Extras = serde_json::from_str(root.asset.extras.as_ref()?.get()).ok()?;
    let origin = DVec3::from_array(extras.origin);
    let mut drawn = placed.iter().filter(|placed| root.nodes[placed.node].mesh.is_some());
    let only = drawn.next().filter(|_| drawn.next().is_none())?;
    // z up becomes y up.
    let translation = DVec3::new(origin.x, origin.z, -origin.y);
    let moved = DAffine3 { matrix3: DMat3::IDENTITY, translation };
    (origin != DVec3::ZERO && only.file_from_node == moved).then_some(origin)
}

/// Mesh of vertices that are offsets from a stated `origin`.
///
/// The origin is used if it is at most 1 m per axis from the one that follows from the vertices. Otherwise the vertices
/// are taken for global ones.
pub(super) fn mesh(
    origin: DVec3,
    mut offsets: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    face_materials: Vec<u16>,
    materials: Vec<Material>,
) -> Result<Mesh, SceneError> {
    let low = offsets.iter().fold(DVec3::INFINITY, |low, v| low.min(*v));
    let high = offsets.iter().fold(DVec3::NEG_INFINITY, |high, v| high.max(*v));
    let rule = Mesh::origin_for(&[origin + low, origin + high]);
    if (rule - origin).abs().max_element() <= 1.0 {
        let offsets = offsets.iter().map(|offset| offset.as_vec3().to_array()).collect();
        return Mesh::new(origin, offsets, faces, face_materials, materials);
    }
    offsets.iter_mut().for_each(|vertex| *vertex += origin);
    Mesh::from_global(&offsets, faces, face_materials, materials)
}
