//! The two kinds of numbers in which the referee evaluates a polynomial: an interval of f64, which is fast and
//! usually certain, and an exact dyadic rational, which is always certain.
//!
//! All inputs of the contract are f64 numbers, which are dyadic rationals m 2^e. Sums, differences and products of
//! dyadic rationals are dyadic rationals. The conditions are signs of polynomials, so they need no division:
//! [`Dyadic`] decides them without error. An [`Interval`] contains the exact value; where it lies on one side of zero
//! the sign is proven, and no exact arithmetic is needed.

use std::cmp::Ordering;

use dashu_int::{IBig, Sign, UBig};

use crate::numbers::short_integer::ShortInteger;

/// A number in which a polynomial can be evaluated.
pub(crate) trait Number: Clone {
    /// The number that equals this finite f64.
    fn of(value: f64) -> Self;
    fn add(&self, other: &Self) -> Self;
    fn sub(&self, other: &Self) -> Self;
    fn mul(&self, other: &Self) -> Self;
    /// How the exact value compares with 0, if that is certain.
    fn sign(&self) -> Option<Ordering>;

    /// What was formed in intervals before, if this is the arithmetic of intervals.
    #[inline]
    fn of_intervals<const N: usize>(_formed: [Interval; N]) -> Option<[Self; N]> {
        None
    }

    fn of_integer(value: u32) -> Self {
        Self::of(f64::from(value))
    }

    fn square(&self) -> Self {
        self.mul(self)
    }

    /// Twice this number; exact in every binary arithmetic.
    fn doubled(&self) -> Self {
        self.add(self)
    }
}

/// A closed interval between two f64 numbers that contains the exact value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Interval {
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Interval {
    /// A number inside, near the middle.
    #[inline]
    pub(crate) fn middle(&self) -> f64 {
        0.5 * self.low + 0.5 * self.high
    }

    /// The interval between two numbers, in this order.
    #[inline]
    pub(crate) fn between(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// The interval widened by `by` on both sides; `by` is not negative.
    #[inline]
    pub(crate) fn wider(self, by: f64) -> Self {
        widened(self.low - by, self.high + by)
    }

    /// The smallest interval that contains both.
    #[inline]
    pub(crate) fn hull(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// The quotient; the whole line if the divisor may be 0.
    pub(crate) fn over(self, divisor: Self) -> Self {
        if divisor.low <= 0.0 && divisor.high >= 0.0 {
            return Self { low: f64::NEG_INFINITY, high: f64::INFINITY };
        }
        let [a, b, c, d] = [
            self.low / divisor.low,
            self.low / divisor.high,
            self.high / divisor.low,
            self.high / divisor.high,
        ];
        widened(a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }

    /// -x.
    #[inline]
    pub(crate) fn negated(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }

    /// The largest absolute value inside.
    #[inline]
    pub(crate) fn magnitude(&self) -> f64 {
        self.low.abs().max(self.high.abs())
    }
}

/// Widens `low..=high`, each the result of one operation rounded to nearest, so that it contains the unrounded
/// results.
///
/// A result x is wrong by at most half a unit in its last place, at most 2^-53 |x|, or by half the smallest subnormal
/// number. The widening |x| 2^-52 + 2^-1022 is at least twice that: it also covers its own rounding, of the same size
/// as the first.
#[inline]
fn widened(low: f64, high: f64) -> Interval {
    let below = low.abs() * f64::EPSILON + f64::MIN_POSITIVE;
    let above = high.abs() * f64::EPSILON + f64::MIN_POSITIVE;
    Interval { low: low - below, high: high + above }
}

impl Number for Interval {
    #[inline]
    fn of_intervals<const N: usize>(formed: [Interval; N]) -> Option<[Self; N]> {
        Some(formed)
    }

    #[inline]
    fn of(value: f64) -> Self {
        Self { low: value, high: value }
    }

    #[inline]
    fn add(&self, other: &Self) -> Self {
        widened(self.low + other.low, self.high + other.high)
    }

    #[inline]
    fn sub(&self, other: &Self) -> Self {
        widened(self.low - other.high, self.high - other.low)
    }

    #[inline]
    fn mul(&self, other: &Self) -> Self {
        let products =
            [self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high];
        let [a, b, c, d] = products;
        // Comparisons are one instruction each, but lose what `min` keeps beside a product of 0 and infinity.
        if products.iter().sum::<f64>().is_nan() {
            return widened(a.min(b).min(c.min(d)), a.max(b).max(c.max(d)));
        }
        let less = |x: f64, y: f64| if x < y { x } else { y };
        let more = |x: f64, y: f64| if x > y { x } else { y };
        widened(less(less(a, b), less(c, d)), more(more(a, b), more(c, d)))
    }

    #[inline]
    fn sign(&self) -> Option<Ordering> {
        if self.low > 0.0 {
            Some(Ordering::Greater)
        } else if self.high < 0.0 {
            Some(Ordering::Less)
        } else if self.low == 0.0 && self.high == 0.0 {
            Some(Ordering::Equal)
        } else {
            None
        }
    }

    #[inline]
    fn square(&self) -> Self {
        let [a, b] = [self.low * self.low, self.high * self.high];
        let low = if self.low <= 0.0 && self.high >= 0.0 { 0.0 } else { a.min(b) };
        let widened = widened(low, a.max(b));
        Self { low: widened.low.max(0.0), ..widened }
    }
}

/// An exact dyadic rational: `mantissa * 2^exponent`.
#[derive(Debug, Clone)]
pub(crate) struct Dyadic {
    mantissa: Mantissa,
    exponent: i64,
}

#[derive(Debug, Clone)]
enum Mantissa {
    Short(ShortInteger),
    Long(IBig),
}

/// What compilers copy without calling a function.
const _: () = assert!(size_of::<Dyadic>() <= 128);

impl Mantissa {
    fn long(&self) -> IBig {
        match self {
            Self::Short(short) => short.to_long(),
            Self::Long(long) => long.clone(),
        }
    }

    fn is_zero(&self) -> bool {
        self.sign() == Ordering::Equal
    }

    #[inline]
    fn sign(&self) -> Ordering {
        match self {
            Self::Short(short) => short.sign(),
            Self::Long(long) => long.cmp(&IBig::ZERO),
        }
    }

    fn negated(&self) -> Self {
        match self {
            Self::Short(short) => Self::Short(short.negated()),
            Self::Long(long) => Self::Long(-long),
        }
    }
}

impl Dyadic {
    /// The sign, the magnitude of the mantissa, and the exponent of 2.
    pub(crate) fn parts(&self) -> (Sign, UBig, i64) {
        let (sign, magnitude) = match &self.mantissa {
            Mantissa::Short(short) => short.parts(),
            Mantissa::Long(long) => long.clone().into_parts(),
        };
        (sign, magnitude, self.exponent)
    }

    /// The sum, or the difference.
    #[inline]
    fn sum(&self, other: &Self, is_difference: bool) -> Self {
        let exponent = self.exponent.min(other.exponent);
        let shifts = [self, other].map(|number| (number.exponent - exponent) as usize);
        if let (Mantissa::Short(a), Mantissa::Short(b)) = (&self.mantissa, &other.mantissa) {
            // One of the two, or none, is to be shifted: the other is not copied.
            let sum = match shifts {
                [0, 0] => a.sum(b, is_difference),
                [0, bits] => b.shifted(bits).and_then(|b| a.sum(&b, is_difference)),
                [bits, _] => a.shifted(bits).and_then(|a| a.sum(b, is_difference)),
            };
            if let Some(sum) = sum {
                return Self { mantissa: Mantissa::Short(sum), exponent };
            }
        }
        self.long_sum(other, is_difference, exponent, shifts)
    }

    #[cold]
    fn long_sum(&self, other: &Self, is_difference: bool, exponent: i64, shifts: [usize; 2]) -> Self {
        // A 0 of some exponent makes no other number longer.
        if other.mantissa.is_zero() {
            return self.clone();
        }
        if self.mantissa.is_zero() {
            let mantissa = if is_difference { other.mantissa.negated() } else { other.mantissa.clone() };
            return Self { mantissa, ..*other };
        }
        let (a, b) = (self.mantissa.long() << shifts[0], other.mantissa.long() << shifts[1]);
        Self { mantissa: Mantissa::Long(if is_difference { a - b } else { a + b }), exponent }
    }
}

impl Number for Dyadic {
    fn of(value: f64) -> Self {
        debug_assert!(value.is_finite(), "the contract's numbers are finite");
        let bits = value.to_bits();
        let (biased, fraction) = ((bits >> 52) as i64 & 0x7ff, bits & ((1 << 52) - 1));
        let (magnitude, exponent) =
            if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
        // Drop trailing zeros, so that integers stay short.
        let zeros = if magnitude == 0 { 0 } else { magnitude.trailing_zeros() };
        let mantissa = ShortInteger::of(magnitude >> zeros, value.is_sign_negative());
        Self {
            mantissa: Mantissa::Short(mantissa),
            exponent: if magnitude == 0 { 0 } else { exponent + i64::from(zeros) },
        }
    }

    #[inline]
    fn add(&self, other: &Self) -> Self {
        self.sum(other, false)
    }

    #[inline]
    fn sub(&self, other: &Self) -> Self {
        self.sum(other, true)
    }

    #[inline]
    fn mul(&self, other: &Self) -> Self {
        let exponent = self.exponent + other.exponent;
        if let (Mantissa::Short(a), Mantissa::Short(b)) = (&self.mantissa, &other.mantissa)
            && let Some(product) = a.times(b)
        {
            return Self { mantissa: Mantissa::Short(product), exponent };
        }
        Self { mantissa: Mantissa::Long(self.mantissa.long() * other.mantissa.long()), exponent }
    }

    #[inline]
    fn sign(&self) -> Option<Ordering> {
        Some(self.mantissa.sign())
    }
}

#[cfg(test)]
#[path = "../../tests/unit/number.rs"]
mod tests;
