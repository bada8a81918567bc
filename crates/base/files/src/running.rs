//! Whether a run is writing into a folder.

use std::fs::{File, Metadata, TryLockError};
use std::path::Path;

use crate::disk::LOCK_NAME;
use crate::journal::is_open;
use crate::watch::{Operation, told};

/// Whether another process's run is writing into this very folder.
pub(crate) fn has_run(folder: &Path) -> bool {
    let path = folder.join(LOCK_NAME);
    let _ = told(Operation::Look, &path);
    // What is no file is not opened: a pipe would wait for its other end.
    if !std::fs::symlink_metadata(&path).is_ok_and(|found| found.is_file()) || is_open(folder) {
        return false;
    }
    let file = File::options().write(true).open(&path);
    file.is_ok_and(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)))
}

/// What tells two files apart; the same for all where the system does not say.
pub(crate) fn identity(metadata: &Metadata) -> u64 {
    #[cfg(unix)]
    return std::os::unix::fs::MetadataExt::ino(metadata);
    #[cfg(not(unix))]
    return u64::from(metadata.is_dir());
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn two_files_are_told_apart_whatever_they_hold() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for name in ["one", "other"] {
            std::fs::write(path(name), "the same").unwrap();
        }
        let of = |name: &str| identity(&std::fs::metadata(path(name)).unwrap());
        let one = of("one");
        assert_ne!(one, of("other"));
        std::fs::rename(path("one"), path("moved")).unwrap();
        assert_eq!(one, of("moved"));
    }
}
