//! A ground far away, written by us: its node moves it to its place, and the file says so.
//!
//! Without that the scene origin follows from the vertices, which were rounded to single precision before they
//! were written: where the middle of the ground lies between two whole metres, it may follow otherwise than
//! before, and the mesh would not be the one that was written.

use glam::{DAffine3, DMat3, DVec3};
use gltf::json::Root;
use serde::Deserialize;

use crate::gltf::nodes::Placed;
use raypencil_scene::{Material, Mesh, SceneError};

/// `asset.extras.originM`, if the one node that has a mesh does nothing but move it there from 0.
pub(super) fn origin(root: &Root, placed: &[Placed]) -> Option<DVec3> {
    #[derive(Deserialize)]
    struct Extras {
        #[serde(rename = "originM")]
        origin: [f64; 3],
    }
    // What is not ours may be anything.
    let extras: Extras = serde_json::from_str(root.asset.extras.as_ref()?.get()).ok()?;
    let origin = DVec3::from_array(extras.origin);
    let mut drawn = placed.iter().filter(|placed| root.nodes[placed.node].mesh.is_some());
    let only = drawn.next().filter(|_| drawn.next().is_none())?;
    // z up becomes y up.
    let translation = DVec3::new(origin.x, origin.z, -origin.y);
    let moved = DAffine3 { matrix3: DMat3::IDENTITY, translation };
    (origin != DVec3::ZERO && only.file_from_node == moved).then_some(origin)
}

/// The mesh of vertices that are offsets from a stated `origin`, which is believed if it is the one that follows
/// from them, or the next whole metre.
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
