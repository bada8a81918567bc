//! Fuzz target: any text as the plan of a sweep, and as the record of its run. The first byte chooses whether the text is sealed here:
//! without its digest, no changed record would come past the seal.

#![no_main]

use std::path::Path;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use raypencil::sweep::records::{outcome_from_bytes, plan_from_bytes, sealed};
use raypencil::sweep::{Outcome, Sweep, Task};

static SWEEP: LazyLock<Sweep> = LazyLock::new(|| {
    Sweep::new("pyramids", Vec::new(), Task::Validate, vec!["scanline".into(), "tracer".into()], false)
        .expect("a sweep of one run")
});

fuzz_target!(|bytes: &[u8]| {
    let Some((&choice, text)) = bytes.split_first() else { return };
    let again = if choice & 1 == 0 { sealed(text) } else { None };
    let record = again.as_ref().map_or(text, |again| again.as_bytes());
    if let Some(Outcome::Results(results)) = outcome_from_bytes(record, &SWEEP, 0) {
        assert!(!results.is_empty());
        // A cell of the table is in one line, and no spreadsheet computes it.
        for (name, value) in &results {
            assert!(!name.is_empty() && !["run", "refused"].contains(&name.as_str()));
            assert!(value.as_str().is_none_or(|text| !text.contains('\n') && !text.starts_with('=')));
        }
    }
    if let Ok(plan) = plan_from_bytes(text, Path::new("any.json")) {
        assert!(plan.runs() > 0 && plan.values(plan.runs() - 1).len() == plan.keys().len());
    }
});
