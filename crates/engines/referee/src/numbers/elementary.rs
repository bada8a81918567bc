//! ln 2, exp(-x) and atan(x) in pairs of f64 with a proven error.
//!
//! An identity makes the argument small, so that a few terms of the series are enough. Each step is an operation of
//! [`DoubleDouble`], which carries the error of what went in; only what the series leaves out is added here. The coefficients are
//! multiplied by their common denominator: they are whole numbers below 2^53, and so exact.

use crate::numbers::double_double::DoubleDouble;
use crate::numbers::number::Number;

/// Largest argument of exp(-x): beyond it the products come near the least f64, where nothing is claimed.
const MAX_EXP_ARGUMENT: f64 = 500.0;
/// The last power of the series of exp.
const EXP_TERMS: u32 = 14;
/// Largest argument of the series of exp. Reduced arguments are below ln(2) / 32 = 0.0217.
const MAX_EXP_TERM: f64 = 1.0 / 32.0;
/// More than the terms that are left out, sum of s^n / n! from n = 15 on, for |s| <= 2^-5: 2^-75 / 15! = 2^-115.25, and less than
/// a hundredth of it for all that follow.
const EXP_REST: f64 = 1.0 / (1u128 << 115) as f64;

/// Largest argument of the series of atan. Reduced arguments are below tan(pi / 64) = 0.0492.
const MAX_ATAN_TERM: f64 = 0.05;
/// The series of atan ends with the power 25, and its coefficients are multiplied by 1 * 3 * 5 * ... * 25.
const ATAN_DENOMINATOR: f64 = 7_905_853_580_625.0;
/// More than the first term that is left out, relative to the sum: t^26 / 27 <= 2^-117.1 for t <= 0.05. Signs alternate, so that the
/// first is larger than all.
const ATAN_REST: f64 = 1.0 / (1u128 << 116) as f64;

/// ln 2 = 0.69314718055994530942 (its first f64) + 2.319046813846299558e-17 (its second) to 6e-34.
pub(crate) const LN_2: DoubleDouble =
    DoubleDouble::constant(std::f64::consts::LN_2, 2.319_046_813_846_299_6e-17, 6e-34);

/// exp(-x); unknown above 500.
pub(crate) fn exp_minus(x: &DoubleDouble) -> DoubleDouble {
    // !(a < b) also holds for NaN.
    if !(x.upper_bound() < MAX_EXP_ARGUMENT) {
        return DoubleDouble::UNKNOWN;
    }
    // exp(-x) = 2^-k exp(s)^16 with s = (k ln 2 - x) / 16, for any whole number k: the nearest makes s small.
    let k = (x.high() * std::f64::consts::LOG2_E).round();
    let s = LN_2.mul(&DoubleDouble::of(k)).sub(x).mul(&DoubleDouble::of(1.0 / 16.0));
    if !(s.upper_bound() < MAX_EXP_TERM) {
        return DoubleDouble::UNKNOWN;
    }
    // The sum of s^n / n!, times 14!, by Horner's rule.
    let mut coefficient = 1.0;
    let mut sum = DoubleDouble::of(coefficient);
    for n in (1..=EXP_TERMS).rev() {
        coefficient *= f64::from(n);
        sum = sum.mul(&s).add(&DoubleDouble::of(coefficient));
    }
    let sixteenth = sum.over(&DoubleDouble::of(coefficient)).with_more_error(EXP_REST);
    let whole = (0..4).fold(sixteenth, |power, _| power.square());
    whole.mul(&DoubleDouble::of(libm::scalbn(1.0, -(k as i32))))
}

/// atan(x) of x >= 0.
pub(crate) fn atan(x: &DoubleDouble) -> DoubleDouble {
    let one = DoubleDouble::of(1.0);
    // atan(x) = pi / 2 - atan(1 / x).
    let is_steep = x.high() > 1.0;
    let gentle = if is_steep { one.over(x) } else { *x };
    // atan(t) = 2 atan(t / (1 + sqrt(1 + t^2))), four times.
    let t = (0..4).fold(gentle, |t, _| t.over(&one.add(&one.add(&t.square()).sqrt())));
    if !(t.upper_bound() < MAX_ATAN_TERM) {
        return DoubleDouble::UNKNOWN;
    }
    // atan(t) / t = 1 - t^2 / 3 + t^4 / 5 - ..., times the denominator, by Horner's rule.
    let squared = t.square();
    let coefficient = |odd: u32| DoubleDouble::of(ATAN_DENOMINATOR / f64::from(odd));
    let odds = (1..25).step_by(2).rev();
    let sum = odds.fold(coefficient(25), |sum, odd| coefficient(odd).sub(&sum.mul(&squared)));
    let angle = t.mul(&sum).over(&DoubleDouble::of(ATAN_DENOMINATOR / 16.0));
    let angle = angle.with_more_error(angle.upper_bound() * ATAN_REST);
    if is_steep { DoubleDouble::PI.mul(&DoubleDouble::of(0.5)).sub(&angle) } else { angle }
}

#[cfg(test)]
#[path = "../../tests/unit/elementary.rs"]
mod tests;
