//! Floors: a crate depends on crates of lower floors only, and the evaluations on `scene` alone.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use cargo_metadata::{DependencyKind, MetadataCommand, Package};

use super::source::{FOLDERS, crates, root};

/// Each crate, and its floor. A crate may depend on crates of lower floors, never on its own floor or above.
const FLOORS: &[(&str, u32)] = &[
    ("scene", 1),
    ("scanline", 2),
    ("tracer", 2),
    ("naive", 2),
    ("referee", 2),
    ("sensor", 2),
    ("terrain", 2),
    ("files", 2),
    ("report", 2),
    ("minimise", 2),
    ("chassis", 2),
    ("rosbag", 3),
    ("rover", 3),
    ("survey", 3),
    ("judge", 3),
    ("mesh-io", 3),
    ("explorer", 4),
    ("diagnosis", 4),
    ("scene-io", 4),
    ("diff", 5),
    ("drive", 5),
    ("pack", 5),
    ("cast", 6),
    ("harness", 7),
    ("campaign", 8),
    ("sweep", 8),
    ("raypencil", 9),
    ("cli", 10),
    ("python", 11),
];

/// Narrower than their floor: these crates may depend on no others than those named.
const NARROWER: &[(&str, &[&str])] = &[
    // The three evaluations share definitions and no kernels.
    ("scanline", &["scene"]),
    ("tracer", &["scene"]),
    ("naive", &["scene"]),
    ("referee", &["scene"]),
    // The simulated vehicle is the truth for the rover: it shares no code with it.
    ("chassis", &["scene"]),
    // The judge knows no renderer.
    ("judge", &["scene", "referee", "files"]),
    // An explanation is tried on the candidate's own numbers: it asks the judge, and renders nothing of the house.
    ("diagnosis", &["scene", "files", "judge"]),
    // Pages show what the judge found; they render nothing.
    ("explorer", &["scene", "judge"]),
    // The command sees what every user of the library sees.
    ("cli", &["raypencil"]),
    // So does the Python package, which carries the command.
    ("python", &["raypencil", "cli"]),
];

/// These may not even share test code: for their tests they have `terrain`, as data.
pub(crate) const EVALUATIONS: &[&str] = &["scanline", "tracer", "referee"];

/// Our crates by folder.
fn house() -> BTreeMap<String, Package> {
    // Without dependencies nothing has to be fetched.
    let metadata = MetadataCommand::new()
        .manifest_path(root().join("Cargo.toml"))
        .no_deps()
        .exec()
        .expect("cargo metadata");
    let folder = |package: &Package| {
        let folder = package.manifest_path.parent().expect("a manifest is in a folder");
        folder.file_name().expect("it has a name").to_string()
    };
    let crates = metadata.packages.into_iter().map(|package| (folder(&package), package));
    crates.filter(|(folder, _)| folder != "tests").collect()
}

/// The crates of this house that a package depends on, by folder: normal ones (and of build scripts), and
/// those of its tests.
fn stands_on(package: &Package, house: &BTreeMap<String, Package>) -> [BTreeSet<String>; 2] {
    let mut found = [BTreeSet::new(), BTreeSet::new()];
    for dependency in &package.dependencies {
        let of_house = house.iter().find(|(_, other)| *other.name == *dependency.name);
        if let Some((folder, _)) = of_house {
            found[usize::from(dependency.kind == DependencyKind::Development)].insert(folder.clone());
        }
    }
    found
}

/// What is wrong with the dependencies of one crate: `normal` ones, and those `of_tests`.
fn faults(name: &str, normal: &BTreeSet<String>, of_tests: &BTreeSet<String>) -> Vec<String> {
    let floor = |name: &str| FLOORS.iter().find(|(of, _)| *of == name).map(|(_, floor)| *floor);
    let Some(level) = floor(name) else { return vec![format!("{name} has no floor in FLOORS")] };
    let mut faults = Vec::new();
    for other in normal.iter().filter(|other| floor(other).is_none_or(|below| below >= level)) {
        faults.push(format!("{name} depends on {other}, which is not on a lower floor"));
    }
    // Tests may reach sideways for data, not up.
    for other in of_tests.iter().filter(|other| floor(other).is_none_or(|below| below > level)) {
        faults.push(format!("the tests of {name} depend on {other}, which is on a higher floor"));
    }
    if let Some((_, may)) = NARROWER.iter().find(|(of, _)| *of == name) {
        for other in normal.iter().filter(|other| !may.contains(&other.as_str())) {
            faults.push(format!("{name} depends on {other}; it may depend on {} alone", may.join(", ")));
        }
    }
    faults
}

#[test]
fn crates_stand_on_lower_floors_only() {
    let house = house();
    let missing: Vec<_> = FLOORS.iter().filter(|(name, _)| !house.contains_key(*name)).collect();
    assert!(missing.is_empty(), "these crates are gone, or cargo metadata does not see them: {missing:?}");
    let mut found = Vec::new();
    for (name, package) in &house {
        let [normal, of_tests] = stands_on(package, &house);
        found.extend(faults(name, &normal, &of_tests));
    }
    assert!(found.is_empty(), "{found:#?}");
}

/// What is wrong with where crates lie: in a folder that is no floor's, or on one of a folder above.
fn misplaced(crates: &BTreeMap<String, String>, stands_on: impl Fn(&str) -> BTreeSet<String>) -> Vec<String> {
    let level = |name: &str| {
        let folder = crates[name].split('/').nth(1);
        FOLDERS.iter().position(|known| Some(*known) == folder)
    };
    let above = |name: &str| {
        let others = stands_on(name).into_iter();
        others.filter(|other| level(other) > level(name)).collect::<Vec<_>>()
    };
    let faults = crates.iter().map(|(name, path)| (path, above(name)));
    faults
        .filter(|(_, above)| !above.is_empty())
        .map(|(path, above)| format!("{path} stands on {}, in a folder above", above.join(", ")))
        .collect()
}

/// Folder after folder, from the bottom up: a newcomer who reads them in this order meets nothing that comes later.
#[test]
fn six_folders_show_the_floors() {
    let house = house();
    let crates = crates();
    assert_eq!(crates.keys().collect::<Vec<_>>(), house.keys().collect::<Vec<_>>());
    let of_folders = fs::read_dir(root().join("crates"))
        .expect("the folders")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned());
    assert_eq!(of_folders.collect::<BTreeSet<_>>(), FOLDERS.map(String::from).into());
    let normal = |name: &str| stands_on(&house[name], &house)[0].clone();
    assert_eq!(misplaced(&crates, normal), Vec::<String>::new());
    // Each is told in its folder's page, in ten lines or a few more.
    for folder in FOLDERS {
        let page = fs::read_to_string(root().join(format!("crates/{folder}/README.md"))).expect("a page");
        assert!(page.lines().count() <= 16, "crates/{folder}/README.md is for a glance");
        let told: BTreeSet<&str> =
            page.lines().filter_map(|line| line.strip_prefix("* [")?.split(']').next()).collect();
        let here = crates.iter().filter(|(_, path)| path.starts_with(&format!("crates/{folder}/")));
        assert_eq!(told, here.map(|(name, _)| name.as_str()).collect(), "crates/{folder}/README.md");
    }
}

#[test]
fn a_crate_in_a_wrong_folder_is_found() {
    let crates =
        [("scene", "crates/base/scene"), ("judge", "crates/verdict/judge"), ("files", "crates/base/files")];
    let crates = crates.map(|(name, path)| (name.to_string(), path.to_string())).into();
    let arrow = |from: &'static str, to: &'static str| {
        move |name: &str| if name == from { BTreeSet::from([to.to_string()]) } else { BTreeSet::new() }
    };
    assert_eq!(misplaced(&crates, arrow("files", "judge")).len(), 1);
    assert!(misplaced(&crates, arrow("judge", "files")).is_empty());
    assert!(misplaced(&crates, arrow("files", "scene")).is_empty());
}

#[test]
fn arrows_that_run_up_or_sideways_are_found() {
    let names = |names: &[&str]| names.iter().map(ToString::to_string).collect::<BTreeSet<String>>();
    let none = BTreeSet::new();
    // Up, on the same floor, to a crate without a floor.
    assert_eq!(faults("files", &names(&["judge"]), &none).len(), 1);
    assert_eq!(faults("drive", &names(&["pack"]), &none).len(), 1);
    assert_eq!(faults("drive", &names(&["attic"]), &none).len(), 1);
    assert_eq!(faults("attic", &none, &none).len(), 1);
    // The judge and a renderer, which is on a lower floor; the command past the facade.
    assert_eq!(faults("judge", &names(&["scanline"]), &none).len(), 1);
    assert_eq!(faults("cli", &names(&["raypencil", "harness"]), &none).len(), 1);
    // Tests sideways, and up.
    assert_eq!(faults("rover", &names(&["terrain"]), &names(&["judge"])), Vec::<String>::new());
    assert_eq!(faults("rover", &none, &names(&["harness"])).len(), 1);
}

/// The crates that users link proptest with, and how `raypencil` depends on them.
#[test]
fn proptest_is_behind_the_feature_of_campaigns() {
    let house = house();
    for (name, package) in &house {
        let is_linked = package
            .dependencies
            .iter()
            .any(|other| other.name == "proptest" && other.kind == DependencyKind::Normal);
        assert_eq!(is_linked, name == "campaign", "{name} has proptest for more than its tests");
    }
    let of_campaigns = |package: &&Package| {
        package.dependencies.iter().any(|other| {
            other.name == "raypencil-campaign" && other.kind == DependencyKind::Normal && !other.optional
        })
    };
    let users: Vec<&Package> = house.values().filter(of_campaigns).collect();
    assert!(users.is_empty(), "these crates always bring campaigns: {users:#?}");
}

#[test]
fn the_evaluations_share_definitions_and_no_kernels() {
    let house = house();
    for name in EVALUATIONS {
        let Some(package) = house.get(*name) else { continue };
        let [normal, of_tests] = stands_on(package, &house);
        let of_tests: Vec<&String> = of_tests.difference(&normal).collect();
        assert_eq!(normal, BTreeSet::from(["scene".to_string()]), "{name} depends on scene alone");
        assert!(
            of_tests.iter().all(|other| *other == "terrain"),
            "{name}'s tests use terrain alone: {of_tests:?}"
        );
    }
}

#[test]
fn there_is_one_glam() {
    // obvhs speaks glam too; two versions would be two types.
    let lock = fs::read_to_string(root().join("Cargo.lock")).expect("Cargo.lock");
    let versions: Vec<&str> = lock
        .split("[[package]]")
        .filter(|package| package.contains("\nname = \"glam\"\n"))
        .filter_map(|package| package.split("version = \"").nth(1)?.split('"').next())
        .collect();
    assert!(versions.len() == 1 && versions[0].starts_with("0.34."), "glam in Cargo.lock: {versions:?}");
}
