//! Any bytes as a terrain: `.glb` or `.gltf`.

use libfuzzer_sys::fuzz_target;

use raypencil_mesh_io::mesh_from_bytes;

#![no_main]

use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    // A folder that is not there: buffers in files of their own are looked for, and not found.
    let _ = mesh_from_bytes(bytes, Path::new("no-such-folder/any.glb"), 0.25);
});
