//! Errors of a campaign.

use raypencil_files::{FileError, FolderError};

/// Why a campaign could not continue.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CampaignError {
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
    /// Shards that do not make a whole campaign.
    #[error("{found}; expected {expected}")]
    Shards {
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
}
