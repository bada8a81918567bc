//! What this process writes into its output folders, noted while it is written.
//!
//! What a run made is what it wrote itself. Whatever else appears in the folder meanwhile belongs to somebody else, who is not to
//! lose it.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

use crate::error::FileError;
use crate::sha256::file_sha256_hex;

/// The output folders that runs of this process are writing into.
static OPEN: Mutex<Vec<Open>> = Mutex::new(Vec::new());

/// Number of the next one.
static NEXT: AtomicU64 = AtomicU64::new(0);

struct Open {
    /// Several may note the same folder.
    number: u64,
    /// Canonical, so that one folder has one name.
    folder: PathBuf,
    /// Files below it, with their digests.
    written: BTreeMap<PathBuf, String>,
}

/// The files that this process writes below a folder, as long as this value lives.
///
/// ```
/// use raypencil_files::{Journal, write_atomically};
///
/// let folder = tempfile::tempdir()?;
/// let journal = Journal::begin(folder.path())?;
/// write_atomically(folder.path().join("mine"), |file| file.write_all(b"abc"))?;
/// std::fs::write(folder.path().join("somebody's"), "abc")?;
/// let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
/// assert_eq!(journal.written().into_iter().collect::<Vec<_>>(), [("mine".into(), abc.into())]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Journal {
    number: u64,
}

impl Journal {
    /// Begins to note what is written below a folder.
    ///
    /// # Errors
    /// A folder that does not exist.
    pub fn begin(folder: &Path) -> io::Result<Self> {
        let folder = folder.canonicalize()?;
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        open().push(Open { number, folder, written: BTreeMap::new() });
        Ok(Self { number })
    }

    /// The files that were written so far, by their paths in the folder, with their digests.
    pub fn written(&self) -> BTreeMap<PathBuf, String> {
        let open = open();
        open.iter()
            .find(|open| open.number == self.number)
            .map(|open| open.written.clone())
            .unwrap_or_default()
    }
}

impl Drop for Journal {
    fn drop(&mut self) {
        open().retain(|open| open.number != self.number);
    }
}

/// Whether a run of this process is writing into this very folder.
pub(crate) fn is_open(folder: &Path) -> bool {
    folder.canonicalize().is_ok_and(|folder| open().iter().any(|open| open.folder == folder))
}

/// The folder of a file; a bare name has the empty path as its parent.
fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// A new file beside the place that [`persist`] puts it in.
pub(crate) fn temporary_beside(path: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".raypencil-").suffix(".part");
    // Temporary files are private by default; the finished file is to be as readable as any other output.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder_of(path))
}

/// Puts a complete temporary file in its place, and notes it where a run is open.
pub(crate) fn persist(temporary: NamedTempFile, path: &Path) -> io::Result<()> {
    let noted = note(temporary.path(), path)?;
    temporary.persist(path).map_err(|error| error.error)?;
    enter(noted);
    Ok(())
}

/// Puts a complete file of this process in its place, on the same file system, and notes it where a run is open.
///
/// # Errors
/// The error of the file system, with the path of the place.
pub fn put_in_place(from: &Path, to: &Path) -> Result<(), FileError> {
    let attempt = || {
        let noted = note(from, to)?;
        std::fs::rename(from, to)?;
        enter(noted);
        Ok(())
    };
    attempt().map_err(|error: io::Error| FileError::io(to, "write", error))
}

/// The canonical path of a file, and its digest before anybody else can see it; `None` where no run is open for it.
fn note(file: &Path, path: &Path) -> io::Result<Option<(PathBuf, String)>> {
    if open().is_empty() {
        return Ok(None);
    }
    let Some(name) = path.file_name() else { return Ok(None) };
    let place = folder_of(path).canonicalize()?.join(name);
    if !open().iter().any(|open| place.starts_with(&open.folder)) {
        return Ok(None);
    }
    let (_, sha256) = file_sha256_hex(file)?;
    Ok(Some((place, sha256)))
}

fn enter(noted: Option<(PathBuf, String)>) {
    let Some((place, sha256)) = noted else { return };
    for open in open().iter_mut() {
        if let Ok(name) = place.strip_prefix(&open.folder) {
            open.written.insert(name.to_path_buf(), sha256.clone());
        }
    }
}

fn open() -> MutexGuard<'static, Vec<Open>> {
    // The list is whole after each of its changes.
    OPEN.lock().unwrap_or_else(PoisonError::into_inner)
}
