//! Texts from untrusted files, made fit for a terminal, a source listing and Markdown.

use std::borrow::Cow;

/// Whether a letter moves a cursor, changes colours or the writing direction, or ends a line where people do not see it.
fn is_harmful(letter: char) -> bool {
    let changes_direction = matches!(
        letter,
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}'
    );
    let ends_line = matches!(letter, '\u{2028}' | '\u{2029}');
    letter.is_control() && !"\n\t".contains(letter) || changes_direction || ends_line
}

/// A text without codes of terminals, colours among them, and without changes of the writing direction; each becomes U+FFFD.
///
/// ```
/// use raypencil_files::harmless;
///
/// // A code that conceals what follows it.
/// assert_eq!(harmless("rock\u{1b}[8m.glb"), "rock\u{fffd}[8m.glb");
/// assert_eq!(harmless("two\n\tlines"), "two\n\tlines");
/// ```
pub fn harmless(text: &str) -> Cow<'_, str> {
    match text.contains(is_harmful) {
        true => text.replace(is_harmful, "\u{fffd}").into(),
        false => text.into(),
    }
}

/// The same in one line: a name with a line break must not look like lines of the program's own.
pub fn harmless_line(text: &str) -> String {
    text.replace(|letter| is_harmful(letter) || "\n\t".contains(letter), "\u{fffd}")
}

/// The same for a source with marks under its letters: each byte is replaced by a `?`, so that the marks stay in place.
pub fn harmless_source(text: &str) -> String {
    let one_for_one = |letter: char| match is_harmful(letter) && letter != '\r' {
        true => "?".repeat(letter.len_utf8()),
        false => letter.to_string(),
    };
    text.chars().map(one_for_one).collect()
}

/// A text that Markdown shows as it is, in one line: each letter that Markdown reads has a backslash before it.
///
/// ```
/// use raypencil_files::markdown_text;
///
/// assert_eq!(markdown_text("my_tracer"), r"my\_tracer");
/// assert_eq!(markdown_text("a\n# b <i>"), "a\u{fffd}\\# b \\<i\\>");
/// ```
pub fn markdown_text(text: &str) -> String {
    let mut shown = String::new();
    for letter in harmless_line(text).chars() {
        if "\\`*_{}[]()<>#|&~!$@:".contains(letter) {
            shown.push('\\');
        }
        shown.push(letter);
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_replaced() {
        assert_eq!(harmless("caf\u{e9}\n\t\u{3c6}"), "caf\u{e9}\n\t\u{3c6}");
        let codes =
            ["\u{1b}[2J", "\u{1b}[8m", "\u{7}", "\r", "\u{9b}2J", "\u{202e}", "\u{61c}", "\u{2028}", "\0"];
        for code in codes {
            let first = code.chars().next().expect("a letter");
            assert!(!harmless(code).contains(first), "{code:?}");
            assert!(!harmless_line(code).contains(first), "{code:?}");
        }
        assert_eq!(harmless_line("a\nb\tc"), "a\u{fffd}b\u{fffd}c");
    }

    #[test]
    fn each_letter_that_turns_the_writing_or_ends_a_line_is_replaced() {
        // Of the Unicode standard: marks, embeddings and overrides, isolates; the separators of lines and of paragraphs.
        let turning = ["\u{61c}\u{200e}\u{200f}", "\u{202a}\u{202b}\u{202c}\u{202d}\u{202e}"];
        let all = turning.concat() + "\u{2066}\u{2067}\u{2068}\u{2069}\u{2028}\u{2029}";
        for letter in all.chars() {
            assert_eq!(harmless(&format!("a{letter}b")), "a\u{fffd}b", "{letter:?}");
        }
        // Their neighbours are letters like others.
        let others = "\u{61b}\u{61d}\u{200d}\u{2010}\u{2027}\u{202f}\u{2065}\u{206a}";
        assert_eq!(harmless(others), others);
    }

    #[test]
    fn each_letter_that_markdown_reads_has_a_backslash() {
        for letter in "\\`*_{}[]()<>#|&~!$@:".chars() {
            assert_eq!(markdown_text(&format!("a{letter}b")), format!("a\\{letter}b"));
        }
        assert_eq!(markdown_text("a-b.c, 1+2=3 'x' \"y\""), "a-b.c, 1+2=3 'x' \"y\"");
    }

    #[test]
    fn a_source_keeps_its_length() {
        let text = "a = \"\u{1b}[8m\u{202e}\u{9b}\"\r\n\t\u{e9}";
        let shown = harmless_source(text);
        assert_eq!(shown, "a = \"?[8m?????\"\r\n\t\u{e9}");
        assert_eq!(shown.len(), text.len());
    }
}
