//! Any bytes as an OpenEXR file, under limits that a fuzzer's memory allows.

use libfuzzer_sys::fuzz_target;

use raypencil_scene::SensorId;
use raypencil_files::{Limits, exr_from_bytes};

#![no_main]

use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    let file = Path::new("any.exr");
    let limits = Limits { cells: 1 << 20, bytes: 1 << 25, size: None };
    if let Ok(map) = exr_from_bytes(bytes, file, &limits) {
        assert!(map.channels.values().all(|raster| raster.size() == (map.width, map.height)));
        let _ = map.to_sensor_map(SensorId::Beam(0), file);
    }
});
