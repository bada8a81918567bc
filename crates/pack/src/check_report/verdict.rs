//! Words that the reports of a check share.

use raypencil_judge::Check;
use raypencil_scene::Precision;

/// Maximum number of defects that a screen or a test case describes; all are counted.
pub(crate) const MAX_SHOWN_DEFECTS: usize = 5;

/// The name of an arithmetic.
pub(crate) fn arithmetic(precision: Precision) -> &'static str {
    if precision == Precision::F32 { "f32" } else { "f64" }
}

/// The outcome of a check.
pub(crate) fn verdict(check: &Check) -> &'static str {
    match (check.compared(), check.passes()) {
        (0, _) => "nothing_compared",
        (_, true) => "agrees",
        (_, false) => "defects",
    }
}
