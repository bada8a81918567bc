//! glTF and GLB: derived numbers for transforms, storage and hierarchies; the message for each malformed file; and
//! files that are written and read back.

pub(crate) mod any_bytes;
pub(crate) mod buffers;
pub(crate) mod container;
pub(crate) mod extensions;
pub(crate) mod scenes;
pub(crate) mod storage;
pub(crate) mod transforms;
pub(crate) mod written;

use std::path::Path;

use raypencil_mesh_io::{DEFAULT_REFLECTIVITY, mesh_from_bytes};
use raypencil_scene::Mesh;
use serde_json::Value;

use super::{glb, memory};
use glb::{SQUARE, glb, reals, square};

/// Reads a GLB. The error is its message.
fn parse(json: &Value, bin: &[u8]) -> Result<Mesh, String> {
    let parsed = mesh_from_bytes(&glb(json, bin), Path::new("test.glb"), DEFAULT_REFLECTIVITY);
    parsed.map_err(|error| error.to_string())
}

/// Reads the square with changed JSON.
fn changed(change: impl FnOnce(&mut Value)) -> Result<Mesh, String> {
    let (mut json, bin) = square();
    change(&mut json);
    parse(&json, &bin)
}

/// The vertices of a mesh.
fn vertices(mesh: &Mesh) -> Vec<[f32; 3]> {
    mesh.vertices().to_vec()
}

/// Asserts the message of a refusal.
fn refused(result: Result<Mesh, String>, message: &str) {
    let error = result.expect_err(message);
    assert_eq!(error, format!("test.glb: {message}"));
}
