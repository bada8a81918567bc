//! Fuzz target: any bytes as an NPY array of any shape, as the answers of a candidate to a pack of rays.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::io::npy_numbers_from_bytes;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(array) = npy_numbers_from_bytes(bytes, Path::new("any.npy")) {
        assert_eq!(array.shape.iter().product::<u64>(), array.values.len() as u64);
    }
});
