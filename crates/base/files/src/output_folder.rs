//! The output folder of a run: one run at a time, nothing of an earlier run beside the files of this one, and nothing removed
//! that no run has made.
//!
//! While a run writes, its folder has a locked file. When the run ends, it leaves the list of the files that it wrote itself, in the
//! format of `sha256sum`. The next run removes those that it does not make again and that are as the list says: a file that was
//! changed since, or put there by somebody else, at any time, stays. The list names the folder that it was made in: a copy of it
//! elsewhere is nobody's list.

use std::collections::BTreeMap;
use std::fs::{File, Metadata, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use crate::atomic::write_atomically;
use crate::bytes;
use crate::folder::{FolderError, create_folder};
use crate::journal::{Journal, is_open};
use crate::sha256::file_sha256_hex;

/// Name of the file that is locked while a run writes.
const LOCK_NAME: &str = ".raypencil-lock";

/// Name of the list of files that a run has made.
const MADE_NAME: &str = ".raypencil-made";

/// Begin of its second line, which says what the files are of.
const SUBJECT: &str = "# results of ";

/// Maximum size of that list, bytes.
const MAX_MADE_BYTES: u64 = 1 << 26;

/// Depth of folders below the output folder that are looked at.
const MAX_DEPTH: usize = 6;

/// How often a lock is asked for that somebody has, before a run is taken to have it.
const LOOKS: u32 = 5;

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
    /// Files that an earlier run has made, with their digests.
    earlier: Vec<(PathBuf, String)>,
    /// What the results are of.
    subject: Option<String>,
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

    /// The same for a folder that may be a pack. One that is dropped without [`OutputFolder::finish`] leaves no list.
    ///
    /// # Errors
    /// As [`OutputFolder::begin`].
    pub fn begin_any(folder: &Path) -> Result<Self, FolderError> {
        let is_missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
        let made: Vec<PathBuf> = folder.ancestors().take_while(is_missing).map(PathBuf::from).collect();
        let cannot = |source| FolderError::Create { path: folder.to_path_buf(), source };
        // Before anything is made, so that a run that is refused leaves nothing.
        let there = folder.ancestors().find(|above| above.exists()).unwrap_or(Path::new("."));
        let whole = there.canonicalize().map_err(cannot)?;
        let own = usize::from(there == folder);
        if let Some(above) = whole.ancestors().skip(own).take(MAX_DEPTH).find(|above| has_run(above)) {
            return Err(FolderError::InUse { path: above.to_path_buf() });
        }
        create_folder(folder)?;
        let lock = lock(folder)?;
        let journal = Journal::begin(folder).map_err(cannot)?;
        let (before, earlier) = (BTreeMap::new(), Vec::new());
        let subject = None;
        let mut output = Self { folder: folder.to_path_buf(), made, lock, journal, before, earlier, subject };
        // No run that could be writing them is left.
        output.before = files_below(folder, &mut remove_part);
        output.earlier = made_earlier(folder);
        Ok(output)
    }

    /// The files that this run has written so far, by their paths in the folder, with their digests.
    pub fn written(&self) -> BTreeMap<PathBuf, String> {
        self.journal.written()
    }

    /// Removes the files of an earlier run that this one has not made again, and lists its own. A run that wrote nothing leaves
    /// no list.
    ///
    /// # Errors
    /// A file that cannot be removed, read or written.
    pub fn finish(self) -> Result<(), FolderError> {
        let now = files_below(&self.folder, &mut |_| {});
        let is_as_before =
            |name: &PathBuf| self.before.get(name).is_some_and(|stamp| now.get(name) == Some(stamp));
        for (name, sha256) in self.earlier.iter().filter(|(name, _)| is_as_before(name)) {
            let path = self.folder.join(name);
            if file_sha256_hex(&path).is_ok_and(|(_, found)| found == *sha256) {
                std::fs::remove_file(&path)
                    .map_err(|source| FolderError::RemoveEarlier { path: path.clone(), source })?;
                // Its folder too, if that was the last file.
                let inner = path.parent().filter(|parent| *parent != self.folder);
                inner.map(std::fs::remove_dir);
            }
        }
        let written = self.written();
        if written.is_empty() {
            let _ = std::fs::remove_file(self.folder.join(MADE_NAME));
            return Ok(());
        }
        let mut list = heading(&self.folder) + "\n";
        if let Some(subject) = &self.subject {
            list += &format!("{SUBJECT}{subject}\n");
        }
        for (name, sha256) in written.iter().filter(|(name, _)| now.contains_key(*name)) {
            let Some(text) = name.to_str().filter(|text| !text.contains('\n')) else { continue };
            list += &format!("{sha256}  {text}\n");
        }
        write_atomically(self.folder.join(MADE_NAME), |file| file.write_all(list.as_bytes()))?;
        Ok(())
    }
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        if self.lock.take().is_some() {
            // Removed while it is locked, so that nobody's lock is removed.
            let _ = std::fs::remove_file(self.folder.join(LOCK_NAME));
        }
        // A run that wrote nothing leaves no folder; one with files in it is not removed.
        for folder in &self.made {
            if std::fs::remove_dir(folder).is_err() {
                break;
            }
        }
    }
}

/// Age after which nobody is writing a half-written file of a run any more.
pub const MIN_ABANDONED_AGE: Duration = Duration::from_secs(600);

/// Removes what killed runs have left half-written below a folder, if nothing was written to it for `min_age`: for folders
/// that several runs share, so that none of them locks it.
pub fn remove_abandoned(folder: &Path, min_age: Duration) {
    files_below(folder, &mut |part| {
        let age = part.symlink_metadata().and_then(|found| found.modified()).ok();
        if age.and_then(|time| time.elapsed().ok()).is_some_and(|age| age >= min_age) {
            remove_part(part);
        }
    });
}

/// Removes a half-written file or folder.
fn remove_part(part: &Path) {
    // One that cannot be removed disturbs nobody: it has a name of its own.
    let is_folder = part.symlink_metadata().is_ok_and(|found| found.is_dir());
    let _ = if is_folder { std::fs::remove_dir_all(part) } else { std::fs::remove_file(part) };
}

fn lock(folder: &Path) -> Result<Option<File>, FolderError> {
    let path = folder.join(LOCK_NAME);
    // The file may vanish between its opening and its locking, when another run ends: then it is opened again.
    for attempt in 0..100 {
        // What is no file is not opened: a pipe would wait for its other end. No run has made it, so none ends with it.
        if std::fs::symlink_metadata(&path).is_ok_and(|found| !found.is_file()) {
            return Err(FolderError::NoLock { path });
        }
        let file = File::options()
            .create(true)
            .truncate(false)
            .write(true)
            .open(&path)
            .map_err(|source| FolderError::Create { path: folder.to_path_buf(), source })?;
        match file.try_lock() {
            Ok(()) => {}
            // Somebody may only be looking whether there is a run.
            Err(TryLockError::WouldBlock) if attempt < LOOKS => {
                std::thread::sleep(Duration::from_millis(2));
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

/// Whether another process's run is writing into this very folder.
fn has_run(folder: &Path) -> bool {
    let path = folder.join(LOCK_NAME);
    // What is no file is not opened: a pipe would wait for its other end.
    if !std::fs::symlink_metadata(&path).is_ok_and(|found| found.is_file()) || is_open(folder) {
        return false;
    }
    let file = File::options().write(true).open(&path);
    file.is_ok_and(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)))
}

/// What tells two files apart; the same for all where the system does not say.
fn identity(metadata: &Metadata) -> u64 {
    #[cfg(unix)]
    return std::os::unix::fs::MetadataExt::ino(metadata);
    #[cfg(not(unix))]
    return u64::from(metadata.is_dir());
}

/// The regular files below a folder, by their paths in it, without those of this module. Calls `part` for each half-written
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
            if text.starts_with(".raypencil-") {
                if text.ends_with(".part") {
                    part(&entry.path());
                }
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

/// The first line of a list: the folder that it was made in. A folder that is copied, or comes out of an archive, is another one;
/// where the system does not say, all are alike.
fn heading(folder: &Path) -> String {
    #[cfg(unix)]
    if let Ok(found) = std::fs::metadata(folder) {
        use std::os::unix::fs::MetadataExt as _;
        return format!("# made in folder {}:{}", found.dev(), found.ino());
    }
    let _ = folder;
    "# made in a folder".to_string()
}

/// The list of an earlier run in this folder: paths with digests. A path that leads out of the folder is none of the files found
/// below it, so nothing is done with it.
fn made_earlier(folder: &Path) -> Vec<(PathBuf, String)> {
    let Some(text) = own_list(folder) else { return Vec::new() };
    let line = |line: &str| {
        let (sha256, name) = line.split_once("  ")?;
        Some((PathBuf::from(name), sha256.to_string()))
    };
    text.lines().filter(|line| !line.starts_with('#')).filter_map(line).collect()
}

/// The text of the list in this folder, if it was made here.
fn own_list(folder: &Path) -> Option<String> {
    let text = bytes::read_file(&folder.join(MADE_NAME), MAX_MADE_BYTES).ok()?;
    let text = String::from_utf8_lossy(&text).into_owned();
    (text.lines().next() == Some(heading(folder).as_str())).then_some(text)
}

/// What the results in a folder are of, if a run has left some and said so, and one of its files is still as it was made.
pub fn subject_of(folder: &Path) -> Option<String> {
    let text = own_list(folder)?;
    let subject = text.lines().nth(1)?.strip_prefix(SUBJECT)?;
    let is_there = |(name, sha256): &(PathBuf, String)| {
        let is_inside = name.components().all(|part| matches!(part, std::path::Component::Normal(_)));
        is_inside && file_sha256_hex(&folder.join(name)).is_ok_and(|(_, found)| found == *sha256)
    };
    made_earlier(folder).iter().any(is_there).then(|| subject.to_string())
}

/// A text without line ends, for the list.
fn one_line(text: &str) -> String {
    text.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect()
}

#[cfg(test)]
#[path = "../tests/unit/output_folder.rs"]
mod tests;
