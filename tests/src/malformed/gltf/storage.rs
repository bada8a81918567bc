//! Strides, alignment and overlaps; buffers that are elsewhere.

use serde_json::json;

use super::changes::{changed, set, text};
use crate::glb::square;
use crate::malformed::case::{Case, Item};

/// The square in a text file with a buffer at `uri`.
fn with_uri(name: &str, what: &'static str, uri: &str) -> Case {
    let (mut json, _) = square();
    json["buffers"][0]["uri"] = json!(uri);
    text(name, what, "buffer 0", json.to_string())
}

/// Strides, alignment and overlaps.
pub(super) fn layouts() -> Vec<Case> {
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
pub(super) fn uris() -> Vec<Case> {
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
