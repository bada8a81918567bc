//! Why a recording cannot be judged.

use std::path::PathBuf;

use raypencil_files::FileError;

/// Why a recording cannot be judged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// A file that cannot be read; the message names it.
    #[error(transparent)]
    File(#[from] FileError),
    /// A cell that breaks the conventions, or a channel that does not fit the scene.
    #[error("{}: `{channel}`{}: {found}; expected {expected}", file.display(), at(cell))]
    Channel {
        /// The file.
        file: PathBuf,
        /// The channel.
        channel: String,
        /// Column and row of the cell, if one cell is at fault.
        cell: Option<(u32, u32)>,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
        /// What to declare or change, if a common convention explains the cell.
        help: Option<Box<Help>>,
    },
    /// A vector of which only some components are there.
    #[error("{}: `{channel}` is absent; expected all of {all}", folder.display())]
    Part {
        /// The recording.
        folder: PathBuf,
        /// The absent component.
        channel: String,
        /// All components.
        all: String,
    },
    /// A folder of several recordings.
    #[error("{}: holds {found}; expected one recording: name one of them", folder.display())]
    Several {
        /// The folder.
        folder: PathBuf,
        /// Names of the recordings.
        found: String,
    },
    /// A folder without any known channel.
    #[error("{}: holds no channel of this scene; expected files such as camera.exr or beam-0/range.T.npy with the names of docs/formats/files.md (found {there})", folder.display())]
    Nothing {
        /// The folder.
        folder: PathBuf,
        /// What it does hold: files with their size, and their channels with their types.
        there: String,
        /// One of these channels.
        example: String,
    },
    /// A channel that is declared to be a map that the scene does not have.
    #[error("{}: channel `{channel}`, declared to be {map}: {found}; expected {expected}", folder.display())]
    Declared {
        /// The folder.
        folder: PathBuf,
        /// The channel. Short texts in boxes, so that the error stays small: it is passed along by value.
        channel: Box<str>,
        /// The map.
        map: Box<str>,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
}

/// A line of help. Errors hold it in a box, since they are passed along by value.
#[derive(Debug)]
pub struct Help {
    /// The words.
    pub words: String,
}

impl RecordingError {
    /// What to declare or change so that the recording is understood, if that may help.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Channel { help, .. } => help.as_ref().map(|help| help.words.clone()),
            Self::Nothing { example, .. } => Some(format!(
                "say which channel is which map of which sensor: --channel camera/depth.Z={example}, or in candidate.json \
                 \"channels\": {{\"camera/depth.Z\": \"{example}\"}}. The map's name says what the numbers are, and nothing is \
                 guessed: depth.Z along the optical axis, range.T along the ray"
            )),
            _ => None,
        }
    }
}

fn at(cell: &Option<(u32, u32)>) -> String {
    cell.map_or(String::new(), |(i, j)| format!(" at {i},{j}"))
}
