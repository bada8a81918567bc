//! A place in a scene TOML and what is wrong there, with the line to look at.

use miette::{Diagnostic, NamedSource, SourceSpan};
use std::borrow::Cow;
use std::ops::Range;
use std::path::Path;
use thiserror::Error;

use raypencil_files::shortened;

/// The longest line that is shown, and the longest part of a file that is marked, bytes.
const LONGEST: usize = 200;

/// A line and column of a scene TOML and what is wrong there.
#[derive(Debug, Error, Diagnostic)]
#[error("{file}:{line}:{column}: {message}")]
#[diagnostic(code(raypencil::toml))]
pub struct TomlProblem {
    /// The file.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What was found there and what was expected.
    pub message: String,
    #[source_code]
    text: NamedSource<String>,
    /// `None` if the place is too far to the right to be shown.
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
        // Long lines are cut, so the place moves up by what is gone before it.
        let shown: String = text.split_inclusive('\n').map(cut).collect();
        let lines_before =
            before[..line_start].split_inclusive('\n').map(|line| cut(line).len()).sum::<usize>();
        let shown_start = lines_before + start - line_start;
        let length = span.end.saturating_sub(start).min(LONGEST);
        let shown_end = floor(&shown, (shown_start + length).min(shown.len()));
        // A place too far to the right is not shown at all.
        let span = (start - line_start < LONGEST)
            .then(|| SourceSpan::new(shown_start.into(), shown_end.saturating_sub(shown_start)));
        let text = NamedSource::new(&file, shown);
        Self { file, line, column, message: shortened(message.into()), text, span }
    }

    /// The bytes of the file that the caret marks.
    pub fn marked(&self) -> &str {
        let Some(span) = &self.span else { return "" };
        self.text.inner().get(span.offset()..span.offset() + span.len()).unwrap_or("")
    }
}

/// A line, its end cut off if it is too long to be looked at.
fn cut(line: &str) -> Cow<'_, str> {
    if line.len() <= LONGEST + 2 {
        return line.into();
    }
    let end = if line.ends_with('\n') { "\n" } else { "" };
    format!("{}...{end}", &line[..floor(line, LONGEST)]).into()
}

/// The last place at or before `at` where a letter starts.
fn floor(text: &str, at: usize) -> usize {
    (0..=at).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0)
}
