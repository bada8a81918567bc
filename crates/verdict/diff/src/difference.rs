//! The difference of two recordings: structure, and the rule that decides whether it passes.

use std::path::PathBuf;

use raypencil_files::{Channels, Storage};

use crate::cells::{CellDifference, Thresholds};
use crate::rulings::Rulings;

/// Two recordings, A and B, with their names.
#[derive(Debug, Clone, Copy)]
pub struct Sides<'a> {
    /// Paths of A and B as the user typed them.
    pub names: [&'a str; 2],
    /// Channels of A and B.
    pub channels: [&'a Channels; 2],
}

/// Difference of two recordings.
#[derive(Debug, Clone)]
pub struct Difference {
    /// The channels that both sides have, sorted by key.
    pub channels: Vec<ChannelDifference>,
    /// Keys of the channels that only A has, and of those that only B has.
    pub only: [Vec<String>; 2],
    /// Allowed differences.
    pub thresholds: Thresholds,
    /// The referee's rulings, if there is a scene.
    pub rulings: Option<Rulings>,
}

/// Difference of one channel.
#[derive(Debug, Clone)]
pub struct ChannelDifference {
    /// Key of the channel, the same on both sides.
    pub key: String,
    /// Files of A and B.
    pub files: [PathBuf; 2],
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// The coarser of the two storages. Ulps are those of this storage.
    pub storage: Storage,
    /// Unit of the values, from the attributes of the files; empty if no file states it.
    pub unit: String,
    /// Number of cells whose values are not equal. NaN equals NaN, an infinity equals itself, -0 equals 0.
    pub unequal: u64,
    /// Number of cells whose difference no threshold allows.
    pub differing: u64,
    /// Number of unequal cells with a value that is not finite. They are counted in `differing`, too.
    pub incomparable: u64,
    /// Number of cells beyond the hard limit.
    pub beyond_hard: u64,
    /// Largest absolute difference of two finite numbers, in `unit`. `None` for whole numbers, which are equal or not.
    pub largest: Option<f64>,
    /// Largest difference in ulps of `storage`.
    pub largest_ulp: Option<f64>,
    /// Root mean square of the differences of finite numbers, in `unit`.
    pub rms: Option<f64>,
    /// Mean of the absolute differences of finite numbers, in `unit`.
    pub mean: Option<f64>,
    /// The first incomparable cell; without one, the cell with the largest difference; without that, the first unequal
    /// cell.
    pub worst: Option<CellDifference>,
    /// Whether the channel fails: too many cells differ, or a cell exceeds the hard limit.
    pub fails: bool,
}

impl ChannelDifference {
    /// Number of cells.
    pub fn cells(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Share of the cells that differ, percent.
    pub fn percent(&self) -> f64 {
        100.0 * self.differing as f64 / self.cells() as f64
    }
}

impl Difference {
    /// Whether no channel fails, and no channel is missing on one side (unless only shared channels count).
    pub fn passes(&self) -> bool {
        self.failing().next().is_none() && !self.fails_by_missing_channels()
    }

    /// The channels that fail.
    pub fn failing(&self) -> impl Iterator<Item = &ChannelDifference> {
        self.channels.iter().filter(|channel| channel.fails)
    }

    /// Adds the referee's rulings, which replace the thresholds of the channels that they concern.
    ///
    /// A channel the referee ruled on fails if either side is wrong, if a cell exceeds the hard limit, or if a cell
    /// could not be judged and the channel already failed its thresholds.
    pub fn with_rulings(mut self, rulings: Rulings) -> Self {
        for channel in &mut self.channels {
            if let Some(ruling) = rulings.channels.get(&channel.key) {
                let all_judged = ruling.not_judged == 0;
                channel.fails =
                    channel.beyond_hard > 0 || ruling.faults() > 0 || !all_judged && channel.fails;
            }
        }
        self.rulings = Some(rulings);
        self
    }

    /// Whether the comparison fails because a channel is on one side only.
    pub(crate) fn fails_by_missing_channels(&self) -> bool {
        !self.thresholds.shared_only && self.only.iter().any(|keys| !keys.is_empty())
    }
}
