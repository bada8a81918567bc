//! Fuzz target: any text as a setting, `KEY=VALUE`, as an axis of a sweep, and as a list of runs.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::io::{Setting, check_settings};
use raypencil::sweep::Axis;

/// Longer ranges are valid but slow, so that the fuzzer would report a timeout.
const MAX_BYTES: usize = 1 << 12;

fuzz_target!(|text: &str| {
    if text.len() > MAX_BYTES {
        return;
    }
    if let Ok(setting) = Setting::parse(text) {
        // A built-in scene has every key that can be set: the value is taken, or refused with a message.
        let _ = check_settings("pyramids", &[setting]);
    }
    for axis in [Axis::parse(text), Axis::list_from_bytes(text.as_bytes(), Path::new("any.csv"))].into_iter().flatten() {
        assert!(!axis.rows.is_empty());
        assert!(axis.rows.iter().all(|row| row.len() == axis.keys.len()));
    }
});
