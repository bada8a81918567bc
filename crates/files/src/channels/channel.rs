//! A recording: channels by their keys.

use std::collections::BTreeMap;
use std::path::PathBuf;

use crate::values::{Storage, Values};

/// Cells of one quantity, as one file holds them.
#[derive(Debug, Clone)]
pub struct Channel {
    /// The file.
    pub file: PathBuf,
    /// Name of the channel inside the file. In an array it is the component (`X`, `0`), empty if there is only one.
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
}

impl Channel {
    /// Bytes of the cells in their file, uncompressed. Whole numbers may take fewer there, never more.
    pub(super) fn stored_bytes(&self) -> u64 {
        let (width, height) = self.values.size();
        let bytes = match self.storage {
            Storage::F16 => 2,
            Storage::F32 | Storage::Whole => 4,
            Storage::F64 => 8,
        };
        u64::from(width) * u64::from(height) * bytes
    }
}
