//! The numbers of a cloud, a column for each field.

use raypencil_files::Fault;

/// How the numbers of a field are stored.
#[derive(Debug, Clone, PartialEq)]
pub enum CloudStorage {
    /// Single precision.
    Single,
    /// Double precision.
    Double,
    /// Whole numbers.
    Whole,
    /// Decimal numbers: for each the number of decimals to which it is good; and whether the file declares single precision.
    Decimal {
        /// Digits after the point: 3 of 0.125, -2 of 1e2; more where the format of the file prints more, and leaves out zeros at the end.
        decimals: Vec<i32>,
        /// Whether the numbers were of single precision before they were printed.
        of_single: bool,
    },
}

/// A field of a cloud: a number for each point.
#[derive(Debug, Clone, PartialEq)]
pub struct CloudColumn {
    /// The name in the file.
    pub name: String,
    /// How its numbers are stored.
    pub storage: CloudStorage,
    /// The numbers, as doubles. Whole numbers beyond 2^53 are rounded.
    pub values: Vec<f64>,
}

impl CloudColumn {
    /// How far a number may be from the one that was stored, by its rounding to single precision or to decimals. That of a double is
    /// 0: bounds of arithmetic have it already. 0 for a number that is not finite.
    ///
    /// ```
    /// use raypencil_mesh_io::{CloudColumn, CloudStorage};
    ///
    /// let values = vec![1.0, 3.0];
    /// let single = CloudColumn { name: "x".into(), storage: CloudStorage::Single, values: values.clone() };
    /// // Half of 2^-23 and of 2^-22.
    /// assert_eq!([0, 1].map(|index| single.error(index)), [1.0 / 16_777_216.0, 1.0 / 8_388_608.0]);
    /// let storage = CloudStorage::Decimal { decimals: vec![0, 2], of_single: false };
    /// let text = CloudColumn { storage, ..single };
    /// assert_eq!([0, 1].map(|index| text.error(index)), [0.5, 0.005]);
    /// ```
    pub fn error(&self, index: usize) -> f64 {
        let value = self.values[index];
        if !value.is_finite() {
            return 0.0;
        }
        // A number that rounds to this one lies within half the gap above it: the gap below is never larger.
        let of_single = || {
            // The gap above the largest number is that below it.
            let size = (value as f32).abs().min(f32::MAX);
            let (from, to) = if size < f32::MAX { (size, size.next_up()) } else { (size.next_down(), size) };
            (f64::from(to) - f64::from(from)) / 2.0
        };
        match &self.storage {
            CloudStorage::Single => of_single(),
            CloudStorage::Double | CloudStorage::Whole => 0.0,
            CloudStorage::Decimal { decimals, of_single: is_single } => {
                // Five units of the decimal behind the last one: the reader of decimal numbers rounds it rightly.
                let of_text = format!("5e{}", -decimals[index] - 1).parse().unwrap_or(0.0);
                of_text + if *is_single { of_single() } else { 0.0 }
            }
        }
    }
}

/// A point cloud: fields by their names, a number for each point.
#[derive(Debug, Clone, PartialEq)]
pub struct Cloud {
    /// Points of a row; the number of all points if the cloud has no order.
    pub width: u64,
    /// Rows; 1 if the cloud has no order.
    pub height: u64,
    /// The fields. x, y and z are among them.
    pub columns: Vec<CloudColumn>,
}

impl Cloud {
    /// A field by its name.
    pub fn column(&self, name: &str) -> Option<&CloudColumn> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, |column| column.values.len())
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Refuses a cloud without x, y and z, and one whose field of the name stands there twice.
pub(super) fn check_names(names: &[String]) -> Result<(), Fault> {
    for axis in ["x", "y", "z"] {
        if !names.iter().any(|name| name == axis) {
            return Err(Fault::new("fields", format!("no {axis}"), "x, y and z, each a single number"));
        }
    }
    Ok(())
}

/// A decimal number, or `nan` or `inf`; `None` for what is no number, and for digits beyond the range of the type: no program
/// that has the type printed them.
pub(crate) fn decimal(word: &str, of_single: bool) -> Option<f64> {
    let number: f64 = word.parse().ok()?;
    let is_held = if of_single { (number as f32).is_finite() } else { number.is_finite() };
    (is_held || !word.contains(|digit: char| digit.is_ascii_digit())).then_some(number)
}

/// A whole number, printed in any way, such as `3.0`; `None` for what a whole number of so many bytes does not hold.
pub(crate) fn whole_decimal(word: &str, is_signed: bool, bytes: usize) -> Option<f64> {
    /// 2^53: all whole numbers up to it are doubles.
    const MAX_EXACT: f64 = 9_007_199_254_740_992.0;
    let number: i128 = match word.parse() {
        Ok(number) => number,
        Err(_) => {
            let number: f64 = word.parse().ok()?;
            (number.fract() == 0.0 && number.abs() <= MAX_EXACT).then_some(number as i128)?
        }
    };
    let bits = 8 * bytes;
    let held = match is_signed {
        true => -(1 << (bits - 1))..1_i128 << (bits - 1),
        false => 0..1_i128 << bits,
    };
    held.contains(&number).then_some(number as f64)
}
