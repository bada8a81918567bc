//! Numbers that are found from a recording, and the plainest number that says the same.

/// Decimals of a number that is told, at most.
const MAX_DECIMALS: i32 = 12;

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
pub(crate) fn rounded_to(number: f64, decimals: i32) -> f64 {
    format!("{number:.*}", decimals as usize).parse().unwrap_or(number)
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
