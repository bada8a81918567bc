//! `angles = { file = "..." }`: a pattern that is a list of times and angles, such as the rosettes of Livox.

use std::path::Path;

use raypencil_files::{Fault, FileError, Limits, bytes, heading_in_comment, sha256};
use raypencil_scene::pattern::{Channel, MAX_RAYS, Mounting, PatternRays, Spinning};
use raypencil_scene::{CastRay, SceneError};
use serde::Deserialize;
use toml::Spanned;

use crate::digest::NamedDigest;
use crate::parse::key::Key;
use crate::parse::rays::grid::RANGE_M;
use crate::parse::source::Source;
use crate::scene_error::SceneIoError;
use crate::trajectory::TIME_S;

/// Names of a heading that has too many, at most.
const MAX_HEADING: usize = 16;

/// The order of the numbers in a row.
const ORDER: &str = "time, azimuth, elevation: seconds, degrees to the left of x, degrees up";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AnglesKeys {
    file: Key<String>,
    min_range_m: Key<f64>,
    max_range_m: Key<f64>,
}

/// Times and angles, and the ranges of the sensor.
pub(super) struct Angles {
    /// Seconds, azimuth to the left and elevation in degrees.
    pub(super) rows: Vec<[f64; 3]>,
    min_range_m: f64,
    max_range_m: f64,
}

impl Angles {
    /// The rays, of shape (rows), with their times. `field` names the pattern in messages.
    pub(super) fn rays(&self, field: &str) -> Result<PatternRays, SceneError> {
        let (mut rays, mut times) = (Vec::new(), Vec::new());
        for &[time, azimuth, elevation] in &self.rows {
            // A head of one channel that fires once: the same rule of directions, to the bit.
            let channel = Channel {
                elevation_deg: elevation,
                azimuth_offset_deg: 0.0,
                vertical_m: 0.0,
                lateral_m: 0.0,
                firing_s: 0.0,
            };
            let head = Spinning {
                channels: vec![channel],
                azimuth_start_deg: azimuth,
                azimuth_step_deg: 1.0,
                steps: 1,
                period_s: 1.0,
                min_range_m: self.min_range_m,
                max_range_m: self.max_range_m,
            };
            let fired: Vec<CastRay> = head.rays(field)?.rays;
            rays.extend(fired);
            times.push(time);
        }
        Ok(PatternRays {
            shape: vec![self.rows.len() as u64],
            rays,
            times: Some(times),
            weights: None,
            returns: None,
            elevations_deg: None,
            mounting: Mounting::HERE,
        })
    }
}

impl Source<'_> {
    pub(super) fn angles(
        &self,
        name: &str,
        table: &Spanned<AnglesKeys>,
        digests: &mut Vec<NamedDigest>,
    ) -> Result<Angles, SceneIoError> {
        let keys = table.get_ref();
        let Some(key) = &keys.file else {
            let message = format!("`{name}.file` is missing; expected rows of {ORDER}, as CSV");
            return Err(self.error(table.span(), message));
        };
        let file = self.file.parent().unwrap_or(Path::new("")).join(key.get_ref());
        if !file.is_file() {
            let message = format!(
                "`{name}.file`: there is no file \"{}\"; expected angles as CSV, the path relative to this file",
                file.display()
            );
            return Err(self.error(key.span(), message));
        }
        let bytes = bytes::read_file(&file, Limits::default().bytes)
            .map_err(|error| FileError::io(&file, "read", error))?;
        digests.push((key.get_ref().clone(), sha256(&bytes)));
        let rows = rows(&bytes).map_err(|fault| FileError::Array(fault.in_file(&file)))?;
        let (mut min_range_m, mut max_range_m) = (0.0, f64::INFINITY);
        self.number(&keys.min_range_m, &format!("{name}.min_range_m"), &mut min_range_m, RANGE_M, "metres")?;
        self.number(&keys.max_range_m, &format!("{name}.max_range_m"), &mut max_range_m, RANGE_M, "metres")?;
        if min_range_m > max_range_m {
            let message = format!(
                "`{name}.min_range_m` is {min_range_m}; expected at most `max_range_m`, {max_range_m} metres"
            );
            return Err(self.error(table.span(), message));
        }
        Ok(Angles { rows, min_range_m, max_range_m })
    }
}

/// Beginnings of words that a heading of such a file may have. Not all of them are of an order and a unit that is read.
const NAMES: [&str; 8] =
    ["time", "azimuth", "elevation", "zenith", "altitude", "inclination", "phi", "theta"];

/// Words that are such names as a whole.
const SHORT_NAMES: [&str; 5] = ["t", "az", "el", "ze", "zen"];

/// Whether a word of a comment may name a column.
fn is_name(word: &str) -> bool {
    let word = word.to_lowercase();
    NAMES.iter().any(|name| word.starts_with(name)) || SHORT_NAMES.contains(&word.as_str())
}

/// Whether a heading calls the third column a zenith: its angles then count from straight up.
fn is_of_zeniths([time, azimuth, third]: [&str; 3], line: usize) -> Result<bool, Fault> {
    let begins = |field: &str, name: &str| field.to_lowercase().starts_with(name);
    let is_zenith = begins(third, "zenith");
    let is_known =
        begins(time, "t") && begins(azimuth, "azimuth") && (is_zenith || begins(third, "elevation"));
    // Angles in radians, or times in nanoseconds, would be read as something else.
    let is_of_unit = |field: &str, units: &[&str]| {
        let field = field.to_lowercase();
        let mut parts = field.split(['/', '_', '[', '(', ' ']).skip(1).filter(|part| !part.is_empty());
        parts.next().is_none_or(|unit| units.contains(&unit.trim_end_matches([']', ')'])))
    };
    let degrees = &["deg", "degree", "degrees", ""];
    if is_known
        && is_of_unit(time, &["s", "sec", "seconds", ""])
        && is_of_unit(azimuth, degrees)
        && is_of_unit(third, degrees)
    {
        return Ok(is_zenith);
    }
    let expected = format!("columns in the order {ORDER}, or zenith: degrees from straight up");
    Err(Fault::new(format!("line {line}"), [time, azimuth, third].join(","), expected))
}

/// The rows of a file. A heading, which may be a comment, may name the columns; where it calls the third a zenith, angles count from straight up.
fn rows(bytes: &[u8]) -> Result<Vec<[f64; 3]>, Fault> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        Fault::new(
            format!("byte {}", error.valid_up_to()),
            "bytes that are no text",
            format!("rows of {ORDER}"),
        )
    })?;
    let (mut rows, mut is_zenith, mut has_heading) = (Vec::new(), false, false);
    for (number, line) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
        if line.trim().is_empty() {
            continue;
        }
        if line.trim_start().starts_with('#') {
            // As NumPy writes a heading: other comments are none, but one that is meant as a heading must be one.
            if let Some(words) = heading_in_comment(line, 3..=3, is_name) {
                let is_of_zeniths = is_of_zeniths([&words[0], &words[1], &words[2]], number)?;
                // One between rows is that of a file that was joined to another.
                if !rows.is_empty() && is_of_zeniths != is_zenith {
                    let angle = |is_of_zeniths: bool| if is_of_zeniths { "zenith" } else { "elevation" };
                    let found = format!("a heading with {}", angle(is_of_zeniths));
                    let expected = format!("{}, as the rows before it have", angle(is_zenith));
                    return Err(Fault::new(format!("line {number}"), found, expected));
                }
                is_zenith = is_of_zeniths;
            } else if line.contains([',', ';'])
                && let Some(words) = heading_in_comment(line, 4..=MAX_HEADING, is_name)
            {
                // Names of more columns than rows have: not all of them mean what is read.
                let expected = format!("columns in the order {ORDER}, or zenith: degrees from straight up");
                return Err(Fault::new(format!("line {number}"), words.join(","), expected));
            }
            continue;
        }
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        let refuse =
            |found: String, expected: String| Err(Fault::new(format!("line {number}"), found, expected));
        let [time, azimuth, third] = fields[..] else {
            return refuse(
                format!("{} fields", fields.len()),
                format!("3 with commas between them: {ORDER}"),
            );
        };
        let is_heading = fields.iter().all(|field| field.parse::<f64>().is_err());
        if is_heading && rows.is_empty() && !has_heading {
            is_zenith = is_of_zeniths([time, azimuth, third], number)?;
            has_heading = true;
            continue;
        }
        let mut row = [0.0; 3];
        let limits = [TIME_S, -360.0..=360.0, if is_zenith { 0.0..=180.0 } else { -90.0..=90.0 }];
        for (column, (field, limits)) in fields.iter().zip(limits).enumerate() {
            row[column] = match field.parse::<f64>() {
                Ok(number) if limits.contains(&number) => number,
                _ => {
                    let expected = format!("{} to {}, as {ORDER}", limits.start(), limits.end());
                    return refuse(format!("field {}: {field:?}", column + 1), expected);
                }
            };
        }
        if is_zenith {
            row[2] = 90.0 - row[2];
        }
        if rows.len() as u64 == MAX_RAYS {
            return refuse(format!("row {}", rows.len() + 1), format!("at most {MAX_RAYS} rows"));
        }
        rows.push(row);
    }
    if rows.is_empty() {
        return Err(Fault::new("file", "no row", format!("rows of {ORDER}")));
    }
    Ok(rows)
}
