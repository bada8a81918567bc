//! What a release promises, told in several places, is the same in all of them.

use std::fs;

use serde_json::Value;
use toml::Table;

use super::source::{crates, root};

fn text(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// `workspace` of the manifest.
fn workspace() -> Table {
    let manifest: Table = text("Cargo.toml").parse().expect("TOML");
    manifest["workspace"].as_table().expect("a table").clone()
}

#[test]
fn one_version_is_told_everywhere() {
    let workspace = workspace();
    let version = workspace["package"]["version"].as_str().expect("a version").to_string();
    assert!(
        text("CITATION.cff").contains(&format!("\nversion: {version}\n")),
        "CITATION.cff, version {version}"
    );
    let mut ours = 0;
    for (name, dependency) in workspace["dependencies"].as_table().expect("a table") {
        // The tests are no package; without a version they are left out of those that are.
        if dependency.get("path").is_some() && name != "raypencil-tests" {
            assert_eq!(dependency["version"].as_str(), Some(version.as_str()), "{name} in Cargo.toml");
            ours += 1;
        }
    }
    assert!(ours > 25, "{ours} crates");
}

#[test]
fn one_oldest_compiler_is_told_everywhere() {
    let workspace = workspace();
    let oldest = workspace["package"]["rust-version"].as_str().expect("a version").to_string();
    assert!(text("README.md").contains(&format!("({oldest} or later)")), "README.md, Rust {oldest}");
    assert!(
        text("CONTRIBUTING.md").contains(&format!("`rust-version` is {oldest}")),
        "CONTRIBUTING.md, Rust {oldest}"
    );
}

#[test]
fn crates_behind_the_door_are_marked() {
    // Everything but the library, the command and the Python package.
    let faces = ["raypencil", "cli", "python"];
    let mut internal = 0;
    for (name, folder) in crates() {
        let manifest: Table = text(&format!("{folder}/Cargo.toml")).parse().expect("TOML");
        let description = manifest["package"]["description"].as_str().expect("a description").to_string();
        let is_face = faces.contains(&name.as_str());
        assert_ne!(description.starts_with("Internal to raypencil. "), is_face, "{folder}/Cargo.toml");
        let docs = text(&format!("{folder}/src/lib.rs"));
        assert_ne!(docs.contains("//! Internal to raypencil: "), is_face, "{folder}/src/lib.rs");
        internal += usize::from(!is_face);
    }
    assert!(internal > 20, "{internal} internal crates");
}

#[test]
fn each_schema_has_a_name_with_its_format() {
    let mut schemas = 0;
    for entry in fs::read_dir(root().join("docs/formats")).expect("the formats") {
        let file = entry.expect("an entry").file_name().to_string_lossy().into_owned();
        let Some(name) = file.strip_suffix(".schema.json") else { continue };
        let schema: Value = serde_json::from_str(&text(&format!("docs/formats/{file}"))).expect("JSON");
        let properties = &schema["properties"];
        // A drive's `format` is a word, and a number stands beside it.
        let format = [&properties["format"]["const"], &properties["format_version"]["const"]];
        let format = format.into_iter().find_map(Value::as_u64).expect("a number of the format");
        assert_eq!(schema["$id"], format!("urn:raypencil:schema:{name}:{format}"), "{file}");
        schemas += 1;
    }
    assert!(schemas >= 6, "{schemas} schemas");
}

#[test]
fn one_cargo_deny_is_asked_everywhere() {
    let run = text(".ci/run");
    let version = run.split("cargo_deny=").nth(1).and_then(|rest| rest.lines().next()).expect("a version");
    assert!(
        text(".github/workflows/ci.yml").contains(&format!("--version {version} ")),
        "cargo-deny {version}"
    );
}
