//! The list of the files that a run has made in a folder, with their digests, and what they are of.

use std::path::{Component, Path, PathBuf};

use crate::bytes;
use crate::sha256::file_sha256_hex;

/// Name of the list.
pub(crate) const MADE_NAME: &str = ".raypencil-made";

/// Begin of its second line, which says what the files are of.
const SUBJECT: &str = "# results of ";

/// Maximum size of a list, bytes.
const MAX_MADE_BYTES: u64 = 1 << 26;

/// A file by its path in the folder, with its digest.
pub(crate) type Entry = (PathBuf, String);

/// The first line of a list: the folder that it was made in. A folder that is copied, or comes out of an archive, is another one;
/// where the system does not say, all are alike.
pub(crate) fn heading(folder: &Path) -> String {
    #[cfg(unix)]
    if let Ok(found) = std::fs::metadata(folder) {
        use std::os::unix::fs::MetadataExt as _;
        return format!("# made in folder {}:{}", found.dev(), found.ino());
    }
    let _ = folder;
    "# made in a folder".to_string()
}

/// The text of a list.
pub(crate) fn text_of<'a>(
    folder: &Path,
    subject: Option<&str>,
    entries: impl Iterator<Item = (&'a PathBuf, &'a String)>,
) -> String {
    let mut list = heading(folder) + "\n";
    if let Some(subject) = subject {
        list += &format!("{SUBJECT}{subject}\n");
    }
    list.extend(entries.filter_map(|(name, sha256)| line(name, sha256)));
    list
}

/// The line of a file; a name that is no line has none.
pub(crate) fn line(name: &Path, sha256: &str) -> Option<String> {
    let text = name.to_str().filter(|text| !text.contains('\n'))?;
    Some(format!("{sha256}  {text}\n"))
}

/// The entries of a list that was made in this folder; of another one none. A path that leads out of the folder is none of the files
/// found below it, so nothing is done with it.
pub(crate) fn entries(folder: &Path, text: &str) -> Vec<Entry> {
    let Some(("", text)) = text.strip_prefix(&heading(folder)).and_then(|rest| rest.split_once('\n')) else {
        return Vec::new();
    };
    // The last line of one who died while writing it is no line.
    let whole = text.rsplit_once('\n').map_or("", |(whole, _)| whole);
    let entry = |line: &str| {
        let (sha256, name) = line.split_once("  ")?;
        Some((PathBuf::from(name), sha256.to_string()))
    };
    whole.lines().filter(|line| !line.starts_with('#')).filter_map(entry).collect()
}

/// The text of a list or of a lock; nothing if it cannot be read.
pub(crate) fn read(file: &Path) -> String {
    let read = bytes::read_file(file, MAX_MADE_BYTES).unwrap_or_default();
    String::from_utf8_lossy(&read).into_owned()
}

/// The list that an earlier run has left in this folder.
pub(crate) fn made_earlier(folder: &Path) -> Vec<Entry> {
    entries(folder, &read(&folder.join(MADE_NAME)))
}

/// What the list of a folder says that its files are of.
pub(crate) fn listed_subject(folder: &Path) -> Option<String> {
    let text = read(&folder.join(MADE_NAME));
    let mut lines = text.lines();
    let is_own = lines.next() == Some(heading(folder).as_str());
    lines.next().filter(|_| is_own)?.strip_prefix(SUBJECT).map(String::from)
}

/// What the results in a folder are of, if a run has left some and said so, and one of its files is still as it was made.
pub fn subject_of(folder: &Path) -> Option<String> {
    let subject = listed_subject(folder)?;
    let is_there = |(name, sha256): &Entry| {
        let is_inside = name.components().all(|part| matches!(part, Component::Normal(_)));
        is_inside && file_sha256_hex(&folder.join(name)).is_ok_and(|(_, found)| found == *sha256)
    };
    made_earlier(folder).iter().any(is_there).then_some(subject)
}

/// Whether a folder between this one and its file has a list of its own that names the file, and that the runs of these entries
/// have not made: then a later run has made the file there.
pub(crate) fn is_claimed_below(folder: &Path, name: &Path, entries: &[Entry]) -> bool {
    let between = name.ancestors().skip(1).filter(|above| !above.as_os_str().is_empty());
    let is_later = |above: &&Path| {
        let list = above.join(MADE_NAME);
        let found = file_sha256_hex(&folder.join(&list)).map(|(_, found)| found);
        found.is_ok_and(|found| !entries.iter().any(|(name, sha256)| *name == list && *sha256 == found))
    };
    between.filter(is_later).map(|above| (above, made_earlier(&folder.join(above)))).any(|(above, list)| {
        let inner = name.strip_prefix(above).ok();
        list.iter().any(|(listed, _)| Some(listed.as_path()) == inner)
    })
}
