//! Fuzz target: any bytes as a PFM file.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::io::{Limits, pfm_from_bytes};

fuzz_target!(|bytes: &[u8]| {
    if let Ok(array) = pfm_from_bytes(bytes, Path::new("any.pfm"), &Limits::default()) {
        let size = array.planes[0].size();
        assert!(array.planes.iter().all(|plane| plane.size() == size));
    }
});
