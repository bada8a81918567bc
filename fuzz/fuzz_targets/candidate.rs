//! Fuzz target: any bytes as `candidate.json`, the note of a recording.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::pack::Provenance;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(note) = Provenance::from_bytes(bytes, Path::new("candidate.json")) {
        assert!(note.totals.iter().all(|total| total.mean >= 0.0 && total.error.is_finite()));
    }
});
