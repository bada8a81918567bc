//! Fuzz target: any bytes as a PNG, TIFF, NPZ or multi-part OpenEXR file, with limits that fit a fuzzer's memory.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::io::{Limits, exr_parts_from_bytes, npz_from_bytes, png_from_bytes, tiff_from_bytes};

fuzz_target!(|bytes: &[u8]| {
    let limits = Limits { cells: 1 << 20, bytes: 1 << 25, size: None };
    let any = Path::new("any");
    let pictures = [png_from_bytes(bytes, any, &limits), tiff_from_bytes(bytes, any, &limits)];
    let archived = npz_from_bytes(bytes, any, &limits).unwrap_or_default();
    for array in pictures.into_iter().flatten().chain(archived.into_iter().map(|(_, array)| array)) {
        let size = array.planes[0].size();
        assert!(array.planes.iter().all(|plane| plane.size() == size));
    }
    let _ = exr_parts_from_bytes(bytes, any, &limits);
});
