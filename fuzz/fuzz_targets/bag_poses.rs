//! Fuzz target: any bytes as a bag with the poses of a sensor.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::io::{PoseChoice, poses_from_bag};

fuzz_target!(|bytes: &[u8]| {
    for topic in [None, Some("/odom"), Some("/tf")] {
        let choice = PoseChoice { topic, frames: None };
        if let Ok(poses) = poses_from_bag(bytes, &choice, Path::new("any.mcap")) {
            assert!(poses.windows(2).all(|pair| pair[0].time_s < pair[1].time_s));
        }
    }
});
