//! Watching the operations on a disk. For tests: a watch can let an operation fail, or wait.

use std::cell::Cell;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// An operation on a disk.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Operation {
    /// Something is looked at that others change: it cannot fail, but others may come before it.
    Look,
    /// A folder is made.
    CreateFolder,
    /// A file is made, in the folder that is named.
    CreateFile,
    /// Bytes are written to a file.
    Write,
    /// A file is moved to the place that is named.
    Rename,
    /// A file is removed.
    RemoveFile,
    /// A folder is removed.
    RemoveFolder,
}

/// Is asked before each operation. An error takes its place.
pub type Watcher = dyn Fn(Operation, &Path) -> io::Result<()> + Send + Sync;

/// Number of watches, so that nobody asks for their list who needs not.
static WATCHES: AtomicUsize = AtomicUsize::new(0);

static WATCHED: Mutex<Vec<(PathBuf, Arc<Watcher>)>> = Mutex::new(Vec::new());

thread_local! {
    static PROCESS: Cell<u64> = const { Cell::new(0) };
}

/// A watch over the operations below a folder, as long as this value lives.
#[derive(Debug)]
pub struct Watch {
    folder: PathBuf,
}

/// Watches a folder, whose path is the begin of the paths that a run is given. One watch a folder.
pub fn watch(folder: &Path, watcher: Arc<Watcher>) -> Watch {
    watched().push((folder.to_path_buf(), watcher));
    WATCHES.fetch_add(1, Ordering::SeqCst);
    Watch { folder: folder.to_path_buf() }
}

impl Drop for Watch {
    fn drop(&mut self) {
        watched().retain(|(folder, _)| *folder != self.folder);
        WATCHES.fetch_sub(1, Ordering::SeqCst);
    }
}

/// Tells the watch over this path of an operation.
pub(crate) fn told(operation: Operation, path: &Path) -> io::Result<()> {
    if WATCHES.load(Ordering::Relaxed) == 0 {
        return Ok(());
    }
    let found =
        watched().iter().find(|(folder, _)| path.starts_with(folder)).map(|(_, watcher)| watcher.clone());
    // It may wait, and others go on meanwhile.
    found.map_or(Ok(()), |watcher| watcher(operation, path))
}

fn watched() -> MutexGuard<'static, Vec<(PathBuf, Arc<Watcher>)>> {
    // The list is whole after each of its changes.
    WATCHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What is taken for the process of this thread: tests let threads play two processes.
pub(crate) fn process() -> u64 {
    PROCESS.get()
}

/// Lets this thread play another process.
#[cfg(test)]
pub(crate) fn play_process(number: u64) {
    PROCESS.set(number);
}
