//! YAML scalars that readers of YAML 1.1, such as PyYAML, and readers of YAML 1.2 understand alike.

/// Real number. YAML 1.1 requires a decimal point and a sign of the exponent: there, `1e16` and `1.5e16` are texts.
pub(crate) fn real(value: f64) -> String {
    let text = format!("{value:?}");
    let Some((digits, exponent)) = text.split_once('e') else { return text };
    let point = if digits.contains('.') { "" } else { ".0" };
    let sign = if exponent.starts_with('-') { "" } else { "+" };
    format!("{digits}{point}e{sign}{exponent}")
}

/// Text in quotes. Without them, `-` would be a list, `1` a number and `no` a truth value.
pub(crate) fn quoted(text: &str) -> String {
    let mut quoted = String::from('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            // Line breaks of YAML, and characters that YAML does not count as printable.
            '\u{2028}' | '\u{2029}' | '\u{feff}' | '\u{fffe}' | '\u{ffff}' => quoted += &escaped(c),
            c if c.is_control() => quoted += &escaped(c),
            c => quoted.push(c),
        }
    }
    quoted + "\""
}

/// Escape of a character by its code point.
fn escaped(c: char) -> String {
    format!("\\U{:08X}", u32::from(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reals_have_a_point_and_exponents_a_sign() {
        for (value, text) in [
            (0.0, "0.0"),
            (-1.0, "-1.0"),
            (0.1, "0.1"),
            (1e16, "1.0e+16"),
            (-1.5e16, "-1.5e+16"),
            (1e-7, "1.0e-7"),
            (2.5e-7, "2.5e-7"),
        ] {
            assert_eq!(real(value), text);
            assert_eq!(text.parse(), Ok(value));
        }
    }

    #[test]
    fn texts_are_quoted() {
        for (text, expected) in [
            ("rover", r#""rover""#),
            ("-", r#""-""#),
            ("a: b # c", r#""a: b # c""#),
            (r#"a"b\c"#, r#""a\"b\\c""#),
            ("a\nb\u{85}\u{2028}", r#""a\U0000000Ab\U00000085\U00002028""#),
            ("Krümel", r#""Krümel""#),
        ] {
            assert_eq!(quoted(text), expected);
        }
    }
}
