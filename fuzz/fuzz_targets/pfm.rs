//! Any bytes as a PFM file.

use libfuzzer_sys::fuzz_target;

use raypencil_files::{Limits, pfm_from_bytes};

#![no_main]

use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(array) = pfm_from_bytes(bytes, Path::new("any.pfm"), &Limits::default()) {
        let size = array.planes[0].size();
        assert!(array.planes.iter().all(|plane| plane.size() == size));
    }
});
