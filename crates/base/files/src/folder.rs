//! Output folders: made when they are missing, and marked as complete by the file that is written last.

use std::io;
use std::path::{Path, PathBuf};

use crate::atomic::write_atomically;
use crate::disk;
use crate::error::FileError;

/// Why an output folder could not be prepared, or one of its files not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FolderError {
    /// The folder, or a folder inside it, could not be created.
    #[error("{}: {}", path.display(), no_folder(source))]
    Create {
        /// Path of the folder.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The file that marks an earlier run as complete could not be removed.
    #[error("{}: cannot remove what an earlier run left: {source}", path.display())]
    RemoveEarlier {
        /// Path of the file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// Another run writes into the folder.
    #[error("{}: another run is writing into it; expected another folder, or that run's end", path.display())]
    InUse {
        /// Path of the folder.
        path: PathBuf,
    },
    /// What bears the name of a run's lock is none.
    #[error("{}: it is no file, and no run has made it; expected none, or an empty file: remove it", path.display())]
    NoLock {
        /// Path of the lock.
        path: PathBuf,
    },
    /// The folder is a reference pack, which a run would mix with its files.
    #[error("{}: it is a pack (it has {file}); expected another folder", path.display())]
    IsPack {
        /// Path of the folder.
        path: PathBuf,
        /// The file that makes it one.
        file: &'static str,
    },
    /// The folder has results of something else.
    #[error("{}: it has results of {of}; expected another folder, or --force to replace them", path.display())]
    IsOfOther {
        /// Path of the folder.
        path: PathBuf,
        /// What the results are of.
        of: String,
    },
    /// What the run reads lies in the folder, made by an earlier run: this one would remove or replace it.
    #[error(
        "{}: an earlier run has made it in the output folder {}, and this one would replace or remove it; expected another folder",
        path.display(), folder.display()
    )]
    IsInput {
        /// Path of what is read.
        path: PathBuf,
        /// Path of the folder.
        folder: PathBuf,
    },
    /// A file that the run reads has the name of one that it writes.
    #[error("{}: this run reads it, and would replace it by a file of its own; expected another output folder", path.display())]
    ReplacesInput {
        /// Path of what is read.
        path: PathBuf,
    },
    /// One of the files could not be written; the message names it.
    #[error(transparent)]
    File(#[from] FileError),
}

/// Why there is no folder, in words.
fn no_folder(source: &io::Error) -> String {
    match source.kind() {
        io::ErrorKind::AlreadyExists => "it is a file; expected a folder, or a new name".into(),
        _ => format!("cannot create the folder: {source}"),
    }
}

/// Creates the output folder of a run and removes `last`, the file by which an earlier run marked it as complete.
///
/// Returns the path of `last`. The caller writes that file after all others, so that a folder that has it is complete.
///
/// # Errors
/// [`FolderError::Create`] or [`FolderError::RemoveEarlier`], with the path.
///
/// ```
/// use raypencil_files::{begin_output_folder, write_atomically};
///
/// let parent = tempfile::tempdir()?;
/// let folder = parent.path().join("out");
/// let summary = begin_output_folder(&folder, "summary.json")?;
/// write_atomically(&summary, |file| file.write_all(b"{}"))?;
///
/// // A second run begins without the mark of the first.
/// assert_eq!(begin_output_folder(&folder, "summary.json")?, summary);
/// assert!(!summary.exists());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn begin_output_folder(folder: &Path, last: &str) -> Result<PathBuf, FolderError> {
    create_folder(folder)?;
    let last = folder.join(last);
    match disk::remove_file(&last) {
        Err(source) if source.kind() != io::ErrorKind::NotFound => {
            Err(FolderError::RemoveEarlier { path: last, source })
        }
        _ => Ok(last),
    }
}

/// Writes texts under their names into an output folder. The last marks a complete folder.
///
/// ```
/// use raypencil_files::write_texts;
///
/// let parent = tempfile::tempdir()?;
/// let folder = parent.path().join("out");
/// write_texts(&folder, &[("report.html", "<p>".to_string()), ("summary.json", "{}".to_string())])?;
/// assert_eq!(std::fs::read_to_string(folder.join("summary.json"))?, "{}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Names the file or folder that could not be written, and why.
pub fn write_texts(folder: &Path, texts: &[(&str, String)]) -> Result<(), FolderError> {
    if let Some((last, _)) = texts.last() {
        begin_output_folder(folder, last)?;
    }
    for (name, text) in texts {
        write_atomically(folder.join(name), |file| file.write_all(text.as_bytes()))?;
    }
    Ok(())
}

/// Creates a folder and its parents where they are missing.
///
/// # Errors
/// [`FolderError::Create`], with the folder.
pub fn create_folder(folder: &Path) -> Result<(), FolderError> {
    disk::create_dir_all(folder).map_err(|source| FolderError::Create { path: folder.to_path_buf(), source })
}
