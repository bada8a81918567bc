//! The modules keep the rule by which they are put together.

use std::collections::{BTreeMap, BTreeSet};

use super::*;

/// Names that the module at `module` imports, each with the module that it comes from, as a path below `script/`.
fn imports(module: &str, text: &str) -> Vec<(String, String)> {
    let folder: Vec<&str> =
        module.rsplit_once('/').map_or(Vec::new(), |(folder, _)| folder.split('/').collect());
    let lines = text.lines().filter(|line| line.starts_with("import "));
    lines
        .flat_map(|line| {
            let (names, from) = line
                .strip_prefix("import { ")
                .and_then(|rest| rest.split_once(" } from '"))
                .unwrap_or_else(|| panic!("an import of one line: {line}"));
            let from = from.strip_suffix("';").unwrap_or_else(|| panic!("a quoted module: {line}"));
            let (above, below) = match from.strip_prefix("./") {
                Some(below) => (0, below),
                None => {
                    let below = from.trim_start_matches("../");
                    ((from.len() - below.len()) / "../".len(), below)
                }
            };
            assert!(from.starts_with('.') && above <= folder.len(), "a module below script/: {line}");
            let mut path = folder[..folder.len() - above].to_vec();
            path.push(below);
            let from = path.join("/");
            names.split(", ").map(|name| (name.to_string(), from.clone())).collect::<Vec<_>>()
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
    /// Paths of the modules in `folder`, each after `before`.
    fn files(folder: &std::path::Path, before: &str, found: &mut BTreeSet<String>) {
        for entry in std::fs::read_dir(folder).expect("the folder") {
            let entry = entry.expect("an entry");
            let name = format!("{before}{}", entry.file_name().to_string_lossy());
            if entry.path().is_dir() {
                files(&entry.path(), &format!("{name}/"), found);
            } else if name.ends_with(".js") {
                found.insert(name);
            }
        }
    }
    let mut found = BTreeSet::new();
    files(std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/script")), "", &mut found);
    let files = found;
    let listed: BTreeSet<String> = MODULES.iter().map(|(name, _)| (*name).to_string()).collect();
    assert!(listed.len() > 10);
    assert_eq!(files, listed);
    assert_eq!(MODULES.last().map(|(name, _)| *name), Some("main.js"), "what starts comes last");
}

#[test]
fn modules_stand_behind_what_they_import() {
    let mut known: BTreeMap<&str, BTreeSet<String>> = BTreeMap::new();
    for (name, text) in MODULES {
        for (imported, from) in imports(name, text) {
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
