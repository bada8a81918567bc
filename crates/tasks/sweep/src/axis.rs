//! Parameters of a sweep: keys of a scene file, each with its values.

use std::collections::BTreeSet;
use std::path::Path;

use raypencil_files::bytes;
use raypencil_scene_io::Setting;
use serde::{Deserialize, Serialize};

use crate::error::SweepError;

/// Maximum number of values of one key.
const MAX_VALUES: usize = 1_000_000;

/// Maximum number of keys of a list. A scene with a camera and three beams has some two hundred.
const MAX_KEYS: usize = 1000;

/// Maximum size of a list of runs, bytes.
const MAX_LIST_BYTES: u64 = 1 << 26;

/// A key with the values that it takes, or several keys that take their values together.
///
/// ```
/// use raypencil_sweep::Axis;
///
/// // From 20 to 35 in steps of 5, both ends included.
/// let pitch = Axis::parse("beam.0.pitch_down_deg=20:35:5")?;
/// assert_eq!(pitch.rows.iter().map(|row| row[0].as_str()).collect::<Vec<_>>(), ["20", "25", "30", "35"]);
/// // Several values; a comma within brackets is part of one.
/// assert_eq!(Axis::parse("terrain.generate.seed=1,2,7")?.rows.len(), 3);
/// assert_eq!(Axis::parse("drive.waypoints_m=[[3, 0], [5, 1]]")?.rows.len(), 1);
/// # Ok::<(), raypencil_sweep::SweepError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// The keys.
    pub keys: Vec<String>,
    /// For each step the values of the keys, as TOML or as plain text.
    pub rows: Vec<Vec<String>>,
}

impl Axis {
    /// Parses `KEY=VALUES`: values separated by commas, or `FIRST:LAST:STEP`, numbers with both ends.
    ///
    /// # Errors
    /// A key that is none, no value, a range that does not end.
    pub fn parse(text: &str) -> Result<Self, SweepError> {
        let (key, values) = text.split_once('=').ok_or_else(|| {
            SweepError::axis(text, "expected KEY=VALUES, such as camera.pitch_down_deg=20:35:5 or =20,25,30")
        })?;
        let key = key.trim();
        // The key is checked where settings are.
        Setting::new(key, "")?;
        let mut rows = Vec::new();
        for part in split(values) {
            let part = part.trim();
            if part.is_empty() {
                return Err(SweepError::axis(
                    text,
                    "a value is empty; expected one before and after each comma",
                ));
            }
            let room = MAX_VALUES - rows.len();
            match range(part, room).map_err(|message| SweepError::axis(text, message))? {
                Some(values) => rows.extend(values.into_iter().map(|value| vec![value])),
                None if room == 0 => {
                    return Err(SweepError::axis(text, format!("expected at most {MAX_VALUES} values")));
                }
                None => rows.push(vec![in_decimals(part)]),
            }
        }
        let values: Vec<Meaning> = rows.iter().map(|row| Meaning::of(&row[0])).collect();
        let mut seen = BTreeSet::new();
        if let Some(twice) = values.iter().position(|value| !seen.insert(value)) {
            let twice = &rows[twice][0];
            return Err(SweepError::axis(text, format!("{twice} is given twice; expected different values")));
        }
        Ok(Self { keys: vec![key.to_string()], rows })
    }

    /// Reads a CSV file: keys in its first row, and a run in each row below.
    ///
    /// # Errors
    /// A file that cannot be read, is no CSV, or has no runs.
    pub fn read_list(path: &Path) -> Result<Self, SweepError> {
        let bytes = bytes::read_file(path, MAX_LIST_BYTES)
            .map_err(|error| raypencil_files::FileError::io(path, "read", error))?;
        Self::list_from_bytes(&bytes, path)
    }

    /// The same from the contents of a file; `path` is its name in messages.
    ///
    /// # Errors
    /// As [`Axis::read_list`], but for those of reading.
    pub fn list_from_bytes(bytes: &[u8], path: &Path) -> Result<Self, SweepError> {
        let refused = |message: String| SweepError::List { file: path.display().to_string(), message };
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes);
        let keys: Vec<String> =
            reader.headers().map_err(|error| refused(error.to_string()))?.iter().map(String::from).collect();
        if keys.len() > MAX_KEYS {
            return Err(refused(format!("line 1: {} keys; expected at most {MAX_KEYS}", keys.len())));
        }
        for key in &keys {
            Setting::new(key, "").map_err(|error| refused(format!("line 1: {error}")))?;
        }
        if let Some(twice) = first_twice(keys.iter().map(String::as_str)) {
            return Err(refused(format!("line 1: `{twice}` is given twice; expected different keys")));
        }
        if keys.len() == 1
            && let Some(line) = empty_line(bytes)
        {
            let expected = "expected a value, or \"\" for the scene's own";
            return Err(refused(format!("line {line}: an empty line; {expected}")));
        }
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|error| refused(error.to_string()))?;
            rows.push(record.iter().map(in_decimals).collect());
        }
        if rows.is_empty() {
            return Err(refused("there is no run; expected keys in the first line and values below".into()));
        }
        Ok(Self { keys, rows })
    }
}

/// The first empty line before the end of a file, from 1. A reader of CSV passes over it, where a person may mean an empty value.
fn empty_line(bytes: &[u8]) -> Option<usize> {
    let text = bytes.trim_ascii_end();
    text.split(|&byte| byte == b'\n').position(|line| line.trim_ascii().is_empty()).map(|line| line + 1)
}

/// A value as tables have it: a whole number of TOML in base 16, 8 or 2 in decimals, so that a column of numbers stays one.
fn in_decimals(value: &str) -> String {
    let of_base = |(prefix, base)| {
        let digits = value.strip_prefix(prefix)?;
        // TOML has underscores between two digits alone.
        let is_split = digits.split('_').all(|part| !part.is_empty() && !part.starts_with(['+', '-']));
        is_split.then(|| i64::from_str_radix(&digits.replace('_', ""), base).ok())?
    };
    let number = [("0x", 16), ("0o", 8), ("0b", 2)].into_iter().find_map(of_base);
    number.map_or_else(|| value.to_string(), |number| number.to_string())
}

/// What a value means: `30`, `3e1` and `30.0` are one number, and `facets` is the text of `"facets"`.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Meaning {
    /// Bits of a number.
    Number(u64),
    /// A text, and all that is none of these.
    Words(String),
}

impl Meaning {
    fn of(value: &str) -> Self {
        let quoted = ['"', '\''].into_iter().find_map(|quote| value.strip_prefix(quote)?.strip_suffix(quote));
        if let Some(text) = quoted {
            return Self::Words(text.into());
        }
        let digits = value.replace('_', "");
        let is_number = digits.starts_with(|letter: char| letter.is_ascii_digit() || "+-".contains(letter));
        match digits.parse::<f64>() {
            // 0 and -0 are one.
            Ok(number) if is_number => Self::Number((number + 0.0).to_bits()),
            _ => Self::Words(value.into()),
        }
    }
}

/// The first text that was there before.
pub(crate) fn first_twice<'a>(texts: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let mut seen = BTreeSet::new();
    texts.into_iter().find(|text| !seen.insert(*text))
}

/// Parts between commas that are not within brackets or quotes.
fn split(text: &str) -> Vec<&str> {
    let (mut parts, mut depth, mut quote, mut start) = (Vec::new(), 0_i32, None, 0);
    for (at, letter) in text.char_indices() {
        match (quote, letter) {
            (Some(open), _) if letter == open => quote = None,
            (None, '"' | '\'') => quote = Some(letter),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth -= 1,
            (None, ',') if depth == 0 => {
                parts.push(&text[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&text[start..]);
    parts
}

/// Decimals of a range's numbers, at most: more than any double between 1e-20 and 1 tells apart.
const MAX_DECIMALS: usize = 40;

/// Values of `FIRST:LAST:STEP`; `None` if the text is no such range. The values have the decimals of the numbers, so that 0.1
/// and two steps of 0.1 are 0.3.
fn range(text: &str, room: usize) -> Result<Option<Vec<String>>, String> {
    let parts: Vec<&str> = text.split(':').map(str::trim).collect();
    let number = |text: &str| text.parse::<f64>().ok().filter(|number| number.is_finite());
    let numbers: Vec<Option<f64>> = parts.iter().map(|part| number(part)).collect();
    let (&[Some(low), Some(high), Some(by)], &[first, _, step]) = (numbers.as_slice(), parts.as_slice())
    else {
        // A key of a scene file takes no text that looks like a range: so it is one, with a slip.
        if parts.len() > 1 && numbers.iter().any(Option::is_some) {
            let slip = match parts.len() {
                2 => "a range needs a step",
                3 => "a range has three numbers",
                _ => "a range has three parts",
            };
            return Err(format!("{text}: {slip}; expected FIRST:LAST:STEP, such as 20:35:5"));
        }
        return Ok(None);
    };
    if by == 0.0 || (high - low) / by < 0.0 {
        return Err(format!("{text} does not come to its end; expected FIRST:LAST:STEP, such as 20:35:5"));
    }
    // A thousandth of a step of room for the last value.
    let steps = (high - low) / by;
    let count = (steps + 1e-3).floor();
    if steps - count > 1e-3 {
        let [last, next] = [low + count * by, low + (count + 1.0) * by].map(|value| {
            // As few digits as the numbers have: sums of decimals have others behind them.
            let short: f64 = format!("{value:.9e}").parse().unwrap_or(value);
            short.to_string()
        });
        return Err(format!(
            "{text} passes its end: {last} is before it and {next} behind; expected a range that ends at one of the two"
        ));
    }
    if count >= room as f64 {
        return Err(format!("{text} has {} values; expected at most {MAX_VALUES}", count + 1.0));
    }
    let decimals = |text: &str| text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    if [first, step].iter().any(|text| text.contains(['e', 'E'])) {
        // Fifteen digits, which every double holds: sums of decimals have others behind them.
        let value = |k: u64| format!("{:.14e}", low + k as f64 * by).parse().unwrap_or(low);
        return Ok(Some((0..=count as u64).map(|k| format!("{:e}", value(k))).collect()));
    }
    let decimals = decimals(first).max(decimals(step));
    if decimals > MAX_DECIMALS {
        return Err(format!("a range with {decimals} decimals; expected at most {MAX_DECIMALS}"));
    }
    Ok(Some((0..=count as u64).map(|k| format!("{:.decimals$}", low + k as f64 * by)).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Vec<String> {
        Axis::parse(text).unwrap().rows.into_iter().map(|mut row| row.remove(0)).collect()
    }

    #[test]
    fn ranges_have_both_ends_and_the_decimals_of_their_numbers() {
        assert_eq!(values("a=0.1:0.5:0.1"), ["0.1", "0.2", "0.3", "0.4", "0.5"]);
        assert_eq!(values("a=3:-3:-3"), ["3", "0", "-3"]);
        assert_eq!(values("a=-2:1:1"), ["-2", "-1", "0", "1"]);
        assert_eq!(values("a=1:2:0.25, 7"), ["1.00", "1.25", "1.50", "1.75", "2.00", "7"]);
        assert_eq!(values("a=5:5:1"), ["5"]);
        assert_eq!(values("a=1e-3:3e-3:1e-3"), ["1e-3", "2e-3", "3e-3"]);
        // Where the first number has more decimals than the step; and sums that no double has, with an exponent.
        assert_eq!(values("a=0.05:2.05:1"), ["0.05", "1.05", "2.05"]);
        assert_eq!(values("a=1e-1:5e-1:1e-1"), ["1e-1", "2e-1", "3e-1", "4e-1", "5e-1"]);
        assert_eq!(values("a=1e3:1.2e3:1e2"), ["1e3", "1.1e3", "1.2e3"]);
        // Whole numbers of another base, as tables and charts have them; and what TOML takes for none.
        assert_eq!(values("a=0x1f,0o17,0b1_01"), ["31", "15", "5"]);
        assert_eq!(values("a=0xg,0x_1,0x+1,\"0x10\""), ["0xg", "0x_1", "0x+1", "\"0x10\""]);
        // A text of digits is no number.
        assert_eq!(values("a=30,\"30\""), ["30", "\"30\""]);
        // No numbers: a text with colons.
        assert_eq!(values("a=x:y:z"), ["x:y:z"]);
    }

    #[test]
    fn a_long_list_of_values_is_looked_through_once() {
        let values: Vec<String> = (0..200_000).map(|value| value.to_string()).collect();
        let start = std::time::Instant::now();
        let message = Axis::parse(&format!("a={},7", values.join(","))).unwrap_err().to_string();
        assert!(message.ends_with("7 is given twice; expected different values"));
        // Each against each would take minutes.
        assert!(start.elapsed().as_secs() < 10);
    }

    #[test]
    fn a_parameter_has_as_many_values_as_there_is_room_for() {
        // Up to the limit, and one more: of a whole range, and of what is left.
        for room in [1, 2, 10] {
            let of = |count: usize| range(&format!("1:{count}:1"), room);
            assert_eq!(of(room).unwrap().unwrap().len(), room);
            assert!(of(room + 1).unwrap_err().contains(&format!("has {} values", room + 1)));
            assert!(range("1:2:1", 0).is_err());
        }
        // A value that is no range, where there is room for none.
        let message = Axis::parse(&format!("a=1:{MAX_VALUES}:1,x")).unwrap_err().to_string();
        assert!(message.contains("expected at most 1000000 values"), "{message}");
    }

    #[test]
    fn commas_within_brackets_and_quotes_do_not_separate() {
        assert_eq!(values("a=[1, 2],[3, 4]"), ["[1, 2]", "[3, 4]"]);
        assert_eq!(values("a=\"x,y\",z"), ["\"x,y\"", "z"]);
        // Brackets and the other quotes within quotes are letters.
        assert_eq!(values("a=\"[\",\"it's\",']'"), ["\"[\"", "\"it's\"", "']'"]);
        assert_eq!(values("a={ b = 1, c = 2 }"), ["{ b = 1, c = 2 }"]);
    }

    #[test]
    fn parameters_that_are_none_are_named() {
        for (text, expected) in [
            ("a", "expected KEY=VALUES"),
            ("a=1,,2", "a value is empty"),
            ("a=", "a value is empty"),
            ("a b=1", "`a b` is no key"),
            ("a=1:2:0", "does not come to its end"),
            ("a=1:2:-1", "does not come to its end"),
            ("a=20:34:5", "20:34:5 passes its end: 30 is before it and 35 behind"),
            ("a=0:1:0.3", "0:1:0.3 passes its end: 0.9 is before it and 1.2 behind"),
            ("a=3:-3:-4", "3:-3:-4 passes its end: -1 is before it and -5 behind"),
            ("a=0:1e9:1", "expected at most 1000000"),
            ("a=1,2,1", "1 is given twice"),
            ("a=30,31,30.0", "30.0 is given twice"),
            ("a=0,-0.0", "-0.0 is given twice"),
            ("a=1_000,1e3", "1e3 is given twice"),
            ("a=0x10,16", "16 is given twice"),
            ("a=16,0b1_0000", "16 is given twice"),
            ("a=facets,\"facets\"", "\"facets\" is given twice"),
            ("a=20:35", "20:35: a range needs a step; expected FIRST:LAST:STEP, such as 20:35:5"),
            ("a=7,20:", "a range needs a step"),
            ("a=1:five:2", "a range has three numbers"),
            ("a=1:2:3:4", "a range has three parts"),
            ("a=1:inf:1", "a range has three numbers"),
            (&format!("a=0.{}1:1:1", "0".repeat(70_000)), "with 70001 decimals; expected at most 40"),
        ] {
            let message = Axis::parse(text).unwrap_err().to_string();
            assert!(message.contains(expected), "{text}: {message}");
        }
    }

    #[test]
    fn a_list_has_a_run_in_each_row() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("runs.csv");
        std::fs::write(&path, "camera.pitch_down_deg, vehicle.position_m\n20,\"[1, 2]\"\n25,\"[0,0]\"\n")
            .unwrap();
        let list = Axis::read_list(&path).unwrap();
        assert_eq!(list.keys, ["camera.pitch_down_deg", "vehicle.position_m"]);
        assert_eq!(list.rows, [["20", "[1, 2]"], ["25", "[0,0]"]]);
        std::fs::write(&path, "camera.width_px\n0x10\n").unwrap();
        assert_eq!(Axis::read_list(&path).unwrap().rows, [["16"]]);
        let most = (0..1000).map(|k| format!("k{k}")).collect::<Vec<_>>().join(",");
        std::fs::write(&path, format!("{most}\n{}\n", ["1"; 1000].join(","))).unwrap();
        assert_eq!(Axis::read_list(&path).unwrap().keys.len(), 1000);
        let many = (0..150_000).map(|k| format!("k{k}")).collect::<Vec<_>>().join(",") + "\n";
        for (text, expected) in [
            ("a,b\n1\n", "runs.csv"),
            ("a,a\n1,2\n", "`a` is given twice"),
            ("a b\n1\n", "`a b` is no key"),
            ("a\n", "there is no run"),
            ("", "there is no run"),
            (&many, "line 1: 150000 keys; expected at most 1000"),
        ] {
            std::fs::write(&path, text).unwrap();
            let message = Axis::read_list(&path).unwrap_err().to_string();
            assert!(message.contains(expected), "{text:?}: {message}");
        }
        assert!(
            Axis::read_list(&folder.path().join("none.csv")).unwrap_err().to_string().contains("none.csv")
        );
    }
}
