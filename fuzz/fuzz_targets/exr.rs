//! Fuzz target: any bytes as an OpenEXR file, with limits that fit a fuzzer's memory.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::io::{Limits, exr_from_bytes};

fuzz_target!(|bytes: &[u8]| {
    let file = Path::new("any.exr");
    let limits = Limits { cells: 1 << 20, bytes: 1 << 25, size: None };
    if let Ok(map) = exr_from_bytes(bytes, file, &limits) {
        assert!(map.channels.values().all(|raster| raster.size() == (map.width, map.height)));
    }
});
