//! Malformed `manifest.json` files: contradictions in itself, with the files, or with the folder.

use serde_json::{Value, json};

use super::bytes::of_good_pack;
use super::case::{Case, Item};

const FILE: &str = "pack/manifest.json";
const RUN: &str = "check pack mine -o out";
/// SHA-256 of an empty file.
const SHA256_OF_EMPTY: &str = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";

/// A well-formed manifest of one empty file.
fn good() -> Value {
    json!({
        "format": 1, "kind": "answers", "raypencilVersion": "0.1.0", "fluxModel": "radiometric",
        "scene": {"name": "s", "sha256": SHA256_OF_EMPTY},
        "sensors": [{"name": "camera", "columns": 4, "rows": 2}],
        "files": [{"path": "scene.toml", "role": "scene", "bytes": 0, "sha256": SHA256_OF_EMPTY}],
    })
}

fn text(name: &str, what: &'static str, place: &str, bytes: impl Into<Vec<u8>>) -> Case {
    Case::of_file(&format!("manifest-{name}"), what, RUN, FILE, bytes.into(), place)
        .file("pack/scene.toml", "")
        .item("mine", Item::Folder)
}

fn changed(name: &str, what: &'static str, place: &str, change: impl FnOnce(&mut Value)) -> Case {
    let mut manifest = good();
    change(&mut manifest);
    text(name, what, place, manifest.to_string())
}

fn set(name: &str, what: &'static str, pointer: &str, value: Value, place: &str) -> Case {
    changed(name, what, place, |manifest| {
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        manifest.pointer_mut(parent).expect("a place in the manifest")[key] = value;
    })
}

/// A manifest whose file has another path.
fn path(name: &str, what: &'static str, path: &str) -> Case {
    set(&format!("path-{name}"), what, "/files/0/path", json!(path), "file")
}

/// A committed pack with some files replaced.
fn with_replaced(name: &str, what: &'static str, words: &[&str], files: &[(&str, Item)]) -> Case {
    let mut case = Case::new(format!("pack-{name}"), what, RUN, words).item("mine", Item::Folder);
    for (path, item) in files {
        case = case.item(&format!("pack/{path}"), item.clone());
    }
    case.item("pack", Item::Pack("facets"))
}

pub(super) fn cases() -> Vec<Case> {
    [texts(), keys(), paths(), files()].concat()
}

fn texts() -> Vec<Case> {
    let whole = good().to_string();
    let mut cases = vec![
        text("empty", "an empty file", "JSON", ""),
        text("null", "null bytes", "JSON", [0; 64]),
        text("list", "a list in place of an object", "JSON", "[1]"),
        text("not-utf8", "a byte that is not UTF-8", "JSON", b"{\"format\": 1, \"kind\": \"\xff\"}".to_vec()),
        text(
            "deep",
            "a hundred thousand open brackets",
            "JSON",
            format!("{{\"format\": {}", "[".repeat(100_000)),
        ),
        text("large", "seventeen megabytes of blanks", "larger than", vec![b' '; 17 << 20]),
        text("key-twice", "a duplicate key", "JSON", whole.replacen('{', "{\"format\": 1,", 1)),
        text("after", "text after the object", "JSON", whole.clone() + "{}"),
        text("many-sensors", "a hundred thousand beams and forty thousand maps", "file", many()),
        Case::new("manifest-missing", "a folder without a manifest", RUN, &["pack", "manifest.json"])
            .item("pack", Item::Folder)
            .item("mine", Item::Folder),
        Case::new("manifest-folder", "a folder in place of the manifest", RUN, &[FILE, "not a regular file"])
            .item(FILE, Item::Folder),
        Case::new("manifest-pipe", "a pipe in place of the manifest", RUN, &[FILE, "not a regular file"])
            .item(FILE, Item::Pipe),
        Case::new("manifest-pack-is-file", "a file in place of the pack's folder", RUN, &["pack"])
            .file("pack", "no folder"),
    ];
    for part in [1, 3, 5, 7] {
        let at = whole.len() * part / 8;
        cases.push(text(
            &format!("cut-{part}-eighths"),
            "a truncated good file",
            "JSON",
            &whole.as_bytes()[..at],
        ));
    }
    cases
}

/// A manifest of 100,000 sensors and 40,000 files: a search through all sensors for each file would exceed the time.
fn many() -> String {
    let mut manifest = good();
    let beam = |index: u32| json!({"name": format!("beam-{index}"), "columns": 4, "rows": 2});
    let sensors = manifest["sensors"].as_array_mut().expect("the sensors");
    sensors.extend((0..100_000).map(beam));
    let file = |index: u32| {
        json!({"path": format!("beam-{}/{index}.npy", 60_000 + index), "role": "answers",
               "bytes": 0, "sha256": SHA256_OF_EMPTY, "type": "float64", "shape": [2, 4]})
    };
    manifest["files"] = (0..40_000).map(file).collect();
    manifest.to_string()
}

fn keys() -> Vec<Case> {
    vec![
        set("format-2", "an unknown format", "/format", json!(2), "format"),
        set("format-2-53", "a format beyond 2^53", "/format", json!((1_u64 << 53) + 1), "format"),
        set("format-negative", "a format of -1", "/format", json!(-1), "JSON"),
        set("key-unknown", "an unknown key", "/evil\u{1b}[31m", json!(1), "JSON"),
        set("kind", "an unknown kind", "/kind", json!("evil"), "JSON"),
        set("blind-no-seed", "a blind pack without a seed", "/kind", json!("blind"), "blindSeed"),
        set("seed", "a seed in a pack that is not blind", "/blindSeed", json!(1), "blindSeed"),
        set("seed-real", "a seed of 1.5", "/blindSeed", json!(1.5), "JSON"),
        set("scene-digest", "an invalid digest of the scene", "/scene/sha256", json!("0"), "scene.sha256"),
        set("no-sensors", "no sensors", "/sensors", json!([]), "sensors"),
        set("columns-2-32", "2^32 columns", "/sensors/0/columns", json!(1_u64 << 32), "JSON"),
        set("bytes-negative", "a file of -1 bytes", "/files/0/bytes", json!(-1), "JSON"),
        set("files-object", "an object in place of the list of files", "/files", json!({}), "JSON"),
        set("name-long", "a kind of a million letters", "/kind", json!("x".repeat(1_000_000)), "JSON"),
        changed("sensor-first", "a beam in place of the camera", "sensors[0]", |manifest| {
            manifest["sensors"] = json!([{"name": "beam-0", "columns": 1, "rows": 1}]);
        }),
        changed("sensor-twice", "two cameras", "sensors[1]", |manifest| {
            let camera = manifest["sensors"][0].clone();
            manifest["sensors"] = json!([camera, camera]);
        }),
        changed("sensor-0", "a camera without columns", "sensors[0]", |manifest| {
            manifest["sensors"][0]["columns"] = json!(0);
        }),
        changed("file-twice", "a duplicate file", "files[1]", |manifest| {
            let file = manifest["files"][0].clone();
            manifest["files"] = json!([file, file]);
        }),
        changed("shape-alone", "a shape without a type", "files[0]", |manifest| {
            manifest["files"][0]["shape"] = json!([2, 4]);
        }),
        changed("shape-9", "a shape of nine numbers", "files[0]", |manifest| {
            manifest["files"][0]["shape"] = json!(vec![2; 9]);
            manifest["files"][0]["type"] = json!("float64");
        }),
        changed("shape-other", "a map of another size than its sensor", "files[0]", |manifest| {
            manifest["files"][0] = json!({"path": "camera/range.T.npy", "role": "answers", "bytes": 0,
                "sha256": SHA256_OF_EMPTY, "type": "float64", "shape": [2, 5]});
        }),
    ]
}

fn paths() -> Vec<Case> {
    vec![
        path("up", "a file in the parent folder", "../secret.bin").file("secret.bin", ""),
        path("up-inside", "a path that goes down and up again", "a/../../secret.bin").file("secret.bin", ""),
        path("absolute", "an absolute path", "/etc/passwd"),
        path("backslash", "the parent folder, with a backslash", "..\\secret.bin"),
        path("drive", "a path with a drive letter", "C:secret.bin"),
        path("null", "a path with a null byte", "scene\u{0}.toml"),
        path("nothing", "an empty path", ""),
        path("dot", "the folder itself", "."),
        path("escape", "terminal escape codes", "\u{1b}[2J"),
        path("long", "a name of a hundred thousand letters", &"x".repeat(100_000)),
        path("percent", "the parent folder, in percent escapes", "%2e%2e/secret.bin").file("secret.bin", ""),
        path("missing", "a missing file", "gone.npy"),
        path("folder", "a folder in place of a file", "down")
            .item("pack/down", Item::Folder)
            .says(&["pack/down", "not a regular file"]),
        path("pipe", "a pipe in place of a file", "pipe")
            .item("pack/pipe", Item::Pipe)
            .says(&["pack/pipe", "not a regular file"]),
        path("link-out", "a link that leads out of the folder", "out.npy")
            .file("secret.bin", "")
            .item("pack/out.npy", Item::Link("../secret.bin".into())),
        path("link-folder", "a linked folder that leads out of the folder", "down/secret.bin")
            .file("down/secret.bin", "")
            .item("pack/down", Item::Link("../down".into())),
        path("link-to-itself", "a link to itself", "loop.npy")
            .item("pack/loop.npy", Item::Link("loop.npy".into())),
        path("device", "a link to /dev/zero", "zero").item("pack/zero", Item::Link("/dev/zero".into())),
    ]
}

/// Good packs with a changed file.
fn files() -> Vec<Case> {
    let file = |bytes: &[u8]| Item::File(bytes.to_vec());
    vec![
        set("size", "a size that differs from the listed one", "/files/0/bytes", json!(1), "scene.toml")
            .says(&["pack/scene.toml"]),
        set("size-top", "a size of 2^64 - 1", "/files/0/bytes", json!(u64::MAX), "scene.toml")
            .says(&["pack/scene.toml"]),
        set(
            "digest",
            "a digest that differs from the listed one",
            "/files/0/sha256",
            json!("0".repeat(64)),
            "scene.toml",
        )
        .says(&["pack/scene.toml"]),
        set(
            "digest-upper",
            "a digest in capitals",
            "/files/0/sha256",
            json!(SHA256_OF_EMPTY.to_uppercase()),
            "files[0]",
        ),
        changed("scene-empty", "an empty scene, listed correctly", "scene.toml", |_| ())
            .says(&["pack/scene.toml"]),
        with_replaced(
            "map-empty",
            "a good pack with an empty map",
            &["camera.exr", "bytes"],
            &[("camera.exr", file(b""))],
        ),
        with_replaced(
            "map-pipe",
            "a good pack with a pipe in place of a map",
            &["camera.exr", "not a regular file"],
            &[("camera.exr", Item::Pipe)],
        ),
        with_replaced(
            "map-folder",
            "a good pack with a folder in place of a map",
            &["camera.exr", "not a regular file"],
            &[("camera.exr", Item::Folder)],
        ),
        ground_outside(),
        changed("scene-unlisted", "a scene that is not listed", "scene.toml", |manifest| {
            manifest["files"] = json!([]);
        }),
    ]
}

/// A pack with a correctly listed scene, whose terrain is outside the pack.
fn ground_outside() -> Case {
    let toml = String::from_utf8(of_good_pack("scene.toml")).expect("a text");
    let toml = toml.replace("terrain.glb", "../ground.glb");
    let glb = of_good_pack("terrain.glb");
    let mut manifest: Value = serde_json::from_slice(&of_good_pack("manifest.json")).expect("a manifest");
    for entry in manifest["files"].as_array_mut().expect("files") {
        if entry["path"] == "scene.toml" {
            entry["bytes"] = json!(toml.len());
            entry["sha256"] = json!(super::bytes::sha256(toml.as_bytes()));
        }
    }
    with_replaced(
        "ground-outside",
        "a good pack with its terrain outside the pack",
        &["pack/scene.toml", "../ground.glb"],
        &[
            ("scene.toml", Item::File(toml.into_bytes())),
            ("manifest.json", Item::File(manifest.to_string().into_bytes())),
        ],
    )
    .file("ground.glb", glb)
}
