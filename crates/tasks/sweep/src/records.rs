//! Files of a sweep from bytes, for tests and fuzz targets. Whoever runs a sweep needs none of this.

use std::path::Path;

use crate::error::SweepError;
use crate::plan::Sweep;
use crate::record::{self, Outcome};
use crate::run;

/// What the record of a run says. `None`: it is damaged, or of another run.
pub fn outcome_from_bytes(text: &[u8], sweep: &Sweep, run: u64) -> Option<Outcome> {
    record::from_bytes(text, sweep, run).map(|record| record.outcome)
}

/// The text of a record with the digest of what it holds; `None` if it is no record. So changed ones come past their seal.
pub fn sealed(text: &[u8]) -> Option<String> {
    record::sealed(text)
}

/// The plan of a sweep, `sweep.json`; `file` is its name in messages.
///
/// # Errors
/// What is no plan.
pub fn plan_from_bytes(text: &[u8], file: &Path) -> Result<Sweep, SweepError> {
    run::plan_from_bytes(text, file)
}
