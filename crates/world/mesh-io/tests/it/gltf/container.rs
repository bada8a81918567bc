//! Containers, JSON and extensions that are refused.

use base64::Engine;
use serde_json::json;
use std::path::Path;

use super::*;
use raypencil_mesh_io::mesh_from_bytes;

#[test]
fn extensions_that_move_vertices_are_refused_by_name() {
    let known = "plain buffers and nodes; extensions are known only for quantized meshes, instances, materials, textures and lights";
    let command =
        "plain buffers; `gltf-transform cp IN OUT` decompresses, and so does Blender's import and export";
    for (name, expected) in [
        ("KHR_draco_mesh_compression", command),
        ("EXT_meshopt_compression", command),
        ("KHR_node_visibility", known),
        ("X_new", known),
    ] {
        let message = format!("extensionsRequired: \"{name}\"; expected {expected}");
        refused(changed(|json| json["extensionsRequired"] = json!(["KHR_materials_unlit", name])), &message);
        // Used but not required: the file has plain data as well.
        assert!(changed(|json| json["extensionsUsed"] = json!([name])).is_ok());
    }
    assert!(changed(|json| json["extensionsRequired"] = json!(["KHR_texture_transform"])).is_ok());
    let old = changed(|json| json["asset"]["version"] = json!("1.0"));
    refused(old, "asset: version \"1.0\", minVersion None; expected glTF 2.0");
    let newer = changed(|json| json["asset"]["minVersion"] = json!("2.1"));
    refused(newer, "asset: version \"2.0\", minVersion Some(\"2.1\"); expected glTF 2.0");
}

fn bytes_refused(bytes: &[u8], message: &str) {
    let error = mesh_from_bytes(bytes, Path::new("test.glb"), 0.25).unwrap_err().to_string();
    assert_eq!(error, format!("test.glb: {message}"));
}

#[test]
fn containers_that_are_broken_are_refused() {
    let (json, bin) = square();
    let good = glb(&json, &bin);
    let with = |at: usize, word: u32| {
        let mut file = good.clone();
        file[at..at + 4].copy_from_slice(&word.to_le_bytes());
        file
    };
    let length = good.len();
    bytes_refused(b"", "first bytes: []; expected the magic \"glTF\" of a GLB, or a JSON object");
    bytes_refused(
        b"\x89PNG",
        "first bytes: [89, 50, 4e, 47]; expected the magic \"glTF\" of a GLB, or a JSON object",
    );
    bytes_refused(b"glTF\x02", "GLB header: 5 bytes; expected 12 bytes");
    bytes_refused(&with(4, 1), "GLB header: version 1; expected version 2");
    bytes_refused(
        &with(8, 11),
        &format!("GLB header: a length of 11 in a file of {length} bytes; expected the length of the file"),
    );
    bytes_refused(
        &[&good[..], b"zz"].concat(),
        &format!(
            "GLB header: a length of {length} in a file of {} bytes; expected the length of the file",
            length + 2
        ),
    );
    bytes_refused(
        &good[..length - 4],
        &format!(
            "GLB header: a length of {length} in a file of {} bytes; expected the length of the file (is it cut off?)",
            length - 4
        ),
    );
    bytes_refused(
        &with(12, u32::MAX),
        &format!(
            "GLB chunk 0: a length of 4294967295 with {} bytes left; expected a chunk that ends within the file",
            length - 20
        ),
    );
    bytes_refused(
        &with(16, 0),
        "GLB chunk 0: type \"\\x00\\x00\\x00\\x00\"; expected first JSON, then at most one BIN, then other types",
    );
    bytes_refused(&with(8, 12)[..12], "GLB chunk 0: nothing; expected a JSON chunk");
    bytes_refused(&with(8, 16)[..16], "GLB chunk 0: 4 bytes left; expected 8 bytes of a chunk header");
    // Chunks of unknown types are skipped, within the declared length.
    let mut longer = good.clone();
    longer.extend(b"\x04\0\0\0XTRAabcd");
    assert!(mesh_from_bytes(&longer, Path::new("x"), 0.25).is_err());
    longer[8..12].copy_from_slice(&(length as u32 + 12).to_le_bytes());
    assert!(mesh_from_bytes(&longer, Path::new("x"), 0.25).is_ok());
    longer[length + 4..length + 8].copy_from_slice(b"BIN\0");
    bytes_refused(
        &longer,
        "GLB chunk 2: type \"BIN\\x00\"; expected first JSON, then at most one BIN, then other types",
    );
}

#[test]
fn malformed_json_names_line_and_column() {
    bytes_refused(b"{\n \"asset\": }", "JSON: expected value at line 2 column 11; expected a glTF 2.0 asset");
    bytes_refused(b"{}", "JSON: missing field `asset` at line 1 column 2; expected a glTF 2.0 asset");
    let error = changed(|json| json["nodes"][0]["mesh"] = json!("first")).unwrap_err();
    assert!(error.contains("JSON: invalid type: string \"first\", expected an index below 2^32"), "{error}");
}

#[test]
fn deep_json_ends_in_an_error_or_is_skipped() {
    let (json, bin) = square();
    let deep = |key: &str, open: &str, close: &str| {
        let nested = format!("{}{}", open.repeat(300_000), close.repeat(300_000));
        let text = json.to_string().replacen('{', &format!("{{\"{key}\": {nested}, "), 1);
        let digits = base64::engine::general_purpose::STANDARD.encode(&bin);
        let uri = format!("\"uri\": \"data:;base64,{digits}\", \"byteLength\"");
        let text = text.replace("\"buffers\":[{\"byteLength\"", &format!("\"buffers\":[{{{uri}"));
        mesh_from_bytes(text.as_bytes(), Path::new("test.gltf"), 0.25).map_err(|error| error.to_string())
    };
    // Unknown keys and extras are skipped without recursion.
    assert!(deep("unknown", "[", "]").is_ok());
    assert!(deep("extras", "[", "]").is_ok());
    // Lists where a list of objects belongs, and numbers of any shape.
    assert!(deep("nodes", "[", "]").is_err());
    assert!(deep("animations", "[", "]").is_err());
    let error = changed(|json| {
        let mut nested = json!(0.5);
        for _ in 0..200 {
            nested = json!([nested]);
        }
        json["materials"] = json!([{"extras": {"reflectivity": nested}}]);
    });
    assert!(error.unwrap_err().contains("material 0 \"\": recursion limit exceeded"));
    let error = changed(|json| {
        let mut nested = json!(0.5);
        for _ in 0..200 {
            nested = json!([nested]);
        }
        json["accessors"][0]["min"] = nested;
    });
    assert!(error.unwrap_err().contains("JSON: recursion limit exceeded"));
}

#[test]
fn the_json_has_as_many_objects_as_may_be() {
    // Braces inside texts count as well.
    let others = square().0.to_string().matches('{').count();
    let of = |count: usize| changed(|json| json["asset"]["generator"] = json!("{".repeat(count - others)));
    assert!(of(1 << 19).is_ok());
    refused(of((1 << 19) + 1), "JSON: 524289 objects; expected at most 524288");
}
