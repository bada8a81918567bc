//! Lines, words and numbers of a text, with line numbers for messages. A text is bytes: names and comments may be in
//! any encoding.

use raypencil_files::Fault;

/// Lines of a text, numbered from 1. A line ends with "\n", "\r\n" or "\r".
pub(super) struct Lines<'a> {
    rest: &'a [u8],
    number: usize,
    joined: bool,
}

impl<'a> Lines<'a> {
    /// Lines of a text whose first line has the number `first`.
    pub(super) fn new(text: &'a [u8], first: usize) -> Self {
        Self { rest: text, number: first, joined: false }
    }

    /// The same; a backslash at the end of a line joins the next line to it. A comment, from `#`, is never joined: it
    /// may end with the path of a folder.
    pub(super) fn joined_by_backslash(text: &'a [u8]) -> Self {
        Self { joined: true, ..Self::new(text, 1) }
    }

    /// The bytes after the last line.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.rest
    }
}

impl<'a> Iterator for Lines<'a> {
    /// Number and bytes of a line, without its end.
    type Item = (usize, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let (first, mut start) = (self.number, 0);
        // Each part is looked at once, however many lines are joined.
        let mut has_comment = false;
        loop {
            let rest = &self.rest[start..];
            let length = rest.iter().position(|byte| b"\n\r".contains(byte)).unwrap_or(rest.len());
            let end = if rest[length..].starts_with(b"\r\n") { length + 2 } else { length + 1 };
            let line = &self.rest[..start + length];
            start = (start + end).min(self.rest.len());
            self.number += 1;
            has_comment = has_comment || (self.joined && rest[..length].contains(&b'#'));
            let goes_on = self.joined && line.ends_with(b"\\") && !has_comment;
            if !goes_on || start == self.rest.len() {
                self.rest = &self.rest[start..];
                return Some((first, line));
            }
        }
    }
}

/// A text without the mark of UTF-8 that editors on Windows put before it (U+FEFF).
pub(super) fn without_mark(text: &[u8]) -> &[u8] {
    text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text)
}

pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// The double nearest to a decimal number, if it is one; infinities and NaN have to be refused by the caller.
pub(super) fn number(word: Option<&[u8]>, place: impl FnOnce() -> String) -> Result<f64, Fault> {
    let text = word.and_then(|word| std::str::from_utf8(word).ok());
    let number = text.and_then(|text| text.parse().ok());
    number.ok_or_else(|| Fault::new(place(), quoted(word), "a decimal number"))
}

pub(super) fn whole(word: Option<&[u8]>, place: impl FnOnce() -> String) -> Result<i64, Fault> {
    let text = word.and_then(|word| std::str::from_utf8(word).ok());
    let number = text.and_then(|text| text.parse().ok());
    number.ok_or_else(|| Fault::new(place(), quoted(word), "a whole number"))
}

/// A word for messages. It may be as long as the file.
pub(super) fn quoted(word: Option<&[u8]>) -> String {
    match word {
        Some(word) => format!("\"{}\"", word[..word.len().min(80)].escape_ascii()),
        None => "nothing".to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_all_systems_have_the_same_numbers() {
        for text in ["a b\n\nc", "a b\r\n\r\nc", "a b\r\rc", "a b\n\rc\r"] {
            let lines: Vec<_> = Lines::new(text.as_bytes(), 1).filter(|(_, line)| !line.is_empty()).collect();
            assert_eq!(lines, [(1, &b"a b"[..]), (3, b"c")], "{text:?}");
        }
    }

    #[test]
    fn a_backslash_joins_lines_but_no_comment() {
        let lines: Vec<_> = Lines::joined_by_backslash(b"f 1 \\\r\n2\nf # C:\\\nv\\").collect();
        assert_eq!(lines, [(1, &b"f 1 \\\r\n2"[..]), (3, b"f # C:\\"), (4, b"v\\")]);
    }
}
