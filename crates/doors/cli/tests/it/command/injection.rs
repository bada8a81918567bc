//! Names that are made to deceive who reads a terminal: of scenes, of programs under test, of files.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use tempfile::TempDir;

use super::{raypencil, screen, text};

const SCENE: &str = "version = 1\nbeam = []\n[camera]\nwidth_px = 12\nheight_px = 8\npixel_pitch_um = 800\npitch_down_deg = \
                     40\n[terrain]\nbuiltin = \"pyramids\"\n";

/// Codes that conceal, colour, move the cursor, ring, and turn the writing direction.
const CODES: [&str; 6] = ["\u{1b}[8m", "\u{1b}[31m", "\u{1b}[2J", "\u{7}", "\u{202e}", "\u{61c}"];

/// A name with all of them, and with a line that looks like one of the program's own.
fn name() -> String {
    format!("evil{}\n0 rays are wrong", CODES.concat())
}

/// Runs the command as on a terminal: `script` gives it one. `None`: there is no such program here.
fn on_a_terminal(folder: &Path, words: &[&str]) -> Option<Output> {
    let quoted: Vec<String> = words.iter().map(|word| format!("'{}'", word.replace('\'', r"'\''"))).collect();
    let line = format!("{} {}", env!("CARGO_BIN_EXE_raypencil"), quoted.join(" "));
    let output = Command::new("script")
        .args(["-q", "-e", "-c", &line, "/dev/null"])
        .current_dir(folder)
        .env("TERM", "xterm")
        .env_remove("NO_COLOR")
        .output();
    output.ok()
}

/// That a text has none of the codes that come from outside. Colours of the program's own are other ones, or stand beside
/// other letters, so the codes are looked for behind `evil`.
#[track_caller]
fn assert_is_harmless(shown: &str) {
    for code in CODES {
        assert!(!shown.contains(&format!("evil{code}")), "{shown:?}");
        let is_colour = code == "\u{1b}[31m" || code == "\u{1b}[2J";
        assert!(is_colour || !shown.contains(code), "{code:?} in {shown:?}");
    }
    assert!(!shown.lines().any(|line| line.starts_with("0 rays are wrong")), "{shown:?}");
}

/// A folder with a pack and a candidate of that name, which is wrong.
fn wrong_candidate() -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    screen(folder.path(), &["pack", "scene.toml", "--no-bench", "-o", "pack"], 0);
    screen(folder.path(), &["render", "scene.toml", "--with", "tracer", "-o", "mine"], 0);
    let note = serde_json::json!({
        "format": 1, "program": name(), "version": name(), "arithmetic": "f32",
        "scene": { "name": "scene", "sha256": digest(folder.path()) },
    });
    fs::write(folder.path().join("mine/candidate.json"), note.to_string()).unwrap();
    folder
}

fn digest(folder: &Path) -> String {
    let manifest: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.join("pack/manifest.json")).unwrap()).unwrap();
    manifest["scene"]["sha256"].as_str().unwrap().to_string()
}

#[test]
fn a_programs_name_is_shown_without_its_codes() {
    let folder = wrong_candidate();
    let folder = folder.path();
    let line = ["validate", "scene.toml", "--candidate", "mine", "-o", "out"];
    let plain = raypencil(folder, &line);
    let shown = text(&plain.stdout) + &text(&plain.stderr);
    assert!(shown.contains("evil"), "{shown}");
    assert_is_harmless(&shown);
    if let Some(output) = on_a_terminal(folder, &line) {
        let shown = text(&output.stdout);
        assert!(shown.contains("evil"), "{shown}");
        assert_is_harmless(&shown);
    } else {
        println!("skipped: there is no `script` to make a terminal");
    }
}

#[test]
fn errors_are_shown_without_codes_of_names() {
    let folder = TempDir::new().unwrap();
    let file = format!("{}.toml", name());
    let evil = format!("version = 1\n# evil{}\nname = \"evil{}\"\n", CODES[0], CODES[4]);
    let lines: Vec<Vec<&str>> = vec![
        vec!["validate", &file],
        vec!["validate", "scene.toml", "--with", "evil\u{1b}[8m"],
        vec!["validate", "--evil\u{1b}[8m\u{7}"],
        vec!["evil\u{1b}[8m\u{61c}"],
        vec!["validate", "evil.toml"],
        vec!["check", "evil\u{1b}[8m", "evil\u{202e}"],
    ];
    fs::write(folder.path().join("evil.toml"), evil).unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    for line in lines {
        let output = raypencil(folder.path(), &line);
        assert_eq!(output.status.code(), Some(2), "{line:?}");
        assert_is_harmless(&text(&output.stderr));
        if let Some(output) = on_a_terminal(folder.path(), &line) {
            let shown = text(&output.stdout);
            assert!(shown.contains("evil"), "{line:?}: {shown}");
            assert_is_harmless(&shown);
        }
    }
}

#[test]
fn a_scenes_name_with_letters_that_xml_has_not_leaves_the_junit_file_whole() {
    let folder = TempDir::new().unwrap();
    let scene = "evil\u{ffff}\u{fffe}\u{1b}[8m.toml";
    fs::write(folder.path().join(scene), SCENE).unwrap();
    screen(folder.path(), &["validate", scene, "-o", "out"], 0);
    let xml = fs::read_to_string(folder.path().join("out/junit.xml")).unwrap();
    let is_allowed = |letter: char| matches!(letter, '\t' | '\n' | '\r' | ' '..='\u{d7ff}' | '\u{e000}'..='\u{fffd}' | '\u{10000}'..);
    assert!(xml.contains("evil") && xml.chars().all(is_allowed), "{xml}");
}
