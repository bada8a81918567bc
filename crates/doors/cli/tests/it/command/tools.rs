//! `completions`, `man` and `reference`: what the command tells of itself.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

use super::{assert_trouble, raypencil, screen};

/// The commands, as their pages are named.
const COMMANDS: &[&str] = &[
    "scene",
    "scene-init",
    "scene-show",
    "campaign",
    "campaign-merge",
    "campaign-replay",
    "cast",
    "check",
    "completions",
    "diff",
    "drive",
    "man",
    "minimise",
    "pack",
    "probe",
    "render",
    "sweep",
    "sweep-merge",
    "terrain",
    "terrain-generate",
    "terrain-import",
    "terrain-inspect",
    "validate",
];

/// The files of a folder, by name.
fn files(folder: &Path) -> BTreeMap<String, String> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let read = entries.map(|entry| {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        (name, std::fs::read_to_string(&path).expect("a text"))
    });
    read.collect()
}

#[test]
fn completions_load_in_their_shells() {
    let folder = tempfile::TempDir::new().unwrap();
    // What each shell does with the script, and then says it knows of the command.
    let shells = [
        (
            "bash",
            "source ./script && complete -p raypencil && COMP_WORDS=(raypencil terr) COMP_CWORD=1 && \
                  _raypencil raypencil terr raypencil && echo \"${COMPREPLY[@]}\"",
            "terrain",
        ),
        (
            "zsh",
            "autoload -Uz compinit && compinit -D && source ./script && echo ${_comps[raypencil]}",
            "_raypencil",
        ),
        ("fish", "source ./script && complete -C 'raypencil terr'", "terrain"),
    ];
    for (shell, words, expected) in shells {
        let script = screen(folder.path(), &["completions", shell, "--quiet"], 0);
        std::fs::write(folder.path().join("script"), script).unwrap();
        let run = Command::new(shell).args(["-c", words]).current_dir(folder.path()).output();
        match run {
            Ok(output) => {
                let said = String::from_utf8_lossy(&output.stdout).into_owned();
                let errors = String::from_utf8_lossy(&output.stderr).into_owned();
                assert!(output.status.success() && said.contains(expected), "{shell}: {said}{errors}");
            }
            Err(_) if shell != "bash" => eprintln!("skipped: there is no {shell} here"),
            Err(error) => panic!("{shell}: {error}"),
        }
    }
    for shell in ["elvish", "powershell"] {
        assert!(screen(folder.path(), &["completions", shell], 0).contains("raypencil"), "{shell}");
    }
    assert_trouble(&raypencil(folder.path(), &["completions", "tcsh"]), &["tcsh", "possible values", "bash"]);
}

#[test]
fn each_command_has_a_manual_page() {
    let folder = tempfile::TempDir::new().unwrap();
    assert_eq!(screen(folder.path(), &["man", "-o", "man"], 0), "man: 24 pages\n");
    let pages = files(&folder.path().join("man"));
    let names = COMMANDS.iter().map(|name| format!("raypencil-{name}.1"));
    let names: BTreeSet<String> = names.chain(["raypencil.1".to_string()]).collect();
    assert!(pages.keys().eq(&names), "{:?}", pages.keys());
    for name in &names {
        let page = &pages[name];
        assert!(page.contains(".SH SYNOPSIS") && page.contains("Examples:"), "{name}");
    }
    // A folder that cannot be made.
    std::fs::write(folder.path().join("taken"), "").unwrap();
    assert_trouble(&raypencil(folder.path(), &["man", "-o", "taken/man"]), &["taken/man", "folder"]);
}

#[test]
fn the_committed_reference_is_that_of_this_command() {
    let folder = tempfile::TempDir::new().unwrap();
    screen(folder.path(), &["reference", "-o", "made"], 0);
    let made = files(&folder.path().join("made"));
    let committed = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/reference/commands");
    let committed = files(&committed);
    let names = COMMANDS.iter().map(|name| format!("{name}.md")).chain(["raypencil.md".to_string()]);
    assert_eq!(made.len(), names.clone().count());
    for name in names {
        let page = made.get(&name).unwrap_or_else(|| panic!("{name} was not made"));
        assert!(
            committed.get(&name) == Some(page),
            "docs/reference/commands/{name} is not what the command says; `just reference` writes it:\n{page}"
        );
    }
    // Nor is there a page of a command that is gone.
    assert!(committed.keys().all(|name| made.contains_key(name)), "{:?}", committed.keys());
}
