//! Any text as a scene file.

use raypencil_scene_io::load_text;

#![no_main]

use libfuzzer_sys::fuzz_target;

/// A larger ground is well made and slow, which is no finding.
const MOST_FACES: i64 = 2000;

fuzz_target!(|text: &str| {
    let faces = |table: toml::Table| table.get("terrain")?.get("generate")?.get("faces")?.as_integer();
    let asked = toml::from_str(text).ok().and_then(faces);
    // Ten thousand is what a ground has that does not say.
    let many = text.contains("generate") && asked.is_none_or(|faces| faces > MOST_FACES);
    if !many && let Ok(loaded) = load_text(text, "no-such-folder/any") {
        assert!(!loaded.scene.mesh().faces().is_empty());
    }
});
