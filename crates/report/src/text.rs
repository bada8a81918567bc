//! Numbers, places and times as people read them.

use std::time::Duration;

/// A count with its thousands apart: 1,081,344.
pub fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (index, digit) in digits.char_indices() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A count and its noun.
pub fn counted(value: u64, one: &str, many: &str) -> String {
    format!("{} {}", count(value), if value == 1 { one } else { many })
}

/// A number in three digits: 0.0312, 17.2, 6.39e-14.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".into()
    } else if value.is_nan() {
        "NaN".into()
    } else if value.is_infinite() {
        "infinite".into()
    } else if (0.000_995..9995.0).contains(&size) {
        // As many decimals as leave three digits.
        let decimals = match size {
            ..0.009_995 => 5,
            ..0.099_95 => 4,
            ..0.9995 => 3,
            ..9.995 => 2,
            ..99.95 => 1,
            _ => 0,
        };
        format!("{value:.decimals$}")
    } else {
        format!("{value:.2e}")
    }
}

/// A number and its unit, if it has one.
pub fn quantity(value: f64, unit: &str) -> String {
    let number = number(value);
    if unit.is_empty() { number } else { format!("{number} {unit}") }
}

/// A wall-clock time in three digits.
pub fn time(time: Duration) -> String {
    let seconds = time.as_secs_f64();
    match seconds {
        ..0.000_999_5 => format!("{} µs", number(seconds * 1e6)),
        ..0.9995 => format!("{} ms", number(seconds * 1e3)),
        _ => format!("{} s", number(seconds)),
    }
}

/// Names as a list in a sentence: a, b and c.
pub fn list(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [only] => (*only).into(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// A text for XML.
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            letter if letter.is_control() => out.push(' '),
            letter => out.push(letter),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_have_their_thousands_apart() {
        let counts = [0, 7, 999, 1000, 1_081_344, 201_326_592].map(count);
        assert_eq!(counts, ["0", "7", "999", "1,000", "1,081,344", "201,326,592"]);
    }

    #[test]
    fn numbers_have_three_digits() {
        let cases = [
            (0.0, "0"),
            (1.0, "1.00"),
            (-0.25, "-0.250"),
            (0.031_24, "0.0312"),
            (0.001, "0.00100"),
            (0.999_96, "1.00"),
            (17.25, "17.2"),
            (1234.0, "1234"),
            (6.394e-14, "6.39e-14"),
            (123_456.0, "1.23e5"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "infinite"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
        assert_eq!(quantity(2.0, "m"), "2.00 m");
    }

    #[test]
    fn times_have_a_fitting_unit() {
        let times = [412, 41_200, 4_120_000].map(|micros| time(Duration::from_micros(micros)));
        assert_eq!(times, ["412 µs", "41.2 ms", "4.12 s"]);
    }

    #[test]
    fn lists_read_as_sentences() {
        assert_eq!(list(&["a", "b", "c"]), "a, b and c");
        assert_eq!(list(&["a"]), "a");
    }
}
