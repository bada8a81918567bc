//! Pages by an automatic checker of accessibility, axe-core (MPL-2.0), in light and in dark colours. It is no part of this
//! project: `RAYPENCIL_AXE` names its `axe.min.js`, which continuous integration installs.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::browser::{Page, open};
use super::{cast, drives, paper};

/// Variable with the path of `axe.min.js`.
const AXE: &str = "RAYPENCIL_AXE";

/// The checker's script. `None`, and words on the terminal, if there is none.
fn axe() -> Option<String> {
    let Some(path) = std::env::var_os(AXE).map(PathBuf::from) else {
        eprintln!("skipped: {AXE} names no axe.min.js");
        return None;
    };
    Some(std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display())))
}

/// What the checker finds on a page: rule, help, and the first elements.
fn violations(page: &Page) -> Vec<Value> {
    let found = page.ask(
        "axe.run(document).then(r => r.violations.map(v => [v.id, v.help, v.nodes.slice(0, 4).map(n => n.html.slice(0, 160))]))",
    );
    found.as_array().expect("a list").clone()
}

fn assert_accessible(axe: &str, file: &Path, ready: &str) {
    // On the narrow page every wide table has to be scrolled, whatever the width of this machine's letters.
    for (scheme, width) in [("light", 1280), ("dark", 480)] {
        let Some(page) = open(file, "", (width, 1000)) else { return };
        let colours = json!({ "features": [{ "name": "prefers-color-scheme", "value": scheme }] });
        page.devtools("Emulation.setEmulatedMedia", &colours);
        page.wait(ready);
        page.run(axe);
        let found = violations(&page);
        assert!(found.is_empty(), "{}, {scheme}, {width} pixels: {found:#?}", file.display());
        // The checker sees what is wrong: a picture without words, a button without a name.
        page.ask("document.querySelector('main').insertAdjacentHTML('beforeend', '<img src=\"data:,\"><button></button>')");
        let rules: Vec<String> =
            violations(&page).iter().map(|one| one[0].as_str().expect("a rule").to_string()).collect();
        assert_eq!(rules, ["button-name", "image-alt"], "{}, {scheme}", file.display());
    }
}

#[test]
fn a_validation_is_accessible() {
    let Some(axe) = axe() else { return };
    let written = paper();
    assert_accessible(
        &axe,
        &written.page(),
        "document.querySelectorAll('[data-ray-table] [data-row]').length > 5",
    );
    // The checker sees a table that a pointer alone can scroll.
    let Some(page) = open(&written.page(), "", (480, 1000)) else { return };
    page.ask("document.querySelectorAll('.scroll').forEach(one => one.removeAttribute('tabindex'))");
    page.run(&axe);
    let rules = violations(&page);
    assert!(rules.iter().any(|one| one[0] == "scrollable-region-focusable"), "{rules:#?}");
}

#[test]
fn a_drive_is_accessible() {
    let Some(axe) = axe() else { return };
    let (folder, _) = drives::small();
    let ready = "document.querySelector('[data-drive]')?.dataset.state === 'ready'";
    assert_accessible(&axe, &folder.path().join("report.html"), ready);
}

#[test]
fn a_cast_is_accessible() {
    let Some(axe) = axe() else { return };
    let folder = cast::with_one_wrong();
    let ready = "document.querySelectorAll('[data-ray-table] [data-row]').length === 1";
    assert_accessible(&axe, &folder.path().join("report.html"), ready);
}
