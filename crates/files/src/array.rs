//! Numbers of cells as array files hold them: planes of one size, widened exactly, and how they were stored.

use std::io::Write;

use crate::error::Fault;
use crate::limits::Limits;
use raypencil_scene::Image;

/// How a file stores the cells of a channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Storage {
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
    /// The distance, in the unit of `value`, from `value` (which this storage holds) to the next number of
    /// this storage away from 0; that of the largest finite number where there is none further out. NaN for
    /// what is not finite, and for whole numbers, whose distance is 1, if `value` is none.
    pub fn ulp(self, value: f64) -> f64 {
        // Digits after the leading one, and the exponent of the smallest normal number. (IEEE 754, table 3.5)
        let (digits, least) = match self {
            Self::F16 => (10, -14),
            Self::F32 => (23, -126),
            Self::F64 => (52, -1022),
            Self::Whole => {
                return if value.is_finite() && libm::trunc(value) == value { 1.0 } else { f64::NAN };
            }
        };
        if !value.is_finite() {
            return f64::NAN;
        }
        // The exponent of the leading digit; the numbers below the smallest normal one are as far apart as
        // those just above it.
        let exponent = if value == 0.0 { least } else { libm::ilogb(value).max(least) };
        libm::scalbn(1.0, exponent - digits)
    }
}

impl std::fmt::Display for Storage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::F16 => "half",
            Self::F32 => "single",
            Self::F64 => "double",
            Self::Whole => "whole",
        })
    }
}

/// The cells of a channel, row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Real numbers, widened exactly.
    Reals(Image<f64>),
    /// Whole numbers; 4294967295 is "none".
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

    /// The number in the cell of that index, counted row by row, as a real number: exact for both kinds.
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

/// What an NPY or PFM file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Array {
    /// How the file stores its numbers.
    pub storage: Storage,
    /// One plane for each component, all of the same size; at least one.
    pub planes: Vec<Values>,
}

/// The shape that a header claims.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shape {
    pub rows: u64,
    pub columns: u64,
    pub components: u64,
}

/// The most components of a cell: more are no channels, but an array of another meaning.
const MOST_COMPONENTS: u64 = 1024;

impl Shape {
    /// Refuses a shape without cells, one that is not expected, or one of another size than the `bytes` that
    /// follow the header. What passes is as large as the file, and so are the planes but for a constant.
    pub(crate) fn check(&self, number_bytes: u64, bytes: u64, limits: &Limits) -> Result<(), Fault> {
        let &Self { rows, columns, components } = self;
        let refuse = |expected: String| {
            let found = format!("{rows} rows of {columns} columns, {components} components");
            Err(Fault::new("shape", found, expected))
        };
        let sides = u64::from(u32::MAX);
        if rows == 0 || columns == 0 || rows > sides || columns > sides || rows * columns > limits.cells {
            return refuse(format!("1 to {} cells", limits.cells));
        }
        if components == 0 || components > MOST_COMPONENTS {
            return refuse(format!("1 to {MOST_COMPONENTS} components"));
        }
        if let Some((width, height)) = limits.size
            && (columns, rows) != (width.into(), height.into())
        {
            return refuse(format!("{height} rows of {width} columns"));
        }
        // At most 2^64 cells times 2^13 bytes.
        let claimed = u128::from(rows * columns) * u128::from(components * number_bytes);
        if claimed > u128::from(limits.bytes) {
            return refuse(format!("at most {} bytes", limits.bytes));
        }
        // CHOICE: bytes too many are refused as well. The header and the numbers are not of one making then,
        // and every number may be in a wrong place.
        if claimed != u128::from(bytes) {
            let expected = format!("the {claimed} bytes of its shape (is the file cut off?)");
            return Err(Fault::new("numbers", format!("{bytes} bytes"), expected));
        }
        Ok(())
    }
}

/// A number that array files can be written of.
pub trait ArrayNumber: Copy + private::Bytes {}

impl ArrayNumber for f64 {}

impl ArrayNumber for f32 {}

impl ArrayNumber for u32 {}

impl ArrayNumber for u8 {}

pub(crate) mod private {
    use super::Write;

    /// A number as little-endian bytes.
    pub trait Bytes {
        /// The type's name in NPY headers.
        const DESCRIPTION: &'static str;
        fn write(self, file: &mut dyn Write) -> std::io::Result<()>;
    }

    macro_rules! bytes {
        ($($number:ty: $name:literal),*) => {$(
            impl Bytes for $number {
                const DESCRIPTION: &'static str = $name;
                fn write(self, file: &mut dyn Write) -> std::io::Result<()> {
                    file.write_all(&self.to_le_bytes())
                }
            }
        )*};
    }
    bytes!(f64: "<f8", f32: "<f4", u32: "<u4", u8: "|u1");
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
    }
}
