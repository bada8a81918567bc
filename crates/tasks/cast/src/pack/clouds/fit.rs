//! Numbers of a mistake, from the points of a trial: the median, and a search on one number.

/// Decimals that are tried for a number, from the fewest.
const DECIMALS: std::ops::RangeInclusive<usize> = 0..=7;

/// The same for a number that is known as well as lengths are.
const ALL_DECIMALS: std::ops::RangeInclusive<usize> = 0..=16;

/// Steps of the search. Newton's method doubles its digits each time.
const STEPS: usize = 12;

/// Residuals beyond so many medians are left out: faces change there. Tuned, as that of the diagnosis of sensors.
const MEDIANS: f64 = 5.0;

/// The middle of some numbers; `None` if there are none, or one is NaN.
pub(in crate::pack) fn median(mut numbers: Vec<f64>) -> Option<f64> {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied().filter(|number| number.is_finite())
}

/// A number with few decimals, then with more, each once; 0 is left out.
pub(in crate::pack) fn rounded(number: f64) -> Vec<f64> {
    rounded_to(number, DECIMALS)
}

/// The same up to the last digit of a number of double precision that is about 1.
pub(in crate::pack) fn rounded_to_all(number: f64) -> Vec<f64> {
    rounded_to(number, ALL_DECIMALS)
}

fn rounded_to(number: f64, decimals: std::ops::RangeInclusive<usize>) -> Vec<f64> {
    let mut found: Vec<f64> = Vec::new();
    for decimals in decimals {
        let text = format!("{number:.decimals$}");
        let Some(rounded) = text.parse::<f64>().ok().filter(|rounded| *rounded != 0.0) else { continue };
        if found.last() != Some(&rounded) {
            found.push(rounded);
        }
    }
    found
}

/// The number at which residuals are least, by the method of Gauss and Newton from 0, within `range`. `residuals` has the same
/// number of vectors each time, NaN where there is none; `by` is the step of differences.
pub(super) fn least(residuals: impl Fn(f64) -> Vec<glam::DVec3>, by: f64, range: [f64; 2]) -> Option<f64> {
    let mut at = 0.0_f64.clamp(range[0], range[1]);
    for _ in 0..STEPS {
        let here = residuals(at);
        let beside = if at + by <= range[1] { at + by } else { at - by };
        let there = residuals(beside);
        let middle = median(here.iter().map(|r| r.length()).filter(|size| size.is_finite()).collect())?;
        let (mut top, mut bottom) = (0.0, 0.0);
        for (r, other) in here.iter().zip(&there) {
            let slope = (*other - *r) / (beside - at);
            if slope.is_finite() && r.length() <= MEDIANS * middle {
                top += slope.dot(*r);
                bottom += slope.dot(slope);
            }
        }
        if bottom == 0.0 {
            return None;
        }
        at = (at - top / bottom).clamp(range[0], range[1]);
    }
    Some(at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn a_number_is_found_among_faces_that_change() {
        // Residuals 3 (x - 0.25), and one in five that has another cause.
        let residuals = |x: f64| {
            let of = |k: usize| {
                if k.is_multiple_of(5) { DVec3::splat(100.0 + x) } else { DVec3::X * (3.0 * (x - 0.25)) }
            };
            (0..50).map(of).collect()
        };
        let found = least(residuals, 1e-3, [-1.0, 1.0]).unwrap();
        assert!((found - 0.25).abs() < 1e-12, "{found}");
    }

    #[test]
    fn numbers_are_told_with_few_decimals_first() {
        assert_eq!(rounded(-0.1990656), [-0.2, -0.199, -0.1991, -0.19907, -0.199066, -0.1990656]);
        assert_eq!(rounded(30.0), [30.0]);
        assert_eq!(median(vec![3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(Vec::new()), None);
    }
}
