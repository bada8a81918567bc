//! Fuzz target: any bytes as an OBJ file.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::io::triangles_from_bytes;

fuzz_target!(|bytes: &[u8]| {
    // A face has three corners that exist, or `Triangles` would have refused it.
    let _ = triangles_from_bytes(bytes, Path::new("no-such-folder/any.obj"));
});
