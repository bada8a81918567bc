//! GLB files from any JSON and any bytes, well-formed or not. (glTF 2.0, section 4)

use serde_json::{Value, json};

/// Vertices of a unit square in the plane y = 0 of the file. In the global frame, where y is the file's -z, they are
/// (0, 0), (1, 0), (1, 1), (0, 1) at z = 0.
pub const SQUARE: [f32; 12] = [0., 0., 0., 1., 0., 0., 1., 0., -1., 0., 0., -1.];

/// Numbers as a buffer stores them.
pub fn reals(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// The JSON and the buffer of [`SQUARE`] as two triangles with 16-bit indices. A test changes either of them.
pub fn square() -> (Value, Vec<u8>) {
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

/// A GLB of a JSON chunk and a binary chunk, each padded to a multiple of four bytes.
///
/// ```
/// use raypencil_tests::glb::{glb, square};
///
/// // 12 bytes of header, 8 bytes of header for each of two chunks; 4 vertices of 12 bytes and 6 indices of 2 bytes.
/// let (json, bin) = square();
/// let json_length = json.to_string().len().next_multiple_of(4);
/// assert_eq!(glb(&json, &bin).len(), 12 + 8 + json_length + 8 + 60);
/// ```
pub fn glb(json: &Value, bin: &[u8]) -> Vec<u8> {
    let mut json = json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bin = bin.to_vec();
    bin.resize(bin.len().next_multiple_of(4), 0);
    container(&[(b"JSON", &json), (b"BIN\0", &bin)])
}

/// A GLB of any chunks, as they are.
pub fn container(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let length = 12 + chunks.iter().map(|(_, data)| 8 + data.len()).sum::<usize>();
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend((length as u32).to_le_bytes());
    for (kind, data) in chunks {
        file.extend((data.len() as u32).to_le_bytes());
        file.extend(*kind);
        file.extend(*data);
    }
    file
}
