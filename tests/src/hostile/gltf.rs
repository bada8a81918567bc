//! glTF JSON: references, counts, hierarchies and numbers that are wrong.

use serde_json::{Value, json};

use super::glb::{glb, reals};
use super::{Case, Item};

const FILE: &str = "ground.glb";
const RUN: &str = "validate ground.glb -o out";
const TEXT: &str = "ground.gltf";
const RUN_TEXT: &str = "validate ground.gltf -o out";
/// 4e12: more than any file holds, and few enough for a careless 64-bit product.
const TRILLIONS: u64 = 4_000_000_000_000;

/// A unit square as two triangles on four vertices; each case changes its JSON or its numbers.
pub(super) fn square() -> (Value, Vec<u8>) {
    let mut bin = reals(&[0., 0., 0., 1., 0., 0., 1., 0., -1., 0., 0., -1.]);
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

/// The square after a change of its JSON.
fn changed(name: &str, what: &'static str, place: &str, change: impl FnOnce(&mut Value)) -> Case {
    let (mut json, bin) = square();
    change(&mut json);
    Case::of_file(&format!("gltf-{name}"), what, RUN, FILE, glb(&json, &bin), place)
}

/// The square with one value set, which may be a new key of an object.
fn set(name: &str, what: &'static str, pointer: &str, value: Value, place: &str) -> Case {
    changed(name, what, place, |json| {
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        let parent = json.pointer_mut(parent).expect("a place in the square");
        match key.parse::<usize>() {
            Ok(index) => parent[index] = value,
            Err(_) => parent[key] = value,
        }
    })
}

/// The square with other numbers in its buffer.
fn numbers(name: &str, what: &'static str, place: &str, change: impl FnOnce(&mut Vec<u8>)) -> Case {
    let (json, mut bin) = square();
    change(&mut bin);
    Case::of_file(&format!("gltf-{name}"), what, RUN, FILE, glb(&json, &bin), place)
}

/// A text file as it stands.
fn text(name: &str, what: &'static str, place: &str, bytes: impl Into<Vec<u8>>) -> Case {
    Case::of_file(&format!("gltf-{name}"), what, RUN_TEXT, TEXT, bytes.into(), place)
}

/// The square in a text file with a buffer at `uri`.
fn with_uri(name: &str, what: &'static str, uri: &str) -> Case {
    let (mut json, _) = square();
    json["buffers"][0]["uri"] = json!(uri);
    text(name, what, "buffer 0", json.to_string())
}

pub(super) fn cases() -> Vec<Case> {
    [texts(), heads(), counts(), hierarchies(), storage(), uris(), bombs()].concat()
}

/// What is no JSON, or not the right one.
fn texts() -> Vec<Case> {
    let nested = |depth: usize| ["[".repeat(depth), "]".repeat(depth)].concat();
    vec![
        text("empty", "an empty file", "first bytes", ""),
        text("words", "a letter, not a file", "first bytes", "Dear rover,"),
        text("byte-order-mark", "a byte order mark before the JSON", "first bytes", "\u{feff}{}"),
        text(
            "not-utf8",
            "a byte that is no UTF-8",
            "JSON",
            b"{\"asset\": {\"version\": \"2.0\xff\"}}".to_vec(),
        ),
        text(
            "lone-surrogate",
            "half a surrogate pair",
            "JSON",
            r#"{"asset": {"version": "2.0", "generator": "\ud800"}}"#,
        ),
        text("open", "JSON that never ends", "JSON", r#"{"asset": {"version": "2.0"}, "nodes": [{"#),
        text("deep-extras", "two hundred thousand open brackets in extras", "JSON", {
            format!(r#"{{"asset": {{"version": "2.0"}}, "extras": {}"#, "[".repeat(200_000))
        }),
        text("deep-extensions", "extensions nested a thousand deep", "JSON", {
            format!(r#"{{"asset": {{"version": "2.0"}}, "accessors": [{{"min": {}}}]}}"#, nested(1000))
        }),
        text("nan", "NaN where JSON has no such word", "JSON", {
            square().0.to_string().replace(r#""mesh":0"#, r#""mesh":0,"scale":[NaN,1,1]"#)
        }),
        text("key-twice", "a key that is there twice", "JSON", {
            square().0.to_string().replacen('{', r#"{"nodes":[],"#, 1)
        }),
        Case::new("gltf-folder", "a folder with the name of a file", RUN, &[FILE, "folder"])
            .item(FILE, Item::Folder),
        Case::new("gltf-pipe", "a pipe with the name of a file", RUN, &[FILE, "not a regular file"])
            .item(FILE, Item::Pipe),
        Case::new("gltf-missing", "no file", RUN, &[FILE, "does not exist"]),
        Case::new("gltf-link-to-itself", "a link to itself", RUN, &[FILE])
            .item(FILE, Item::Link(FILE.into())),
    ]
}

/// Versions, extensions and types.
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
            "a required extension of nobody",
            "/extensionsRequired",
            json!(["EVIL_\u{1b}[31m"]),
            "EVIL_",
        ),
        set(
            "instancing",
            "instances that only an extension knows",
            "/extensionsUsed",
            json!(["EXT_mesh_gpu_instancing"]),
            "EXT_mesh",
        ),
        set("nodes-object", "an object where a list belongs", "/nodes", json!({"0": {}}), "JSON"),
        set("mesh-text", "a text where an index belongs", "/nodes/0/mesh", json!("0"), "JSON"),
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
            "indices that are reals",
            "/accessors/1/componentType",
            json!(5126),
            "accessor 1",
        ),
        set("flat", "positions of two numbers", "/accessors/0/type", json!("VEC2"), "accessor 0"),
        set("skin", "a skin", "/nodes/0/skin", json!(0), "node 0"),
        set("weights", "morph weights", "/nodes/0/weights", json!([1.0]), "node 0"),
        set(
            "reflectivity-2",
            "ground that reflects twice the light",
            "/materials",
            json!([{"extras": {"reflectivity": 2}}]),
            "material 0",
        ),
        set(
            "reflectivity-text",
            "a reflectivity in words",
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
        set("no-mesh", "no mesh at all", "/nodes/0", json!({}), "no triangles"),
        set("points", "a cloud of points alone", "/meshes/0/primitives/0/mode", json!(0), "no triangles"),
        set("no-scenes", "a scene that is not there", "/scenes", json!([]), "scene 0"),
    ]
}

/// Counts, offsets and references that lie.
fn counts() -> Vec<Case> {
    let mut cases = vec![
        set("count-negative", "a negative count", "/accessors/0/count", json!(-4), "JSON"),
        set("count-real", "four and a half vertices", "/accessors/0/count", json!(4.5), "JSON"),
        set("count-text", "a count in quotes", "/accessors/0/count", json!("4"), "JSON"),
        set("count-0", "no vertices", "/accessors/0/count", json!(0), "accessor 0"),
        set("count-5", "one vertex too many", "/accessors/0/count", json!(5), "accessor 0"),
        set("index-count-5", "corners that make no triangles", "/accessors/1/count", json!(5), "accessor 1"),
        set(
            "no-view-trillions",
            "4e12 zeros without a buffer view",
            "/accessors/0",
            json!({"componentType": 5126, "count": TRILLIONS, "type": "VEC3"}),
            "4000000000000",
        ),
        set(
            "sparse-trillions",
            "a sparse accessor of 4e12 entries",
            "/accessors/0",
            json!({
                "componentType": 5126, "count": 4, "type": "VEC3", "sparse": {
                    "count": TRILLIONS, "indices": {"bufferView": 1, "componentType": 5125}, "values": {"bufferView": 0}}
            }),
            "accessor 0",
        ),
        set("index-trillions", "4e12 indices", "/accessors/1/count", json!(TRILLIONS * 3), "faces"),
        set(
            "offset-top",
            "an accessor offset of 2^64 - 4",
            "/accessors/0/byteOffset",
            json!(u64::MAX - 3),
            "accessor 0",
        ),
        set(
            "view-top",
            "a view whose end is beyond 2^64",
            "/bufferViews/0/byteOffset",
            json!(u64::MAX - 3),
            "buffer view 0",
        ),
        set(
            "view-long",
            "a view longer than its buffer",
            "/bufferViews/0/byteLength",
            json!(61),
            "buffer view 0",
        ),
        set("view-negative", "a negative offset", "/bufferViews/0/byteOffset", json!(-4), "JSON"),
        set("buffer-long", "a buffer longer than its chunk", "/buffers/0/byteLength", json!(61), "buffer 0"),
        set("buffer-huge", "a buffer of 2^63 bytes", "/buffers/0/byteLength", json!(1_u64 << 63), "buffer 0"),
        set("beyond-2-64", "a length of 1e30", "/buffers/0/byteLength", json!(1e30), "JSON"),
        set("mesh-missing", "a mesh that is not there", "/nodes/0/mesh", json!(1), "mesh 1"),
        set(
            "accessor-missing",
            "an accessor that is not there",
            "/meshes/0/primitives/0/indices",
            json!(2),
            "accessor 2",
        ),
        set(
            "index-2-32",
            "an accessor beyond 2^32",
            "/meshes/0/primitives/0/indices",
            json!(1_u64 << 32),
            "JSON",
        ),
        set(
            "index-wraps",
            "a mesh of index 2^32, which 32 bits take for 0",
            "/nodes/0/mesh",
            json!(1_u64 << 32),
            "JSON",
        ),
        set(
            "child-wraps",
            "a root of index 2^32, which 32 bits take for 0",
            "/scenes/0/nodes",
            json!([1_u64 << 32]),
            "JSON",
        ),
        set("view-missing", "a view that is not there", "/accessors/0/bufferView", json!(7), "buffer view 7"),
        set(
            "buffer-missing",
            "a buffer that is not there",
            "/bufferViews/0/buffer",
            json!(u32::MAX),
            "buffer 4294967295",
        ),
        set(
            "material-missing",
            "a material that is not there",
            "/meshes/0/primitives/0/material",
            json!(3),
            "material 3",
        ),
    ];
    for (name, count) in [("2-53", (1_u64 << 53) + 1), ("trillions", TRILLIONS), ("2-64", u64::MAX)] {
        cases.push(set(
            &format!("count-{name}"),
            "an absurd count",
            "/accessors/0/count",
            json!(count),
            "vertices",
        ));
    }
    cases
}

/// Nodes that make no tree, and transforms that make no ground.
fn hierarchies() -> Vec<Case> {
    let nodes = |name: &str, what, nodes: Value, place: &str| set(name, what, "/nodes", nodes, place);
    let tower: Vec<Value> =
        (0..5000).map(|level| json!({"children": [level + 1]})).chain([json!({"mesh": 0})]).collect();
    let matrix = |last: f64| json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, last]);
    vec![
        nodes("own-child", "a node that is its own child", json!([{"children": [0]}]), "node 0"),
        nodes(
            "cycle",
            "two nodes that are each other's children",
            json!([{"children": [1]}, {"children": [0]}]),
            "node",
        ),
        nodes(
            "cycle-aside",
            "a cycle that no scene shows",
            json!([{"mesh": 0}, {"children": [2]}, {"children": [1]}]),
            "node 1",
        ),
        nodes(
            "two-parents",
            "a node with two parents",
            json!([{"children": [1, 2]}, {"children": [2]}, {"mesh": 0}]),
            "node 2",
        ),
        nodes(
            "child-twice",
            "a child that is named twice",
            json!([{"children": [1, 1]}, {"mesh": 0}]),
            "node 1",
        ),
        nodes("child-missing", "a child that is not there", json!([{"children": [9]}]), "node 0"),
        nodes("tower", "five thousand levels of nodes", Value::Array(tower), "levels"),
        nodes(
            "overflow",
            "scales whose product is infinite",
            json!([{"children": [1], "scale": [1e38, 1e38, 1e38]}, {"mesh": 0, "scale": [1e38, 1e38, 1e38]}]),
            "node 1",
        ),
        set("root-missing", "a root that is not there", "/scenes/0/nodes", json!([5]), "scene 0"),
        set("root-negative", "a root of index -1", "/scenes/0/nodes", json!([-1]), "JSON"),
        set("matrix-short", "a matrix of 15 numbers", "/nodes/0/matrix", json!(vec![1.0; 15]), "JSON"),
        set(
            "matrix-infinite",
            "a matrix of 1e39, which single precision has not",
            "/nodes/0/matrix",
            json!(vec![1e39; 16]),
            "JSON",
        ),
        set(
            "matrix-beyond",
            "a matrix of 1e400, which no double is",
            "/nodes/0/translation",
            Value::Null,
            "JSON",
        )
        .file(FILE, {
            square().0.to_string().replace(r#""mesh":0"#, r#""mesh":0,"translation":[1e400,0,0]"#)
        }),
        set("projective", "a matrix that is not affine", "/nodes/0/matrix", matrix(2.0), "node 0"),
        set("rotation", "a rotation of length 2", "/nodes/0/rotation", json!([0, 0, 0, 2]), "node 0"),
        set("rotation-zero", "a rotation of length 0", "/nodes/0/rotation", json!([0, 0, 0, 0]), "node 0"),
        changed("matrix-and-scale", "a matrix beside a scale", "node 0", |json| {
            json["nodes"][0]["matrix"] = matrix(1.0);
            json["nodes"][0]["scale"] = json!([1, 1, 1]);
        }),
        numbers("vertex-nan", "a vertex that is not a number", "accessor 0", |bin| {
            bin[4..8].copy_from_slice(&f32::NAN.to_le_bytes())
        }),
        numbers("vertex-infinite", "a vertex at infinity", "accessor 0", |bin| {
            bin[0..4].copy_from_slice(&f32::NEG_INFINITY.to_le_bytes());
        }),
        numbers("vertex-far", "a vertex at 3e38 m", "node 0", |bin| {
            bin[0..4].copy_from_slice(&f32::MAX.to_le_bytes())
        }),
        numbers("index-beyond", "an index beyond the vertices", "accessor 1", |bin| {
            bin[58..60].copy_from_slice(&[4, 0])
        }),
        numbers("index-restart", "an index of 65535, which restarts strips elsewhere", "accessor 1", |bin| {
            bin[58..60].fill(255)
        }),
    ]
}

/// Strides, alignment and overlaps.
fn storage() -> Vec<Case> {
    let stride = |name: &str, stride: u64| {
        set(
            &format!("stride-{name}"),
            "a stride that is none",
            "/bufferViews/0/byteStride",
            json!(stride),
            "accessor 0",
        )
    };
    vec![
        stride("0", 0),
        stride("4", 4),
        stride("13", 13),
        stride("253", 253),
        stride("2-63", 1 << 63),
        changed("misaligned", "reals at an odd byte of their view", "accessor 0", |json| {
            json["accessors"][0]["byteOffset"] = json!(1);
            json["accessors"][0]["count"] = json!(3);
        }),
        changed("misaligned-view", "a view of reals that starts at an odd byte", "accessor 0", |json| {
            json["bufferViews"][0] = json!({"buffer": 0, "byteOffset": 2, "byteLength": 48});
        }),
        changed("misaligned-indices", "16-bit indices at an odd byte", "accessor 1", |json| {
            json["bufferViews"][1] = json!({"buffer": 0, "byteOffset": 47, "byteLength": 12});
        }),
        changed("overlap", "indices that are the bytes of the vertices", "accessor 1", |json| {
            json["bufferViews"][1] = json!({"buffer": 0, "byteOffset": 12, "byteLength": 48});
        }),
    ]
}

/// Buffers that are elsewhere.
fn uris() -> Vec<Case> {
    let uri = |name: &str, what, uri: &str| with_uri(&format!("uri-{name}"), what, uri);
    vec![
        uri("up", "a buffer in the folder above", "../secret.bin").file("../secret.bin", [0; 60]),
        uri("up-inside", "a path that goes down and up again", "a/../../secret.bin")
            .file("../secret.bin", [0; 60]),
        uri("up-escaped", "the folder above, in percent escapes", "%2e%2e/secret.bin")
            .file("../secret.bin", [0; 60]),
        uri("slash-escaped", "its slash too", "%2E%2E%2fsecret.bin").file("../secret.bin", [0; 60]),
        uri("backslash", "the folder above, as other systems write it", "..%5csecret.bin"),
        uri("absolute", "an absolute path", "/etc/passwd"),
        uri("file-scheme", "a path with a scheme", "file:///etc/passwd"),
        uri("http", "an address of the net", "http://127.0.0.1:1/ground.bin"),
        uri("drive", "a path with a drive", "C:/ground.bin"),
        uri("nothing", "an empty path", ""),
        uri("null", "a path with a null byte", "ground%00.bin"),
        uri("escape-cut", "an escape that is cut off", "ground.bin%2"),
        uri("escape-wrong", "an escape that is no number", "%zz"),
        uri("escape-not-utf8", "an escape that is no UTF-8", "%ff%fe.bin"),
        uri("missing", "a file that is not there", "ground.bin"),
        uri("folder", "a folder as a buffer", "ground.bin").item("ground.bin", Item::Folder),
        uri("pipe", "a pipe as a buffer", "ground.bin").item("ground.bin", Item::Pipe),
        uri("link-out", "a link that leads out", "ground.bin")
            .file("../secret.bin", [0; 60])
            .item("ground.bin", Item::Link("../secret.bin".into())),
        uri("link-folder", "a linked folder that leads out", "down/secret.bin")
            .file("../elsewhere/secret.bin", [0; 60])
            .item("down", Item::Link("../elsewhere".into())),
        uri("device", "a link to a device without an end", "ground.bin")
            .item("ground.bin", Item::Link("/dev/zero".into())),
        uri("short", "a file that is too short", "ground.bin").file("ground.bin", [0; 59]),
        uri("data-letters", "base64 with other letters", "data:application/octet-stream;base64,AAAA*AAA"),
        uri("data-padding", "base64 without its padding", "data:application/octet-stream;base64,AAAAA"),
        uri("data-nothing", "base64 of nothing", "data:application/octet-stream;base64,"),
        uri("data-plain", "a data URI without base64", "data:application/octet-stream,AAAA"),
        uri("data-cut", "a data URI without data", "data:"),
    ]
}

/// Small files that ask for much.
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
            // A thousand triangles, all on vertex 0.
            let (mut json, mut bin) = square();
            bin.resize(60 + 6000, 0);
            json["buffers"][0]["byteLength"] = json!(bin.len());
            json["bufferViews"][1]["byteLength"] = json!(6000);
            json["bufferViews"][1]["byteOffset"] = json!(60);
            json["accessors"][1]["count"] = json!(3000);
            json["nodes"] = Value::Array(vec![json!({"mesh": 0}); 100_000]);
            json["scenes"][0]["nodes"] = (0..100_000).collect();
            let what = "a thousand faces, drawn a hundred thousand times";
            Case::of_file("gltf-instances", what, RUN, FILE, glb(&json, &bin), "faces")
        },
        instances(
            "primitives",
            "twenty thousand point clouds, drawn twenty thousand times",
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
