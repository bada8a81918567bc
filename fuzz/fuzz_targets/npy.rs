//! Any bytes as an NPY file.

use libfuzzer_sys::fuzz_target;

use raypencil_files::{Limits, npy_from_bytes};

#![no_main]

use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(array) = npy_from_bytes(bytes, Path::new("any.npy"), &Limits::default()) {
        let size = array.planes[0].size();
        assert!(array.planes.iter().all(|plane| plane.size() == size));
    }
});
