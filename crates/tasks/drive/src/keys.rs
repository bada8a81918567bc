//! Names of a scene file in the errors of a drive: people know the keys, not the fields of a plan.

use raypencil_scene::SceneError;

/// The start of a drive. A built-in route has one of its own, and either of these takes its place.
const START: &str = "the start (vehicle.position_m, --at)";

/// The way of a drive.
const ROUTE: &str = "the route (drive.waypoints_m, --to)";

/// The error with the keys of a scene file in place of the plan's fields: `drive.grid_last_m` for `drive.grid.last`. Times are
/// in the unit of their key.
pub(crate) fn in_keys(error: SceneError) -> SceneError {
    let parts: Vec<&str> = error.field.split('.').collect();
    let field = match parts.as_slice() {
        [
            "drive",
            "vehicle",
            name @ ("wheelbase" | "track" | "wheel_radius" | "wheel_width" | "clearance"),
        ] => {
            format!("drive.{name}_m")
        }
        ["drive", "grid", name @ ("first" | "step" | "last")] => format!("drive.grid_{name}_m"),
        ["drive", "grid", "sectors"] => "drive.grid_sectors".into(),
        ["drive", "times", "interval"] => {
            return in_unit(error, "drive.exposure_interval_ms", "ms", 1e3);
        }
        ["drive", "times", "row_time"] => return in_unit(error, "drive.row_time_us", "us", 1e6),
        ["drive", "times", "duration"] => {
            return in_unit(error, "drive.electronics.exposure_ms", "ms", 1e3);
        }
        ["drive", "map", "points"] => "drive.map_points".into(),
        ["drive", "truth", "centre_of_mass", _] => "drive.true_centre_of_mass_m".into(),
        ["drive", "electronics", "bias"] => "drive.electronics.bias_dn".into(),
        ["drive", "optics", "focus"] => "drive.optics.focus_m".into(),
        ["drive", "optics", _, "f_number"] => "camera.focal_length_mm / camera.aperture_mm".into(),
        ["drive", "optics", "speckle", "grain"] => "the grain of drive.optics.speckle_contrast".into(),
        ["drive", "route"] => ROUTE.into(),
        ["drive", "route", "start"] => START.into(),
        ["drive", "route", waypoint] if waypoint.starts_with("waypoints[") => {
            waypoint.replace("waypoints", "drive.waypoints_m")
        }
        _ => return error,
    };
    SceneError { field, ..error }
}

/// The error of a time with another name, its seconds in another unit of which a second has `each`.
fn in_unit(error: SceneError, field: &str, unit: &str, each: f64) -> SceneError {
    let [value, expected] = [&error.value, &error.expected].map(|text| seconds_in(text, unit, each));
    SceneError { field: field.into(), value, expected }
}

/// A text with its seconds in another unit: "at least 0.001 s" is "at least 1 ms".
fn seconds_in(text: &str, unit: &str, each: f64) -> String {
    let words: Vec<&str> = text.split(' ').collect();
    let is_second = |word: &str| word.trim_end_matches([',', ':']) == "s";
    let new = words.iter().enumerate().map(|(at, word)| {
        let number =
            word.parse::<f64>().ok().filter(|_| words.get(at + 1).is_some_and(|next| is_second(next)));
        match number {
            Some(seconds) => twelve_digits(each * seconds).to_string(),
            None if is_second(word) => word.replacen('s', unit, 1),
            None => (*word).to_string(),
        }
    });
    new.collect::<Vec<_>>().join(" ")
}

/// A number without the rounding of its last digits: the file's 0.0001 ms is 1.0000000000000001e-7 s.
fn twelve_digits(number: f64) -> f64 {
    format!("{number:.11e}").parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_in_the_unit_of_their_key() {
        let error = |part: &str, value: &str, expected: &str| {
            in_keys(SceneError::new(format!("drive.times.{part}"), value, expected)).to_string()
        };
        assert_eq!(
            error(
                "interval",
                "1.0000000000000001e-7 s",
                "0, or at least the duration of an exposure, 0.001 s"
            ),
            "drive.exposure_interval_ms is 0.0001 ms: expected 0, or at least the duration of an exposure, 1 ms"
        );
        assert_eq!(
            error("row_time", "0.5 s, thus 63.5 s for 128 rows", "all rows within the 0.1 s of a frame"),
            "drive.row_time_us is 500000 us, thus 63500000 us for 128 rows: expected all rows within the 100000 us of a frame"
        );
    }

    #[test]
    fn the_route_and_its_start_have_names_that_people_gave() {
        let named = |field: &str| in_keys(SceneError::new(field, "off", "on")).field;
        assert_eq!(named("drive.route"), "the route (drive.waypoints_m, --to)");
        assert_eq!(named("drive.route.start"), "the start (vehicle.position_m, --at)");
        assert_eq!(named("drive.route.waypoints[1]"), "drive.waypoints_m[1]");
        assert_eq!(named("drive.optics.blurs[0].f_number"), "camera.focal_length_mm / camera.aperture_mm");
    }
}
