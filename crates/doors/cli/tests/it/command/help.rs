//! `--help` of every command, as snapshots.

use std::path::Path;

use super::screen;

/// Asserts the snapshot of a command's help text.
#[track_caller]
fn assert_help(command: &[&str]) {
    let arguments = [command, &["--help"]].concat();
    let name = [&["help"], command].concat().join("_");
    let help = screen(Path::new("."), &arguments, 0);
    insta::with_settings!({ omit_expression => true }, { insta::assert_snapshot!(name, help) });
}

#[test]
fn help_of_every_command() {
    assert_help(&[]);
    for command in [
        "validate",
        "render",
        "probe",
        "pack",
        "check",
        "campaign",
        "minimise",
        "drive",
        "diff",
        "cast",
        "terrain",
        "sweep",
        "completions",
        "man",
        "reference",
    ] {
        assert_help(&[command]);
    }
    for command in ["merge", "replay"] {
        assert_help(&["campaign", command]);
    }
    assert_help(&["sweep", "merge"]);
    for command in ["generate", "import", "inspect"] {
        assert_help(&["terrain", command]);
    }
}

#[test]
fn the_short_help_of_the_command_line() {
    let help = screen(Path::new("."), &["-h"], 0);
    insta::with_settings!({ omit_expression => true }, { insta::assert_snapshot!("help_short", help) });
}
