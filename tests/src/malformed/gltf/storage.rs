//! Wrong strides, alignment and overlaps; buffers in other files.

use serde_json::json;

use super::changes::{changed, set, text};
use crate::glb::square;
use crate::malformed::case::{Case, Item};

/// The square in a `.gltf` file with its buffer at `uri`.
fn with_uri(name: &str, what: &'static str, uri: &str) -> Case {
    let (mut json, _) = square();
    json["buffers"][0]["uri"] = json!(uri);
    text(name, what, "buffer 0", json.to_string())
}

/// Wrong strides, alignment and overlaps.
pub(super) fn layouts() -> Vec<Case> {
    let stride = |name: &str, stride: u64| {
        set(
            &format!("stride-{name}"),
            "an invalid stride",
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
        changed("misaligned", "reals at an odd offset in their view", "accessor 0", |json| {
            json["accessors"][0]["byteOffset"] = json!(1);
            json["accessors"][0]["count"] = json!(3);
        }),
        changed("misaligned-view", "a view of reals at a misaligned offset", "accessor 0", |json| {
            json["bufferViews"][0] = json!({"buffer": 0, "byteOffset": 2, "byteLength": 48});
        }),
        changed("misaligned-indices", "16-bit indices at an odd offset", "accessor 1", |json| {
            json["bufferViews"][1] = json!({"buffer": 0, "byteOffset": 47, "byteLength": 12});
        }),
        changed("overlap", "indices that overlap the vertices", "accessor 1", |json| {
            json["bufferViews"][1] = json!({"buffer": 0, "byteOffset": 12, "byteLength": 48});
        }),
    ]
}

/// Buffers in other files.
pub(super) fn uris() -> Vec<Case> {
    let uri = |name: &str, what, uri: &str| with_uri(&format!("uri-{name}"), what, uri);
    vec![
        uri("up", "a buffer in the parent folder", "../secret.bin").file("../secret.bin", [0; 60]),
        uri("up-inside", "a path that goes down and up again", "a/../../secret.bin")
            .file("../secret.bin", [0; 60]),
        uri("up-escaped", "the parent folder, in percent escapes", "%2e%2e/secret.bin")
            .file("../secret.bin", [0; 60]),
        uri("slash-escaped", "the parent folder and the slash, in percent escapes", "%2E%2E%2fsecret.bin")
            .file("../secret.bin", [0; 60]),
        uri("backslash", "the parent folder, with a backslash", "..%5csecret.bin"),
        uri("absolute", "an absolute path", "/etc/passwd"),
        uri("file-scheme", "a path with a URI scheme", "file:///etc/passwd"),
        uri("http", "an http address", "http://127.0.0.1:1/ground.bin"),
        uri("drive", "a path with a drive letter", "C:/ground.bin"),
        uri("nothing", "an empty path", ""),
        uri("null", "a path with a null byte", "ground%00.bin"),
        uri("escape-cut", "a truncated percent escape", "ground.bin%2"),
        uri("escape-wrong", "a percent escape that is not a number", "%zz"),
        uri("escape-not-utf8", "a percent escape that is not UTF-8", "%ff%fe.bin"),
        uri("missing", "a missing file", "ground.bin"),
        uri("folder", "a folder in place of a buffer", "ground.bin").item("ground.bin", Item::Folder),
        uri("pipe", "a pipe in place of a buffer", "ground.bin").item("ground.bin", Item::Pipe),
        uri("link-out", "a link that leads out of the folder", "ground.bin")
            .file("../secret.bin", [0; 60])
            .item("ground.bin", Item::Link("../secret.bin".into())),
        uri("link-folder", "a linked folder that leads out of the folder", "down/secret.bin")
            .file("../elsewhere/secret.bin", [0; 60])
            .item("down", Item::Link("../elsewhere".into())),
        uri("device", "a link to /dev/zero", "ground.bin").item("ground.bin", Item::Link("/dev/zero".into())),
        uri("hole", "a buffer of a gigabyte, nearly all of which is a hole", "ground.bin")
            .item("ground.bin", Item::Hole(vec![0; 60], 1 << 30)),
        uri("short", "a file that is too short", "ground.bin").file("ground.bin", [0; 59]),
        uri("data-letters", "base64 with invalid letters", "data:application/octet-stream;base64,AAAA*AAA"),
        uri("data-padding", "base64 without its padding", "data:application/octet-stream;base64,AAAAA"),
        uri("data-nothing", "empty base64", "data:application/octet-stream;base64,"),
        uri("data-plain", "a data URI without base64", "data:application/octet-stream,AAAA"),
        uri("data-cut", "a data URI without data", "data:"),
    ]
}

/// A well-formed square for each of forty buffers, which all name one file of 24 MB.
pub(in crate::malformed) fn forty_buffers() -> Case {
    let (mut json, bin) = square();
    let forty = |make: &dyn Fn(usize) -> Vec<serde_json::Value>| (0..40).flat_map(make).collect();
    json["buffers"] = forty(&|_| vec![json!({"byteLength": 60, "uri": "ground.bin"})]);
    json["bufferViews"] = forty(&|k| {
        let view = |at: u32, length: u32| json!({"buffer": k, "byteOffset": at, "byteLength": length});
        vec![view(0, 48), view(48, 12)]
    });
    json["accessors"] = forty(&|k| {
        vec![
            json!({"bufferView": 2 * k, "componentType": 5126, "count": 4, "type": "VEC3"}),
            json!({"bufferView": 2 * k + 1, "componentType": 5123, "count": 6, "type": "SCALAR"}),
        ]
    });
    json["meshes"][0]["primitives"] =
        forty(&|k| vec![json!({"attributes": {"POSITION": 2 * k}, "indices": 2 * k + 1})]);
    Case::new(
        "good-gltf-buffers",
        "one file that forty buffers name",
        "terrain import ground.gltf -o out.glb",
        &[],
    )
    .file("ground.gltf", json.to_string())
    .item("ground.bin", Item::Hole(bin, 24 << 20))
}
