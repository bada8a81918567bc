//! Errors of files: the file, the place in it, what was found and what was expected.

use miette::Diagnostic;
use std::borrow::Cow;
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
    within(&text, MAX_MESSAGE_CHARS).into_owned()
}

/// A text of at most so many characters; of a longer one the start and the end.
fn within(text: &str, most: usize) -> Cow<'_, str> {
    let count = text.chars().count();
    if count <= most {
        return text.into();
    }
    let start: String = text.chars().take(most / 2).collect();
    let end: String = text.chars().skip(count - most / 2).collect();
    format!("{start} ... {end}").into()
}

/// Maximum length of a whole message, characters: about one screen of text.
const MAX_WHOLE_CHARS: usize = 3000;

/// A message as people can read it, whatever it repeats of an input: of a word of more than 400 characters, such as a number of
/// 70,000 digits, the start and the end, and so of a message of more than 3000.
///
/// ```
/// use raypencil_files::readable;
///
/// assert_eq!(readable("seed=12: expected less"), "seed=12: expected less");
/// let long = readable(&format!("seed={}: expected less", "1".repeat(70_000))).into_owned();
/// assert!(long.starts_with("seed=111") && long.ends_with("11: expected less") && long.len() < 500);
/// ```
pub fn readable(text: &str) -> Cow<'_, str> {
    let is_long = |word: &str| word.len() > MAX_MESSAGE_CHARS && word.chars().count() > MAX_MESSAGE_CHARS;
    if !text.split_whitespace().any(is_long) {
        return within(text, MAX_WHOLE_CHARS);
    }
    let words: String = text
        .split_inclusive(char::is_whitespace)
        .map(|part| {
            let word = part.trim_end();
            within(word, MAX_MESSAGE_CHARS).into_owned() + &part[word.len()..]
        })
        .collect();
    within(&words, MAX_WHOLE_CHARS).into_owned().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_words_and_long_messages_keep_their_ends() {
        let word = "x".repeat(400);
        let text = format!("a\n{word}\t{word}\n  b");
        assert_eq!(readable(&text), text);
        let text = format!("a\n{word}y\t\u{e9}{word}\n  b");
        let half = "x".repeat(200);
        let cut = format!("a\n{half} ... {}y\t\u{e9}{} ... {half}\n  b", &half[1..], &half[1..]);
        assert_eq!(readable(&text), cut);
        let many = "0, ".repeat(70_000) + "end";
        let shown = readable(&many);
        assert!(shown.chars().count() == 3005 && shown.ends_with("0, end"), "{}", shown.len());
        let whole = "0, ".repeat(1000);
        assert_eq!(readable(&whole), whole);
    }
}
