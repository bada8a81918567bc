//! Fuzz target: any text as a scene file.

#![no_main]

use libfuzzer_sys::fuzz_target;
use raypencil::io::load_text;

/// Larger terrains are valid but slow, so that the fuzzer would report a timeout.
const MAX_FACES: i64 = 2000;

fuzz_target!(|text: &str| {
    let faces = |table: toml::Table| table.get("terrain")?.get("generate")?.get("faces")?.as_integer();
    let asked = toml::from_str(text).ok().and_then(faces);
    // A generated terrain without a count has ten thousand faces.
    let is_large = text.contains("generate") && asked.is_none_or(|faces| faces > MAX_FACES);
    if !is_large && let Ok(loaded) = load_text(text, "no-such-folder/any") {
        assert!(!loaded.scene.mesh().faces().is_empty());
    }
});
