//! Fuzz target: any bytes as rays, NPY or CSV.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::cast::rays_from_bytes;

fuzz_target!(|bytes: &[u8]| {
    for name in ["any.npy", "any.csv"] {
        if let Ok(array) = rays_from_bytes(bytes, Path::new(name)) {
            assert_eq!(array.shape.iter().product::<u64>(), array.rays.len() as u64);
            assert!(array.rays.iter().all(|ray| ray.origin.is_finite() && ray.t_min <= ray.t_max && ray.t_blind <= ray.t_max));
        }
    }
});
