//! Checks of ranges and image sizes.

use raypencil_scene::{Image, SceneError};

/// Refuses a `value` outside `low..=high` (and NaN, which is outside of everything).
pub(crate) fn check_range(
    field: &str,
    part: &str,
    value: f64,
    low: f64,
    high: f64,
    unit: &str,
) -> Result<(), SceneError> {
    if value >= low && value <= high {
        return Ok(());
    }
    Err(SceneError::new(format!("{field}.{part}"), value, format!("{low} to {high} {unit}").trim_end()))
}

/// Panics unless two rasters have the same size: a mistake of the program, not of its input.
pub(crate) fn assert_same_size<A: Copy, B: Copy>(a: &Image<A>, b: &Image<B>, what: &str) {
    assert_eq!((a.width(), a.height()), (b.width(), b.height()), "size of {what}");
}
