//! Any text below the first lines of a resolved scene, whose terrain is not there.

use raypencil_scene_io::load_text;

#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let text = format!("version = 1\nkind = \"resolved\"\n{text}");
    let _ = load_text(&text, "no-such-folder/any");
});
