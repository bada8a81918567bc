//! Two recordings of anything, channel by channel: what differs, by how much, and whether that is allowed.
//! `docs/guide/diff.md` has the rules.
//!
//! ```text
//! diff        two sets of channels -> Difference; no scene, no referee
//! cells       the rule for one cell, the numbers of one channel
//! unit        what an EXR's attributes say of a channel's unit
//! ruled       who is right, where there is a scene to ask about
//! screen      for people at a terminal
//! summary     for programs
//! report      for people: pictures of what differs
//! junit       for CI
//! folder      the files of a comparison
//! ```

use std::path::PathBuf;
use thiserror::Error;

use raypencil_files::{Channel, Channels, Storage};

use crate::cells::{self, CellDifference, Thresholds};
use crate::ruled::Rulings;
use crate::unit;

/// Two recordings and how people name them.
#[derive(Debug, Clone, Copy)]
pub struct Sides<'a> {
    /// What was given for A and for B.
    pub names: [&'a str; 2],
    /// What was read there.
    pub channels: [&'a Channels; 2],
}

/// What differs between two recordings.
#[derive(Debug, Clone)]
pub struct Difference {
    /// The channels that both have, by key.
    pub channels: Vec<ChannelDifference>,
    /// Keys that only A has, and only B.
    pub only: [Vec<String>; 2],
    /// What was allowed.
    pub thresholds: Thresholds,
    /// What the referee says, if it was asked.
    pub rulings: Option<Rulings>,
}

/// What differs in one channel.
#[derive(Debug, Clone)]
pub struct ChannelDifference {
    /// The channel's key in both.
    pub key: String,
    /// The file of A and of B.
    pub files: [PathBuf; 2],
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The coarser of the two storages: that of the ulps.
    pub storage: Storage,
    /// The unit of the values, if a file says one; else nothing.
    pub unit: String,
    /// Cells that are not the same number. NaN is the same as NaN, an infinity as itself, -0 as 0.
    pub unequal: u64,
    /// Cells that differ by more than any threshold allows.
    pub differing: u64,
    /// Of those, cells of which one is no finite number, and the other is not the same.
    pub incomparable: u64,
    /// Cells beyond the hard limit.
    pub beyond_hard: u64,
    /// The largest absolute difference of two finite numbers, in the unit; `None` for whole numbers, which
    /// are equal or not.
    pub largest: Option<f64>,
    /// The largest difference in ulps of the coarser storage.
    pub largest_ulp: Option<f64>,
    /// Root of the mean square of the differences of finite numbers, in the unit.
    pub rms: Option<f64>,
    /// Mean of the absolute differences of finite numbers, in the unit.
    pub mean: Option<f64>,
    /// The cell to look at: the first incomparable one, else the one with the largest difference, else the
    /// first that is unequal.
    pub worst: Option<CellDifference>,
    /// Whether too many cells differ, or one beyond the hard limit.
    pub fails: bool,
}

impl ChannelDifference {
    /// How many cells it has.
    pub fn cells(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// The share of cells that differ, percent.
    pub fn percent(&self) -> f64 {
        100.0 * self.differing as f64 / self.cells() as f64
    }
}

impl Difference {
    /// Whether nothing fails.
    pub fn passes(&self) -> bool {
        self.failing().next().is_none() && !self.lacks()
    }

    /// The channels that fail.
    pub fn failing(&self) -> impl Iterator<Item = &ChannelDifference> {
        self.channels.iter().filter(|channel| channel.fails)
    }

    /// Takes up what the referee says: of a channel that it ruled on, a side that is wrong
    /// fails, and what is beyond the hard limit; and what cannot be told, if it is not allowed.
    pub fn ruled(mut self, rulings: Rulings) -> Self {
        for channel in &mut self.channels {
            if let Some(ruling) = rulings.channels.get(&channel.key) {
                let is_known = ruling.not_judged == 0;
                channel.fails = channel.beyond_hard > 0 || ruling.faults() > 0 || !is_known && channel.fails;
            }
        }
        self.rulings = Some(rulings);
        self
    }

    /// Whether a channel that only one side has fails the comparison.
    pub(crate) fn lacks(&self) -> bool {
        !self.thresholds.shared_only && self.only.iter().any(|keys| !keys.is_empty())
    }
}

/// Why two recordings cannot be compared.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum DiffError {
    /// A channel that has another size in each.
    #[error(
        "channel `{key}`: {} has {} x {} cells, {} has {} x {}; expected the same size",
        files[0].display(), sizes[0].0, sizes[0].1, files[1].display(), sizes[1].0, sizes[1].1
    )]
    Sizes {
        /// The channel.
        key: String,
        /// The files of A and of B.
        files: Box<[PathBuf; 2]>,
        /// Their columns and rows.
        sizes: [(u32, u32); 2],
    },
    /// No channel that both have.
    #[error(
        "no channel is in both: A has {a}, B has {b}; expected the same names, as of two folders or two files"
    )]
    NothingShared {
        /// Some keys of A.
        a: String,
        /// Some keys of B.
        b: String,
    },
}

/// Compares every channel that both recordings have.
///
/// # Errors
/// Channels of different sizes, or none that both have.
pub fn diff(a: &Channels, b: &Channels, thresholds: &Thresholds) -> Result<Difference, DiffError> {
    let mut channels = Vec::new();
    for (key, of_a) in &a.by_key {
        let Some(of_b) = b.by_key.get(key) else { continue };
        let unit = unit::of([a, b], key);
        channels.push(compare(key, of_a, of_b, unit, thresholds)?);
    }
    if channels.is_empty() {
        return Err(DiffError::NothingShared { a: some(a), b: some(b) });
    }
    let lacking = |one: &Channels, other: &Channels| -> Vec<String> {
        one.by_key.keys().filter(|key| !other.by_key.contains_key(*key)).cloned().collect()
    };
    Ok(Difference { channels, only: [lacking(a, b), lacking(b, a)], thresholds: *thresholds, rulings: None })
}

fn compare(
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
    // Whole numbers are exact, so a real channel beside them is the coarser one.
    let storage = a.storage.min(b.storage);
    let numbers = cells::compare(&a.values, &b.values, storage, thresholds);
    let mut difference = ChannelDifference {
        key: key.to_string(),
        files,
        width,
        height,
        storage,
        unit,
        unequal: numbers.unequal,
        differing: numbers.differing,
        incomparable: numbers.incomparable,
        beyond_hard: numbers.beyond_hard,
        largest: numbers.largest,
        largest_ulp: numbers.largest_ulp,
        rms: numbers.rms,
        mean: numbers.mean,
        worst: numbers.worst,
        fails: false,
    };
    // Products, so that 0 percent is exactly none.
    let too_many = 100.0 * difference.differing as f64 > thresholds.fail_percent * difference.cells() as f64;
    difference.fails = too_many || difference.beyond_hard > 0;
    Ok(difference)
}

/// A few keys, for a message.
fn some(channels: &Channels) -> String {
    const LISTED: usize = 4;
    let keys: Vec<&str> = channels.by_key.keys().take(LISTED).map(String::as_str).collect();
    match channels.by_key.len().saturating_sub(LISTED) {
        0 => keys.join(", "),
        more => format!("{} and {more} more", keys.join(", ")),
    }
}
