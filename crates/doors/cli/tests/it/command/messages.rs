//! Twenty error messages as people see them, one snapshot: what is wrong, where, and what to write instead.

use super::{raypencil, text};

/// Scene files with one mistake each.
const SCENES: [(&str, &str); 9] = [
    ("misspelt.toml", "version = 1\n[camera]\nwidht_px = 3\n"),
    ("wrong-unit.toml", "version = 1\n[camera]\nfocal_length_m = 0.008\n"),
    ("other-name.toml", "version = 1\n[camera]\nfov = 60\n"),
    ("text-for-number.toml", "version = 1\n[camera]\nwidth_px = \"100\"\n"),
    ("table-for-tables.toml", "version = 1\n[beam]\nrows = 3\n"),
    ("text-for-table.toml", "version = 1\nterrain = \"pyramids\"\n"),
    ("out-of-range.toml", "version = 1\n[camera]\npitch_down_deg = 400\n"),
    ("no-version.toml", "[camera]\nwidth_px = 3\n"),
    ("off-ground.toml", "version = 1\n[vehicle]\nposition_m = [500, 0]\n"),
];

/// Command lines with one mistake each.
const COMMANDS: [&str; 11] = [
    "validate nowhere.toml",
    "validate pyramids --fan 30deg",
    "validate pyramids --heading north",
    "validate pyramids --with one",
    "validate pyramids --set camera.widht_px=100",
    "validat pyramids",
    "render pyramids --with scanline -o misspelt.toml",
    "probe pyramids --pixel 5000,1",
    "probe pyramids --pixel 3,3 --max-memory much",
    "check misspelt.toml misspelt.toml",
    "pack pyramids --pack-version one -o out",
];

#[test]
fn twenty_messages_are_as_the_snapshot_shows() {
    let folder = tempfile::tempdir().unwrap();
    let mut shown = String::new();
    let validations = SCENES.map(|(name, scene)| {
        std::fs::write(folder.path().join(name), scene).unwrap();
        format!("validate {name}")
    });
    for line in validations.iter().map(String::as_str).chain(COMMANDS) {
        let words: Vec<&str> = line.split(' ').collect();
        let output = raypencil(folder.path(), &words);
        assert_eq!(output.status.code(), Some(2), "{line}");
        assert_eq!(text(&output.stdout), "", "{line}");
        shown += &format!("$ raypencil {line}\n{}\n", text(&output.stderr).trim_end());
        shown.push('\n');
    }
    insta::with_settings!({ omit_expression => true }, { insta::assert_snapshot!("messages", shown) });
}
