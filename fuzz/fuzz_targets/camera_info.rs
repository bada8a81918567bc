//! Fuzz target: any text as a calibration of ROS, of either camera.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::io::camera_info_from_text;

fuzz_target!(|text: &str| {
    for is_rectified in [false, true] {
        if let Ok(info) = camera_info_from_text(text, Path::new("any.yaml"), is_rectified) {
            // What is in range is asked by the reader of the scene; a camera that is not calibrated is none.
            assert!(info.focal_length.iter().any(|&length| length != 0.0));
        }
    }
});
