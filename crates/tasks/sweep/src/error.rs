//! Errors of a sweep.

use raypencil_files::{FileError, FolderError};
use raypencil_harness::HarnessError;
use raypencil_scene_io::SceneIoError;

/// Why a sweep could not begin or continue.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// A folder; the message names it.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A file; the message names it.
    #[error(transparent)]
    File(#[from] FileError),
    /// A scene or a setting that is refused.
    #[error(transparent)]
    Scene(#[from] Box<SceneIoError>),
    /// A parameter with values that are none.
    #[error("{text}: {message}")]
    Axis {
        /// The parameter as it was given.
        text: String,
        /// What was found and expected.
        message: String,
    },
    /// A value that its key does not take.
    #[error("run {run} of the sweep, {given}: {source}; nothing was written")]
    Value {
        /// Number of the run.
        run: u64,
        /// The keys and values that are new in it.
        given: String,
        /// What the scene says of them.
        source: Box<SceneIoError>,
    },
    /// A list of runs that is none.
    #[error("{file}: {message}")]
    List {
        /// Path of the file.
        file: String,
        /// What was found and expected.
        message: String,
    },
    /// Parameters that make no sweep together, or a task that does not fit them.
    #[error("{found}; expected {expected}")]
    Plan {
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// Maps that could not be written.
    #[error(transparent)]
    Maps(#[from] HarnessError),
    /// A record that belongs to another sweep.
    #[error("{file}: {found}; expected {expected}")]
    Record {
        /// Path of the file.
        file: String,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
}

impl SweepError {
    pub(crate) fn axis(text: &str, message: impl Into<String>) -> Self {
        Self::Axis { text: text.into(), message: message.into() }
    }
}

impl From<SceneIoError> for SweepError {
    fn from(error: SceneIoError) -> Self {
        Self::Scene(Box::new(error))
    }
}
