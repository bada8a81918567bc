//! Malformed `candidate.json` files, and maps of candidates.

use serde_json::{Value, json};

use super::bytes::{of_good_pack, zlib};
use super::case::{Case, Item};

const FILE: &str = "mine/candidate.json";
const RUN: &str = "check PACK mine -o out";

/// A note with totals, which other tests change.
fn note() -> Value {
    let manifest: Value = serde_json::from_slice(&of_good_pack("manifest.json")).expect("a manifest");
    json!({
        "format": 1, "program": "P 1", "arithmetic": "f64",
        "scene": {"name": "s", "sha256": manifest["scene"]["sha256"]},
        "totals": [{"way": "direct", "beam": 0, "mean": 1.0, "error": 0.1}],
    })
}

/// A well-formed note.
pub(super) fn good() -> String {
    let mut note = note();
    note["totals"] = json!([]);
    note.to_string()
}

fn text(name: &str, what: &'static str, place: &str, bytes: impl Into<Vec<u8>>) -> Case {
    Case::of_file(&format!("candidate-{name}"), what, RUN, FILE, bytes.into(), place)
}

fn set(name: &str, what: &'static str, pointer: &str, value: Value, place: &str) -> Case {
    let mut note = note();
    *note.pointer_mut(pointer).expect("a place in the note") = value;
    text(name, what, place, note.to_string())
}

pub(super) fn cases() -> Vec<Case> {
    let whole = note().to_string();
    let map = |name: &str, what, words: &[&str], file: &str, bytes: Vec<u8>| {
        Case::new(format!("candidate-{name}"), what, RUN, words).file(&format!("mine/{file}"), bytes)
    };
    vec![
        text("empty", "an empty file", "JSON", ""),
        text("words", "plain text of another kind", "JSON", "Dear rover,"),
        text(
            "not-utf8",
            "a byte that is not UTF-8",
            "JSON",
            b"{\"format\": 1, \"program\": \"\xff\"}".to_vec(),
        ),
        text(
            "deep",
            "a hundred thousand open brackets",
            "JSON",
            format!("{{\"format\": {}", "[".repeat(100_000)),
        ),
        text("deep-unknown", "a hundred thousand brackets under an ignored key", "JSON", {
            format!("{{\"seeds\": {}{}, \"format\": 1", "[".repeat(100_000), "]".repeat(100_000))
        }),
        text("large", "two megabytes of blanks", "larger than", vec![b' '; 2 << 20]),
        text("cut", "a truncated good file", "JSON", &whole.as_bytes()[..whole.len() / 2]),
        text("key-twice", "a duplicate key", "JSON", whole.replacen('{', "{\"format\": 1,", 1)),
        text("infinite", "a mean too large for a double", "JSON", whole.replace("1.0", "1e999")),
        text("nan", "a mean that is not a number", "JSON", whole.replace("1.0", "NaN")),
        set("format-2", "an unknown format", "/format", json!(2), "format"),
        set("format-text", "a format in quotes", "/format", json!("1"), "format: "),
        set("arithmetic", "an unknown arithmetic", "/arithmetic", json!("f\u{1b}[31m"), "arithmetic: "),
        set("mean-negative", "a negative mean", "/totals/0/mean", json!(-1.0), "totals[0]"),
        set("beam-negative", "a beam of index -1", "/totals/0/beam", json!(-1), "JSON"),
        set("beam-beyond", "a beam beyond 2^64", "/totals/0/beam", json!(1e30), "JSON"),
        set(
            "digest-long",
            "a digest of half a million letters",
            "/scene/sha256",
            json!("0".repeat(500_000)),
            "scene.sha256",
        ),
        Case::new("candidate-other-scene", "a note for another scene", RUN, &["mine", "0000"]).file(FILE, {
            let mut note = note();
            note["scene"]["sha256"] = json!("0".repeat(64));
            note.to_string()
        }),
        Case::new(
            "candidate-note-folder",
            "a folder in place of the note",
            RUN,
            &[FILE, "not a regular file"],
        )
        .item(FILE, Item::Folder),
        Case::new("candidate-note-pipe", "a pipe in place of the note", RUN, &[FILE, "not a regular file"])
            .item(FILE, Item::Pipe),
        Case::new("candidate-nothing", "an empty folder", RUN, &["mine"]).item("mine", Item::Folder),
        Case::new("candidate-missing", "no folder", RUN, &["mine"]),
        Case::new(
            "candidate-map-pipe",
            "a pipe in place of a map",
            RUN,
            &["camera.exr", "not a regular file"],
        )
        .item("mine/camera.exr", Item::Pipe),
        map(
            "huge-map",
            "a map of 2^26 zeros, compressed by a factor of a thousand",
            &["camera.exr", "data window"],
            "camera.exr",
            huge(),
        ),
        map("map-empty", "an empty map", &["camera.exr", "header"], "camera.exr", Vec::new()),
        map(
            "array-wrong-size",
            "an array of another size",
            &["range.T.npy"],
            "camera/range.T.npy",
            super::npy::good(),
        ),
    ]
}

/// A well-formed map of 8192 x 8192 zeros, far larger than any sensor of the pack.
fn huge() -> Vec<u8> {
    super::exr::zeros(1 << 13, 1 << 13, &zlib(&vec![0; 16 << 15]))
}
