//! The error of this crate: which file, which place in it, what was found, what was expected.

use std::fmt;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

use miette::{Diagnostic, NamedSource, SourceSpan};
use raypencil_scene::SceneError;
use thiserror::Error;

/// Why a file could not be read or written.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum SceneIoError {
    /// A place in a scene TOML.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Toml(Box<TomlProblem>),

    /// A place in a glTF or GLB file.
    #[error("{0}")]
    #[diagnostic(code(raypencil::gltf))]
    Gltf(Box<Problem>),

    /// A place in an elevation model.
    #[error("{0}")]
    #[diagnostic(code(raypencil::dem))]
    Dem(Box<Problem>),

    /// A place in an OpenEXR file.
    #[error("{0}")]
    #[diagnostic(code(raypencil::exr))]
    Exr(Box<Problem>),

    /// A place in an NPY or PFM file.
    #[error("{0}")]
    #[diagnostic(code(raypencil::array))]
    Array(Box<Problem>),

    /// A recording whose files do not go together, or that has none.
    #[error("{0}")]
    #[diagnostic(code(raypencil::recording))]
    Recording(Box<Problem>),

    /// A pack that is none, or is not as it was written.
    #[error("{0}")]
    #[diagnostic(code(raypencil::pack))]
    Pack(Box<Problem>),

    /// The file system refused.
    #[error("{}: cannot {action}: {source}", path.display())]
    #[diagnostic(code(raypencil::io))]
    Io {
        /// The file.
        path: PathBuf,
        /// What was tried: "read", "write".
        action: &'static str,
        /// What the system said.
        source: io::Error,
    },

    /// A scene source that is neither a built-in name nor a file of a known kind.
    #[error("`{given}` {problem}; expected {expected}")]
    #[diagnostic(code(raypencil::source))]
    Source {
        /// What was given.
        given: String,
        /// What is wrong with it.
        problem: String,
        /// The built-in names and the extensions that are accepted.
        expected: String,
    },

    /// An override of the command line that is out of range.
    #[error("override {name} is {value}; expected {expected}")]
    #[diagnostic(code(raypencil::overrides))]
    Override {
        /// Which one.
        name: &'static str,
        /// What it holds.
        value: String,
        /// What would have been accepted.
        expected: String,
    },

    /// The vehicle was to stand on the ground where there is none.
    #[error("{origin}: no ground under the vehicle at ({x}, {y}) m; expected a place within {ground}")]
    #[diagnostic(code(raypencil::ground), help("give the vehicle a position on the ground, or a height"))]
    NoGround {
        /// The scene's file or name.
        origin: String,
        /// Where the vehicle was to stand, global frame, metres.
        x: f64,
        /// Where the vehicle was to stand, global frame, metres.
        y: f64,
        /// The extent of the ground, in words.
        ground: String,
    },

    /// The numbers of a file are fine one by one, but make no scene.
    #[error("{origin}: {source}")]
    #[diagnostic(code(raypencil::scene))]
    Scene {
        /// The scene's file or name.
        origin: String,
        /// The field and what is wrong with it.
        source: SceneError,
    },
}

impl SceneIoError {
    /// A file system error on `path` while trying to `action`.
    pub(crate) fn io(path: &Path, action: &'static str, source: io::Error) -> Self {
        Self::Io { path: path.to_path_buf(), action, source }
    }
}

/// A place in a binary file and what is wrong there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// The file.
    pub file: String,
    /// Where in the file: `accessor 3`, `node 2 "rock"`, `channel "range.T"`.
    pub place: String,
    /// What was found there.
    pub found: String,
    /// What was expected.
    pub expected: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}: {}; expected {}", self.file, self.place, self.found, self.expected)
    }
}

/// A [`Problem`] whose file is not known yet: what the inner readers return.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Fault {
    place: String,
    found: String,
    expected: String,
}

impl Fault {
    /// Names the `place`, what was `found` there and what was `expected`.
    pub(crate) fn new(
        place: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Self { place: place.into(), found: found.into(), expected: expected.into() }
    }

    /// Adds the file.
    pub(crate) fn in_file(self, file: &Path) -> Box<Problem> {
        let Self { place, found, expected } = self;
        Box::new(Problem { file: file.display().to_string(), place, found, expected })
    }
}

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
    #[label("here")]
    span: SourceSpan,
}

impl TomlProblem {
    /// Marks the bytes `span` of `text`, the contents of `file`.
    pub(crate) fn new(file: &Path, text: &str, span: Range<usize>, message: impl Into<String>) -> Self {
        let file = file.display().to_string();
        // A span past the end (a missing key of an empty file) marks the end.
        let start = span.start.min(text.len());
        let before = &text.as_bytes()[..start];
        let line_start = before.iter().rposition(|&byte| byte == b'\n').map_or(0, |newline| newline + 1);
        let line = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
        let column = 1 + String::from_utf8_lossy(&before[line_start..]).chars().count();
        let length = span.end.min(text.len()).saturating_sub(start);
        Self {
            text: NamedSource::new(&file, text.to_string()),
            file,
            line,
            column,
            message: message.into(),
            span: SourceSpan::new(start.into(), length),
        }
    }

    /// The bytes of the file that the caret marks.
    pub fn marked(&self) -> &str {
        let start = self.span.offset();
        self.text.inner().get(start..start + self.span.len()).unwrap_or("")
    }
}
