//! The build stays light: few test executables, one command to build, one version of what is heavy.
//! (docs/evidence/build-times.md has the times)

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use cargo_metadata::{Metadata, MetadataCommand};
use toml::Table;

use super::source::root;

/// Most test executables of the workspace: each links the house once more.
const MAX_TEST_EXECUTABLES: usize = 45;

/// The packages that take longest to compile (docs/evidence/build-times.md), the house's own left out. A second version of one
/// of them costs as much again.
const HEAVIEST: &[&str] = &[
    "obvhs",
    "dashu-int",
    "exr",
    "glam",
    "mcap",
    "parquet",
    "toml",
    "tiny-skia",
    "zip",
    "gltf-json",
    "serde_json",
    "proptest",
    "clap_builder",
];

/// Packages that were left out, because something smaller does the same.
const LEFT_OUT: &[(&str, &str)] = &[
    ("resvg", "drawings are painted by tiny-skia: crates/base/report/src/paint.rs"),
    ("skrifa", "letters are read by ttf-parser: crates/base/report/src/letters.rs"),
    ("zstd-sys", "bags are compressed by LZ4"),
    ("icu_segmenter", "the lock holds textwrap, of miette, at 0.16.2"),
];

/// The workspace, without its dependencies: nothing has to be fetched.
fn workspace() -> Metadata {
    let manifest = root().join("Cargo.toml");
    MetadataCommand::new().manifest_path(manifest).no_deps().exec().expect("cargo metadata")
}

/// The versions of each package in the lock.
fn locked() -> BTreeMap<String, BTreeSet<String>> {
    let lock: Table =
        fs::read_to_string(root().join("Cargo.lock")).expect("Cargo.lock").parse().expect("TOML");
    let mut found: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for package in lock["package"].as_array().expect("packages") {
        let [name, version] =
            ["name", "version"].map(|key| package[key].as_str().expect("a text").to_string());
        found.entry(name).or_default().insert(version);
    }
    assert!(found.len() > 100, "{} packages in Cargo.lock", found.len());
    found
}

#[test]
fn test_executables_are_few() {
    let mut found = Vec::new();
    for package in &workspace().packages {
        for target in package.targets.iter().filter(|target| target.test) {
            found.push(format!("{} {}", package.name, target.name));
        }
    }
    assert!(
        (20..=MAX_TEST_EXECUTABLES).contains(&found.len()),
        "{} test executables: {found:#?}",
        found.len()
    );
}

/// Cargo builds no unit test of a library with `test = false`, and says nothing of it.
#[test]
fn a_library_without_a_test_executable_has_no_unit_tests() {
    fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("a folder of sources") {
            let path = entry.expect("an entry").path();
            match path.is_dir() {
                true => sources(&path, found),
                false if path.extension().is_some_and(|ending| ending == "rs") => found.push(path),
                false => {}
            }
        }
    }
    for package in &workspace().packages {
        let library = package.targets.iter().find(|target| target.src_path.ends_with("src/lib.rs"));
        let Some(library) = library.filter(|target| !target.test) else { continue };
        let mut all = Vec::new();
        sources(library.src_path.as_std_path().parent().expect("a folder"), &mut all);
        for path in all {
            let text = fs::read_to_string(&path).expect("a source file");
            assert!(!text.contains("#[cfg(test)]"), "{}: cargo runs none of its tests", path.display());
        }
    }
}

#[test]
fn the_first_command_builds_the_command_alone() {
    let workspace = workspace();
    let built: Vec<String> =
        workspace.workspace_default_packages().iter().map(|package| package.name.to_string()).collect();
    assert_eq!(built, ["raypencil-cli"]);
}

#[test]
fn what_is_heavy_is_in_the_lock_once() {
    let locked = locked();
    for name in HEAVIEST {
        let versions =
            locked.get(*name).unwrap_or_else(|| panic!("{name} is not in Cargo.lock: is it still heavy?"));
        assert_eq!(versions.len(), 1, "{name} is compiled once for each of {versions:?}");
    }
    for (name, instead) in LEFT_OUT {
        assert!(!locked.contains_key(*name), "{name} is in Cargo.lock; {instead}");
    }
}

/// Cargo only warns of a profile for a package that is gone, and a kernel that is named wrongly would not be optimised.
#[test]
fn each_level_of_optimisation_is_for_a_package_that_exists() {
    let locked = locked();
    let manifest: Table =
        fs::read_to_string(root().join("Cargo.toml")).expect("Cargo.toml").parse().expect("TOML");
    let mut levels: BTreeMap<&str, BTreeMap<String, i64>> = BTreeMap::new();
    for profile in ["release", "test"] {
        for (name, of_package) in manifest["profile"][profile]["package"].as_table().expect("packages") {
            if name == "*" {
                // All packages of others; their levels stand one by one.
                assert!(!of_package.as_table().expect("a table").contains_key("opt-level"));
                continue;
            }
            assert!(
                locked.contains_key(name),
                "{name} has a level in the profile {profile} and is not in Cargo.lock"
            );
            let level = of_package["opt-level"].as_integer().expect("a level");
            levels.entry(profile).or_default().insert(name.clone(), level);
        }
    }
    // The kernels are the same ones in both, so that the tests try what people run. Cargo.toml says why
    // `drive` is the exception.
    let kernels = |profile: &str| -> BTreeSet<String> {
        let fast = levels[profile].iter().filter(|(_, level)| **level == 3);
        fast.map(|(name, _)| name.clone()).collect()
    };
    let mut released = kernels("release");
    assert!(released.remove("raypencil-drive"), "the tests have a level of their own for it");
    assert_eq!(released, kernels("test"));
    for kernel in ["scanline", "tracer", "referee"] {
        assert!(kernels("release").contains(&format!("raypencil-{kernel}")), "{kernel} is not optimised");
    }
}
