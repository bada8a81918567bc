//! The lock of an output folder. A run appends to it what it is about to put in place, so that the next run knows what one that
//! died has left.

use std::fs::{File, Metadata, TryLockError};
use std::path::Path;
use std::time::Duration;

use crate::disk::{self, LOCK_NAME};
use crate::folder::FolderError;
use crate::running::identity;
use crate::watch::{Operation, told};

/// How often a lock is asked for that somebody has, before a run is taken to have it.
const LOOKS: u32 = 5;

/// Time between two of these looks.
const PAUSE: Duration = Duration::from_millis(if cfg!(test) { 0 } else { 2 });

/// Locks a folder, for this run alone or for runs that share it; `None` on a file system without locks.
pub(crate) fn lock(folder: &Path, is_shared: bool) -> Result<Option<File>, FolderError> {
    let path = folder.join(LOCK_NAME);
    let cannot = |source| FolderError::Create { path: folder.to_path_buf(), source };
    // The file may vanish between its opening and its locking, when another run ends: then it is opened again.
    for attempt in 0..100 {
        // What is no file is not opened: a pipe would wait for its other end. No run has made it, so none ends with it.
        if std::fs::symlink_metadata(&path).is_ok_and(|found| !found.is_file()) {
            return Err(FolderError::NoLock { path });
        }
        told(Operation::CreateFile, &path).map_err(cannot)?;
        let mut options = File::options();
        let file = options.create(true).truncate(false).read(true).write(true).open(&path).map_err(cannot)?;
        let _ = told(Operation::Look, &path);
        match if is_shared { file.try_lock_shared() } else { file.try_lock() } {
            Ok(()) => {}
            // Somebody may only be looking whether there is a run.
            Err(TryLockError::WouldBlock) if attempt < LOOKS => {
                std::thread::sleep(PAUSE);
                continue;
            }
            Err(TryLockError::WouldBlock) => break,
            // A file system without locks.
            Err(TryLockError::Error(_)) => {
                let _ = std::fs::remove_file(&path);
                return Ok(None);
            }
        }
        let is_same = |there: Metadata| file.metadata().is_ok_and(|mine| identity(&mine) == identity(&there));
        if std::fs::symlink_metadata(&path).is_ok_and(is_same) {
            return Ok(Some(file));
        }
    }
    Err(FolderError::InUse { path: folder.to_path_buf() })
}

/// The end of a run that shares a folder: the last of them removes the lock, unless it is that of a run that died.
pub(crate) fn unlock_shared(folder: &Path, lock: &File) {
    let is_empty = lock.metadata().is_ok_and(|found| found.len() == 0);
    if is_empty && lock.try_lock().is_ok() {
        let _ = disk::remove_file(&folder.join(LOCK_NAME));
    }
}
