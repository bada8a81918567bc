//! The glTF file of an input pack: JSON and binary chunk.

use serde_json::{Value, json};

/// Corners of the mesh that nearly all nodes draw, in the file's axes. The first three are a triangle whose outside is
/// up (+y). No accessor counts the last two.
pub(super) const CORNERS: [[f32; 3]; 6] = [
    [0.25, 0.5, -0.125],
    [1.25, 0.75, -0.25],
    [0.5, 1.0, -1.5],
    [1.5, 0.25, -1.75],
    [0.75, 0.25, -0.5],
    [1.0, 0.5, -1.0],
];

/// A quaternion (x, y, z, w) whose rotation takes (x, y, z) to (z, x, y), exactly.
const TURN: [f32; 4] = [0.5, 0.5, 0.5, 0.5];

/// A quaternion whose rotation takes (x, y, z) to (-y, -z, x), exactly. Its w is unlike its x, so that the order matters.
const OTHER_TURN: [f32; 4] = [0.5, -0.5, 0.5, 0.5];

/// Translations along x as a map projection has them; the second takes off all but a quarter. In single precision the
/// first is 4,500,000, and nothing is left.
const ON_THE_MAP: f64 = 4_500_000.25;

const OFF_THE_MAP: f64 = -4_500_000.0;

/// Bytes of the binary chunk, and where each view of it begins and ends.
#[derive(Default)]
struct Binary {
    bytes: Vec<u8>,
    views: Vec<Value>,
}

impl Binary {
    /// Adds a view at the next multiple of four bytes, and returns its index.
    fn view(&mut self, bytes: &[u8], stride: Option<u32>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()});
        if let Some(stride) = stride {
            view["byteStride"] = stride.into();
        }
        self.views.push(view);
        self.bytes.extend(bytes);
        self.views.len() - 1
    }
}

fn bytes_of(numbers: impl IntoIterator<Item = f32>) -> Vec<u8> {
    numbers.into_iter().flat_map(f32::to_le_bytes).collect()
}

/// JSON and binary chunk.
pub(super) fn document() -> (Value, Vec<u8>) {
    let mut binary = Binary::default();
    let corners = binary.view(&bytes_of(CORNERS.into_iter().flatten()), None);
    // Each corner between two numbers that are none: a loader that ignores the stride reads them as coordinates.
    let between = |[x, y, z]: [f32; 3]| [64.0, x, y, z, 64.0];
    let interleaved = binary.view(&bytes_of(CORNERS.into_iter().flat_map(between)), Some(20));
    let shorts = |numbers: &[u16]| numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<_>>();
    let list = binary.view(&shorts(&[0, 1, 3]), None);
    let bytes = binary.view(&[0, 1, 3], None);
    let ints = binary.view(&[0_u32, 1, 3].map(u32::to_le_bytes).concat(), None);
    let row = binary.view(&shorts(&[0, 1, 2, 3]), None);
    let around = binary.view(&shorts(&[0, 1, 3, 2]), None);
    let flat = binary.view(&shorts(&[0, 0, 1, 0, 1, 3]), None);
    let other = binary.view(&shorts(&[0, 1, 2]), None);

    let vertices = |view: usize, offset: u32, count: u32| {
        json!({"bufferView": view, "byteOffset": offset, "componentType": 5126, "count": count, "type": "VEC3",
               "min": [0.25, 0.25, -1.75], "max": [1.5, 1.0, -0.125]})
    };
    let indices = |view: usize, kind: u32, count: u32| json!({"bufferView": view, "componentType": kind, "count": count, "type": "SCALAR"});
    let (unsigned_byte, unsigned_short, unsigned_int) = (5121, 5123, 5125);
    let accessors = json!([
        vertices(corners, 0, 4),
        vertices(corners, 0, 3),
        vertices(interleaved, 4, 4),
        indices(list, unsigned_short, 3),
        indices(bytes, unsigned_byte, 3),
        indices(ints, unsigned_int, 3),
        indices(row, unsigned_short, 4),
        indices(around, unsigned_short, 4),
        indices(flat, unsigned_short, 6),
        indices(other, unsigned_short, 3),
    ]);
    let (lines, triangles, strip, fan) = (1, 4, 5, 6);
    let primitive = |positions: u32, indices: u32, mode: u32| json!({"attributes": {"POSITION": positions}, "indices": indices, "mode": mode});
    let of_material = |material: u32, mut primitive: Value| {
        primitive["material"] = material.into();
        primitive
    };
    let meshes = json!([
        {"name": "plain", "primitives": [primitive(0, 3, triangles)]},
        {"name": "strip", "primitives": [primitive(0, 6, strip)]},
        {"name": "fan", "primitives": [primitive(0, 7, fan)]},
        {"name": "without-indices", "primitives": [{"attributes": {"POSITION": 1}}]},
        {"name": "byte-indices", "primitives": [primitive(0, 4, triangles)]},
        {"name": "int-indices", "primitives": [primitive(0, 5, triangles)]},
        {"name": "interleaved", "primitives": [primitive(2, 3, triangles)]},
        {"name": "primitives", "primitives": [
            primitive(0, 9, triangles), primitive(0, 6, lines), primitive(0, 3, triangles),
        ]},
        {"name": "faces-without-area", "primitives": [primitive(0, 8, triangles)]},
        {"name": "reflectivity", "primitives": [
            of_material(1, primitive(0, 3, triangles)), of_material(0, primitive(0, 9, triangles)),
        ]},
    ]);
    let nodes = json!([
        {"name": "primitives", "mesh": 7, "translation": [0.0, 0.0, 32.0]},
        {"name": "axes", "mesh": 0},
        {"name": "translation", "mesh": 0, "translation": [2.0, 0.5, -3.0]},
        {"name": "rotation", "mesh": 0, "rotation": OTHER_TURN},
        {"name": "scale", "mesh": 0, "scale": [2.0, 0.5, 4.0]},
        {"name": "parts-of-a-transform", "mesh": 0,
         "translation": [4.0, 0.0, 0.0], "rotation": TURN, "scale": [2.0, 1.0, 0.5]},
        {"name": "a child", "mesh": 0, "translation": [0.0, 2.0, 0.0], "scale": [1.0, 2.0, 1.0]},
        {"name": "parents", "translation": [8.0, 0.0, 0.0], "rotation": TURN, "children": [6]},
        {"name": "matrix", "mesh": 0, "matrix": [
            1.0, 0.0, 4.0, 0.0,   2.0, 1.0, 0.0, 0.0,   0.0, 0.5, 1.0, 0.0,   1.0, 0.0, -2.0, 1.0,
        ]},
        {"name": "mirroring", "mesh": 0, "translation": [0.0, 0.0, -12.0], "scale": [-1.0, 1.0, 1.0]},
        {"name": "a mirrored child", "mesh": 0, "scale": [-1.0, 1.0, 1.0]},
        {"name": "mirrored-twice", "translation": [0.0, 0.0, -16.0], "scale": [1.0, 1.0, -1.0], "children": [10]},
        {"name": "instances", "mesh": 0, "translation": [0.0, 4.0, 0.0]},
        {"name": "of another scene", "mesh": 0, "translation": [0.0, 8.0, 0.0]},
        {"name": "first child", "mesh": 0, "translation": [0.0, 0.0, 2.0]},
        {"name": "second child", "mesh": 0, "translation": [0.0, 0.0, 4.0]},
        {"name": "order-of-nodes", "mesh": 0, "translation": [20.0, 0.0, 0.0], "children": [15, 14]},
        {"name": "strip", "mesh": 1, "translation": [0.0, 0.0, 8.0]},
        {"name": "fan", "mesh": 2, "translation": [0.0, 0.0, 12.0]},
        {"name": "without-indices", "mesh": 3, "translation": [0.0, 0.0, 16.0]},
        {"name": "byte-indices", "mesh": 4, "translation": [0.0, 0.0, 20.0]},
        {"name": "int-indices", "mesh": 5, "translation": [0.0, 0.0, 24.0]},
        {"name": "interleaved", "mesh": 6, "translation": [0.0, 0.0, 28.0]},
        {"name": "faces-without-area", "mesh": 8, "translation": [0.0, 0.0, 36.0]},
        {"name": "reflectivity", "mesh": 9, "translation": [0.0, 0.0, 40.0]},
        {"name": "off the map", "mesh": 0, "translation": [OFF_THE_MAP, 0.0, 44.0]},
        {"name": "decimals", "translation": [ON_THE_MAP, 0.0, 0.0], "children": [25]},
    ]);
    let json = json!({
        "asset": {"version": "2.0", "generator": "raypencil"},
        // The default scene is the second one.
        "scene": 1,
        "scenes": [
            {"name": "another scene", "nodes": [13]},
            {"name": "default", "nodes": [
                1, 2, 3, 4, 5, 7, 8, 9, 11, 12, 16, 17, 18, 19, 20, 21, 22, 0, 23, 24, 26,
            ]},
        ],
        "nodes": nodes,
        "meshes": meshes,
        "materials": [
            {"name": "stated", "extras": {"reflectivity": 0.125}},
            {"name": "grey", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1.0]}},
        ],
        "accessors": accessors,
        "bufferViews": binary.views,
        "buffers": [{"byteLength": binary.bytes.len()}],
    });
    (json, binary.bytes)
}
