//! To how many decimals the numbers of a text are good. A number by itself does not tell: `0` is what `%.8g` prints of 0, and what
//! `%.0f` prints of 0.4. All coordinates of a file are printed by one format, which the numbers with the most digits show.

use super::columns::{CloudColumn, CloudStorage};

/// A number as it is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Printed {
    /// Digits after the point, less the exponent: 3 of 0.125, -2 of 1e2. `None` of `nan` and `inf`.
    decimals: Option<i16>,
    /// Digits from the first that is not 0; none of a zero.
    digits: u8,
    has_exponent: bool,
}

impl Printed {
    /// Of a word that parses as a number.
    pub(crate) fn of(word: &str) -> Self {
        let (mantissa, exponent) = word.split_once(['e', 'E']).map_or((word, None), |(m, e)| (m, Some(e)));
        let after = mantissa.split_once('.').map_or(0, |(_, after)| after.len());
        // What parses as a number has an exponent that is one; 400 decimals are beyond every double.
        let power = exponent.map_or(0, |text| text.parse::<i32>().unwrap_or(0).clamp(-400, 400));
        let decimals = i32::try_from(after).unwrap_or(400).min(400) - power;
        let all = || mantissa.bytes().filter(u8::is_ascii_digit);
        let digits = all().skip_while(|&digit| digit == b'0').count();
        Self {
            decimals: all().next().and_then(|_| i16::try_from(decimals).ok()),
            digits: u8::try_from(digits).unwrap_or(u8::MAX),
            has_exponent: exponent.is_some(),
        }
    }
}

/// How numbers are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    /// To so many decimals; zeros at the end may be left out.
    Fixed(i16),
    /// To so many digits from the first that is not 0; zeros at the end may be left out.
    Significant(u8),
}

impl Format {
    /// The format that explains the numbers. An exponent is printed of significant digits alone. Else nine in ten numbers of the right
    /// format have all their digits, since nine in ten digits are not 0.
    fn of<'p>(numbers: impl Iterator<Item = &'p Printed> + Clone) -> Self {
        let decimals = || numbers.clone().filter_map(|number| number.decimals);
        let most_decimals = decimals().max().unwrap_or(0);
        let most_digits = numbers.clone().map(|number| number.digits).max().unwrap_or(0);
        let are_fixed = decimals().filter(|&decimals| decimals == most_decimals).count();
        let are_significant =
            numbers.clone().filter(|number| number.digits > 0 && number.digits == most_digits).count();
        match numbers.clone().any(|number| number.has_exponent) || are_fixed < are_significant {
            true => Self::Significant(most_digits),
            false => Self::Fixed(most_decimals),
        }
    }

    /// The decimals to which a number of this format is good. A zero of significant digits is exact.
    fn decimals(self, number: &Printed) -> i32 {
        match (self, number.decimals) {
            (Self::Fixed(decimals), _) => i32::from(decimals),
            (Self::Significant(_), Some(_)) if number.digits == 0 => 400,
            (Self::Significant(most), Some(decimals)) => {
                i32::from(decimals) + i32::from(most) - i32::from(number.digits)
            }
            (Self::Significant(_), None) => 0,
        }
    }
}

/// The format of a column by itself: all its numbers have the same decimals, and some.
fn of_column(numbers: &[Printed]) -> Option<Format> {
    let decimals = numbers.iter().find_map(|number| number.decimals).filter(|&decimals| decimals > 0)?;
    let is_so =
        |number: &Printed| number.decimals.is_none_or(|other| other == decimals) && !number.has_exponent;
    numbers.iter().all(is_so).then_some(Format::Fixed(decimals))
}

/// Columns with their numbers as they are printed: each number gets the decimals to which it is good. A column of a binary file has no
/// printed numbers, and stays as it is.
pub(crate) fn with_decimals(columns: Vec<(CloudColumn, Vec<Printed>)>) -> Vec<CloudColumn> {
    let is_axis = |column: &CloudColumn| {
        ["x", "y", "z"].contains(&column.name.as_str()) && column.storage != CloudStorage::Whole
    };
    let axes = columns.iter().filter(|(column, _)| is_axis(column)).flat_map(|(_, printed)| printed);
    let of_axes = Format::of(axes);
    let named = |(column, printed): (CloudColumn, Vec<Printed>)| {
        if column.storage == CloudStorage::Whole || printed.is_empty() {
            return column;
        }
        let format = of_column(&printed)
            .unwrap_or_else(|| if is_axis(&column) { of_axes } else { Format::of(printed.iter()) });
        let decimals = printed.iter().map(|number| format.decimals(number)).collect();
        let of_single = column.storage == CloudStorage::Single;
        CloudColumn { storage: CloudStorage::Decimal { decimals, of_single }, ..column }
    };
    columns.into_iter().map(named).collect()
}

#[cfg(test)]
#[path = "../../tests/unit/printed.rs"]
mod tests;
