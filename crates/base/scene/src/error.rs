//! The one error of this crate: which field of a scene is wrong, what it holds, what was expected.

use thiserror::Error;

/// A field of a scene that no renderer could work with.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{field} is {value}: expected {expected}")]
pub struct SceneError {
    /// The field, as a path from the scene: `camera.focal_length`, `beam 1.rows`, `mesh.faces[7]`.
    pub field: String,
    /// The value found there.
    pub value: String,
    /// What would have been accepted, with its unit.
    pub expected: String,
}

impl SceneError {
    /// Names a `field`, the `value` it holds and what was `expected` instead.
    pub fn new(field: impl Into<String>, value: impl ToString, expected: impl Into<String>) -> Self {
        Self { field: field.into(), value: value.to_string(), expected: expected.into() }
    }
}

/// Refuses a `value` outside `low..=high` (and NaN, which is outside of everything). `field` is asked for the name
/// only if the value is refused.
///
/// ```
/// use raypencil_scene::check_range;
///
/// let refused = check_range(|| "camera.focal_length".into(), f64::NAN, 1e-5, 1e2, "m").unwrap_err();
/// assert_eq!(refused.to_string(), "camera.focal_length is NaN: expected 0.00001 to 100 m");
/// ```
///
/// # Errors
/// Names the field, the value, the limits and their unit.
pub fn check_range(
    field: impl FnOnce() -> String,
    value: f64,
    low: f64,
    high: f64,
    unit: &str,
) -> Result<(), SceneError> {
    if value >= low && value <= high {
        return Ok(());
    }
    Err(SceneError::new(field(), value, format!("{low} to {high} {unit}").trim_end()))
}

/// Refuses a `count` outside `low..=high`. `field` is asked for the name only if the count is refused.
///
/// # Errors
/// Names the field, the count and the limits.
pub fn check_count(
    field: impl FnOnce() -> String,
    count: u64,
    low: u64,
    high: u64,
) -> Result<(), SceneError> {
    if (low..=high).contains(&count) {
        return Ok(());
    }
    Err(SceneError::new(field(), count, format!("{low} to {high}")))
}
