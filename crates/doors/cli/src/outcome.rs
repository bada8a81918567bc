//! Results and errors of the commands, and where renderers come from.

use miette::Diagnostic;
use raypencil::campaign::CampaignError;
use raypencil::diff::DiffError;
use raypencil::drive::DriveError;
use raypencil::harness::{CandidateError, Contender, HarnessError, NoSuchRay};
use raypencil::io::{FileError, FolderError, SceneIoError};
use raypencil::pack::{CheckError, PackError};
use raypencil::sweep::SweepError;
use thiserror::Error;

/// Finds a renderer by its name; `None` if there is no such renderer.
pub type Registry = dyn Fn(&str) -> Option<Contender> + Sync;

/// The result of a command that finished.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// All agree, or nothing was compared. Exit code 0.
    Fine,
    /// A defect or a difference. Exit code 1.
    Differs,
}

/// An error of a command. Exit code 2.
#[derive(Debug, Error, Diagnostic)]
pub(crate) enum Trouble {
    /// A scene, or a file that it needs, cannot be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneIoError),

    /// Another file cannot be read or written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),

    /// The output folder cannot be written.
    #[error(transparent)]
    Folder(#[from] FolderError),

    /// The folder of a validation cannot be written.
    #[error(transparent)]
    Validation(#[from] HarnessError),

    /// The scene does not have the ray.
    #[error(transparent)]
    Ray(#[from] NoSuchRay),

    /// A pack cannot be written.
    #[error(transparent)]
    Pack(#[from] PackError),

    /// A pack or a candidate cannot be checked.
    #[error("{error}")]
    Check {
        error: Box<CheckError>,
        /// What to declare, if that may help.
        #[help]
        help: Option<String>,
    },

    /// A candidate cannot be read.
    #[error("{error}")]
    Candidate {
        error: Box<CandidateError>,
        /// What to declare, if that may help.
        #[help]
        help: Option<String>,
    },

    /// Two recordings cannot be compared.
    #[error(transparent)]
    Diff(#[from] DiffError),

    /// A campaign cannot run.
    #[error(transparent)]
    Campaign(#[from] CampaignError),

    /// A sweep cannot run.
    #[error(transparent)]
    Sweep(#[from] SweepError),

    /// A drive cannot run.
    #[error("{scene}: {error}")]
    Drive {
        /// The scene as it was given.
        scene: String,
        error: DriveError,
    },

    /// Arguments that clap accepts and that make no sense together.
    #[error("{0}")]
    Usage(String),
}

impl From<CheckError> for Trouble {
    fn from(error: CheckError) -> Self {
        let help = error.help();
        Self::Check { error: Box::new(error), help }
    }
}

impl From<CandidateError> for Trouble {
    fn from(error: CandidateError) -> Self {
        let help = error.help();
        Self::Candidate { error: Box::new(error), help }
    }
}
