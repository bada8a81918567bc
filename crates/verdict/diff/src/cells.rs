//! The rule for one cell, and the statistics of one channel's cells.

use raypencil_files::{Storage, Values};

/// Allowed differences. A cell passes if *any* of `fail`, `fail_relative` and `fail_ulp` allows its difference. All are
/// 0 by default, which allows none.
///
/// ```
/// use std::path::PathBuf;
///
/// use raypencil_diff::{Thresholds, diff};
/// use raypencil_files::{Channel, Channels, Storage, Values};
/// use raypencil_scene::Image;
///
/// let recording = |range: f64| {
///     let values = Values::Reals(Image::filled(1, 1, range));
///     let channel = Channel { file: PathBuf::new(), name: String::new(), storage: Storage::F32, values };
///     Channels { by_key: [("camera/range.T".into(), channel)].into(), ..Channels::default() }
/// };
/// let passes = |thresholds| diff(&recording(8.0), &recording(8.5), &thresholds).is_ok_and(|found| found.passes());
/// // |8.5 - 8| = 0.5, and 0.5 / 8.5 = 0.0588...: one threshold that allows the cell is enough.
/// assert!(!passes(Thresholds::default()));
/// assert!(passes(Thresholds { fail: 0.5, ..Thresholds::default() }));
/// assert!(passes(Thresholds { fail_relative: 0.059, fail: 1e-9, ..Thresholds::default() }));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Thresholds {
    /// Absolute difference, in the channel's unit.
    pub fail: f64,
    /// Difference relative to the larger magnitude of the two numbers.
    pub fail_relative: f64,
    /// Difference in ulps of the coarser storage of the two, at the larger magnitude.
    pub fail_ulp: f64,
    /// Share of a channel's cells that may differ by more than the above, percent.
    pub fail_percent: f64,
    /// Absolute difference that no cell of real numbers may exceed, in the channel's unit, whatever else is allowed.
    pub hard_fail: Option<f64>,
    /// Whether a channel that only one side has is ignored. Otherwise it is a failure.
    pub shared_only: bool,
}

/// A cell and the values of both sides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellDifference {
    /// Column.
    pub i: u32,
    /// Row; row 0 is at the top.
    pub j: u32,
    /// Value of side A.
    pub a: f64,
    /// Value of side B.
    pub b: f64,
}

/// Comparison of two numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Comparison {
    /// Equal: NaN equals NaN, an infinity equals itself, -0 equals 0.
    Equal,
    /// Two finite numbers and their absolute difference.
    Apart(f64),
    /// Unequal, and at least one is not finite. No threshold allows that.
    Incomparable,
}

pub(crate) fn compare_numbers(a: f64, b: f64) -> Comparison {
    if a == b || a.is_nan() && b.is_nan() {
        Comparison::Equal
    } else if a.is_finite() && b.is_finite() {
        Comparison::Apart((a - b).abs())
    } else {
        Comparison::Incomparable
    }
}

impl Thresholds {
    /// Whether the difference of two finite numbers passes. `ulp` is the unit of `fail_ulp`.
    pub(crate) fn allow(&self, a: f64, b: f64, difference: f64, ulp: f64) -> bool {
        difference <= self.fail
            || difference <= self.fail_relative * a.abs().max(b.abs())
            || difference <= self.fail_ulp * ulp
    }
}

/// Statistics of a channel's cells. [`crate::ChannelDifference`] describes the fields.
#[derive(Debug, Default)]
pub(crate) struct CellStatistics {
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

/// The number in a cell, as it is compared with the one `beside` it. "None" of whole numbers is NaN beside a channel of reals, where
/// it has no other form.
pub(crate) fn number(values: &Values, beside: &Values, index: usize) -> f64 {
    match (values, beside) {
        (Values::Wholes(whole), Values::Reals(real))
            if whole.cells()[index] == u32::MAX && real.cells()[index].is_nan() =>
        {
            f64::NAN
        }
        _ => values.real(index),
    }
}

/// Compares all cells of two channels of the same size, row by row.
pub(crate) fn compare_cells(
    a: &Values,
    b: &Values,
    storage: Storage,
    thresholds: &Thresholds,
) -> CellStatistics {
    let (width, height) = a.size();
    let mut found = CellStatistics::default();
    let cell = |index: usize| CellDifference {
        i: (index % width as usize) as u32,
        j: (index / width as usize) as u32,
        a: a.real(index),
        b: b.real(index),
    };
    let cells = width as usize * height as usize;
    if storage == Storage::Whole {
        // Indices and truth values are equal or not; the size of their difference has no meaning.
        for index in (0..cells).filter(|&index| a.real(index) != b.real(index)) {
            found.unequal += 1;
            found.worst.get_or_insert_with(|| cell(index));
        }
        found.differing = found.unequal;
        return found;
    }

    let (mut finite, mut sum, mut squares) = (0_u64, 0.0, 0.0);
    let (mut largest, mut largest_ulp) = (0.0_f64, 0.0_f64);
    let (mut first_incomparable, mut index_of_largest) = (None, None);
    for index in 0..cells {
        let (x, y) = (number(a, b, index), number(b, a, index));
        match compare_numbers(x, y) {
            Comparison::Equal => finite += u64::from(x.is_finite()),
            Comparison::Incomparable => {
                found.unequal += 1;
                found.incomparable += 1;
                first_incomparable.get_or_insert(index);
            }
            Comparison::Apart(difference) => {
                finite += 1;
                found.unequal += 1;
                let ulp = storage.ulp(x.abs().max(y.abs()));
                found.differing += u64::from(!thresholds.allow(x, y, difference, ulp));
                found.beyond_hard += u64::from(thresholds.hard_fail.is_some_and(|limit| difference > limit));
                // Strictly larger: of equal differences the first one stays.
                if difference > largest {
                    (largest, index_of_largest) = (difference, Some(index));
                }
                largest_ulp = largest_ulp.max(difference / ulp);
                sum += difference;
                squares += difference * difference;
            }
        }
    }
    found.differing += found.incomparable;
    if thresholds.hard_fail.is_some() {
        found.beyond_hard += found.incomparable;
    }
    if finite > 0 {
        found.largest = Some(largest);
        found.largest_ulp = Some(largest_ulp);
        found.mean = Some(sum / finite as f64);
        found.rms = Some((squares / finite as f64).sqrt());
    }
    found.worst = first_incomparable.or(index_of_largest).map(cell);
    found
}
