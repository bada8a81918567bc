//! The step of which numbers are multiples.

/// Numbers from which a step is found, at least: of fewer, a step fits whatever is wrong.
pub(super) const MIN_FITTED: usize = 12;

/// Greatest chance that other numbers are multiples of a step too. Tuned: about a hundred steps are tried.
const MAX_CHANCE: f64 = 1e-9;

/// Roundings of a number that is compared with a multiple: of the multiple, and of the number's own rounding.
const ROUNDINGS: f64 = 4.0;

/// How far a number may be from a multiple.
fn error_of(number: f64, error: f64) -> f64 {
    error + ROUNDINGS * f64::EPSILON * number.abs()
}

/// Parts of a power of ten that are steps.
const STEPS_OF_TEN: [f64; 11] = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0];

/// Such parts of powers of ten.
pub(super) fn steps_of_ten(powers: std::ops::RangeInclusive<i32>) -> impl Iterator<Item = f64> {
    powers.flat_map(|power| {
        let part = move |part: f64| format!("{part}e{power}").parse::<f64>().unwrap_or(f64::NAN);
        STEPS_OF_TEN.into_iter().map(part)
    })
}

/// Negative powers of two.
pub(super) fn steps_of_two(powers: std::ops::RangeInclusive<i32>) -> impl Iterator<Item = f64> {
    powers.map(|power| libm::ldexp(1.0, -power))
}

/// The largest step of which nearly all numbers, each with how far it may be moved, are multiples, if that is no chance.
pub(super) fn step(numbers: &[[f64; 2]], steps: &[f64]) -> Option<f64> {
    let mut steps = steps.to_vec();
    steps.sort_by(|a, b| b.total_cmp(a));
    steps.into_iter().find(|&step| {
        // The chance that a number lies as near to a multiple, where that says something.
        let chance = |number: f64, error: f64| (2.0 * error_of(number, error) / step).min(1.0);
        let of = numbers.iter().filter(|[number, error]| chance(*number, *error) < 0.25);
        let (mut all, mut multiples, mut log) = (0_usize, 0_usize, 0.0);
        for &[number, error] in of {
            all += 1;
            if is_multiple(number, error, step) {
                multiples += 1;
                log += libm::log(chance(number, error).max(1e-3));
            }
        }
        all >= MIN_FITTED && (all - multiples) * 100 <= all && log <= libm::log(MAX_CHANCE)
    })
}

pub(super) fn is_multiple(number: f64, error: f64, step: f64) -> bool {
    (number - step * (number / step).round()).abs() <= error_of(number, error)
}
