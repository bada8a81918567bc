//! The output folder of a run: one run at a time, nothing of an earlier run beside the files of this one, and nothing removed
//! that no run has made.
//!
//! While a run writes, its folder has a locked file, to which it appends each file before it puts it in its place. When the run
//! ends, it leaves the list of the files that it wrote itself, in the format of `sha256sum`, and removes its lock; one that dies
//! leaves the lock, and with it the list. The next run removes what it does not make again and that is as the list says: a file that
//! was changed since, or put there by somebody else, at any time, stays. A list names the folder that it was made in: a copy of it
//! elsewhere is nobody's list. `docs/theory/folders.md` has the states of a folder.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use crate::atomic::write_atomically;
use crate::disk::{self, LOCK_NAME, TEMPORARY, is_temporary};
use crate::folder::{FolderError, create_folder};
use crate::folder_lock::{lock, unlock_shared};
use crate::journal::{Journal, is_open};
use crate::made_list::{
    Entry, MADE_NAME, entries, heading, is_claimed_below, listed_subject, made_earlier, subject_of, text_of,
};
use crate::running::{has_run, identity};
use crate::sha256::file_sha256_hex;
use crate::watch::{Operation, told};

/// Depth of folders below the output folder that are looked at.
const MAX_DEPTH: usize = 6;

/// Maximum size of what a run that died has left in its lock, bytes.
const MAX_LOCK_BYTES: u64 = 1 << 26;

/// Files by which a folder is a pack.
const PACK_NAMES: [&str; 3] = ["manifest.json", "raypack.json", "input.json"];

/// What tells whether a file was written again: a file that is written anew has another time, and mostly another size.
type Stamp = (u64, Option<SystemTime>, u64);

/// An output folder that a run writes into.
///
/// ```
/// use raypencil_files::{OutputFolder, write_atomically};
///
/// let parent = tempfile::tempdir()?;
/// let folder = parent.path().join("out");
/// let run = |beams: usize| -> Result<(), Box<dyn std::error::Error>> {
///     let output = OutputFolder::begin(&folder)?;
///     // While it writes, nobody else does.
///     assert!(OutputFolder::begin(&folder).is_err());
///     for beam in 0..beams {
///         write_atomically(folder.join(format!("beam-{beam}.exr")), |file| writeln!(file, "{beam}"))?;
///     }
///     Ok(output.finish()?)
/// };
/// run(3)?;
/// std::fs::write(folder.join("notes.txt"), "mine")?;
/// run(2)?;
/// assert!(folder.join("beam-1.exr").exists() && folder.join("notes.txt").exists());
/// // Of a beam that this run does not have.
/// assert!(!folder.join("beam-2.exr").exists());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct OutputFolder {
    folder: PathBuf,
    /// Folders that were made for it, the innermost first.
    made: Vec<PathBuf>,
    /// Locked until the end; `None` on a file system without locks.
    lock: Option<File>,
    /// What this run has written.
    journal: Journal,
    /// Files that were there when the run began.
    before: BTreeMap<PathBuf, Stamp>,
    /// Files that earlier runs have made, also one that died, with their digests. One that died may have left two of a file.
    earlier: Vec<Entry>,
    /// Whether `earlier` has files that no list names.
    is_unlisted: bool,
    /// What the results are of.
    subject: Option<String>,
    /// Whether the list is as it is to be.
    is_finished: bool,
    /// Whether something of an earlier run could not be removed. Then the lock stays: without one, a folder has nothing of earlier
    /// runs beside its mark.
    is_mixed: bool,
}

impl OutputFolder {
    /// Creates the folder where it is missing, locks it, and removes what a run that was killed has left half-written.
    ///
    /// # Errors
    /// A folder that cannot be written, into which another run is writing, also as a part of a folder above, or that is a pack.
    pub fn begin(folder: &Path) -> Result<Self, FolderError> {
        if let Some(name) = PACK_NAMES.iter().find(|name| folder.join(name).exists()) {
            return Err(FolderError::IsPack { path: folder.to_path_buf(), file: name });
        }
        Self::begin_any(folder)
    }

    /// The same for results of a subject, such as a scene: a folder with results of another one is refused, unless it is `replaced`.
    ///
    /// ```
    /// use raypencil_files::{OutputFolder, write_atomically};
    ///
    /// let parent = tempfile::tempdir()?;
    /// let folder = parent.path().join("out");
    /// let run = |subject: &str, replaced: bool| -> Result<(), Box<dyn std::error::Error>> {
    ///     let output = OutputFolder::begin_of(&folder, subject, replaced)?;
    ///     write_atomically(folder.join("map.exr"), |file| writeln!(file, "{subject}"))?;
    ///     Ok(output.finish()?)
    /// };
    /// run("pyramids", false)?;
    /// run("pyramids", false)?;
    /// let error = run("facets", false).unwrap_err().to_string();
    /// assert!(error.contains("results of pyramids"), "{error}");
    /// run("facets", true)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`OutputFolder::begin`].
    pub fn begin_of(folder: &Path, subject: &str, replaced: bool) -> Result<Self, FolderError> {
        let subject = one_line(subject);
        if let Some(of) = subject_of(folder).filter(|of| *of != subject && !replaced) {
            return Err(FolderError::IsOfOther { path: folder.to_path_buf(), of });
        }
        let mut output = Self::begin(folder)?;
        output.subject = Some(subject);
        Ok(output)
    }

    /// The same for a folder that may be a pack, which has a list of its own: it ends by [`OutputFolder::finish_unlisted`].
    ///
    /// # Errors
    /// As [`OutputFolder::begin`].
    pub fn begin_any(folder: &Path) -> Result<Self, FolderError> {
        let cannot = |source| FolderError::Create { path: folder.to_path_buf(), source };
        let made = made_for_a_run(folder)?;
        let mut lock = lock(folder, false)?;
        // First, so that it is known of whatever fails afterwards.
        let left = lock.as_mut().map(|lock| left_by_a_dead_run(folder, lock)).transpose().map_err(cannot)?;
        let mut earlier = left.unwrap_or_default();
        let is_unlisted = !earlier.is_empty();
        earlier.extend(made_earlier(folder));
        let ahead = lock.as_ref().map(File::try_clone).transpose().map_err(cannot)?;
        let journal = Journal::begin_with(folder, ahead).map_err(cannot)?;
        let (before, subject, is_finished, is_mixed) = (BTreeMap::new(), None, false, false);
        let folder = folder.to_path_buf();
        let mut output = Self {
            folder,
            made,
            lock,
            journal,
            before,
            earlier,
            is_unlisted,
            subject,
            is_finished,
            is_mixed,
        };
        let folder = &output.folder;
        // One that began above meanwhile has looked below before this lock was there, or is seen now.
        refuse_below_a_run(folder.canonicalize().map_err(cannot)?.ancestors().skip(1))?;
        if let Some(lock) = output.lock.as_mut().filter(|_| !is_unlisted) {
            begin_lock(folder, lock).map_err(cannot)?;
        }
        // No run that could be writing them is left.
        output.before = files_below(folder, &mut |part| remove_part(part, MIN_ABANDONED_AGE));
        Ok(output)
    }

    /// Refuses inputs of this run that an earlier one has made in its folder: they would be replaced or removed.
    ///
    /// # Errors
    /// [`FolderError::IsInput`] for the first of the files or folders that is such a file, or holds one.
    pub fn refuse_inputs(&self, inputs: &[&Path]) -> Result<(), FolderError> {
        let Ok(folder) = self.folder.canonicalize() else { return Ok(()) };
        let is_made = |input: &&&Path| {
            let Ok(path) = input.canonicalize() else { return false };
            path.strip_prefix(&folder).is_ok_and(|within| {
                // The folder itself as an input holds all that was made.
                self.earlier
                    .iter()
                    .any(|(name, _)| name.starts_with(within) && self.before.contains_key(name))
            })
        };
        match inputs.iter().find(is_made) {
            Some(path) => Err(FolderError::IsInput { path: path.to_path_buf(), folder: self.folder.clone() }),
            None => Ok(()),
        }
    }

    /// The files that this run has written so far, by their paths in the folder, with their digests.
    pub fn written(&self) -> BTreeMap<PathBuf, String> {
        self.journal.written()
    }

    /// Removes the files of earlier runs before this one makes its own, where [`OutputFolder::finish`] would do it at the end. For a run
    /// that works for long: if it is stopped, no results of another run lie beside what it left. The mark is to be removed before.
    ///
    /// # Errors
    /// A file that cannot be removed.
    ///
    /// ```
    /// use raypencil_files::{OutputFolder, write_atomically};
    ///
    /// let parent = tempfile::tempdir()?;
    /// let folder = parent.path().join("out");
    /// let output = OutputFolder::begin(&folder)?;
    /// write_atomically(folder.join("map.exr"), |file| writeln!(file, "1"))?;
    /// output.finish()?;
    /// std::fs::write(folder.join("notes.txt"), "mine")?;
    ///
    /// let output = OutputFolder::begin(&folder)?;
    /// output.clear_earlier()?;
    /// assert!(!folder.join("map.exr").exists() && folder.join("notes.txt").exists());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn clear_earlier(&self) -> Result<(), FolderError> {
        self.remove_earlier().map(drop)
    }

    /// Removes the files of earlier runs that this one has not made again, and lists its own. A run that wrote nothing leaves
    /// no list.
    ///
    /// # Errors
    /// A file that cannot be removed, read or written.
    pub fn finish(mut self) -> Result<(), FolderError> {
        let now = self.remove_earlier().inspect_err(|_| self.is_mixed = true)?;
        let mut written = self.written();
        written.retain(|name, _| now.contains_key(name));
        self.list(&written)?;
        self.is_finished = true;
        Ok(())
    }

    /// The same without a list: of a pack, whose manifest is one.
    ///
    /// # Errors
    /// As [`OutputFolder::finish`].
    pub fn finish_unlisted(mut self) -> Result<(), FolderError> {
        self.remove_earlier().inspect_err(|_| self.is_mixed = true)?;
        self.list(&BTreeMap::new())?;
        self.is_finished = true;
        Ok(())
    }

    /// Removes the files of earlier runs that are as these have made them, and that nobody has made again. Returns the files that
    /// there were.
    fn remove_earlier(&self) -> Result<BTreeMap<PathBuf, Stamp>, FolderError> {
        let now = files_below(&self.folder, &mut |_| {});
        let is_as_before =
            |name: &PathBuf| self.before.get(name).is_some_and(|stamp| now.get(name) == Some(stamp));
        // Before any list goes.
        let is_claimed = |(name, _): &&Entry| is_claimed_below(&self.folder, name, &self.earlier);
        let candidates = self.earlier.iter().filter(|(name, _)| is_as_before(name));
        let candidates: Vec<&Entry> = candidates.filter(|entry| !is_claimed(entry)).collect();
        for (name, sha256) in candidates {
            let path = self.folder.join(name);
            if file_sha256_hex(&path).is_ok_and(|(_, found)| found == *sha256) {
                disk::remove_file(&path)
                    .map_err(|source| FolderError::RemoveEarlier { path: path.clone(), source })?;
                // Its folder too, if that was the last file.
                let inner = path.parent().filter(|parent| *parent != self.folder);
                inner.map(disk::remove_dir);
            }
        }
        Ok(now)
    }

    /// Leaves a list of these files; without any none.
    fn list(&self, files: &BTreeMap<PathBuf, String>) -> Result<(), FolderError> {
        let list = self.folder.join(MADE_NAME);
        if !files.is_empty() {
            let text = text_of(&self.folder, self.subject.as_deref(), files.iter());
            return Ok(write_atomically(list, |file| file.write_all(text.as_bytes()))?);
        }
        match disk::remove_file(&list) {
            Err(source) if source.kind() != io::ErrorKind::NotFound => {
                Err(FolderError::RemoveEarlier { path: list, source })
            }
            _ => Ok(()),
        }
    }

    /// Lists what a run that failed has written beside what lay there, so that the next one can remove both.
    fn list_what_is_there(&mut self) -> Result<(), FolderError> {
        let (written, claimed) = (self.written(), self.journal.claimed());
        if written.is_empty() && claimed.is_empty() && !self.is_unlisted {
            return Ok(());
        }
        self.subject = self.subject.take().or_else(|| listed_subject(&self.folder));
        let is_there = |(name, sha256): &&Entry| {
            file_sha256_hex(&self.folder.join(name)).is_ok_and(|(_, found)| found == *sha256)
        };
        // A pack that could not remove all of an earlier one has claimed the rest.
        self.earlier.extend(claimed);
        let mut files: BTreeMap<PathBuf, String> = self.earlier.iter().filter(is_there).cloned().collect();
        files.extend(written);
        self.list(&files)
    }
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        if self.lock.is_some() {
            // What cannot be listed stays in the lock, as that of a run that died.
            if self.is_finished || !self.is_mixed && self.list_what_is_there().is_ok() {
                // Removed while it is locked, so that nobody's lock is removed.
                let _ = disk::remove_file(&self.folder.join(LOCK_NAME));
            }
            self.lock = None;
        }
        remove_empty(&self.made);
    }
}

/// Output folder that several runs share, each of which writes files of its own: no run that wants it for itself begins in it or
/// above it as long as one of them lives.
#[derive(Debug)]
pub struct SharedFolder {
    folder: PathBuf,
    made: Vec<PathBuf>,
    /// `None` on a file system without locks.
    lock: Option<File>,
    /// So that this process's own runs in folders below are not refused.
    _journal: Journal,
}

impl SharedFolder {
    /// Creates the folder where it is missing, and locks it together with others who share it.
    ///
    /// # Errors
    /// A folder that cannot be written, or into which a run is writing that does not share it, also as a part of a folder above.
    pub fn begin(folder: &Path) -> Result<Self, FolderError> {
        let cannot = |source| FolderError::Create { path: folder.to_path_buf(), source };
        let made = made_for_a_run(folder)?;
        let lock = lock(folder, true)?;
        let journal = Journal::begin(folder).map_err(cannot)?;
        let shared = Self { folder: folder.to_path_buf(), made, lock, _journal: journal };
        refuse_below_a_run(folder.canonicalize().map_err(cannot)?.ancestors().skip(1))?;
        Ok(shared)
    }
}

impl Drop for SharedFolder {
    fn drop(&mut self) {
        if let Some(lock) = self.lock.take() {
            unlock_shared(&self.folder, &lock);
        }
        remove_empty(&self.made);
    }
}

/// Makes a folder for a run, unless another run is writing into one above. Returns the folders that were missing, the innermost
/// first.
fn made_for_a_run(folder: &Path) -> Result<Vec<PathBuf>, FolderError> {
    let is_missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
    let made: Vec<PathBuf> = folder.ancestors().take_while(is_missing).map(PathBuf::from).collect();
    // Before anything is made, so that a run that is refused leaves nothing.
    let there = folder.ancestors().find(|above| above.exists()).unwrap_or(Path::new("."));
    let whole =
        there.canonicalize().map_err(|source| FolderError::Create { path: folder.to_path_buf(), source })?;
    let own = usize::from(there == folder);
    refuse_below_a_run(whole.ancestors().skip(own))?;
    create_folder(folder)?;
    Ok(made)
}

/// A run that wrote nothing leaves no folder; one with files in it is not removed.
fn remove_empty(made: &[PathBuf]) {
    for folder in made {
        if disk::remove_dir(folder).is_err() {
            break;
        }
    }
}

/// Refuses a folder below one into which another process's run is writing.
fn refuse_below_a_run<'a>(above: impl Iterator<Item = &'a Path>) -> Result<(), FolderError> {
    match above.take(MAX_DEPTH).find(|above| has_run(above)) {
        Some(above) => Err(FolderError::InUse { path: above.to_path_buf() }),
        None => Ok(()),
    }
}

/// The files that a run that died had put in place, or was about to. Its lock is continued: if this run dies too, the next one
/// knows of both.
fn left_by_a_dead_run(folder: &Path, lock: &mut File) -> io::Result<Vec<Entry>> {
    let mut text = Vec::new();
    lock.take(MAX_LOCK_BYTES).read_to_end(&mut text)?;
    Ok(entries(folder, &String::from_utf8_lossy(&text)))
}

/// The first line of a lock, before this run's files.
fn begin_lock(folder: &Path, lock: &mut File) -> io::Result<()> {
    lock.set_len(0)?;
    lock.seek(SeekFrom::Start(0))?;
    disk::write(lock, &folder.join(LOCK_NAME), format!("{}\n", heading(folder)).as_bytes())
}

/// Age after which nobody is writing a half-written file of a run any more.
pub const MIN_ABANDONED_AGE: Duration = Duration::from_secs(600);

/// Removes what killed runs have left half-written below a folder that several runs share: what nobody has locked. Where the system
/// does not say that, what nothing was written to for `min_age`.
pub fn remove_abandoned(folder: &Path, min_age: Duration) {
    files_below(folder, &mut |part| remove_part(part, min_age));
}

/// Creates the folder of files that a command writes one by one, where it is missing, and removes what killed runs have left
/// half-written in it. In this folder alone: it may be anybody's, and large. An empty path is the current folder.
///
/// # Errors
/// [`FolderError::Create`].
pub fn begin_files(folder: &Path) -> Result<(), FolderError> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    create_folder(folder)?;
    for entry in std::fs::read_dir(folder).into_iter().flatten().filter_map(io::Result::ok) {
        if is_temporary(&entry.file_name()) {
            remove_part(&entry.path(), MIN_ABANDONED_AGE);
        }
    }
    Ok(())
}

/// Whether nothing was written to a file or folder for this time.
fn is_older(part: &Path, age: Duration) -> bool {
    let written = part.symlink_metadata().and_then(|found| found.modified()).ok();
    written.and_then(|time| time.elapsed().ok()).is_some_and(|elapsed| elapsed >= age)
}

/// Removes a half-written file or folder, unless somebody is still writing it: who does has it locked. Where there are no locks, by
/// its age.
fn remove_part(part: &Path, min_age: Duration) {
    // What is neither was made by no run, and a pipe would wait for its other end.
    let Ok(found) = part.symlink_metadata() else { return };
    if !found.is_file() && !found.is_dir() {
        return;
    }
    let _ = told(Operation::Look, part);
    let opened = if cfg!(unix) { File::open(part).ok() } else { None };
    let is_dead = match opened.as_ref().map(File::try_lock) {
        Some(Ok(())) => true,
        Some(Err(std::fs::TryLockError::WouldBlock)) => false,
        Some(Err(std::fs::TryLockError::Error(_))) | None => is_older(part, min_age),
    };
    if is_dead {
        // One that cannot be removed disturbs nobody: it has a name of its own. The lock is held until it is gone.
        let _ = if found.is_dir() { disk::remove_dir_all(part) } else { disk::remove_file(part) };
    }
    drop(opened);
}

/// The regular files below a folder, by their paths in it, without locks and without its own list. Calls `part` for each half-written
/// file or folder of a run, but for those of runs that are still writing into a folder below. Links are not followed.
fn files_below(folder: &Path, part: &mut dyn FnMut(&Path)) -> BTreeMap<PathBuf, Stamp> {
    let mut found = BTreeMap::new();
    let mut folders = vec![(PathBuf::new(), 0)];
    while let Some((inner, depth)) = folders.pop() {
        let Ok(entries) = std::fs::read_dir(folder.join(&inner)) else { continue };
        for entry in entries.filter_map(io::Result::ok) {
            let file_name = entry.file_name();
            let text = file_name.to_string_lossy();
            let Ok(metadata) = entry.path().symlink_metadata() else { continue };
            let name = inner.join(&file_name);
            if is_temporary(&file_name) {
                part(&entry.path());
            } else if text.starts_with(TEMPORARY.0) && (depth == 0 || text != MADE_NAME) {
                // A lock, or the folder's own list.
            } else if metadata.is_dir() && depth < MAX_DEPTH {
                if !has_run(&entry.path()) && !is_open(&entry.path()) {
                    folders.push((name, depth + 1));
                }
            } else if metadata.is_file() {
                found.insert(name, (metadata.len(), metadata.modified().ok(), identity(&metadata)));
            }
        }
    }
    found
}

/// A text without line ends, for the list.
fn one_line(text: &str) -> String {
    text.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect()
}

#[cfg(test)]
#[path = "../tests/unit/output_folder.rs"]
mod tests;
