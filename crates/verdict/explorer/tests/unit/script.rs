//! The modules keep the rule by which they are put together.

use std::collections::{BTreeMap, BTreeSet};

use super::*;

/// Names that a module imports, each with the module that it comes from.
fn imports(text: &str) -> Vec<(String, String)> {
    let lines = text.lines().filter(|line| line.starts_with("import "));
    lines
        .flat_map(|line| {
            let (names, from) = line
                .strip_prefix("import { ")
                .and_then(|rest| rest.split_once(" } from './"))
                .unwrap_or_else(|| panic!("an import of one line: {line}"));
            let from = from.strip_suffix("';").unwrap_or_else(|| panic!("a quoted module: {line}"));
            names.split(", ").map(|name| (name.to_string(), from.to_string())).collect::<Vec<_>>()
        })
        .collect()
}

/// Names at the top level of a module, and whether each is exported.
fn names(text: &str) -> Vec<(String, bool)> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '$';
    text.lines()
        .filter_map(|line| {
            let exported = line.starts_with("export ");
            let line = line.strip_prefix("export ").unwrap_or(line);
            let line = line.strip_prefix("async ").unwrap_or(line);
            let rest = ["function* ", "function ", "class ", "const ", "let "]
                .iter()
                .find_map(|word| line.strip_prefix(word))?;
            Some((rest.split(|c| !is_word(c)).next()?.to_string(), exported))
        })
        .collect()
}

#[test]
fn every_file_of_the_folder_is_a_module() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/script");
    let files: BTreeSet<String> = std::fs::read_dir(folder)
        .expect("the folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .filter(|name| name.ends_with(".js"))
        .collect();
    let listed: BTreeSet<String> = MODULES.iter().map(|(name, _)| (*name).to_string()).collect();
    assert!(listed.len() > 10);
    assert_eq!(files, listed);
    assert_eq!(MODULES.last().map(|(name, _)| *name), Some("main.js"), "what starts comes last");
}

#[test]
fn modules_stand_behind_what_they_import() {
    let mut known: BTreeMap<&str, BTreeSet<String>> = BTreeMap::new();
    for (name, text) in MODULES {
        for (imported, from) in imports(text) {
            let exported = known.get(from.as_str());
            let exported =
                exported.unwrap_or_else(|| panic!("{name} stands before {from}, which it imports"));
            assert!(exported.contains(&imported), "{from} does not export {imported}, which {name} imports");
        }
        let exported = names(text).into_iter().filter(|(_, exported)| *exported).map(|(name, _)| name);
        known.insert(name, exported.collect());
    }
}

#[test]
fn names_at_the_top_level_are_unique() {
    let mut seen: BTreeMap<String, &str> = BTreeMap::new();
    for (module, text) in MODULES {
        for (name, _) in names(text) {
            assert!(!name.is_empty(), "{module} takes apart at its top level");
            if let Some(other) = seen.insert(name.clone(), module) {
                panic!("{name} is in {other} and in {module}");
            }
        }
    }
    assert!(seen.len() > 50);
}

#[test]
fn the_script_is_one_text_that_no_page_misreads() {
    let script = SCRIPT.as_str();
    for word in [
        "</script",
        "<!--",
        "\nimport ",
        "\nexport ",
        "eval(",
        "new Function",
        "fetch(",
        "XMLHttpRequest",
        "innerHTML",
        "http://",
        "https://",
    ] {
        assert!(!script.contains(word), "{word:?}");
    }
    assert!(!STYLE.contains("</style") && !STYLE.contains("url(") && !STYLE.contains("@import"));
    // Texts of every module are in it.
    assert!(MODULES.iter().all(|(name, _)| script.contains(&format!("// {name}\n"))));
}
