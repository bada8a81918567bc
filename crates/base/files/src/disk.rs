//! The operations by which this program changes a disk, in one room, so that each of them can be made to fail.
//!
//! What they do is what `std::fs` does. Before each, whoever watches the folder is told of it ([`watch`]): tests do, to let a
//! disk fail, a process die, or two runs go on in any order. Nobody else watches, and then an operation costs one look at a
//! number.

use std::ffi::OsStr;
use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

use tempfile::{NamedTempFile, TempDir};

use crate::watch::{Operation, told};

/// Name of the file that is locked while a run writes into its folder.
pub(crate) const LOCK_NAME: &str = ".raypencil-lock";

/// Begin and end of the names of files and folders that are half-written.
pub(crate) const TEMPORARY: (&str, &str) = (".raypencil-", ".part");

/// Whether a file or folder of this name is half-written.
pub(crate) fn is_temporary(name: &OsStr) -> bool {
    let name = name.to_string_lossy();
    name.starts_with(TEMPORARY.0) && name.ends_with(TEMPORARY.1)
}

/// Creates a folder and those above it, where they are missing.
///
/// # Errors
/// As [`std::fs::create_dir_all`].
pub fn create_dir_all(folder: &Path) -> io::Result<()> {
    let missing: Vec<&Path> = folder.ancestors().take_while(|above| is_missing(above)).collect();
    for above in missing.iter().rev() {
        told(Operation::CreateFolder, above)?;
        match std::fs::create_dir(above) {
            // Somebody else has made it meanwhile.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && above.is_dir() => {}
            made => made?,
        }
    }
    // What is there already may be a file.
    if missing.is_empty() { std::fs::create_dir_all(folder) } else { Ok(()) }
}

fn is_missing(folder: &Path) -> bool {
    !folder.as_os_str().is_empty()
        && std::fs::metadata(folder).is_err_and(|error| error.kind() == io::ErrorKind::NotFound)
}

/// Removes a file.
///
/// # Errors
/// As [`std::fs::remove_file`].
pub fn remove_file(file: &Path) -> io::Result<()> {
    told(Operation::RemoveFile, file)?;
    std::fs::remove_file(file)
}

/// Removes an empty folder.
///
/// # Errors
/// As [`std::fs::remove_dir`].
pub fn remove_dir(folder: &Path) -> io::Result<()> {
    told(Operation::RemoveFolder, folder)?;
    std::fs::remove_dir(folder)
}

/// Removes a folder with all that is in it. Links are not followed.
pub(crate) fn remove_dir_all(folder: &Path) -> io::Result<()> {
    told(Operation::RemoveFolder, folder)?;
    std::fs::remove_dir_all(folder)
}

/// Moves a file, on one file system.
pub(crate) fn rename(from: &Path, to: &Path) -> io::Result<()> {
    told(Operation::Rename, to)?;
    std::fs::rename(from, to)
}

/// Refuses a folder where a file is to be put.
pub(crate) fn in_place_of_a_file(place: &Path) -> io::Result<()> {
    if place.symlink_metadata().is_ok_and(|found| found.is_dir()) {
        return Err(io::Error::new(
            io::ErrorKind::IsADirectory,
            "it is a folder; expected a file, or nothing: remove it",
        ));
    }
    Ok(())
}

/// Writes all of the bytes to a file that is known by a path.
pub(crate) fn write(file: &mut impl Write, path: &Path, bytes: &[u8]) -> io::Result<()> {
    if let Err(error) = told(Operation::Write, path) {
        // A disk that is full has taken a part.
        let _ = file.write_all(&bytes[..bytes.len() / 2]);
        return Err(error);
    }
    file.write_all(bytes)
}

/// Half-written file beside its place. It is locked until it is in its place, so that others know that somebody writes it.
/// Dropped before that, it is removed.
#[derive(Debug)]
pub(crate) struct Temporary {
    /// Until it is in its place.
    file: Option<NamedTempFile>,
}

/// How often a file is made anew that somebody removes before it is locked.
const ATTEMPTS: u32 = 100;

impl Temporary {
    /// New file in a folder.
    pub(crate) fn create_in(folder: &Path) -> io::Result<Self> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(TEMPORARY.0).suffix(TEMPORARY.1);
        // Temporary files are private by default; the finished file is to be as readable as any other output.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        for _ in 0..ATTEMPTS {
            told(Operation::CreateFile, folder)?;
            let file = builder.tempfile_in(folder)?;
            let is_own = is_owned(file.as_file(), file.path());
            let temporary = Self { file: Some(file) };
            if is_own {
                return Ok(temporary);
            }
        }
        Err(io::Error::other("somebody removes each new file at once"))
    }

    fn file(&self) -> &NamedTempFile {
        self.file.as_ref().expect("it is not in its place yet")
    }

    pub(crate) fn path(&self) -> &Path {
        self.file().path()
    }

    /// Puts it in its place.
    pub(crate) fn persist(mut self, place: &Path) -> io::Result<()> {
        told(Operation::Rename, place)?;
        let file = self.file.take().expect("it is not in its place yet");
        file.persist(place).map(drop).map_err(|error| {
            self.file = Some(error.file);
            in_place_of_a_file(place).err().unwrap_or(error.error)
        })
    }
}

impl Write for Temporary {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let file = self.file.as_mut().expect("it is not in its place yet");
        let path = file.path().to_path_buf();
        write(file.as_file_mut(), &path, bytes).map(|()| bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_mut().expect("it is not in its place yet").flush()
    }
}

impl Seek for Temporary {
    fn seek(&mut self, place: SeekFrom) -> io::Result<u64> {
        self.file.as_mut().expect("it is not in its place yet").seek(place)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if let Some(file) = self.file.take()
            && told(Operation::RemoveFile, file.path()).is_err()
        {
            let _ = file.keep();
        }
    }
}

/// Half-written folder, for files that are put in their places together. Locked and removed like a half-written file.
#[derive(Debug)]
pub struct TemporaryFolder {
    folder: Option<TempDir>,
    /// Open and locked.
    _lock: Option<File>,
}

impl TemporaryFolder {
    /// New folder in a folder.
    ///
    /// # Errors
    /// That of the file system.
    pub fn create_in(folder: &Path) -> io::Result<Self> {
        for _ in 0..ATTEMPTS {
            told(Operation::CreateFolder, folder)?;
            let made = tempfile::Builder::new().prefix(TEMPORARY.0).suffix(TEMPORARY.1).tempdir_in(folder)?;
            let lock = if cfg!(unix) { File::open(made.path()).ok() } else { None };
            if lock.as_ref().is_none_or(|lock| is_owned(lock, made.path())) {
                return Ok(Self { folder: Some(made), _lock: lock });
            }
        }
        Err(io::Error::other("somebody removes each new folder at once"))
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        self.folder.as_ref().expect("it is there until it is dropped").path()
    }
}

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        if let Some(folder) = self.folder.take()
            && told(Operation::RemoveFolder, folder.path()).is_err()
        {
            let _ = folder.keep();
        }
    }
}

/// Locks what was just made, and tells whether it is still there: somebody may have taken it for left by a dead process.
#[cfg(unix)]
fn is_owned(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    match file.try_lock() {
        Ok(()) => {
            let is_same =
                |there: std::fs::Metadata| file.metadata().is_ok_and(|own| own.ino() == there.ino());
            std::fs::symlink_metadata(path).is_ok_and(is_same)
        }
        Err(std::fs::TryLockError::WouldBlock) => false,
        // A file system without locks: what is half-written is known by its age alone.
        Err(std::fs::TryLockError::Error(_)) => true,
    }
}

/// A lock would keep everybody from reading it.
#[cfg(not(unix))]
fn is_owned(_file: &File, _path: &Path) -> bool {
    true
}
