//! Triangles from glTF, STL, OBJ, PLY and NPY: the same mesh in every format, numbers as they are, and the message for
//! each malformed file.

pub(crate) mod any_bytes;
pub(crate) mod formats;
pub(crate) mod gltf;
pub(crate) mod hostile;
pub(crate) mod samples;

use std::path::Path;

use raypencil_mesh_io::triangles_from_bytes;
use raypencil_scene::Triangles;

use super::{glb, memory};

/// Reads the bytes of a file. The error is its message, without the file's name.
fn parse(name: &str, bytes: &[u8]) -> Result<Triangles, String> {
    triangles_from_bytes(bytes, Path::new(name)).map_err(|error| {
        let message = error.to_string();
        message.strip_prefix(&format!("{name}: ")).expect("messages start with the file").to_string()
    })
}

/// Bits of all coordinates.
fn bits(mesh: &Triangles) -> Vec<u64> {
    mesh.vertices().as_flattened().iter().map(|coordinate| coordinate.to_bits()).collect()
}

/// Asserts the message of a refusal.
#[track_caller]
fn refused(name: &str, bytes: impl AsRef<[u8]>, message: &str) {
    assert_eq!(parse(name, bytes.as_ref()).expect_err(message), message);
}
