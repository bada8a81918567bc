use std::io;
use std::path::Path;
use std::path::PathBuf;

use crate::error::FileError;

/// Why the folder of a run could not be made ready, or one of its files not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FolderError {
    /// The folder itself, or one in it, could not be made.
    #[error("{}: cannot create the folder: {source}", path.display())]
    Create {
        /// Path of the folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The file of an earlier run that would mark the folder as complete could not be removed.
    #[error("{}: cannot remove what an earlier run left: {source}", path.display())]
    RemoveEarlier {
        /// Path of the file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// One of the files; the message names it.
    #[error(transparent)]
    File(#[from] FileError),
}

/// Makes the folder of a run, and takes away the file of an earlier one that would mark the folder as complete. Its
/// place is returned: it is to be written last.
pub fn begin(folder: &Path, last: &str) -> Result<PathBuf, FolderError> {
    create(folder)?;
    let last = folder.join(last);
    match std::fs::remove_file(&last) {
        Err(source) if source.kind() != io::ErrorKind::NotFound => {
            Err(FolderError::RemoveEarlier { path: last, source })
        }
        _ => Ok(last),
    }
}

/// Makes a folder, and those that it lies in, unless it is there.
///
/// # Errors
/// What the file system says, with the folder.
pub fn create(folder: &Path) -> Result<(), FolderError> {
    std::fs::create_dir_all(folder)
        .map_err(|source| FolderError::Create { path: folder.to_path_buf(), source })
}
