//! Texts that a spreadsheet would compute.

/// Whether a spreadsheet takes a text for a formula, which may run a program.
pub(crate) fn is_formula(text: &str) -> bool {
    text.starts_with(['=', '+', '-', '@', '\t', '\r']) && text.parse::<f64>().is_err()
}
