//! The error of this crate.

use miette::Diagnostic;
use std::io;
use std::path::Path;
use thiserror::Error;

use raypencil_files::FileError;
use raypencil_scene::SceneError;

use crate::toml_problem::TomlProblem;

/// Error of a scene that cannot be loaded.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum SceneIoError {
    /// File that the scene needs; the message names it.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),

    /// Error at a line of a scene file.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Toml(Box<TomlProblem>),

    /// Source that is neither a built-in name nor a file of a known kind.
    #[error("`{given}` {problem}; expected {expected}")]
    #[diagnostic(code(raypencil::source))]
    Source {
        /// The source as it was given.
        given: String,
        /// Reason for refusing it.
        problem: String,
        /// Accepted names and extensions.
        expected: String,
    },

    /// Override of the command line that is out of range.
    #[error("override {name} is {value}; expected {expected}")]
    #[diagnostic(code(raypencil::overrides))]
    Override {
        /// Name of the override.
        name: &'static str,
        /// Its value.
        value: String,
        /// Accepted values.
        expected: String,
    },

    /// Key of a scene file given outside of it, with a value that does not fit.
    #[error("set {setting}: {message}")]
    #[diagnostic(code(raypencil::setting))]
    Setting {
        /// The setting as it was given: `KEY=VALUE`.
        setting: String,
        /// Value found and values expected.
        message: String,
    },

    /// Position of the vehicle where there is no ground.
    #[error("{origin}: no ground under the vehicle at ({x}, {y}) m; expected a place within {ground}")]
    #[diagnostic(code(raypencil::ground), help("give the vehicle a position on the ground, or a height"))]
    NoGround {
        /// File or name of the scene.
        origin: String,
        /// Position of the vehicle, global x, metres.
        x: f64,
        /// Position of the vehicle, global y, metres.
        y: f64,
        /// Extent of the ground, in words.
        ground: String,
    },
}

impl SceneIoError {
    /// File system error on `path` while trying to `action`.
    pub(crate) fn io(path: &Path, action: &'static str, source: io::Error) -> Self {
        FileError::io(path, action, source).into()
    }

    /// Numbers of `origin` that are in range one by one, but make no scene together.
    pub(crate) fn scene(origin: String, source: SceneError) -> Self {
        FileError::Scene { origin, source }.into()
    }
}
