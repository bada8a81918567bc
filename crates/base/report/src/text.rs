//! Numbers, times and lists as people read them, and texts for XML.

use std::time::Duration;

/// A count with commas between thousands.
///
/// ```
/// assert_eq!(raypencil_report::count(1_081_344), "1,081,344");
/// ```
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

/// A count and its noun, in the singular or the plural.
///
/// ```
/// use raypencil_report::counted;
///
/// assert_eq!(counted(1, "ray", "rays"), "1 ray");
/// assert_eq!(counted(0, "ray", "rays"), "0 rays");
/// ```
pub fn counted(value: u64, one: &str, many: &str) -> String {
    format!("{} {}", count(value), if value == 1 { one } else { many })
}

/// A number in three significant digits.
///
/// ```
/// use raypencil_report::number;
///
/// assert_eq!([0.031_24, 17.25, 6.394e-14].map(number), ["0.0312", "17.2", "6.39e-14"]);
/// ```
pub fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".into()
    } else if value.is_nan() {
        "NaN".into()
    } else if value.is_infinite() {
        "infinite".into()
    } else if (0.000_995..9995.0).contains(&size) {
        // Number of decimals that leaves three digits after rounding.
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

/// A number in three digits and its unit; `unit` may be empty.
pub fn quantity(value: f64, unit: &str) -> String {
    let number = number(value);
    if unit.is_empty() { number } else { format!("{number} {unit}") }
}

/// A duration in three digits, in µs, ms or s.
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

/// A text for XML and HTML: reserved characters escaped, control characters replaced by blanks.
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

/// How many of the rays of a page are described in full, and which, in words.
///
/// ```
/// use raypencil_report::described_words;
///
/// assert_eq!(described_words(17, 17), "Every ray that is not 'agree' is described in full: 17.");
/// ```
pub fn described_words(described: u64, all: u64) -> String {
    let [described_words, all_words] = [described, all].map(count);
    if described == all {
        return format!("Every ray that is not 'agree' is described in full: {described_words}.");
    }
    format!(
        "{described_words} of the {all_words} rays that are not 'agree' are described in full: the worst half by class \
         and size, and a fair sample of the others. The command of each ray prints the rest."
    )
}
