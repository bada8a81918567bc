//! Numbers that are found from a recording, and the plainest number that says the same.

/// Decimals of a number that is told, at most: as many as a number of double precision that is about 1 has.
const MAX_DECIMALS: i32 = 16;

/// The number with the fewest decimals that is within `uncertainty` of another.
pub(crate) fn plainest(number: f64, uncertainty: f64) -> f64 {
    for decimals in 0..=MAX_DECIMALS {
        let rounded = rounded_to(number, decimals);
        if (rounded - number).abs() <= uncertainty {
            return rounded;
        }
    }
    number
}

/// The number with the fewest decimals from `low`, included, to `high`, left out.
pub(crate) fn plainest_between(low: f64, high: f64) -> f64 {
    for decimals in 0..=MAX_DECIMALS {
        let rounded = rounded_to(0.5 * (low + high), decimals);
        if (low..high).contains(&rounded) {
            return rounded;
        }
    }
    low
}

/// By way of text: the decimal fraction itself, and no product of a rounded power of ten.
fn rounded_to(number: f64, decimals: i32) -> f64 {
    format!("{number:.*}", decimals as usize).parse().unwrap_or(number)
}

/// The number with so many digits, one or more, that is nearest to another.
pub(crate) fn rounded_to_digits(number: f64, digits: usize) -> f64 {
    format!("{number:.*e}", digits - 1).parse().unwrap_or(number)
}

/// Median and width of the middle half of some numbers, which are sorted. `None` if there are fewer than `least`.
pub(crate) fn middle(numbers: &mut [f64], least: usize) -> Option<(f64, f64)> {
    if numbers.len() < least.max(1) {
        return None;
    }
    // NaN is larger than every number.
    numbers.sort_by(f64::total_cmp);
    let at = |quarter: usize| numbers[(numbers.len() - 1) * quarter / 4];
    Some((at(2), at(3) - at(1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_is_the_median_and_its_spread_that_of_the_inner_half() {
        assert_eq!(middle(&mut [50.0, 1.0, 4.0, 2.0, 3.0], 5), Some((3.0, 2.0)));
        assert_eq!(middle(&mut [1.0, 2.0], 3), None);
        assert_eq!(middle(&mut [], 0), None);
    }

    #[test]
    fn a_number_is_told_in_as_many_digits_as_are_known() {
        assert_eq!(plainest(0.1264, 0.001), 0.126);
        assert_eq!(plainest(0.1264, 0.004), 0.13);
        assert_eq!(plainest(-2.9996, 0.0005), -3.0);
        assert_eq!(plainest(0.1264, 0.0), 0.1264);
        assert_eq!(plainest_between(0.126, 0.128), 0.127);
    }

    #[test]
    fn a_number_between_two_may_be_the_lower_one_and_not_the_higher() {
        // The middle of 0.5 and 1 is nearest to 1, and next to 0.8.
        assert_eq!(plainest_between(0.5, 1.0), 0.8);
        // The middle of 2 and 2.5 is nearest to 2.
        assert_eq!(plainest_between(2.0, 2.5), 2.0);
    }

    #[test]
    fn digits_count_from_the_first_that_is_not_0() {
        assert_eq!([1, 2, 3].map(|digits| rounded_to_digits(0.012_345, digits)), [0.01, 0.012, 0.0123]);
        assert_eq!([1, 2, 3].map(|digits| rounded_to_digits(-98_765.0, digits)), [-1e5, -99e3, -98_800.0]);
    }
}
