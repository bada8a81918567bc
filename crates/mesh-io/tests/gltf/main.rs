//! glTF and GLB: transforms, storage and hierarchies by derived numbers; each malformed file by its message;
//! what is written is read back.

pub(crate) mod any_bytes;
pub(crate) mod container;
pub(crate) mod scenes;
pub(crate) mod storage;
pub(crate) mod transforms;
pub(crate) mod written;

use serde_json::{Value, json};
use std::path::Path;

use raypencil_mesh_io::{DEFAULT_REFLECTIVITY, mesh_from_bytes};
use raypencil_scene::Mesh;

/// A GLB from its JSON and binary chunk.
fn glb(json: &Value, bin: &[u8]) -> Vec<u8> {
    let mut json = json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bin = bin.to_vec();
    bin.resize(bin.len().next_multiple_of(4), 0);
    let mut file = b"glTF\x02\0\0\0".to_vec();
    let length = 12 + 8 + json.len() + 8 + bin.len();
    file.extend((length as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &bin)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    file
}

fn reals(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// Four corners of a unit square in the plane y = 0 of the file: in the global frame (0, 0), (1, 0), (1, 1),
/// (0, 1) at z = 0, because y is -z.
const SQUARE: [f32; 12] = [0., 0., 0., 1., 0., 0., 1., 0., -1., 0., 0., -1.];

/// The square with u16 indices as two triangles; tests change the JSON.
fn square() -> (Value, Vec<u8>) {
    let mut bin = reals(&SQUARE);
    bin.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
    let json = json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "ground", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 12},
        ],
        "buffers": [{"byteLength": 60}],
    });
    (json, bin)
}

fn parse(json: &Value, bin: &[u8]) -> Result<Mesh, String> {
    let parsed = mesh_from_bytes(&glb(json, bin), Path::new("test.glb"), DEFAULT_REFLECTIVITY);
    parsed.map_err(|error| error.to_string())
}

/// The square after a change of its JSON.
fn changed(change: impl FnOnce(&mut Value)) -> Result<Mesh, String> {
    let (mut json, bin) = square();
    change(&mut json);
    parse(&json, &bin)
}

/// The vertices of a mesh that has those of the square under some transforms.
fn vertices(mesh: &Mesh) -> Vec<[f32; 3]> {
    mesh.vertices().to_vec()
}

fn refused(result: Result<Mesh, String>, message: &str) {
    let error = result.expect_err(message);
    assert_eq!(error, format!("test.glb: {message}"));
}
