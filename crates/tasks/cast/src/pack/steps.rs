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
