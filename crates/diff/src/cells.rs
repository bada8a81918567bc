//! The rule for one cell, and what a channel's cells add up to.

use raypencil_files::{Storage, Values};

/// What may differ. A cell passes if *any* of the first three allows its difference; all are 0 by default,
/// which allows nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Thresholds {
    /// An absolute difference, in the channel's own unit.
    pub fail: f64,
    /// A difference relative to the larger magnitude of the two numbers.
    pub fail_relative: f64,
    /// A difference in ulps of the coarser storage of the two, at the larger magnitude.
    pub fail_ulp: f64,
    /// The share of differing cells that is allowed in a channel, percent.
    pub fail_percent: f64,
    /// An absolute difference that no cell of reals may exceed, whatever else is allowed.
    pub hard_fail: Option<f64>,
    /// Whether channels that only one side has are no failure.
    pub shared_only: bool,
}

/// A cell and what both sides have there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellDifference {
    /// Column.
    pub i: u32,
    /// Row; 0 is on top.
    pub j: u32,
    /// A's value.
    pub a: f64,
    /// B's value.
    pub b: f64,
}

/// How two numbers of a cell differ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Differs {
    /// Not at all: NaN is NaN, an infinity is itself, -0 is 0.
    Same,
    /// By this absolute difference of two finite numbers.
    By(f64),
    /// One is no finite number, and the other is not the same: no threshold allows that.
    Incomparable,
}

/// Compares two numbers.
pub(crate) fn differs(a: f64, b: f64) -> Differs {
    if a == b || a.is_nan() && b.is_nan() {
        Differs::Same
    } else if a.is_finite() && b.is_finite() {
        Differs::By((a - b).abs())
    } else {
        Differs::Incomparable
    }
}

impl Thresholds {
    /// Whether a difference `by` of two finite numbers passes; `ulp` is the unit of the third threshold.
    pub(super) fn allow(&self, a: f64, b: f64, by: f64, ulp: f64) -> bool {
        by <= self.fail || by <= self.fail_relative * a.abs().max(b.abs()) || by <= self.fail_ulp * ulp
    }
}

/// The numbers of a channel; see [`crate::difference::diff::ChannelDifference`].
#[derive(Debug, Default)]
pub(super) struct Numbers {
    pub unequal: u64,
    pub differing: u64,
    pub incomparable: u64,
    pub beyond_hard: u64,
    pub largest: Option<f64>,
    pub largest_ulp: Option<f64>,
    pub rms: Option<f64>,
    pub mean: Option<f64>,
    pub worst: Option<CellDifference>,
}

/// Goes through all cells of two channels of one size, row by row.
pub(super) fn compare(a: &Values, b: &Values, storage: Storage, thresholds: &Thresholds) -> Numbers {
    let (width, height) = a.size();
    let mut numbers = Numbers::default();
    let cell = |index: usize| CellDifference {
        i: (index % width as usize) as u32,
        j: (index / width as usize) as u32,
        a: a.real(index),
        b: b.real(index),
    };
    let cells = width as usize * height as usize;
    if storage == Storage::Whole {
        // Indices and truth values: how far apart two of them are means nothing.
        for index in (0..cells).filter(|&index| a.real(index) != b.real(index)) {
            numbers.unequal += 1;
            numbers.worst.get_or_insert_with(|| cell(index));
        }
        numbers.differing = numbers.unequal;
        return numbers;
    }

    let (mut finite, mut sum, mut squares) = (0_u64, 0.0, 0.0);
    let (mut largest, mut largest_ulp) = (0.0_f64, 0.0_f64);
    let (mut first_incomparable, mut farthest) = (None, None);
    for index in 0..cells {
        let (x, y) = (a.real(index), b.real(index));
        match differs(x, y) {
            Differs::Same => finite += u64::from(x.is_finite()),
            Differs::Incomparable => {
                numbers.unequal += 1;
                numbers.incomparable += 1;
                first_incomparable.get_or_insert(index);
            }
            Differs::By(by) => {
                finite += 1;
                numbers.unequal += 1;
                let ulp = storage.ulp(x.abs().max(y.abs()));
                numbers.differing += u64::from(!thresholds.allow(x, y, by, ulp));
                numbers.beyond_hard += u64::from(thresholds.hard_fail.is_some_and(|most| by > most));
                // Strictly larger: of equals the first stays.
                if by > largest {
                    (largest, farthest) = (by, Some(index));
                }
                largest_ulp = largest_ulp.max(by / ulp);
                sum += by;
                squares += by * by;
            }
        }
    }
    numbers.differing += numbers.incomparable;
    if thresholds.hard_fail.is_some() {
        numbers.beyond_hard += numbers.incomparable;
    }
    if finite > 0 {
        numbers.largest = Some(largest);
        numbers.largest_ulp = Some(largest_ulp);
        numbers.mean = Some(sum / finite as f64);
        numbers.rms = Some((squares / finite as f64).sqrt());
    }
    numbers.worst = first_incomparable.or(farthest).map(cell);
    numbers
}
