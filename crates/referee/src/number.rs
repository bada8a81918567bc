//! The two numbers in which every question of the referee is asked: an interval of f64, fast and usually
//! certain, and an exact dyadic rational, always certain.
//!
//! All inputs of the contract are f64 numbers, which are dyadic rationals m 2^e; sums, differences and
//! products of dyadic rationals are dyadic rationals. The questions are signs of polynomials, so division
//! is never needed: [`Dyadic`] answers them without error. [`Interval`] holds a range that contains the
//! exact value; if it lies on one side of zero the sign is proven and the exact arithmetic is not needed.

use std::cmp::Ordering;

use dashu_int::{IBig, Sign, UBig};

/// A number in which a polynomial can be evaluated.
pub(crate) trait Number: Clone {
    /// Exactly this f64, which is finite.
    fn of(value: f64) -> Self;
    fn add(&self, other: &Self) -> Self;
    fn sub(&self, other: &Self) -> Self;
    fn mul(&self, other: &Self) -> Self;
    /// How the exact value compares with 0, if that is certain.
    fn sign(&self) -> Option<Ordering>;

    fn of_integer(value: u32) -> Self {
        Self::of(f64::from(value))
    }

    fn square(&self) -> Self {
        self.mul(self)
    }

    /// Twice this number, which is exact in every binary arithmetic.
    fn doubled(&self) -> Self {
        self.add(self)
    }
}

/// A closed range of reals, between two f64 numbers, that contains the exact value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Interval {
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Interval {
    /// Some number inside, near the middle.
    #[inline]
    pub(crate) fn middle(&self) -> f64 {
        0.5 * self.low + 0.5 * self.high
    }

    /// Everything between two numbers in order.
    #[inline]
    pub(crate) fn between(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// This range and `by` more on both sides; `by` is not negative.
    #[inline]
    pub(crate) fn wider(self, by: f64) -> Self {
        widened(self.low - by, self.high + by)
    }

    /// A range that contains both.
    #[inline]
    pub(crate) fn hull(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// The quotient; everything if the divisor may be 0.
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

/// Widens `low..=high`, each the result of one operation rounded to nearest, so that it contains the
/// results of the operation without rounding.
///
/// A result x is wrong by at most half a unit in its last place, at most 2^-53 |x|, or by half the smallest
/// subnormal number. The widening |x| 2^-52 + 2^-1022 is at least twice that, so that the rounding of the
/// widening itself, of the same size as the first, is covered too.
#[inline]
fn widened(low: f64, high: f64) -> Interval {
    let below = low.abs() * f64::EPSILON + f64::MIN_POSITIVE;
    let above = high.abs() * f64::EPSILON + f64::MIN_POSITIVE;
    Interval { low: low - below, high: high + above }
}

impl Number for Interval {
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
        let [a, b, c, d] =
            [self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high];
        widened(a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
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
    mantissa: IBig,
    exponent: i64,
}

impl Dyadic {
    /// Sign, magnitude and the exponent of 2 that the magnitude is multiplied by.
    pub(crate) fn parts(&self) -> (Sign, UBig, i64) {
        let (sign, magnitude) = self.mantissa.clone().into_parts();
        (sign, magnitude, self.exponent)
    }

    /// Both mantissas at the smaller of the two exponents.
    fn aligned(&self, other: &Self) -> (IBig, IBig, i64) {
        let exponent = self.exponent.min(other.exponent);
        let shifted = |number: &Self| &number.mantissa << (number.exponent - exponent) as usize;
        (shifted(self), shifted(other), exponent)
    }
}

impl Number for Dyadic {
    fn of(value: f64) -> Self {
        debug_assert!(value.is_finite(), "the contract's numbers are finite");
        let bits = value.to_bits();
        let (biased, fraction) = ((bits >> 52) as i64 & 0x7ff, (bits & ((1 << 52) - 1)) as i64);
        let (magnitude, exponent) =
            if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
        // Without its trailing zeros, so that whole numbers stay short.
        let zeros = if magnitude == 0 { 0 } else { magnitude.trailing_zeros() };
        let mantissa =
            IBig::from(if value.is_sign_negative() { -(magnitude >> zeros) } else { magnitude >> zeros });
        Self { mantissa, exponent: if magnitude == 0 { 0 } else { exponent + i64::from(zeros) } }
    }

    fn add(&self, other: &Self) -> Self {
        let (a, b, exponent) = self.aligned(other);
        Self { mantissa: a + b, exponent }
    }

    fn sub(&self, other: &Self) -> Self {
        let (a, b, exponent) = self.aligned(other);
        Self { mantissa: a - b, exponent }
    }

    fn mul(&self, other: &Self) -> Self {
        Self { mantissa: &self.mantissa * &other.mantissa, exponent: self.exponent + other.exponent }
    }

    fn sign(&self) -> Option<Ordering> {
        Some(self.mantissa.cmp(&IBig::ZERO))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Any finite f64 whose products of three stay finite.
    fn some_number() -> impl Strategy<Value = f64> {
        prop_oneof![
            any::<f64>().prop_filter("moderate", |x| x.abs() < 1e90 && (*x == 0.0 || x.abs() > 1e-90)),
            -4.0f64..4.0,
            (-8i32..8).prop_map(f64::from),
            Just(0.0),
        ]
    }

    /// Whether an exact number lies in an interval.
    fn contains(interval: Interval, exact: &Dyadic) -> bool {
        let not_below = exact.sub(&Dyadic::of(interval.low)).sign() != Some(Ordering::Less);
        let not_above = Dyadic::of(interval.high).sub(exact).sign() != Some(Ordering::Less);
        not_below && not_above
    }

    proptest! {
        #[test]
        fn a_dyadic_is_its_f64(x in some_number()) {
            // Exactly: m 2^e equals x, by rebuilding it from the integer where that is exact.
            let d = Dyadic::of(x);
            prop_assert_eq!(d.sign(), x.partial_cmp(&0.0));
            prop_assert_eq!(d.sub(&Dyadic::of(x)).sign(), Some(Ordering::Equal));
            prop_assert_eq!(d.sub(&Dyadic::of(x.next_up())).sign(), Some(Ordering::Less));
        }

        #[test]
        fn an_interval_contains_the_exact_value(a in some_number(), b in some_number(), c in some_number()) {
            fn poly<T: Number>(a: f64, b: f64, c: f64) -> T {
                let (a, b, c) = (T::of(a), T::of(b), T::of(c));
                a.mul(&b).sub(&c.square()).add(&b.mul(&c).mul(&a)).sub(&a.doubled())
            }
            prop_assert!(contains(poly::<Interval>(a, b, c), &poly::<Dyadic>(a, b, c)));
        }

        #[test]
        fn a_quotient_times_its_divisor_contains_the_dividend(a in some_number(), b in some_number()) {
            let quotient = Interval::of(a).over(Interval::of(b));
            prop_assert!(b == 0.0 || contains(quotient.mul(&Interval::of(b)), &Dyadic::of(a)));
            prop_assert!(b != 0.0 || (quotient.low == f64::NEG_INFINITY && quotient.high == f64::INFINITY));
        }

        #[test]
        fn ordinary_sums_and_products_are_exact(a in -1_000_000i64..1_000_000, b in -1_000_000i64..1_000_000) {
            // Whole numbers: what i64 says, Dyadic says.
            let (x, y) = (Dyadic::of(a as f64), Dyadic::of(b as f64));
            prop_assert_eq!(x.mul(&y).sub(&Dyadic::of((a * b) as f64)).sign(), Some(Ordering::Equal));
            prop_assert_eq!(x.add(&y).sign(), Some((a + b).cmp(&0)));
            prop_assert_eq!(x.sub(&y).sign(), Some(a.cmp(&b)));
        }
    }

    #[test]
    fn an_interval_has_a_sign_only_if_all_of_it_has() {
        let sign = |low: f64, high: f64| Interval::between(low, high).sign();
        assert_eq!(sign(1e-300, 2.0), Some(Ordering::Greater));
        assert_eq!(sign(-2.0, -1e-300), Some(Ordering::Less));
        assert_eq!(sign(0.0, 0.0), Some(Ordering::Equal));
        assert_eq!([sign(0.0, 1.0), sign(-1.0, 0.0), sign(-1.0, 1.0)], [None; 3]);
    }

    #[test]
    fn squares_are_never_negative() {
        let square = |low: f64, high: f64| Interval::between(low, high).square();
        for (low, high, most) in
            [(0.0, 1.0, 1.0), (-2.0, 1.0, 4.0), (-1.0, 0.0, 1.0), (-1e-200, 1e-200, 1e-307)]
        {
            let found = square(low, high);
            assert!(found.low == 0.0 && found.high >= high * high && found.high <= most * 1.001, "{found:?}");
        }
        let found = square(-3.0, -2.0);
        assert!(
            found.low <= 4.0 && found.low > 3.999 && found.high >= 9.0 && found.high < 9.001,
            "{found:?}"
        );
    }
}
