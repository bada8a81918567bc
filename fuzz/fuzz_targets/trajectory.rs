//! Fuzz target: any text as poses of TUM or CSV.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::io::poses_from_text;

fuzz_target!(|text: &str| {
    if let Ok(poses) = poses_from_text(text, Path::new("any.tum")) {
        assert!(poses.windows(2).all(|pair| pair[0].time_s < pair[1].time_s));
    }
});
