//! Any bytes as the manifest of a pack, without the files that it lists.

use libfuzzer_sys::fuzz_target;

use raypencil_pack::Manifest;

#![no_main]

use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(manifest) = Manifest::from_bytes(bytes, Path::new("manifest.json")) {
        // What is believed leads nowhere but into the pack's own folder.
        for file in &manifest.files {
            assert!(
                !file.path.starts_with('/') && file.path.split('/').all(|part| part != ".."),
                "{}",
                file.path
            );
        }
    }
});
