//! glTF in its own axes, with transforms in double precision.

use serde_json::{Value, json};

use super::glb::{glb, square};
use super::*;

/// The square (0, 0, 0), (1, 0, 0), (1, 0, -1), (0, 0, -1) below other nodes.
fn placed(nodes: Value) -> Triangles {
    let (mut json, bin) = square();
    json.as_object_mut().unwrap().remove("scene");
    json.as_object_mut().unwrap().remove("scenes");
    json["nodes"] = nodes;
    parse("a.glb", &glb(&json, &bin)).unwrap()
}

#[test]
fn no_axis_is_turned() {
    let mesh = placed(json!([{"mesh": 0}]));
    assert_eq!(mesh.vertices(), [[0., 0., 0.], [1., 0., 0.], [1., 0., -1.], [0., 0., -1.]]);
    assert_eq!(mesh.faces(), [[0, 1, 2], [0, 2, 3]]);
}

#[test]
fn rotation_scale_and_mirror_by_hand() {
    // Node 0: a quarter turn about y (z -> x, x -> -z) after a scale of (2, 3, 4), then a move by (10, 20, 30):
    // (1, 0, 0) -> (2, 0, 0) -> (0, 0, -2) -> (10, 20, 28); (0, 0, -1) -> (0, 0, -4) -> (-4, 0, 0) -> (6, 20, 30).
    // Node 1 mirrors x below a parent that doubles all: (1, 0, -1) -> (-1, 0, -1) -> (-2, 0, -2).
    let half = 0.5_f64.sqrt();
    let mesh = placed(json!([
        {"mesh": 0, "translation": [10, 20, 30], "rotation": [0, half, 0, half], "scale": [2, 3, 4]},
        {"scale": [2, 2, 2], "children": [2]},
        {"mesh": 0, "scale": [-1, 1, 1]},
    ]));
    let near = |v: usize, expected: [f64; 3]| {
        // The quaternion is a unit to 1e-16 only.
        let error = (0..3).map(|axis| (mesh.vertices()[v][axis] - expected[axis]).abs()).fold(0.0, f64::max);
        assert!(error < 1e-14, "{v}: {:?}", mesh.vertices()[v]);
    };
    near(0, [10., 20., 30.]);
    near(1, [10., 20., 28.]);
    near(2, [6., 20., 28.]);
    near(3, [6., 20., 30.]);
    assert_eq!(mesh.vertices()[4..], [[0., 0., 0.], [-2., 0., 0.], [-2., 0., -2.], [0., 0., -2.]]);
    // The mirrored triangles have their last two corners swapped: the outside stays outside.
    assert_eq!(mesh.faces(), [[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]]);
}

#[test]
fn transforms_are_not_rounded_to_single_precision() {
    // 0.1 and 2^24 + 1 are no single-precision numbers.
    let mesh = placed(json!([{"mesh": 0, "translation": [0.1, 16777217, -0.3]}]));
    assert_eq!(mesh.vertices()[0], [0.1, 16777217.0, -0.3]);
    assert_eq!(mesh.vertices()[1], [1.0 + 0.1, 16777217.0, -0.3]);
    let matrix = placed(json!([{"mesh": 0, "matrix": [0.1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.7, 0, 0, 1]}]));
    assert_eq!(matrix.vertices()[1], [0.1 + 0.7, 0.0, 0.0]);
}

#[test]
fn buffers_beside_the_file_have_digests() {
    let folder = tempfile::tempdir().unwrap();
    let (mut json, bin) = square();
    json["buffers"][0]["uri"] = json!("square.bin");
    std::fs::write(folder.path().join("square.bin"), &bin).unwrap();
    let path = folder.path().join("square.gltf");
    std::fs::write(&path, json.to_string()).unwrap();
    let file = raypencil_mesh_io::read_triangles(&path).unwrap();
    let sha256 = raypencil_files::sha256;
    assert_eq!(file.digests, [sha256(json.to_string().as_bytes()), sha256(&bin)]);
    assert_eq!((file.triangles.faces().len(), file.polygons), (2, None));
}

#[test]
fn messages_are_those_of_terrain() {
    let (mut json, bin) = square();
    json["accessors"][0]["count"] = json!(400);
    refused(
        "a.glb",
        glb(&json, &bin),
        "accessor 0: 400 elements of 12 bytes, 12 apart, from byte 0; expected 1 or more within buffer view 0 of 48 \
         bytes",
    );
}
