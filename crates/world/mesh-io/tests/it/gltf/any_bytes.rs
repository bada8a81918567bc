//! Damaged files never panic.

use base64::Engine;
use proptest::prelude::*;
use serde_json::json;
use std::path::Path;

use super::*;
use raypencil_mesh_io::mesh_from_bytes;

/// A file with a hierarchy, two materials, several primitives and both kinds of buffer.
fn rich() -> Vec<u8> {
    let (mut json, bin) = square();
    let digits = base64::engine::general_purpose::STANDARD.encode(&bin);
    json["buffers"]
        .as_array_mut()
        .unwrap()
        .push(json!({"byteLength": 60, "uri": format!("data:;base64,{digits}")}));
    json["bufferViews"]
        .as_array_mut()
        .unwrap()
        .push(json!({"buffer": 1, "byteLength": 48, "byteStride": 12}));
    let view = json!({"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC3"});
    json["accessors"].as_array_mut().unwrap().push(view);
    json["materials"] = json!([{"name": "a", "extras": {"reflectivity": 0.5}}, {}]);
    json["nodes"] = json!([
        {"children": [1, 2]},
        {"mesh": 0, "rotation": [0, 0.6, 0, 0.8], "translation": [1, 2, 3]},
        {"mesh": 0, "matrix": [0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 5, 6, 7, 1], "children": [3]},
        {"mesh": 0, "scale": [-1, 2, 1]},
    ]);
    json["meshes"][0]["primitives"] = json!([
        {"attributes": {"POSITION": 0}, "indices": 1, "material": 1},
        {"attributes": {"POSITION": 2}, "mode": 5, "material": 0},
        {"attributes": {"POSITION": 2}, "mode": 6},
        {"attributes": {"POSITION": 0}, "mode": 3},
    ]);
    glb(&json, &bin)
}

/// Ok or Err; a panic fails the test.
fn survives(bytes: &[u8]) {
    let _ = mesh_from_bytes(bytes, Path::new("no/such/folder/test.glb"), 0.25);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn changed_bytes_never_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
        end in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let mut bytes = rich();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        if let Some(end) = end {
            bytes.truncate(end.index(bytes.len()));
        }
        survives(&bytes);
    }

    // Most changed bytes break the JSON. Changed digits leave the JSON valid and change its numbers.
    #[test]
    fn changed_digits_never_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), b'0'..=b'9'), 1..6),
    ) {
        let mut bytes = rich();
        let digits: Vec<usize> = (20..bytes.len()).filter(|&at| bytes[at].is_ascii_digit()).collect();
        for (at, digit) in changes {
            bytes[digits[at.index(digits.len())]] = digit;
        }
        survives(&bytes);
    }
}

#[test]
fn the_unchanged_file_is_read() {
    let mesh = mesh_from_bytes(&rich(), Path::new("test.glb"), 0.25).unwrap();
    // Three instances of 2 + 2 + 2 faces, of 4 + 4 vertices.
    assert_eq!((mesh.faces().len(), mesh.vertices().len()), (18, 24));
}

#[test]
fn a_file_cut_anywhere_is_refused() {
    let bytes = rich();
    for end in 0..bytes.len() {
        assert!(mesh_from_bytes(&bytes[..end], Path::new("test.glb"), 0.25).is_err(), "{end}");
    }
}
