//! Double-double numbers: pairs of f64 with a proven error, about 106 bits. They are the fast way to correctly
//! rounded values.
//!
//! A number here is hi + lo, known to within `error`. Sums and products are those of double-word arithmetic, whose
//! relative errors are proven: 3 u^2 / (1 - 4 u) for a sum ("AccurateDWPlusDW") and 7 u^2 for a product
//! ("DWTimesDW1"), u = 2^-53 (M. Joldes, J.-M. Muller, V. Popescu, 2017, doi:10.1145/3121432; checked formally by
//! Muller and L. Rideau, 2022). Quotients and roots are checked by multiplying back, so their errors need no theorem.
//! A product below 1e-250 is bounded by its size alone. Above 1e250, and for quotients below 1e-250, nothing is
//! claimed: the error is infinite, and exact arithmetic takes over.

mod crossing_parameter;
mod plane_crossing;

use std::cmp::Ordering;

pub(crate) use crossing_parameter::crossing_parameter;
pub(crate) use plane_crossing::PlaneCrossing;

use crate::numbers::number::Number;
use crate::numbers::rounding::Rounded;

/// hi + lo, with |lo| at most half a unit in the last place of hi. The true number is at most `error` away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DoubleDouble {
    high: f64,
    low: f64,
    error: f64,
}

/// Relative error charged for a sum: 2^-104 = 4 u^2, which exceeds 3 u^2 / (1 - 4 u).
const SUM_ERROR: f64 = 1.0 / (1u128 << 104) as f64;
/// Relative error charged for a product: 2^-103 = 8 u^2.
const PRODUCT_ERROR: f64 = 2.0 * SUM_ERROR;
/// Factor that covers the roundings of an error: sums and products of at most a dozen positive terms, each rounded by
/// 2^-53.
const ROUNDED_UP: f64 = 1.0 + 1.0 / (1u64 << 48) as f64;
/// Smallest size at which no partial result underflows.
const MIN_MAGNITUDE: f64 = 1e-250;
/// Largest size at which no partial result overflows.
const MAX_MAGNITUDE: f64 = 1e250;

/// a + b = sum + rest, exactly. (D. Knuth)
#[inline(always)]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    let of_a = sum - of_b;
    (sum, (a - of_a) + (b - of_b))
}

/// a + b = sum + rest, exactly, if |a| >= |b| or a = 0. (T. Dekker)
#[inline(always)]
fn fast_two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// a b = product + rest, exactly, for sizes from [`MIN_MAGNITUDE`] to [`MAX_MAGNITUDE`]: by one fused operation where the processor has
/// it, else by T. Dekker and G. Veltkamp. Both give the same numbers.
#[allow(
    clippy::disallowed_methods,
    reason = "the rest of a product is a number of f64: the same, fused or not"
)]
#[inline(always)]
fn two_product<const FUSED: bool>(a: f64, b: f64) -> (f64, f64) {
    #[inline(always)]
    fn split(a: f64) -> (f64, f64) {
        let scaled = 134_217_729.0 * a; // 2^27 + 1
        let high = scaled - (scaled - a);
        (high, a - high)
    }
    let product = a * b;
    if FUSED {
        return (product, a.mul_add(b, -product));
    }
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    (product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2)
}

impl DoubleDouble {
    /// A number of which nothing is known.
    pub(crate) const UNKNOWN: Self = Self { high: 0.0, low: 0.0, error: f64::INFINITY };
    /// pi = 3.14159265358979323846 (its first f64) + 1.2246467991473532e-16 (its second) to 3e-33.
    pub(crate) const PI: Self = Self::constant(std::f64::consts::PI, 1.224_646_799_147_353_2e-16, 3e-33);

    /// A constant by its first two f64, and how far it is from their sum.
    pub(crate) const fn constant(high: f64, low: f64, error: f64) -> Self {
        Self { high, low, error }
    }

    /// The nearest f64, or almost.
    #[inline]
    pub(crate) fn high(&self) -> f64 {
        self.high
    }

    /// An upper bound of the true number's absolute value.
    #[inline]
    pub(crate) fn upper_bound(&self) -> f64 {
        (self.high.abs() + self.low.abs() + self.error) * ROUNDED_UP
    }

    /// A lower bound of the true number's absolute value: |lo| is at most 2^-53 |hi|, and the first factor takes twice that.
    #[inline]
    fn lower_bound(&self) -> f64 {
        (self.high.abs() * (1.0 - f64::EPSILON) - self.error * ROUNDED_UP) * (1.0 - f64::EPSILON)
    }

    /// The absolute value.
    #[inline]
    pub(crate) fn abs(&self) -> Self {
        if self.high < 0.0 { Self { high: -self.high, low: -self.low, ..*self } } else { *self }
    }

    /// The quotient.
    pub(crate) fn over(&self, divisor: &Self) -> Self {
        let least = divisor.lower_bound();
        let first = self.high / divisor.high;
        // !(a > b) also holds for NaN.
        if !(least > 0.0) || !(first == 0.0 || (MIN_MAGNITUDE..MAX_MAGNITUDE).contains(&first.abs())) {
            return Self::UNKNOWN;
        }
        // The residue x - z y, for the first digits of the quotient z, and then for all of them.
        let rest = self.sub(&divisor.mul(&Self::of(first)));
        let (high, low) = fast_two_sum(first, rest.high / divisor.high);
        let quotient = Self { high, low, error: 0.0 };
        let rest = self.sub(&divisor.mul(&quotient)).upper_bound();
        // The quotient of a residue that is not 0 may underflow.
        let error = if rest == 0.0 { 0.0 } else { rest / least * ROUNDED_UP + f64::MIN_POSITIVE };
        quotient.with_error(error)
    }

    /// The square root; unknown if the number is not certainly positive.
    pub(crate) fn sqrt(&self) -> Self {
        if self.high == 0.0 && self.low == 0.0 && self.error == 0.0 {
            return *self;
        }
        if !(self.lower_bound() > 0.0) {
            return Self::UNKNOWN;
        }
        let first = self.high.sqrt();
        let rest = self.sub(&Self::of(first).square());
        let (high, low) = fast_two_sum(first, rest.high / (2.0 * first));
        let root = Self { high, low, error: 0.0 };
        // |sqrt(x) - z| = |x - z^2| / (sqrt(x) + z).
        let rest = self.sub(&root.square());
        root.with_error(rest.upper_bound() / root.lower_bound() * ROUNDED_UP)
    }

    /// The number with this error; unknown if the error is not finite.
    #[inline]
    fn with_error(self, error: f64) -> Self {
        if error.is_finite() { Self { error, ..self } } else { Self::UNKNOWN }
    }

    /// Both f64, and the error.
    #[cfg(test)]
    pub(crate) fn parts(&self) -> [f64; 3] {
        [self.high, self.low, self.error]
    }

    /// The number, if it may be off by so much more.
    #[inline]
    pub(crate) fn with_more_error(self, more: f64) -> Self {
        self.with_error((self.error + more) * ROUNDED_UP)
    }

    /// The number correctly rounded, if that is certain.
    pub(crate) fn rounded(&self) -> Option<Rounded> {
        // A sum of two f64 is rounded correctly, and rounding keeps order: if both ends of the interval of the true
        // number round to the same f64, so does everything between.
        let doubt = self.error * ROUNDED_UP + self.low.abs() * f64::EPSILON;
        let (from, to) = (self.low - doubt, self.low + doubt);
        let double = self.high + from;
        if !(double == self.high + to) || !double.is_finite() {
            return None;
        }
        // The side of the f64 on which the number lies; hi - double is exact, because they are neighbours.
        let beside = self.high - double;
        let side = if self.error == 0.0 && beside + self.low == 0.0 {
            Ordering::Equal
        } else if beside + from > 0.0 {
            Ordering::Greater
        } else if beside + to < 0.0 {
            Ordering::Less
        } else {
            // The side is unknown, which matters only on a midpoint of two f32.
            let [below, above] =
                [Ordering::Less, Ordering::Greater].map(|side| Rounded::beside(double, side));
            return (below.single == above.single).then_some(below);
        };
        // An exact zero has no sign.
        Some(if double == 0.0 { Rounded::ZERO } else { Rounded::beside(double, side) })
    }
}

impl Number for DoubleDouble {
    #[inline]
    fn of(value: f64) -> Self {
        Self { high: value, low: 0.0, error: 0.0 }
    }

    #[inline]
    fn add(&self, other: &Self) -> Self {
        let (sum, rest) = two_sum(self.high, other.high);
        let (low, last) = two_sum(self.low, other.low);
        let (sum, rest) = fast_two_sum(sum, rest + low);
        let (high, low) = fast_two_sum(sum, last + rest);
        // The sum of two f64 is exact.
        let rounding = if self.low == 0.0 && other.low == 0.0 { 0.0 } else { SUM_ERROR * high.abs() };
        let error = (self.error + other.error + rounding) * ROUNDED_UP;
        if error < MAX_MAGNITUDE && high.abs() < MAX_MAGNITUDE {
            Self { high, low, error }
        } else {
            Self::UNKNOWN
        }
    }

    #[inline]
    fn sub(&self, other: &Self) -> Self {
        self.add(&Self { high: -other.high, low: -other.low, error: other.error })
    }

    #[inline]
    fn mul(&self, other: &Self) -> Self {
        let is_zero = |x: &Self| x.high == 0.0 && x.error == 0.0;
        if is_zero(self) || is_zero(other) {
            return Self::of(0.0);
        }
        let size = (self.high * other.high).abs();
        if !(size < MAX_MAGNITUDE) || self.high.abs() > MAX_MAGNITUDE || other.high.abs() > MAX_MAGNITUDE {
            return Self::UNKNOWN;
        }
        if size < MIN_MAGNITUDE {
            // One factor is 0 but for its error, or almost: the product lies between -most and most.
            let most = self.upper_bound() * other.upper_bound() * ROUNDED_UP + f64::MIN_POSITIVE;
            return Self::of(0.0).with_error(most);
        }
        let (product, rest) = two_product::<false>(self.high, other.high);
        let cross = self.high * other.low + self.low * other.high;
        let (high, low) = fast_two_sum(product, rest + cross);
        let rounding = if self.low == 0.0 && other.low == 0.0 { 0.0 } else { PRODUCT_ERROR * high.abs() };
        let inherited = if self.error == 0.0 && other.error == 0.0 {
            0.0
        } else {
            // Each product may underflow by less than the last term.
            self.upper_bound() * other.error + other.upper_bound() * self.error + f64::MIN_POSITIVE
        };
        Self { high, low, error: (inherited + rounding) * ROUNDED_UP }
    }

    #[inline]
    fn sign(&self) -> Option<Ordering> {
        if self.high == 0.0 && self.low == 0.0 && self.error == 0.0 {
            Some(Ordering::Equal)
        } else if self.lower_bound() > 0.0 {
            self.high.partial_cmp(&0.0)
        } else {
            None
        }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/double_double.rs"]
mod tests;
