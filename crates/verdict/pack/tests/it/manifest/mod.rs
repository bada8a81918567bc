//! Manifests: a written one is read back; a changed file and a path out of the folder are refused.

mod schema;

use std::path::Path;

use raypencil_files::write_npy;
use raypencil_pack::{
    ChannelType, FileRole, FileType, Manifest, ManifestChannel, ManifestClause, ManifestFile, ManifestScene,
    ManifestSensor, ManifestSharpness, PackKind,
};
use raypencil_scene::{FluxModel, Image};

/// SHA-256 of nothing and of "abc" (FIPS 180-4, examples).
const NOTHING: &str = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";

const ABC: &str = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

/// A manifest of two files. The second has every key that a file can have.
fn manifest() -> Manifest {
    let sensor = |name: &str, columns, rows| ManifestSensor { name: name.into(), columns, rows };
    let bare = |path: &str, role| ManifestFile {
        path: path.into(),
        role,
        bytes: 3,
        sha256: ABC.into(),
        kind: None,
        shape: None,
        channels: Vec::new(),
    };
    let channel = ManifestChannel { name: "range.T".into(), unit: "m".into(), kind: ChannelType::Float64 };
    Manifest {
        format: 1,
        kind: PackKind::Answers,
        raypencil_version: "0.1.0".into(),
        version: None,
        licence: None,
        scene: ManifestScene { name: "pyramids".into(), sha256: NOTHING.into() },
        flux_model: FluxModel::Radiometric,
        blind_seed: None,
        sensors: vec![sensor("camera", 3, 2), sensor("beam-0", 5, 1)],
        clauses: Vec::new(),
        sharpness: Vec::new(),
        files: vec![
            bare("scene.toml", FileRole::Scene),
            ManifestFile {
                kind: Some(FileType::Float64),
                shape: Some(vec![2, 3]),
                channels: vec![channel],
                ..bare("camera/range.T.npy", FileRole::Answers)
            },
        ],
    }
}

/// [`manifest`] as that of a blind pack.
fn blind() -> Manifest {
    let mut blind = manifest();
    (blind.kind, blind.blind_seed) = (PackKind::Blind, Some(7));
    blind.sharpness = vec![ManifestSharpness {
        slack: "shift-right".into(),
        unit: "of a cell".into(),
        f64: Some(5e-9),
        f32: Some(0.01),
    }];
    (blind.version, blind.licence) = (Some("1.0.0".into()), Some("CC0-1.0".into()));
    blind.files.truncate(1);
    blind.clauses = vec![ManifestClause { clause: "fronts-only".into(), rays: 9 }];
    blind
}

/// A folder with a scene, a map and their manifest.
fn pack() -> (tempfile::TempDir, Manifest) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), "abc").unwrap();
    std::fs::create_dir(folder.path().join("camera")).unwrap();
    write_npy(folder.path().join("camera/range.T.npy"), &[&Image::filled(3, 2, 1.5_f64)]).unwrap();
    let mut written = manifest();
    for (entry, role) in written.files.iter_mut().zip([FileRole::Scene, FileRole::Answers]) {
        let ManifestFile { bytes, sha256, .. } =
            ManifestFile::of(folder.path(), entry.path.clone(), role).unwrap();
        (entry.bytes, entry.sha256) = (bytes, sha256);
    }
    written.write(folder.path()).unwrap();
    (folder, written)
}

fn refusal(folder: &Path) -> String {
    let start = format!("{}", folder.display());
    Manifest::read_verified(folder).unwrap_err().to_string().replace(&start, "PACK")
}

#[test]
fn a_pack_is_read_back_and_other_files_are_left_alone() {
    let (folder, written) = pack();
    std::fs::write(folder.path().join("notes.txt"), "mine").unwrap();
    assert_eq!(Manifest::read_verified(folder.path()).unwrap(), written);
    assert_eq!((written.files[0].bytes, written.files[0].sha256.as_str()), (3, ABC));
    // A header of 128 bytes and six doubles.
    assert_eq!(written.files[1].bytes, 128 + 48);
    let text = std::fs::read_to_string(folder.path().join("manifest.json")).unwrap();
    assert!(text.ends_with("}\n") && !text.contains("blindSeed") && text.contains("\"raypencilVersion\""));
    written.write(folder.path()).unwrap();
    assert_eq!(std::fs::read_to_string(folder.path().join("manifest.json")).unwrap(), text);
}

#[test]
fn files_that_were_changed_are_named() {
    let (folder, written) = pack();
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, "abd").unwrap();
    let message = refusal(folder.path());
    assert!(
        message.starts_with(
            "PACK/scene.toml: SHA-256: a52d159f262b2c6ddb724a61840befc36eb30c88877a4030b65cbe86298449c9"
        ),
        "{message}"
    );
    assert!(
        message.ends_with(&format!("expected {ABC} (was it changed after it was written?)")),
        "{message}"
    );
    std::fs::write(&scene, "ab").unwrap();
    assert_eq!(
        refusal(folder.path()),
        "PACK/scene.toml: bytes: 2; expected 3 (was it changed after it was written?)"
    );
    std::fs::remove_file(&scene).unwrap();
    assert_eq!(
        refusal(folder.path()),
        "PACK/manifest.json: file \"scene.toml\": missing; expected the file that was packed"
    );
    std::fs::create_dir(&scene).unwrap();
    assert_eq!(refusal(folder.path()), "PACK/scene.toml: cannot read: not a regular file");
    assert_eq!(written.files.len(), 2);
}

#[test]
fn every_digit_of_a_digest_counts() {
    for digit in 0..64 {
        let message = changed(|m| {
            let mut digits: Vec<char> = m["files"][0]["sha256"].as_str().unwrap().chars().collect();
            digits[digit] = if digits[digit] == '0' { '1' } else { '0' };
            m["files"][0]["sha256"] = digits.into_iter().collect::<String>().into();
        });
        assert!(message.starts_with("PACK/scene.toml: SHA-256: "), "digit {digit}: {message}");
    }
}

#[test]
fn folders_without_a_valid_manifest_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let none = "PACK: pack: no manifest.json; expected a folder with manifest.json (is this a pack?)";
    assert_eq!(refusal(folder.path()), none);
    let misspelt = refusal(&folder.path().join("pakc"));
    let words =
        "pack: there is no such folder; expected the folder of a pack, with manifest.json or raypack.json";
    assert!(misspelt.ends_with(words), "{misspelt}");
    let with = |text: &str| {
        std::fs::write(folder.path().join("manifest.json"), text).unwrap();
        refusal(folder.path())
    };
    let schema = "expected a manifest as docs/formats/pack.schema.json describes";
    for text in
        ["", "{", "[1]", "{\"format\": -1}", "{\"format\": 1}", "{\"format\": 1e400}", "{\"format\": nan}"]
    {
        let message = with(text);
        assert!(message.starts_with("PACK/manifest.json: JSON: ") && message.ends_with(schema), "{message}");
    }
    assert_eq!(
        with("{\"format\": 2, \"new\": 1}"),
        "PACK/manifest.json: format: 2; expected 1 (was it written by a newer version?)"
    );
    assert_eq!(with("{\"format\": 0}"), "PACK/manifest.json: format: 0; expected 1");
    assert!(with(&"[".repeat(100_000)).contains("JSON: "));
}

/// The refusal of a manifest whose JSON was changed.
fn changed(change: impl FnOnce(&mut serde_json::Value)) -> String {
    let (folder, written) = pack();
    let mut value = serde_json::to_value(written).unwrap();
    change(&mut value);
    std::fs::write(folder.path().join("manifest.json"), value.to_string()).unwrap();
    refusal(folder.path()).replace("PACK/manifest.json: ", "")
}

#[test]
fn manifests_that_contradict_themselves_are_refused() {
    assert_eq!(
        changed(|m| m["blindSeed"] = 7.into()),
        "blindSeed: 7; expected none: the answers are in the pack"
    );
    assert_eq!(
        changed(|m| m["kind"] = "blind".into()),
        "blindSeed: absent; expected a seed: the pack is blind"
    );
    assert_eq!(
        changed(|m| (m["kind"], m["blindSeed"]) = ("questions".into(), 7.into())),
        "blindSeed: 7; expected none: the scene is of no seed"
    );
    let digits = "expected 64 hexadecimal digits in lower case";
    assert_eq!(changed(|m| m["scene"]["sha256"] = "0".into()), format!("scene.sha256: \"0\"; {digits}"));
    let upper = ABC.to_uppercase();
    assert_eq!(
        changed(|m| m["files"][0]["sha256"] = upper.clone().into()),
        format!("files[0] \"scene.toml\": sha256: \"{upper}\"; {digits}")
    );
    assert_eq!(
        changed(|m| m["files"][1]["path"] = "scene.toml".into()),
        "files[1] \"scene.toml\": there twice; expected each file once"
    );
    assert!(changed(|m| m["extra"] = 1.into()).starts_with("JSON: unknown field `extra`"));
    assert!(changed(|m| m["files"][0]["bytes"] = (-1).into()).starts_with("JSON: invalid value"));
    assert!(changed(|m| m["files"][0]["role"] = "x".into()).starts_with("JSON: unknown variant `x`"));
}

#[test]
fn wrong_sensors_are_refused() {
    assert_eq!(
        changed(|m| m["sensors"][1]["name"] = "beam-1".into()),
        "sensors[1]: \"beam-1\"; expected \"beam-0\""
    );
    assert_eq!(
        changed(|m| m["sensors"][0]["name"] = "eye".into()),
        "sensors[0]: \"eye\"; expected \"camera\""
    );
    assert_eq!(
        changed(|m| m["sensors"] = serde_json::json!([])),
        "sensors: none; expected the camera at least"
    );
    assert_eq!(
        changed(|m| m["sensors"][0]["rows"] = 0.into()),
        "sensors[0]: camera of 3 x 0 cells; expected 1 to 1048576 columns and rows"
    );
    let place = "files[1] \"camera/range.T.npy\"";
    assert_eq!(
        changed(|m| m["sensors"][0]["columns"] = 4.into()),
        format!("{place}: 2 rows of 3 columns; expected 2 rows of 4 columns, as camera has")
    );
    assert_eq!(
        changed(|m| m["files"][1]["shape"] = serde_json::json!([2])),
        format!("{place}: a shape of 1 numbers; expected rows and columns, and components of an array")
    );
    let one = changed(|m| drop(m["files"][1].as_object_mut().unwrap().remove("type")));
    assert_eq!(one, format!("{place}: one of type and shape; expected both or neither"));
}

#[test]
fn paths_that_leave_the_folder_are_refused() {
    let stays = "expected a path within the pack's folder, with / between its parts";
    for path in ["/etc/passwd", "../scene.toml", "camera/../../x", "", "camera//x", "./scene.toml", "camera/"]
    {
        let message = changed(|m| m["files"][0]["path"] = path.into());
        let why = "is absolute, leads out of the folder or names no file";
        assert_eq!(message, format!("files[0] {path:?}: {why}; {stays}"));
    }
    for path in ["C:\\x", "camera\\x", "file:x", "a\0b"] {
        let message = changed(|m| m["files"][0]["path"] = path.into());
        assert_eq!(message, format!("files[0] {path:?}: has a backslash, a drive or a scheme; {stays}"));
    }
    #[cfg(unix)]
    {
        let (folder, _) = pack();
        let outside = tempfile::tempdir().unwrap();
        std::fs::write(outside.path().join("scene.toml"), "abc").unwrap();
        std::fs::remove_file(folder.path().join("scene.toml")).unwrap();
        std::os::unix::fs::symlink(outside.path().join("scene.toml"), folder.path().join("scene.toml"))
            .unwrap();
        let why = "file \"scene.toml\": leads out of the folder by a link";
        assert_eq!(refusal(folder.path()), format!("PACK/manifest.json: {why}; {stays}"));
    }
}

#[test]
fn a_manifest_that_would_be_refused_is_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let mut bad = manifest();
    bad.files[0].path = "../scene.toml".into();
    let message = bad.write(folder.path()).unwrap_err().to_string();
    assert!(message.contains("files[0] \"../scene.toml\": is absolute, leads out"), "{message}");
    assert!(!folder.path().join("manifest.json").exists());
    let message = ManifestFile::of(folder.path(), "none.npy", FileRole::Rays).unwrap_err().to_string();
    assert!(message.ends_with("file \"none.npy\": missing; expected the file that was packed"), "{message}");
}
