//! A recording: channels by their keys.

use crate::values::{Storage, Values};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Cells of one quantity, as one file holds them.
#[derive(Debug, Clone)]
pub struct Channel {
    /// The file.
    pub file: PathBuf,
    /// Name of the channel inside the file, `PART/NAME` in a file of several parts. In an array it is the component (`X`, `0`),
    /// empty if there is only one.
    pub name: String,
    /// Number format in which the file stores the cells.
    pub storage: Storage,
    /// The cells.
    pub values: Values,
}

/// Contents of a recording.
#[derive(Debug, Clone, Default)]
pub struct Channels {
    /// The channels by their keys, such as `camera/range.T`: the finest of several under one key.
    pub by_key: BTreeMap<String, Channel>,
    /// The coarser channels with their keys. Each agrees with the finest to within half an ulp of its own storage.
    pub coarser: Vec<(String, Channel)>,
    /// Text attributes of each OpenEXR file.
    pub attributes: BTreeMap<PathBuf, BTreeMap<String, String>>,
    /// Every file that was read, ordered by key and path.
    pub files: Vec<PathBuf>,
    /// What of the declarations concerned a channel.
    pub used: Used,
}

/// What of the declarations about a recording concerned a channel of it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Used {
    /// Declared maps whose channel is there.
    pub maps: BTreeSet<String>,
    /// Whether whole numbers were scaled.
    pub scale: bool,
}

impl Channels {
    /// The channels as messages list them, those of each file together: their names in the file and their types.
    pub fn inventory(&self, root: &Path) -> String {
        let named = self.by_key.iter().map(|(key, channel)| (channel.name_in_file(key), channel));
        inventory(named, root)
    }
}

impl Channel {
    /// The name by which it can be declared to be a map: that of its file, if it is an array.
    pub fn name_in_file<'a>(&'a self, key: &'a str) -> &'a str {
        let is_exr = self.file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("exr"));
        if is_exr { &self.name } else { key.rsplit('/').next().unwrap_or(key) }
    }

    /// Bytes of the cells in their file, uncompressed. Whole numbers may take fewer there, never more.
    pub(super) fn stored_bytes(&self) -> u64 {
        let (width, height) = self.values.size();
        let bytes = match self.storage {
            Storage::F16 => 2,
            Storage::F32 | Storage::Whole | Storage::Steps(_) => 4,
            Storage::F64 => 8,
        };
        u64::from(width) * u64::from(height) * bytes
    }
}

/// The channels of a recording as messages list them: those of each file together.
pub(super) fn inventory<'a>(
    channels: impl IntoIterator<Item = (&'a str, &'a Channel)>,
    root: &Path,
) -> String {
    let mut files: Vec<(String, Vec<String>)> = Vec::new();
    for (name, channel) in channels {
        let file = channel.file.strip_prefix(root).ok().filter(|path| !path.as_os_str().is_empty());
        let file = match file {
            Some(path) => path.display().to_string(),
            None => channel.file.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        };
        let (width, height) = channel.values.size();
        let head = format!("{file} ({width} x {height})");
        let words = match channel.storage {
            Storage::Whole => format!("{name} (whole numbers)"),
            storage => format!("{name} ({storage})"),
        };
        match files.iter_mut().find(|(other, _)| *other == head) {
            Some((_, names)) => names.push(words),
            None => files.push((head, vec![words])),
        }
    }
    let files: Vec<String> =
        files.into_iter().map(|(file, names)| format!("{file}: {}", names.join(", "))).collect();
    files.join("; ")
}
