//! Fuzz target: any text after the first lines of a resolved scene. Its terrain file is missing.

#![no_main]

use libfuzzer_sys::fuzz_target;
use raypencil::io::load_text;

fuzz_target!(|text: &str| {
    let text = format!("version = 1\nkind = \"resolved\"\n{text}");
    let _ = load_text(&text, "no-such-folder/any");
});
