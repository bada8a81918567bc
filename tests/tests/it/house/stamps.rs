//! No stale table: each table and figure of the documents says by its stamp what it stands on, and that is not newer than it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use raypencil_tests::stands_on::{Stamp, stamps};

use super::source::root;

/// The stamps of every page of the documents, each with its page.
fn all_stamps() -> Vec<(String, Stamp)> {
    let mut pages = Vec::new();
    super::documents::pages(&root().join("docs"), &mut pages);
    pages.push(root().join("README.md"));
    let mut found = Vec::new();
    for path in pages {
        let page = path.strip_prefix(root()).unwrap_or(&path).display().to_string();
        let text = fs::read_to_string(&path).expect("a page");
        let of_page = stamps(&text).unwrap_or_else(|error| panic!("{page}: {error}"));
        found.extend(of_page.into_iter().map(|stamp| (page.clone(), stamp)));
    }
    found
}

/// The files of a folder of `docs`, from the root of the project.
fn files(folder: &str) -> impl Iterator<Item = String> + use<> {
    let folder = PathBuf::from("docs").join(folder);
    let entries = fs::read_dir(root().join(&folder)).expect("a folder");
    entries.map(move |entry| folder.join(entry.expect("an entry").file_name()).display().to_string())
}

#[test]
fn no_table_and_no_figure_is_older_than_the_rule_that_it_shows() {
    let mut stale = Vec::new();
    for (page, stamp) in all_stamps() {
        match stamp.stale(&root()) {
            Ok(newer) if newer.is_empty() => {}
            Ok(newer) => stale.push(format!(
                "{page}: what `{}` makes is stale: {}. Make it again, then `just stamp {page} '{}'`",
                stamp.made_by,
                newer.join("; "),
                stamp.made_by
            )),
            Err(error) => stale.push(format!("{page}, `{}`: {error}", stamp.made_by)),
        }
    }
    assert!(stale.is_empty(), "{}", stale.join("\n"));
}

#[test]
fn each_generated_file_of_the_documents_is_made_by_one_stamped_command() {
    let mut shown: BTreeMap<String, u32> = BTreeMap::new();
    let mut stamped = BTreeSet::new();
    for (page, stamp) in all_stamps() {
        for file in &stamp.shows {
            assert!(root().join(file).is_file(), "{page}: there is no {file}");
            *shown.entry(file.clone()).or_default() += 1;
        }
        stamped.insert(page);
    }
    let twice: Vec<_> = shown.iter().filter(|(_, stamps)| **stamps > 1).collect();
    assert!(twice.is_empty(), "made by two commands: {twice:?}");
    // Without a stamp: what tests compare with what its command would write; and times of machines, which say at which commit.
    let compared = ["malformed-inputs", "injected-faults", "shared-faults"];
    let measured = ["build-times", "page-times", "mutants"];
    let without: Vec<String> =
        compared.into_iter().chain(measured).map(|name| format!("docs/evidence/{name}.md")).collect();
    let evidence = files("evidence").filter(|file| !without.contains(file));
    let without: Vec<_> = evidence
        .chain(files("figures"))
        .filter(|file| !stamped.contains(file) && !shown.contains_key(file))
        .collect();
    assert!(without.is_empty(), "no stamp says what these stand on: {without:?}");
}

#[test]
fn the_commands_of_stamps_are_recipes() {
    let justfile = fs::read_to_string(root().join("justfile")).expect("the justfile");
    for (page, stamp) in all_stamps() {
        let Some(recipe) = stamp.made_by.strip_prefix("just ").and_then(|rest| rest.split(' ').next()) else {
            continue;
        };
        let is_recipe =
            |line: &str| line.strip_prefix(recipe).is_some_and(|rest| rest.starts_with([' ', ':']));
        assert!(justfile.lines().any(is_recipe), "{page}: the justfile has no recipe `{recipe}`");
    }
}

#[test]
fn a_changed_input_makes_a_table_stale() {
    let folder = tempfile::tempdir().expect("a folder");
    let stamp = |digest: String| Stamp {
        inputs: vec!["runs.csv".into()],
        inputs_digest: Some(digest),
        measured: Some("a test".into()),
        ..Stamp::default()
    };
    let write = |text: &str| fs::write(folder.path().join("runs.csv"), text).expect("a file");
    write("25,16\n");
    let digest =
        raypencil_tests::stands_on::digest_of_files(folder.path(), &["runs.csv".into()]).expect("a digest");
    let stale = |stamp: &Stamp, root: &Path| stamp.stale(root).map(|newer| newer.len());
    assert_eq!(stale(&stamp(digest.clone()), folder.path()), Ok(0));
    write("25,17\n");
    assert_eq!(stale(&stamp(digest), folder.path()), Ok(1));
    assert!(Stamp { measured: None, ..Stamp::default() }.stale(folder.path()).is_err());
}
