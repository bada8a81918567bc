//! The error of a scene that cannot be loaded: its file, or what the file says.

use miette::Diagnostic;
use std::io;
use std::path::Path;
use thiserror::Error;

use crate::toml_problem::TomlProblem;
use raypencil_files::FileError;
use raypencil_scene::SceneError;

/// Why a scene could not be loaded or written.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum SceneIoError {
    /// A file that the scene needs; the message names it.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),

    /// A place in a scene TOML.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Toml(Box<TomlProblem>),

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
}

impl SceneIoError {
    /// A file system error on `path` while trying to `action`.
    pub(crate) fn io(path: &Path, action: &'static str, source: io::Error) -> Self {
        FileError::io(path, action, source).into()
    }

    /// Numbers of `origin` that are fine one by one, but make no scene.
    pub(crate) fn scene(origin: String, source: SceneError) -> Self {
        FileError::Scene { origin, source }.into()
    }
}
