//! `scene show` and `scene init`.

use std::fs;

use tempfile::TempDir;

use super::{assert_trouble, raypencil, screen};

#[test]
fn a_scene_file_that_was_begun_is_the_default_scene() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let said = screen(folder, &["scene", "init", "new/my.toml"], 0);
    assert!(said.contains("raypencil scene show new/my.toml"), "{said}");
    let sha256 = |scene: &str| {
        let shown = screen(folder, &["scene", "show", scene, "--json"], 0);
        let json: serde_json::Value = serde_json::from_str(&shown).unwrap();
        json["sha256"].as_str().unwrap().to_string()
    };
    assert_eq!(sha256("new/my.toml"), sha256("pyramids"));
    // Whoever has begun to change it keeps it.
    fs::write(folder.join("new/my.toml"), "mine").unwrap();
    assert_trouble(&raypencil(folder, &["scene", "init", "new/my.toml"]), &["my.toml", "there already"]);
    assert_eq!(fs::read_to_string(folder.join("new/my.toml")).unwrap(), "mine");
    assert_trouble(&raypencil(folder, &["scene", "init", "scene.txt"]), &["ends in .toml"]);
}

#[test]
fn a_scene_is_shown_with_its_units_and_a_picture() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let said = screen(folder, &["scene", "show", "--set", "camera.pitch_down_deg=35", "-o", "a/p.svg"], 0);
    for word in ["camera    at (0.3, 0, 1.5) m, 35 deg down", "1024 x 1024 pixels", "picture   a/p.svg"] {
        assert!(said.contains(word), "{word} is not in\n{said}");
    }
    let svg = fs::read_to_string(folder.join("a/p.svg")).unwrap();
    assert!(svg.contains("from above") && svg.contains("beam 1"));
    screen(folder, &["scene", "show", "facets", "-o", "p.png"], 0);
    assert!(fs::read(folder.join("p.png")).unwrap().starts_with(b"\x89PNG"));
    assert_trouble(&raypencil(folder, &["scene", "show", "-o", "p.jpg"]), &["p.jpg", ".svg or .png"]);
}
