//! Fuzz target: any bytes as an STL file, binary or text.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::io::triangles_from_bytes;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(mesh) = triangles_from_bytes(bytes, Path::new("no-such-folder/any.stl")) {
        // No vertex is there without a face; the fuzzer may also write the magic of another format.
        let is_other = bytes.starts_with(b"glTF") || bytes.starts_with(b"ply");
        assert!(is_other || mesh.vertices().len() <= 3 * mesh.faces().len());
    }
});
