//! Compares two recordings channel by channel. `docs/guide/diff.md` has the rules.

use std::path::PathBuf;

use raypencil_files::{Channel, Channels};

use crate::cells::{Thresholds, compare_cells};
use crate::difference::{ChannelDifference, Difference};
use crate::unit::unit_of;

/// Why two recordings cannot be compared.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DiffError {
    /// A channel whose sizes differ.
    #[error(
        "channel `{key}`: {} has {} x {} cells, {} has {} x {}; expected the same size",
        files[0].display(), sizes[0].0, sizes[0].1, files[1].display(), sizes[1].0, sizes[1].1
    )]
    Sizes {
        /// Key of the channel.
        key: String,
        /// Files of A and B.
        files: Box<[PathBuf; 2]>,
        /// Columns and rows in A and B.
        sizes: [(u32, u32); 2],
    },
    /// No channel is on both sides.
    #[error(
        "no channel is in both: A has {a}, B has {b}; expected the same names, as of two folders or two files"
    )]
    NothingShared {
        /// Some keys of A, as text.
        a: String,
        /// Some keys of B, as text.
        b: String,
    },
}

/// Compares every channel that both recordings have.
///
/// ```
/// use std::path::PathBuf;
///
/// use raypencil_diff::{Thresholds, diff};
/// use raypencil_files::{Channel, Channels, Storage, Values};
/// use raypencil_scene::Image;
///
/// let recording = |cells: &[f64]| {
///     let values = Values::Reals(Image::from_cells(cells.len() as u32, 1, cells.to_vec()));
///     let channel = Channel { file: PathBuf::new(), name: String::new(), storage: Storage::F64, values };
///     Channels { by_key: [("camera/range.T".into(), channel)].into(), ..Channels::default() }
/// };
/// let (a, b) = (recording(&[1.0, 2.0, f64::NAN]), recording(&[1.0, 2.5, f64::NAN]));
/// let difference = diff(&a, &b, &Thresholds::default())?;
/// // Differences 0 and 0.5; NaN equals NaN and has no part in the mean: (0 + 0.5) / 2.
/// let channel = &difference.channels[0];
/// assert_eq!((channel.unequal, channel.largest, channel.mean), (1, Some(0.5), Some(0.25)));
/// assert!(!difference.passes());
/// # Ok::<(), raypencil_diff::DiffError>(())
/// ```
///
/// # Errors
/// A channel whose sizes differ; no channel on both sides.
pub fn diff(a: &Channels, b: &Channels, thresholds: &Thresholds) -> Result<Difference, DiffError> {
    let mut channels = Vec::new();
    for (key, of_a) in &a.by_key {
        let Some(of_b) = b.by_key.get(key) else { continue };
        let unit = unit_of([a, b], key);
        channels.push(compare_channel(key, of_a, of_b, unit, thresholds)?);
    }
    if channels.is_empty() {
        return Err(DiffError::NothingShared { a: some_keys(a), b: some_keys(b) });
    }
    let missing = |one: &Channels, other: &Channels| -> Vec<String> {
        one.by_key.keys().filter(|key| !other.by_key.contains_key(*key)).cloned().collect()
    };
    Ok(Difference { channels, only: [missing(a, b), missing(b, a)], thresholds: *thresholds, rulings: None })
}

fn compare_channel(
    key: &str,
    a: &Channel,
    b: &Channel,
    unit: String,
    thresholds: &Thresholds,
) -> Result<ChannelDifference, DiffError> {
    let sizes = [a.values.size(), b.values.size()];
    let files = [a.file.clone(), b.file.clone()];
    if sizes[0] != sizes[1] {
        return Err(DiffError::Sizes { key: key.to_string(), files: Box::new(files), sizes });
    }
    let (width, height) = sizes[0];
    // Whole numbers are exact. Beside a channel of reals, the reals are the coarser storage.
    let storage = a.storage.min(b.storage);
    let found = compare_cells(&a.values, &b.values, storage, thresholds);
    let mut difference = ChannelDifference {
        key: key.to_string(),
        files,
        width,
        height,
        storage,
        unit,
        unequal: found.unequal,
        differing: found.differing,
        incomparable: found.incomparable,
        beyond_hard: found.beyond_hard,
        largest: found.largest,
        largest_ulp: found.largest_ulp,
        rms: found.rms,
        mean: found.mean,
        worst: found.worst,
        fails: false,
    };
    // Compare products, not quotients: with 0 percent no cell may differ.
    let too_many = 100.0 * difference.differing as f64 > thresholds.fail_percent * difference.cells() as f64;
    difference.fails = too_many || difference.beyond_hard > 0;
    Ok(difference)
}

/// The first keys of a recording, for a message.
fn some_keys(channels: &Channels) -> String {
    const MAX_LISTED_KEYS: usize = 4;
    let keys: Vec<&str> = channels.by_key.keys().take(MAX_LISTED_KEYS).map(String::as_str).collect();
    match channels.by_key.len().saturating_sub(MAX_LISTED_KEYS) {
        0 => keys.join(", "),
        more => format!("{} and {more} more", keys.join(", ")),
    }
}
