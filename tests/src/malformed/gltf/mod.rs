//! Malformed glTF: syntax, versions and types, excessive sizes. Counts, nodes and storage are in files of their own.

mod changes;
mod counts;
mod nodes;
mod storage;

use serde_json::{Value, json};

use super::case::{Case, Item};
use crate::glb::{glb, square};
use changes::{FILE, RUN, changed, set, text};
pub(super) use storage::forty_buffers;

pub(super) fn cases() -> Vec<Case> {
    [texts(), heads(), counts::cases(), nodes::cases(), storage::layouts(), storage::uris(), bombs()].concat()
}

/// Malformed JSON.
fn texts() -> Vec<Case> {
    let nested = |depth: usize| ["[".repeat(depth), "]".repeat(depth)].concat();
    vec![
        text("empty", "an empty file", "first bytes", ""),
        text("words", "plain text of another kind", "first bytes", "Dear rover,"),
        text("byte-order-mark", "a byte order mark before the JSON", "first bytes", "\u{feff}{}"),
        text(
            "not-utf8",
            "a byte that is not UTF-8",
            "JSON",
            b"{\"asset\": {\"version\": \"2.0\xff\"}}".to_vec(),
        ),
        text(
            "lone-surrogate",
            "one half of a surrogate pair",
            "JSON",
            r#"{"asset": {"version": "2.0", "generator": "\ud800"}}"#,
        ),
        text("open", "unterminated JSON", "JSON", r#"{"asset": {"version": "2.0"}, "nodes": [{"#),
        text("deep-extras", "two hundred thousand open brackets in extras", "JSON", {
            format!(r#"{{"asset": {{"version": "2.0"}}, "extras": {}"#, "[".repeat(200_000))
        }),
        text("deep-extensions", "extensions nested a thousand deep", "JSON", {
            format!(r#"{{"asset": {{"version": "2.0"}}, "accessors": [{{"min": {}}}]}}"#, nested(1000))
        }),
        text("nan", "NaN, which is not JSON", "JSON", {
            square().0.to_string().replace(r#""mesh":0"#, r#""mesh":0,"scale":[NaN,1,1]"#)
        }),
        text("key-twice", "a duplicate key", "JSON", {
            square().0.to_string().replacen('{', r#"{"nodes":[],"#, 1)
        }),
        Case::new("gltf-folder", "a folder in place of the file", RUN, &[FILE, "folder"])
            .item(FILE, Item::Folder),
        Case::new("gltf-pipe", "a pipe in place of the file", RUN, &[FILE, "not a regular file"])
            .item(FILE, Item::Pipe),
        Case::new("gltf-missing", "no file", RUN, &[FILE, "does not exist"]),
        Case::new("gltf-link-to-itself", "a link to itself", RUN, &[FILE])
            .item(FILE, Item::Link(FILE.into())),
    ]
}

/// Wrong versions, extensions and types.
fn heads() -> Vec<Case> {
    vec![
        set("version-1", "glTF 1.0", "/asset/version", json!("1.0"), "asset"),
        set("version-number", "a version that is a number", "/asset/version", json!(2.0), "JSON"),
        set("no-asset", "no asset", "/asset", json!(null), "JSON"),
        set(
            "draco",
            "a required compression",
            "/extensionsRequired",
            json!(["KHR_draco_mesh_compression"]),
            "KHR_draco",
        ),
        set(
            "unknown-extension",
            "an unknown required extension",
            "/extensionsRequired",
            json!(["EVIL_\u{1b}[31m"]),
            "EVIL_",
        ),
        set(
            "instancing",
            "instances of an accessor that is not there",
            "/nodes/0/extensions",
            json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 99}}}),
            "accessor 99",
        ),
        set("nodes-object", "an object in place of a list", "/nodes", json!({"0": {}}), "JSON"),
        set("mesh-text", "a string in place of an index", "/nodes/0/mesh", json!("0"), "JSON"),
        set("mode-7", "a primitive of an unknown mode", "/meshes/0/primitives/0/mode", json!(7), "primitive"),
        set(
            "no-position",
            "a primitive without positions",
            "/meshes/0/primitives/0/attributes",
            json!({}),
            "primitive",
        ),
        set("type", "an accessor of an unknown type", "/accessors/0/type", json!("VEC9"), "accessor 0"),
        set(
            "component",
            "components of an unknown type",
            "/accessors/0/componentType",
            json!(9999),
            "accessor 0",
        ),
        set(
            "short-positions",
            "positions in 16 bits",
            "/accessors/0/componentType",
            json!(5123),
            "accessor 0",
        ),
        set(
            "float-indices",
            "indices of floating point",
            "/accessors/1/componentType",
            json!(5126),
            "accessor 1",
        ),
        set("flat", "positions with two components", "/accessors/0/type", json!("VEC2"), "accessor 0"),
        set(
            "instances-of-corners",
            "instances where indices are",
            "/nodes/0/extensions",
            json!({"EXT_mesh_gpu_instancing": {"attributes": {"SCALE": 1}}}),
            "accessor 1",
        ),
        set("weights", "morph weights", "/nodes/0/weights", json!([1.0]), "node 0"),
        set(
            "reflectivity-2",
            "a reflectivity of 2",
            "/materials",
            json!([{"extras": {"reflectivity": 2}}]),
            "material 0",
        ),
        set(
            "reflectivity-text",
            "a reflectivity that is a string",
            "/materials",
            json!([{"extras": {"reflectivity": "NaN"}}]),
            "material 0",
        ),
        set(
            "materials",
            "seventy thousand materials",
            "/materials",
            Value::Array(vec![json!({}); 70_000]),
            "materials",
        ),
        set("no-mesh", "no mesh", "/nodes/0", json!({}), "no triangles"),
        set(
            "points",
            "a point cloud without triangles",
            "/meshes/0/primitives/0/mode",
            json!(0),
            "no triangles",
        ),
        set("no-scenes", "a missing scene", "/scenes", json!([]), "scene 0"),
    ]
}

/// Small files with excessive demands.
fn bombs() -> Vec<Case> {
    let instances = |name: &str, what, mesh: Value, count: usize, place: &str| {
        changed(name, what, place, |json| {
            json["meshes"][0]["primitives"] = mesh;
            json["nodes"] = Value::Array(vec![json!({"mesh": 0}); count]);
            json["scenes"][0]["nodes"] = (0..count).collect();
        })
    };
    let points = json!({"attributes": {"POSITION": 0}, "mode": 0});
    vec![
        {
            // A thousand triangles, all of them on vertex 0.
            let (mut json, mut bin) = square();
            bin.resize(60 + 6000, 0);
            json["buffers"][0]["byteLength"] = json!(bin.len());
            json["bufferViews"][1]["byteLength"] = json!(6000);
            json["bufferViews"][1]["byteOffset"] = json!(60);
            json["accessors"][1]["count"] = json!(3000);
            json["nodes"] = Value::Array(vec![json!({"mesh": 0}); 100_000]);
            json["scenes"][0]["nodes"] = (0..100_000).collect();
            let what = "a thousand faces in a hundred thousand instances";
            Case::of_file("gltf-instances", what, RUN, FILE, glb(&json, &bin), "faces")
        },
        instances(
            "primitives",
            "twenty thousand point clouds in twenty thousand instances",
            Value::Array(vec![points; 20_000]),
            20_000,
            "primitives",
        ),
        text("objects", "two million empty nodes", "JSON", {
            format!(r#"{{"asset": {{"version": "2.0"}}, "nodes": [{}{{}}]}}"#, "{},".repeat(2_000_000))
        }),
        text("long-name", "an unknown extension with a name of a million letters", "extensionsRequired", {
            format!(
                r#"{{"asset": {{"version": "2.0"}}, "extensionsRequired": ["{}"]}}"#,
                "x".repeat(1_000_000)
            )
        }),
    ]
}
