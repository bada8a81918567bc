//! Unsafe code: the lint `unsafe_code` forbids it in every crate, but for those that this file names.

use std::fs;

use toml::Table;

use super::source::{crates, root};

/// The crates that may have unsafe code, and the one file of each that has it.
const MAY: &[(&str, &str)] = &[
    // What runs before the standard library hides a closed standard output.
    ("cli", "src/closed_output.rs"),
    // Arrays of NumPy on memory of ours.
    ("python", "src/mesh.rs"),
    // Code for fused operations, and hints to the processor's memory.
    ("referee", "src/lanes.rs"),
    // Code for AVX2.
    ("tracer", "src/lanes.rs"),
];

/// What is wrong with the lints of a crate, if anything is: those of the workspace hold, in a crate of [`MAY`] with
/// `unsafe_code` denied, so that each place has to allow it and to say why.
fn fault(name: &str, manifest: &Table, workspace: &Table) -> Option<String> {
    let lints = manifest.get("lints").and_then(toml::Value::as_table);
    let Some(lints) = lints else { return Some("has no [lints]".into()) };
    if !MAY.iter().any(|(may, _)| *may == name) {
        let is_of_workspace = lints.len() == 1 && lints.get("workspace") == Some(&true.into());
        return (!is_of_workspace).then(|| "has lints of its own; expected those of the workspace".into());
    }
    let mut expected = workspace.clone();
    expected["rust"]["unsafe_code"] = "deny".into();
    (*lints != expected)
        .then(|| "differs from the workspace's lints in more than unsafe_code = \"deny\"".into())
}

fn read(path: &str) -> Table {
    let text = fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"));
    text.parse().unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The lints of the workspace.
fn workspace() -> Table {
    let lints = read("Cargo.toml")["workspace"]["lints"].as_table().expect("a table").clone();
    assert_eq!(lints["rust"]["unsafe_code"], "forbid".into());
    lints
}

/// The folders of all members: crates, and the tests of the whole house.
fn members() -> Vec<(String, String)> {
    crates()
        .into_iter()
        .map(|(name, folder)| (format!("{folder}/Cargo.toml"), name))
        .chain([("tests/Cargo.toml".into(), "tests".into())])
        .collect()
}

#[test]
fn unsafe_code_is_where_it_may_be() {
    let workspace = workspace();
    let members = members();
    let faults = members.iter().filter_map(|(path, name)| {
        fault(name, &read(path), &workspace).map(|fault| format!("{path} {fault}"))
    });
    assert_eq!(faults.collect::<Vec<_>>(), Vec::<String>::new());
    assert!(members.len() > 25, "{} members", members.len());
    // A crate that no longer needs it leaves the list.
    for (name, file) in MAY {
        let text = fs::read_to_string(root().join(&crates()[*name]).join(file)).expect("the file");
        assert!(text.contains("#[allow(unsafe_code, reason = "), "{file} of {name} has no unsafe code");
    }
}

#[test]
fn lints_that_let_unsafe_code_in_are_found() {
    let workspace = workspace();
    let manifest = |text: &str| text.parse::<Table>().expect("TOML");
    assert_eq!(fault("scene", &manifest("lints.workspace = true"), &workspace), None);
    assert!(fault("scene", &manifest(""), &workspace).is_some());
    assert!(fault("scene", &manifest("[lints.rust]\nunsafe_code = \"deny\""), &workspace).is_some());
    let mut own = read("crates/engines/tracer/Cargo.toml");
    assert_eq!(fault("tracer", &own, &workspace), None);
    assert!(fault("scanline", &own, &workspace).is_some());
    own["lints"]["rust"]["unsafe_code"] = "allow".into();
    assert!(fault("tracer", &own, &workspace).is_some());
    assert!(fault("tracer", &manifest("lints.workspace = true"), &workspace).is_some());
}
