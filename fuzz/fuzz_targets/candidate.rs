//! Any bytes as `candidate.json`, the note of a recording.

use libfuzzer_sys::fuzz_target;

use raypencil_pack::Provenance;

#![no_main]

use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(note) = Provenance::from_bytes(bytes, Path::new("candidate.json")) {
        assert!(note.totals.iter().all(|total| total.mean >= 0.0 && total.error.is_finite()));
    }
});
