//! One small mesh in every format. All its numbers are single-precision ones, so that every format holds it.

use serde_json::json;

use super::glb::{glb, reals};

/// Vertices, in the order in which the faces use them.
pub(crate) const VERTICES: [[f64; 3]; 5] = [
    [0.5, -0.25, 3.0],
    [1e-7_f32 as f64, 0.0, 1.0],
    [0.1_f32 as f64, 2.0, -7.5],
    [4.0, 1e20_f32 as f64, 0.0],
    [-1.0, -2.0, 8.0],
];

/// Faces.
pub(crate) const FACES: [[u32; 3]; 3] = [[0, 1, 2], [0, 2, 3], [3, 2, 4]];

/// Corners of all faces, in single precision.
fn corners() -> impl Iterator<Item = [f32; 3]> {
    FACES.into_iter().flatten().map(|vertex| VERTICES[vertex as usize].map(|coordinate| coordinate as f32))
}

pub(crate) fn binary_stl() -> Vec<u8> {
    let mut file = vec![b' '; 80];
    // As some programs write it.
    file[..5].copy_from_slice(b"solid");
    file.extend((FACES.len() as u32).to_le_bytes());
    let corners: Vec<_> = corners().collect();
    for face in corners.chunks(3) {
        file.extend(reals(&[0.0, 0.0, 1.0]));
        file.extend(reals(face.as_flattened()));
        file.extend([7, 0]);
    }
    file
}

pub(crate) fn text_stl() -> Vec<u8> {
    let mut file = "solid any name facet\n".to_string();
    let corners: Vec<_> =
        FACES.into_iter().map(|face| face.map(|vertex| VERTICES[vertex as usize])).collect();
    for face in corners {
        file += "  facet normal 0 0 1\n    outer loop\n";
        for [x, y, z] in face {
            file += &format!("      vertex {x:e} {y} {z}\n");
        }
        file += "    endloop\n  endfacet\n";
    }
    (file + "endsolid any name\n").into_bytes()
}

pub(crate) fn obj() -> Vec<u8> {
    let mut file = "# a comment\nmtllib none.mtl\no rock\n".to_string();
    for [x, y, z] in VERTICES {
        file += &format!("v {x} {y} {z}\n");
    }
    file += "vt 0 0\nvn 0 0 1\ns off\n";
    // Faces 0 and 1 as one polygon; each form of a corner.
    (file + "f 1/1/1 -4/1 3//1 4\nf 4 3 5\n").into_bytes()
}

/// Text before the numbers of a PLY file.
pub(crate) fn ply_header(format: &str, real: &str, length: &str, index: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\ncomment of any kind\nelement vertex 5\nproperty {real} x\nproperty uchar red\n\
         property {real} y\nproperty {real} z\nelement face 2\nproperty list {length} {index} vertex_indices\n\
         property list uchar float weights\nelement edge 1\nproperty int vertex1\nend_header\n"
    )
}

pub(crate) fn text_ply() -> Vec<u8> {
    let mut file = ply_header("ascii", "float", "uchar", "int");
    for [x, y, z] in VERTICES {
        file += &format!("{x:e} 255 {y} {z}\n");
    }
    (file + "4 0 1 2 3 0\n3 3 2 4 2 0.5 0.5\n17\n").into_bytes()
}

/// Binary PLY in single or double precision.
pub(crate) fn binary_ply(big_endian: bool, double: bool) -> Vec<u8> {
    let format = if big_endian { "binary_big_endian" } else { "binary_little_endian" };
    let real = if double { "double" } else { "float32" };
    let mut file = ply_header(format, real, "uint16", "uint").into_bytes();
    let mut put = |bytes: &mut [u8]| {
        if big_endian {
            bytes.reverse();
        }
        file.extend_from_slice(bytes);
    };
    for [x, y, z] in VERTICES {
        let mut real = |number: f64| match double {
            true => put(&mut number.to_le_bytes()),
            false => put(&mut (number as f32).to_le_bytes()),
        };
        real(x);
        // A byte is the same in either order; it goes between x and y.
        put(&mut [255]);
        let mut real = |number: f64| match double {
            true => put(&mut number.to_le_bytes()),
            false => put(&mut (number as f32).to_le_bytes()),
        };
        real(y);
        real(z);
    }
    for (polygon, weights) in [(&[0_u32, 1, 2, 3][..], 0), (&[3, 2, 4], 2)] {
        put(&mut (polygon.len() as u16).to_le_bytes());
        polygon.iter().for_each(|index| put(&mut index.to_le_bytes()));
        put(&mut [weights]);
        (0..weights).for_each(|_| put(&mut 0.5_f32.to_le_bytes()));
    }
    put(&mut 17_i32.to_le_bytes());
    file
}

/// GLB with the vertices as they are, under a node without a transform.
pub(crate) fn binary_gltf() -> Vec<u8> {
    let numbers: Vec<f32> = VERTICES.as_flattened().iter().map(|number| *number as f32).collect();
    let mut bin = reals(&numbers);
    bin.extend(FACES.as_flattened().iter().flat_map(|index| (*index as u16).to_le_bytes()));
    let json = json!({
        "asset": {"version": "2.0"},
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 5, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 9, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 60},
            {"buffer": 0, "byteOffset": 60, "byteLength": 18},
        ],
        "buffers": [{"byteLength": 78}],
    });
    glb(&json, &bin)
}

/// NPY file of rows of three numbers, which are given as bytes.
pub(crate) fn npy(descr: &str, rows: u64, numbers: &[u8]) -> Vec<u8> {
    let text = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({rows}, 3), }}\n");
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((text.len() as u16).to_le_bytes());
    file.extend(text.bytes());
    file.extend(numbers);
    file
}

/// Vertices in double precision.
pub(crate) fn npy_vertices() -> Vec<u8> {
    let numbers: Vec<u8> = VERTICES.as_flattened().iter().flat_map(|number| number.to_le_bytes()).collect();
    npy("<f8", 5, &numbers)
}

/// Faces as big-endian 64-bit integers.
pub(crate) fn npy_faces() -> Vec<u8> {
    let numbers: Vec<u8> =
        FACES.as_flattened().iter().flat_map(|index| i64::from(*index).to_be_bytes()).collect();
    npy(">i8", 3, &numbers)
}

/// Every format that is one file, with a name.
pub(crate) fn all() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("binary.stl", binary_stl()),
        ("text.stl", text_stl()),
        ("any.obj", obj()),
        ("text.ply", text_ply()),
        ("little.ply", binary_ply(false, false)),
        ("big.ply", binary_ply(true, false)),
        ("little-double.ply", binary_ply(false, true)),
        ("big-double.ply", binary_ply(true, true)),
        ("any.glb", binary_gltf()),
    ]
}
