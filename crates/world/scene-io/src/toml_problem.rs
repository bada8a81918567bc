//! An error at a line and column of a scene file, with that line for the reader.

use miette::{Diagnostic, NamedSource, SourceSpan};
use std::borrow::Cow;
use std::ops::Range;
use std::path::Path;
use thiserror::Error;

use raypencil_files::{harmless_line, harmless_source, shortened};

/// Maximum length of a line that is shown, and of the part of it that is marked, bytes.
const MAX_SHOWN_BYTES: usize = 200;

/// Error at a line and column of a scene file.
#[derive(Debug, Error, Diagnostic)]
#[error("{file}:{line}:{column}: {message}")]
#[diagnostic(code(raypencil::toml))]
pub struct TomlProblem {
    /// Path of the file.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Key, value found and values expected.
    pub message: String,
    #[source_code]
    text: NamedSource<String>,
    /// Bytes of the shown text; `None` if the place is too far to the right to be shown.
    #[label("here")]
    span: Option<SourceSpan>,
}

impl TomlProblem {
    /// Marks the bytes `span` of `text`, the contents of `file`.
    pub(crate) fn new(file: &Path, text: &str, span: Range<usize>, message: impl Into<String>) -> Self {
        let file = file.display().to_string();
        // A span past the end (a missing key of an empty file) marks the end.
        let start = floor(text, span.start.min(text.len()));
        let before = &text[..start];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = 1 + before.bytes().filter(|&byte| byte == b'\n').count();
        let column = 1 + before[line_start..].chars().count();
        // Long lines are cut: the place moves up by the bytes that are cut off before it.
        let shown: String = text.split_inclusive('\n').map(cut).collect();
        let lines_before =
            before[..line_start].split_inclusive('\n').map(|line| cut(line).len()).sum::<usize>();
        let shown_start = lines_before + start - line_start;
        let length = span.end.saturating_sub(start).min(MAX_SHOWN_BYTES);
        let shown_end = floor(&shown, (shown_start + length).min(shown.len()));
        // A place too far to the right is not shown at all.
        let span = (start - line_start < MAX_SHOWN_BYTES)
            .then(|| SourceSpan::new(shown_start.into(), shown_end.saturating_sub(shown_start)));
        // Shown on a terminal as it is. The marks count its bytes.
        let text = NamedSource::new(harmless_line(&file), harmless_source(&shown));
        Self { file, line, column, message: shortened(message.into()), text, span }
    }

    /// Part of the file that the caret marks.
    pub fn marked(&self) -> &str {
        let Some(span) = &self.span else { return "" };
        self.text.inner().get(span.offset()..span.offset() + span.len()).unwrap_or("")
    }
}

/// Line, with its end cut off if it is too long.
fn cut(line: &str) -> Cow<'_, str> {
    if line.len() <= MAX_SHOWN_BYTES + 2 {
        return line.into();
    }
    let end = if line.ends_with('\n') { "\n" } else { "" };
    format!("{}...{end}", &line[..floor(line, MAX_SHOWN_BYTES)]).into()
}

/// Last start of a character at or before `at`.
fn floor(text: &str, at: usize) -> usize {
    (0..=at).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_200_bytes_and_their_end_are_whole() {
        let whole = "x".repeat(200);
        for end in ["", "\n", "\r\n"] {
            assert_eq!(cut(&format!("{whole}{end}")), format!("{whole}{end}"));
        }
        assert_eq!(cut(&format!("{whole}xyz")), format!("{whole}..."));
        assert_eq!(cut(&format!("{whole}xy\n")), format!("{whole}...\n"));
    }
}
