//! Cells as files hold them: planes of one size, widened exactly, and the format in which they were stored.

use raypencil_scene::Image;

/// Distance of neighbouring numbers that are stored as multiples of it: positive and finite. Of two, the larger one is the
/// coarser, and comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    /// Bits of the number: those of positive numbers are in their order.
    bits: u64,
}

impl Step {
    /// A step; `None` unless it is positive and finite.
    pub fn new(step: f64) -> Option<Self> {
        (step > 0.0 && step.is_finite()).then_some(Self { bits: step.to_bits() })
    }

    /// The number.
    pub fn get(self) -> f64 {
        f64::from_bits(self.bits)
    }
}

impl Ord for Step {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        other.bits.cmp(&self.bits)
    }
}

impl PartialOrd for Step {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// Number format in which a file stores the cells of a channel. The coarser comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Storage {
    /// Multiples of a step, metres: lengths as whole numbers, such as millimetres in 16 bits.
    Steps(Step),
    /// IEEE 754 half precision.
    F16,
    /// IEEE 754 single precision.
    F32,
    /// IEEE 754 double precision.
    F64,
    /// Integers or truth values, of any width.
    Whole,
}

impl Storage {
    /// The largest finite number; infinity for whole numbers, which are not rounded to a largest one.
    ///
    /// ```
    /// use raypencil_files::Storage;
    ///
    /// // Half precision: (2 - 2^-10) 2^15. A range beyond it is stored as infinity, which means "no hit".
    /// assert_eq!(Storage::F16.max(), 65504.0);
    /// assert_eq!(Storage::F32.max(), f64::from(f32::MAX));
    /// ```
    pub fn max(self) -> f64 {
        match self {
            Self::F16 => 65504.0,
            Self::F32 => f64::from(f32::MAX),
            Self::F64 => f64::MAX,
            // Numbers beyond the type of the file were cut off before anybody reads them.
            Self::Whole | Self::Steps(_) => f64::INFINITY,
        }
    }

    /// The first of the whole numbers that another one may be rounded to: 2^(d + 1) for d digits after the leading
    /// one. `None` if each whole number up to 2^32 is stored as itself.
    ///
    /// ```
    /// use raypencil_files::Storage;
    ///
    /// // In half precision 2049 is rounded to 2048; in single precision 2^24 + 1 to 2^24.
    /// assert_eq!(Storage::F16.first_ambiguous_whole(), Some(2048));
    /// assert_eq!(Storage::F32.first_ambiguous_whole(), Some(16_777_216));
    /// ```
    pub fn first_ambiguous_whole(self) -> Option<u32> {
        match self {
            Self::F16 => Some(1 << 11),
            Self::F32 => Some(1 << 24),
            Self::F64 | Self::Whole | Self::Steps(_) => None,
        }
    }

    /// The storage in the words of reports, if it is coarser than single precision: `half precision`, `steps of 0.001 m`.
    ///
    /// ```
    /// use raypencil_files::{Step, Storage};
    ///
    /// assert_eq!(Storage::F16.coarse_words().as_deref(), Some("half precision"));
    /// let millimetres = Storage::Steps(Step::new(0.001).unwrap());
    /// assert_eq!(millimetres.coarse_words().as_deref(), Some("steps of 0.001 m"));
    /// assert_eq!(Storage::F32.coarse_words(), None);
    /// ```
    pub fn coarse_words(self) -> Option<String> {
        match self {
            Self::F16 => Some("half precision".into()),
            Self::Steps(_) => Some(self.to_string()),
            Self::F32 | Self::F64 | Self::Whole => None,
        }
    }

    /// Distance from `value`, a number of this storage, to the next one away from 0, in the unit of `value`.
    ///
    /// The largest finite number has the distance to its neighbour nearer to 0. The distance of whole numbers is 1.
    /// NaN if `value` is not finite, or if it is no whole number where the storage holds only those.
    ///
    /// ```
    /// use raypencil_files::Storage;
    ///
    /// // Single precision has 23 digits after the leading one; 4 = 2^2 is followed by 4 + 2^(2 - 23).
    /// assert_eq!(Storage::F32.ulp(4.0), 1.0 / 2_097_152.0);
    /// assert_eq!(Storage::F32.ulp(4.0), f64::from(4.0_f32.next_up()) - 4.0);
    /// ```
    pub fn ulp(self, value: f64) -> f64 {
        // Digits after the leading one, and the exponent of the smallest normal number. (IEEE 754, table 3.5)
        let (digits, least) = match self {
            Self::F16 => (10, -14),
            Self::F32 => (23, -126),
            Self::F64 => (52, -1022),
            Self::Steps(step) => return if value.is_finite() { step.get() } else { f64::NAN },
            Self::Whole => {
                return if value.is_finite() && libm::trunc(value) == value { 1.0 } else { f64::NAN };
            }
        };
        if !value.is_finite() {
            return f64::NAN;
        }
        // The exponent of the leading digit. Subnormal numbers are as far apart as the smallest normal ones.
        let exponent = if value == 0.0 { least } else { libm::ilogb(value).max(least) };
        libm::scalbn(1.0, exponent - digits)
    }
}

impl std::fmt::Display for Storage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Steps(step) => return write!(f, "steps of {} m", step.get()),
            Self::F16 => "half",
            Self::F32 => "single",
            Self::F64 => "double",
            Self::Whole => "whole",
        })
    }
}

/// Cells of a channel, row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Real numbers, widened exactly.
    Reals(Image<f64>),
    /// Whole numbers; 4294967295 means "none".
    Wholes(Image<u32>),
}

impl Values {
    /// Columns and rows.
    pub fn size(&self) -> (u32, u32) {
        match self {
            Self::Reals(image) => (image.width(), image.height()),
            Self::Wholes(image) => (image.width(), image.height()),
        }
    }

    /// The number in cell `index`, counted row by row, as f64; exact for both kinds.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn real(&self, index: usize) -> f64 {
        match self {
            Self::Reals(image) => image.cells()[index],
            Self::Wholes(image) => f64::from(image.cells()[index]),
        }
    }
}

/// Contents of an NPY or PFM file.
#[derive(Debug, Clone, PartialEq)]
pub struct Array {
    /// Number format in the file.
    pub storage: Storage,
    /// One plane for each component, all of the same size; at least one.
    pub planes: Vec<Values>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ulp_is_the_distance_to_the_next_number() {
        for value in [1.0_f32, 1.5, 2.0, 1e-45, 3e-39, 1e30, f32::MIN_POSITIVE] {
            let next = f64::from(f32::from_bits(value.to_bits() + 1)) - f64::from(value);
            assert_eq!(Storage::F32.ulp(value.into()), next, "{value}");
            assert_eq!(Storage::F32.ulp(-f64::from(value)), next, "{value}");
        }
        for value in [1.0_f64, 0.1, 5e-324, 1e300] {
            assert_eq!(Storage::F64.ulp(value), f64::from_bits(value.to_bits() + 1) - value, "{value}");
        }
        // Half precision: 1 + 2^-10 follows 1, the subnormal numbers are multiples of 2^-24.
        assert_eq!(Storage::F16.ulp(1.0), 1.0 / 1024.0);
        assert_eq!(Storage::F16.ulp(0.0), 1.0 / 16_777_216.0);
        assert_eq!(Storage::F32.ulp(f64::from(f32::MAX)), (0..104).fold(1.0, |power, _| 2.0 * power));
        assert!(Storage::F32.ulp(f64::INFINITY).is_nan() && Storage::F64.ulp(f64::NAN).is_nan());
        assert_eq!(Storage::Whole.ulp(7.0), 1.0);
        assert!(Storage::Whole.ulp(7.5).is_nan());
        let steps = |step| Storage::Steps(Step::new(step).unwrap());
        assert_eq!(steps(0.001).ulp(3.2), 0.001);
        // From 2^(digits + 1) on the next whole number is another one's.
        assert_eq!(Storage::F16.first_ambiguous_whole(), Some(2048));
        assert_eq!(Storage::F32.first_ambiguous_whole(), Some(16_777_216));
        assert_eq!([Storage::F16, Storage::F32].map(|storage| storage.ulp(2048.0)), [2.0, 1.0 / 4096.0]);
        // The coarser comes first: centimetres before millimetres, both before half precision.
        assert!(steps(0.01) < steps(0.001) && steps(0.001) < Storage::F16);
        assert_eq!([0.0, -1.0, f64::NAN, f64::INFINITY].map(Step::new), [None; 4]);
    }
}
