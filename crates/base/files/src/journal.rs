//! What this process writes into its output folders, noted while it is written.
//!
//! What a run made is what it wrote itself. Whatever else appears in the folder meanwhile belongs to somebody else, who is not to
//! lose it.

use std::collections::BTreeMap;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::disk::{LOCK_NAME, TEMPORARY, is_temporary};
use crate::made_list::{MADE_NAME, line};
use crate::watch::process;

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
    /// Files of earlier runs that this one is about to remove, with their digests.
    claimed: BTreeMap<PathBuf, String>,
    /// The folder's lock, which has each file before it is put in its place.
    ahead: Option<Arc<File>>,
    /// Threads may play several processes.
    process: u64,
}

impl Open {
    /// The path of a place in the folder, if it is noted there: all that is below but what is half-written, and what this crate
    /// writes into the folder itself. The list of a run in a folder below is a file of this one.
    fn name_of<'a>(&self, place: &'a Path) -> Option<&'a Path> {
        let name = place.strip_prefix(&self.folder).ok()?;
        let is_half_written = name.components().any(|part| is_temporary(part.as_os_str()));
        let is_own = place.file_name()?.to_string_lossy().starts_with(TEMPORARY.0);
        let is_list_below = name.ends_with(MADE_NAME) && name != Path::new(MADE_NAME);
        (!is_half_written && (!is_own || is_list_below)).then_some(name)
    }
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
        Self::begin_with(folder, None)
    }

    /// The same with the folder's lock, into which each file is written before it is put in its place.
    pub(crate) fn begin_with(folder: &Path, ahead: Option<File>) -> io::Result<Self> {
        let folder = folder.canonicalize()?;
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        open().push(Open {
            number,
            folder,
            written: BTreeMap::new(),
            claimed: BTreeMap::new(),
            ahead: ahead.map(Arc::new),
            process: process(),
        });
        Ok(Self { number })
    }

    /// The files that were written so far, by their paths in the folder, with their digests.
    pub fn written(&self) -> BTreeMap<PathBuf, String> {
        self.noted(|open| &open.written)
    }

    /// The files of earlier runs that were to be removed, whether they are gone or not.
    pub(crate) fn claimed(&self) -> BTreeMap<PathBuf, String> {
        self.noted(|open| &open.claimed)
    }

    fn noted(&self, of: fn(&Open) -> &BTreeMap<PathBuf, String>) -> BTreeMap<PathBuf, String> {
        let open = open();
        open.iter().find(|open| open.number == self.number).map(|open| of(open).clone()).unwrap_or_default()
    }
}

impl Drop for Journal {
    fn drop(&mut self) {
        open().retain(|open| open.number != self.number);
    }
}

/// Whether a run of this process is writing into this very folder.
pub(crate) fn is_open(folder: &Path) -> bool {
    folder.canonicalize().is_ok_and(|folder| own(&mut open()).any(|open| open.folder == folder))
}

/// The runs of this process.
fn own(open: &mut [Open]) -> impl Iterator<Item = &mut Open> {
    open.iter_mut().filter(|open| open.process == process())
}

/// Whether a run is open for a place, by its canonical path.
pub(crate) fn is_noted(place: &Path) -> bool {
    own(&mut open()).any(|open| open.name_of(place).is_some())
}

/// The folders of this process's runs.
pub(crate) fn open_folders() -> Vec<PathBuf> {
    own(&mut open()).map(|open| open.folder.clone()).collect()
}

/// What is to be written into which lock, before a file is put in this place.
pub(crate) fn lines_ahead(place: &Path, sha256: &str) -> Vec<(Arc<File>, PathBuf, String)> {
    let line_for = |open: &mut Open| {
        let name = open.name_of(place)?;
        Some((open.ahead.clone()?, open.folder.join(LOCK_NAME), line(name, sha256)?))
    };
    own(&mut open()).filter_map(line_for).collect()
}

/// Notes a file that is in its place.
pub(crate) fn enter(place: &Path, sha256: &str) {
    for open in own(&mut open()) {
        if let Some(name) = open.name_of(place).map(PathBuf::from) {
            open.written.insert(name, sha256.to_string());
        }
    }
}

/// Notes a file of an earlier run that is about to be removed.
pub(crate) fn enter_claim(place: &Path, sha256: &str) {
    for open in own(&mut open()) {
        if let Some(name) = open.name_of(place).map(PathBuf::from) {
            open.claimed.insert(name, sha256.to_string());
        }
    }
}

fn open() -> MutexGuard<'static, Vec<Open>> {
    // The list is whole after each of its changes.
    OPEN.lock().unwrap_or_else(PoisonError::into_inner)
}
