//! Range checks of parameters.

use raypencil_scene::SceneError;

/// Refuses a `value` outside `low..=high`, and NaN. The error names `field.name`, the value and the range.
pub(crate) fn check_range(
    field: &str,
    name: &str,
    value: f64,
    low: f64,
    high: f64,
    unit: &str,
) -> Result<(), SceneError> {
    if value >= low && value <= high {
        return Ok(());
    }
    Err(SceneError::new(format!("{field}.{name}"), value, format!("{low} to {high} {unit}").trim_end()))
}

/// Refuses a `count` outside `low..=high`. The error names `field.name`, the count and the range.
pub(crate) fn check_count(
    field: &str,
    name: &str,
    count: u64,
    low: u64,
    high: u64,
) -> Result<(), SceneError> {
    if (low..=high).contains(&count) {
        return Ok(());
    }
    Err(SceneError::new(format!("{field}.{name}"), count, format!("{low} to {high}")))
}
