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
        Self { field: field.into(), value: readable(&value.to_string()), expected: expected.into() }
    }
}

/// Digits of a number that people can read at a glance.
const MAX_DIGITS: usize = 24;

/// A value with its huge and its tiny numbers as powers of ten: 1e300 would be 300 zeros.
fn readable(value: &str) -> String {
    let is_digit = |c: char| c.is_ascii_digit() || c == '.';
    let mut text = String::new();
    let mut rest = value;
    while let Some(start) = rest.find(is_digit) {
        let length = rest[start..].find(|c| !is_digit(c)).unwrap_or(rest.len() - start);
        let (before, number) = (&rest[..start], &rest[start..start + length]);
        text.push_str(before);
        match number.parse::<f64>() {
            Ok(parsed) if length > MAX_DIGITS && parsed.is_finite() => text.push_str(&format!("{parsed:e}")),
            _ => text.push_str(number),
        }
        rest = &rest[start + length..];
    }
    text + rest
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_many_digits_are_powers_of_ten() {
        let shown = |value: [f64; 2]| SceneError::new("at", format!("{value:?}"), "less").to_string();
        assert_eq!(SceneError::new("at", -1e300, "less").to_string(), "at is -1e300: expected less");
        assert_eq!(SceneError::new("at", 1.5e-40, "more").to_string(), "at is 1.5e-40: expected more");
        let vector = glam::DVec2::new(2e30, 0.25);
        assert_eq!(SceneError::new("at", vector, "less").to_string(), "at is [2e30, 0.25]: expected less");
        // What people can read stays, and so do other texts.
        assert_eq!(shown([123456789.125, -3.0]), "at is [123456789.125, -3.0]: expected less");
        assert_eq!(
            SceneError::new("name", "a.1.b", "another").to_string(),
            "name is a.1.b: expected another"
        );
    }
}
