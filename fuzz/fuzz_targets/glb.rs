//! Fuzz target: any bytes as a terrain, `.glb` or `.gltf`.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::io::mesh_from_bytes;

fuzz_target!(|bytes: &[u8]| {
    // The folder does not exist: external buffers are missing.
    let _ = mesh_from_bytes(bytes, Path::new("no-such-folder/any.glb"), 0.25);
});
