//! Fuzz target: any bytes as a point cloud, PCD or PLY.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::io::cloud_from_bytes;

fuzz_target!(|bytes: &[u8]| {
    let Ok(cloud) = cloud_from_bytes(bytes, Path::new("any.pcd"), |_| true) else { return };
    // Each field has a number for each point, and what storing did to it.
    for column in &cloud.columns {
        assert_eq!(column.values.len(), cloud.len());
        assert!((0..cloud.len()).all(|point| column.error(point) >= 0.0));
    }
});
