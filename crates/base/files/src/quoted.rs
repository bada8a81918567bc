//! Words for a shell.

/// Text that a shell reads as this one word, with quotes only if they are needed.
///
/// ```
/// use raypencil_files::quoted;
///
/// assert_eq!(quoted("data/scenes/default.toml"), "data/scenes/default.toml");
/// assert_eq!(quoted("a b"), "'a b'");
/// // A quote ends the quoted text, is escaped, and the text goes on.
/// assert_eq!(quoted("it's"), r"'it'\''s'");
/// ```
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "._-/+@%:,=".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_string()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_with_other_signs_are_quoted() {
        for plain in ["data/scenes/a-b_c.toml", "x=1,y@z:2+3%", "3"] {
            assert_eq!(quoted(plain), plain);
        }
        // Of all signs of ASCII but letters and digits these alone mean nothing to a shell.
        for sign in (33..127_u8).map(char::from).filter(|sign| !sign.is_alphanumeric()) {
            let word = format!("a{sign}b");
            assert_eq!(quoted(&word) == word, "._-/+@%:,=".contains(sign), "{word}");
        }
        for (word, expected) in [("", "''"), ("a b", "'a b'"), ("$(x)", "'$(x)'"), ("it's", r"'it'\''s'")] {
            assert_eq!(quoted(word), expected);
        }
    }
}
