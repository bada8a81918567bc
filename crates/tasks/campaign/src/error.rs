//! Errors of a campaign.

use raypencil_files::{FileError, FolderError};
use raypencil_pack::PackError;
use raypencil_scene_io::SceneIoError;

/// Why a campaign could not continue.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CampaignError {
    /// A scene of each terrain that the campaign cannot have.
    #[error("--parts {part}: {why}")]
    Part {
        /// Its name.
        part: &'static str,
        /// Why there is none.
        why: &'static str,
    },
    /// A folder; the message names it.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A file; the message names it.
    #[error(transparent)]
    File(#[from] FileError),
    /// A file that is damaged, or belongs to another campaign.
    #[error("{file}: {found}; expected {expected}")]
    Record {
        /// Path of the file.
        file: String,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// A scene that cannot be loaded; the message names it.
    #[error(transparent)]
    Scene(#[from] Box<SceneIoError>),
    /// A candidate's command that cannot be run.
    #[error("{command}: {found}; expected {expected}")]
    Candidate {
        /// The command.
        command: String,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// A pack for a candidate, or of a ray that it answers wrongly.
    #[error(transparent)]
    Pack(#[from] Box<PackError>),
    /// Shards that do not make a whole campaign.
    #[error("{found}; expected {expected}")]
    Shards {
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
}
