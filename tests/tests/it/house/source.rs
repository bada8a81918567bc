//! The sources of a crate, parsed.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use quote::ToTokens;

/// The root of the workspace.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ is in the workspace").to_path_buf()
}

/// The folders in `crates`, from the lowest floor up.
pub(crate) const FOLDERS: [&str; 6] = ["base", "engines", "world", "verdict", "tasks", "doors"];

/// Every crate by its name, with its folder from the root on, such as `crates/base/scene`.
pub(crate) fn crates() -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for folder in FOLDERS {
        let of_floor = format!("crates/{folder}");
        for entry in fs::read_dir(root().join(&of_floor)).expect("a folder of crates") {
            let entry = entry.expect("an entry");
            if entry.path().is_dir() {
                let name = entry.file_name().to_string_lossy().into_owned();
                let path = format!("{of_floor}/{name}");
                assert_eq!(found.insert(name, path), None, "a name for two crates");
            }
        }
    }
    found
}

/// The Rust files of a crate, with their names.
pub(crate) fn sources(of: &str) -> Vec<(String, syn::File)> {
    fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("a folder of sources") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                collect(&path, files);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    let folder = root().join(&crates()[of]).join("src");
    let mut files = Vec::new();
    collect(&folder, &mut files);
    files.sort();
    assert!(!files.is_empty(), "{of} has no sources");
    let read = |path: PathBuf| {
        let name = path.strip_prefix(root()).expect("in the workspace").display().to_string();
        let text = fs::read_to_string(&path).expect("a source file");
        let file = syn::parse_file(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
        (name, file)
    };
    files.into_iter().map(read).collect()
}

/// Whether an item is compiled for tests alone.
pub(crate) fn is_for_tests(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg") && attribute.to_token_stream().to_string().contains("test")
    })
}

/// Tokens as one would write them.
pub(crate) fn written(tokens: &impl ToTokens) -> String {
    let mut text = tokens.to_token_stream().to_string();
    for (spaced, tight) in [(" :: ", "::"), (" < ", "<"), ("< ", "<"), (" <", "<"), (" >", ">"), ("& ", "&")]
    {
        text = text.replace(spaced, tight);
    }
    text
}

/// The map says where to look; a file that moved is missing there first.
#[test]
fn the_map_leads_to_files_that_are_there() {
    let map = fs::read_to_string(root().join("ARCHITECTURE.md")).expect("the map");
    let crates = crates();
    let mut found = 0;
    for word in map.split('`').skip(1).step_by(2) {
        let Some((name, rest)) = word.split_once('/') else { continue };
        let Some(folder) =
            crates.get(name).filter(|_| rest.starts_with("src/") || rest.starts_with("script/"))
        else {
            continue;
        };
        assert!(root().join(folder).join(rest).exists(), "ARCHITECTURE.md: {word} is not there");
        found += 1;
    }
    assert!(found > 40, "{found} places on the map");
}
