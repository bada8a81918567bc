//! Names of keys in the errors of a pattern: people know the keys, not the fields of the pattern.

use raypencil_scene::SceneError;

/// The error with the key of a file in place of the pattern's field: `rays 0.grid.width_deg` for `rays 0.grid.width`. Its numbers are in the
/// unit of the key.
pub(super) fn in_keys(error: SceneError) -> SceneError {
    let Some((table, part)) = error.field.rsplit_once('.') else { return error };
    let key = match part {
        "min_range" | "max_range" => format!("{part}_m"),
        "width" | "height" | "azimuth_start" | "azimuth_step" => format!("{part}_deg"),
        // The only number of a channel that the key alone does not limit: a channel fires within its sequence.
        "firing" => return firing_in_us(&error).unwrap_or(error),
        _ => return error,
    };
    SceneError { field: format!("{table}.{key}"), ..error }
}

/// The error of a channel's time in a sequence, in microseconds.
fn firing_in_us(error: &SceneError) -> Option<SceneError> {
    let (table, channel) = error.field.strip_suffix(".firing")?.rsplit_once(".channels")?;
    let last = error.expected.strip_prefix("0 to ")?.strip_suffix(" s")?;
    let [value, last] = [error.value.parse().ok()?, last.parse().ok()?].map(microseconds);
    Some(SceneError {
        field: format!("{table}.firing_times_us{channel}"),
        value: value.to_string(),
        expected: format!("0 to {last} us"),
    })
}

/// Microseconds without the rounding of the last digits: the file's 0.3 is 3e-7 s, which is 0.29999999999999999 again.
fn microseconds(seconds: f64) -> f64 {
    let microseconds = 1e6 * seconds;
    format!("{microseconds:.11e}").parse().unwrap_or(microseconds)
}
