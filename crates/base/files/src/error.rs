//! Errors of files: the file, the place in it, what was found and what was expected.

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
    /// Wrong contents of a glTF or GLB file.
    #[error("{0}")]
    #[diagnostic(code(raypencil::gltf))]
    Gltf(Box<Problem>),

    /// Wrong contents of an STL, OBJ or PLY file, or a file that is no mesh.
    #[error("{0}")]
    #[diagnostic(code(raypencil::mesh))]
    Mesh(Box<Problem>),

    /// Wrong contents of a point cloud, PCD or PLY.
    #[error("{0}")]
    #[diagnostic(code(raypencil::cloud))]
    Cloud(Box<Problem>),

    /// Wrong contents of an elevation model.
    #[error("{0}")]
    #[diagnostic(code(raypencil::dem))]
    Dem(Box<Problem>),

    /// Wrong contents of an OpenEXR file.
    #[error("{0}")]
    #[diagnostic(code(raypencil::exr))]
    Exr(Box<Problem>),

    /// Wrong contents of an NPY or PFM file.
    #[error("{0}")]
    #[diagnostic(code(raypencil::array))]
    Array(Box<Problem>),

    /// A recording without maps, or with files that contradict each other.
    #[error("{0}")]
    #[diagnostic(code(raypencil::recording))]
    Recording(Box<Problem>),

    /// A folder that is no pack, or a pack whose files have changed.
    #[error("{0}")]
    #[diagnostic(code(raypencil::pack))]
    Pack(Box<Problem>),

    /// An error of the file system.
    #[error("{}: cannot {action}: {source}", path.display())]
    #[diagnostic(code(raypencil::io))]
    Io {
        /// The file.
        path: PathBuf,
        /// The action that failed: "read", "write".
        action: &'static str,
        /// The system's error.
        source: io::Error,
    },

    /// Numbers that are valid one by one but make no scene.
    #[error("{origin}: {source}")]
    #[diagnostic(code(raypencil::scene))]
    Scene {
        /// The scene's file or name.
        origin: String,
        /// The field of the scene, and what is wrong with it.
        source: SceneError,
    },
}

impl FileError {
    /// The file system's error `source` when it was asked to `action` ("read", "write") `path`.
    pub fn io(path: &Path, action: &'static str, source: io::Error) -> Self {
        Self::Io { path: path.to_path_buf(), action, source }
    }

    pub(crate) fn recording(path: &Path, fault: Fault) -> Self {
        Self::Recording(fault.in_file(path))
    }
}

/// A fault and the file that it is in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// The file.
    pub file: String,
    /// Place in the file: `accessor 3`, `node 2 "rock"`, `channel "range.T"`.
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

/// A place in a file and what is wrong there; with its file it is a [`Problem`].
///
/// ```
/// use raypencil_files::{Fault, FileError};
///
/// let fault = Fault::new("accessor 3", "a stride of 2 bytes", "12 to 252");
/// let error = FileError::Gltf(fault.in_file("rocks.glb".as_ref()));
/// assert_eq!(error.to_string(), "rocks.glb: accessor 3: a stride of 2 bytes; expected 12 to 252");
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    place: String,
    found: String,
    expected: String,
}

impl Fault {
    /// A fault at `place`, where this was `found` and that was `expected`.
    pub fn new(place: impl Into<String>, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { place: place.into(), found: found.into(), expected: expected.into() }
    }

    /// The same fault inside a part of its file.
    pub fn inside(self, part: &str) -> Self {
        Self { place: format!("{part}, {}", self.place), ..self }
    }

    /// Adds the file. Texts are shortened: a name that comes from the file may have a million characters.
    pub fn in_file(self, file: &Path) -> Box<Problem> {
        let [place, found, expected] = [self.place, self.found, self.expected].map(shortened);
        Box::new(Problem { file: file.display().to_string(), place, found, expected })
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}; expected {}", self.place, self.found, self.expected)
    }
}

/// Maximum length of each part of a message, characters.
const MAX_MESSAGE_CHARS: usize = 400;

/// A text of at most 400 characters as it is; the start and the end of a longer one.
pub fn shortened(text: String) -> String {
    let count = text.chars().count();
    if count <= MAX_MESSAGE_CHARS {
        return text;
    }
    let start: String = text.chars().take(MAX_MESSAGE_CHARS / 2).collect();
    let end: String = text.chars().skip(count - MAX_MESSAGE_CHARS / 2).collect();
    format!("{start} ... {end}")
}
