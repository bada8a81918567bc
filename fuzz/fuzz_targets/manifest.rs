//! Fuzz target: any bytes as the manifest of a pack, without the files that it lists.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::pack::Manifest;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(manifest) = Manifest::from_bytes(bytes, Path::new("manifest.json")) {
        // The paths of an accepted manifest stay in the folder of the pack.
        for file in &manifest.files {
            assert!(
                !file.path.starts_with('/') && file.path.split('/').all(|part| part != ".."),
                "{}",
                file.path
            );
        }
    }
});
