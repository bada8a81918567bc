//! The error of files: which file, which place in it, what was found, what was expected.

use miette::Diagnostic;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

use raypencil_scene::SceneError;

/// Why a file could not be read or written.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum FileError {
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

impl FileError {
    /// A file system error on `path` while trying to `action`.
    pub fn io(path: &Path, action: &'static str, source: io::Error) -> Self {
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
pub struct Fault {
    place: String,
    found: String,
    expected: String,
}

impl Fault {
    /// Names the `place`, what was `found` there and what was `expected`.
    pub fn new(place: impl Into<String>, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { place: place.into(), found: found.into(), expected: expected.into() }
    }

    /// Adds the file. What the file itself says is shortened: it may be a name of a million letters.
    pub fn in_file(self, file: &Path) -> Box<Problem> {
        let [place, found, expected] = [self.place, self.found, self.expected].map(shortened);
        Box::new(Problem { file: file.display().to_string(), place, found, expected })
    }
}

/// The longest part of a message, letters.
const LONGEST: usize = 400;

/// The start and the end of a text that is too long to read.
pub fn shortened(text: String) -> String {
    let letters = text.chars().count();
    if letters <= LONGEST {
        return text;
    }
    let start: String = text.chars().take(LONGEST / 2).collect();
    let end: String = text.chars().skip(letters - LONGEST / 2).collect();
    format!("{start} ... {end}")
}
