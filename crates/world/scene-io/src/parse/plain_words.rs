//! Messages of the TOML reader in people's words, with what to write instead.

/// Least likeness (Jaro and Winkler, 0 to 1) of a key that is suggested for a misspelt one. Tuned: it finds one wrong, missing or
/// exchanged letter in keys of this project, and no key for a word that is none.
const MIN_LIKENESS: f64 = 0.85;

/// The message without the words of programmers. What is not known stays as it is.
pub(crate) fn plain_words(message: &str) -> String {
    let message = message.trim_end();
    unknown_key(message)
        .or_else(|| wrong_kind(message))
        .or_else(|| wrong_length(message))
        .or_else(|| {
            let key = message.strip_prefix("missing field ")?;
            Some(format!("the key {key} is missing"))
        })
        .unwrap_or_else(|| message.to_string())
}

/// The texts between backticks.
fn quoted(text: &str) -> Vec<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

/// "unknown field `a`, expected one of `b`, `c`".
fn unknown_key(message: &str) -> Option<String> {
    let rest = message.strip_prefix("unknown field ")?;
    let mut names = quoted(rest).into_iter();
    let key = names.next()?;
    let known: Vec<&str> = names.collect();
    let hint = nearest(key, &known).map_or(String::new(), |name| match unit_words(name) {
        Some(unit) => format!("; did you mean `{name}`, in {unit}?"),
        None => format!("; did you mean `{name}`?"),
    });
    let list: Vec<String> = known.iter().map(|name| format!("`{name}`")).collect();
    Some(match list.is_empty() {
        true => format!("unknown key `{key}`; no keys are expected here"),
        false => format!("unknown key `{key}`{hint} Known keys: {}", list.join(", "))
            .replace("` Known", "`. Known"),
    })
}

/// Names of other programs for what a key of this one says.
const OTHER_NAMES: [(&str, &[&str]); 4] = [
    (
        "field_of_view_deg",
        &["fov", "fov_deg", "hfov", "hfov_deg", "horizontal_fov", "fov_x_deg", "view_angle_deg"],
    ),
    (
        "intrinsics_px",
        &["fx", "fy", "cx", "cy", "k", "K", "intrinsics", "camera_matrix", "focal_length_px", "fx_px"],
    ),
    ("camera_info", &["calibration", "camera_info_file", "calib", "ros_camera_info"]),
    ("pixel_pitch_um", &["pixel_size_um", "pixel_um", "sensor_width_mm"]),
];

/// The known key that a misspelt one was meant to be.
fn nearest<'a>(key: &str, known: &[&'a str]) -> Option<&'a str> {
    let other = OTHER_NAMES.iter().find(|(_, names)| names.contains(&key)).map(|(name, _)| *name);
    if let Some(name) = known.iter().find(|known| Some(**known) == other) {
        return Some(name);
    }
    let likeness = |name: &str| strsim::jaro_winkler(key, name);
    let best = known.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
    (likeness(best) >= MIN_LIKENESS).then_some(best)
}

/// The unit by which a key ends.
fn unit_words(key: &str) -> Option<&'static str> {
    let units = [
        ("_px", "pixels"),
        ("_um", "micrometres"),
        ("_mm", "millimetres"),
        ("_nm", "nanometres"),
        ("_m", "metres"),
        ("_deg", "degrees"),
        ("_w", "watts"),
        ("_per_m", "1/m"),
    ];
    // The longest ending that fits.
    units.iter().filter(|(end, _)| key.ends_with(end)).max_by_key(|(end, _)| end.len()).map(|(_, unit)| *unit)
}

/// "invalid type: string "a", expected i64".
fn wrong_kind(message: &str) -> Option<String> {
    let rest = message.strip_prefix("invalid type: ").or_else(|| message.strip_prefix("invalid value: "))?;
    let (found, expected) = rest.rsplit_once(", expected ")?;
    let found = [
        ("string ", "the text "),
        ("integer ", "the number "),
        ("floating point ", "the number "),
        ("boolean ", ""),
    ]
    .into_iter()
    .find_map(|(word, plain)| Some(format!("{plain}{}", found.strip_prefix(word)?.replace('`', ""))))
    .unwrap_or_else(|| match found {
        "map" => "a table".into(),
        "sequence" => "a list".into(),
        _ => found.to_string(),
    });
    let expected = match expected {
        "a sequence" => "a list: of numbers, [1, 2.5]; of tables, each under its [[name]]".to_string(),
        "a map" => "a table of keys, { ... } or [...]".into(),
        "a string" | "string" => "a text in quotes".into(),
        "a boolean" => "true or false".into(),
        "f64" | "f32" | "floating point" => "a number".into(),
        "u64" | "u32" | "u16" | "u8" | "usize" => "a whole number, 0 or more".into(),
        "i64" | "i32" => "a whole number".into(),
        other if other.starts_with("struct ") || other.starts_with("internally tagged enum ") => {
            "a table of keys, { ... } or [...]".into()
        }
        other if other.starts_with("an array of length ") => {
            format!("a list of {} numbers", &other["an array of length ".len()..])
        }
        other => other.to_string(),
    };
    Some(format!("{found}; expected {expected}"))
}

/// "invalid length 3, expected an array of length 2".
fn wrong_length(message: &str) -> Option<String> {
    let (found, expected) = message.strip_prefix("invalid length ")?.split_once(", expected ")?;
    let expected = match expected.strip_prefix("an array of length ") {
        Some(length) => format!("one of {length}"),
        None => expected.to_string(),
    };
    Some(format!("a list of {found}; expected {expected}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_of_the_reader_are_told_in_plain_words() {
        for (message, plain) in [
            (
                "unknown field `widht_px`, expected one of `position_m`, `width_px`, `height_px`",
                "unknown key `widht_px`; did you mean `width_px`, in pixels? Known keys: `position_m`, `width_px`, `height_px`",
            ),
            (
                "unknown field `focal_length_m`, expected one of `focal_length_mm`, `aperture_mm`",
                "unknown key `focal_length_m`; did you mean `focal_length_mm`, in millimetres? Known keys: `focal_length_mm`, \
                 `aperture_mm`",
            ),
            (
                "unknown field `zebra`, expected `version` or `camera`",
                "unknown key `zebra`. Known keys: `version`, `camera`",
            ),
            (
                "unknown field `fx`, expected one of `fan_deg`, `intrinsics_px`",
                "unknown key `fx`; did you mean `intrinsics_px`, in pixels? Known keys: `fan_deg`, `intrinsics_px`",
            ),
            (
                "unknown field `hfov`, expected one of `width_px`, `field_of_view_deg`",
                "unknown key `hfov`; did you mean `field_of_view_deg`, in degrees? Known keys: `width_px`, `field_of_view_deg`",
            ),
            // Where the key is none of that table, it is not suggested.
            ("unknown field `fov`, expected `version`", "unknown key `fov`. Known keys: `version`"),
            ("unknown field `a`, there are no fields", "unknown key `a`; no keys are expected here"),
            (
                "invalid type: map, expected a sequence",
                "a table; expected a list: of numbers, [1, 2.5]; of tables, each under its [[name]]",
            ),
            (
                "invalid type: string \"pyramids\", expected struct TerrainKeys",
                "the text \"pyramids\"; expected a table of keys, { ... } or [...]",
            ),
            ("invalid type: string \"100\", expected i64", "the text \"100\"; expected a whole number"),
            ("invalid type: integer `1`, expected a string", "the number 1; expected a text in quotes"),
            ("invalid type: boolean `true`, expected f64", "true; expected a number"),
            ("invalid length 3, expected an array of length 2", "a list of 3; expected one of 2"),
            ("missing field `elevation_deg`", "the key `elevation_deg` is missing"),
            ("duplicate key", "duplicate key"),
        ] {
            assert_eq!(plain_words(message), plain);
        }
    }
}
