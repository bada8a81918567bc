//! Enclosures of positive reals at any precision: they decide the roundings that 106 bits leave open.
//!
//! Both ends are binary numbers of `precision` bits. Each operation rounds the low end down and the high end up.
//! dashu-float rounds correctly in the direction asked for, also `exp`, `atan` and pi (it repeats with more digits
//! until the rounding is certain). All numbers here are positive or 0: the caller keeps the signs.

use dashu_float::round::mode::{Down, Up};
use dashu_float::round::{ErrorBounds, Round};
use dashu_float::{Context, FBig, Repr};
use dashu_int::{IBig, Sign};

use crate::numbers::number::Dyadic;
use crate::numbers::rounding::{LeadingBits, Rounded};

type Real = Repr<2>;

/// An interval that contains a real number x >= 0: low <= x <= high, 0 <= low.
#[derive(Debug, Clone)]
pub(crate) struct Enclosure {
    low: Real,
    high: Real,
}

/// Largest argument of exp(-x) that is evaluated; beyond it the enclosure is from 0 to 2^-1000000. A flux with such a
/// factor is 0 in f64, whose smallest number is 2^-1074.
const MAX_EXP_ARGUMENT: i64 = 800_000;

/// The operations at one precision.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Precision {
    down: Context<Down>,
    up: Context<Up>,
}

/// The value of an operation that is defined for its arguments.
fn value<R: Round>(result: dashu_float::FpResult<FBig<R, 2>>) -> Real {
    result.expect("defined for positive numbers").value().into_repr()
}

fn zero() -> Real {
    Repr::zero()
}

/// The larger of x and 0.
fn not_negative(x: Real) -> Real {
    if x.sign() == Sign::Negative { zero() } else { x }
}

impl Precision {
    pub(crate) fn new(bits: usize) -> Self {
        Self { down: Context::new(bits), up: Context::new(bits) }
    }

    /// The absolute value of an exact number.
    pub(crate) fn magnitude(&self, x: &Dyadic) -> Enclosure {
        let (_, magnitude, exponent) = x.parts();
        let x: Real = Repr::new(IBig::from(magnitude), exponent as isize);
        Enclosure { low: self.round_down(&x), high: self.round_up(&x) }
    }

    fn round_down(&self, x: &Real) -> Real {
        value(self.down.add(x, &zero()))
    }

    fn round_up(&self, x: &Real) -> Real {
        value(self.up.add(x, &zero()))
    }

    pub(crate) fn add(&self, x: &Enclosure, y: &Enclosure) -> Enclosure {
        Enclosure { low: value(self.down.add(&x.low, &y.low)), high: value(self.up.add(&x.high, &y.high)) }
    }

    /// |x - y|.
    pub(crate) fn distance(&self, x: &Enclosure, y: &Enclosure) -> Enclosure {
        let below = value(self.down.sub(&x.low, &y.high));
        let above = value(self.down.sub(&y.low, &x.high));
        let low = if below.sign() == Sign::Positive { below } else { not_negative(above) };
        let [one, other] = [(&x.high, &y.low), (&y.high, &x.low)]
            .map(|(high, low)| not_negative(value(self.up.sub(high, low))));
        let high = if one > other { one } else { other };
        Enclosure { low, high }
    }

    pub(crate) fn mul(&self, x: &Enclosure, y: &Enclosure) -> Enclosure {
        Enclosure { low: value(self.down.mul(&x.low, &y.low)), high: value(self.up.mul(&x.high, &y.high)) }
    }

    /// x / y; y must not contain 0.
    pub(crate) fn div(&self, x: &Enclosure, y: &Enclosure) -> Enclosure {
        Enclosure { low: value(self.down.div(&x.low, &y.high)), high: value(self.up.div(&x.high, &y.low)) }
    }

    pub(crate) fn sqrt(&self, x: &Enclosure) -> Enclosure {
        Enclosure { low: value(self.down.sqrt(&x.low)), high: value(self.up.sqrt(&x.high)) }
    }

    /// exp(-x).
    pub(crate) fn exp_minus(&self, x: &Enclosure) -> Enclosure {
        fn of<R: ErrorBounds>(context: &Context<R>, x: &Real) -> Option<Real> {
            let limit: Real = Repr::new(IBig::from(MAX_EXP_ARGUMENT), 0);
            (*x <= limit).then(|| value(context.exp(&-x.clone(), None)))
        }
        Enclosure {
            low: of(&self.down, &x.high).unwrap_or_else(zero),
            high: of(&self.up, &x.low).unwrap_or_else(|| Repr::new(IBig::ONE, -1_000_000)),
        }
    }

    pub(crate) fn atan(&self, x: &Enclosure) -> Enclosure {
        Enclosure { low: value(self.down.atan(&x.low, None)), high: value(self.up.atan(&x.high, None)) }
    }

    pub(crate) fn pi(&self) -> Enclosure {
        Enclosure {
            low: self.down.pi::<2>(None).value().into_repr(),
            high: self.up.pi::<2>(None).value().into_repr(),
        }
    }

    /// ln 2.
    pub(crate) fn ln_2(&self) -> Enclosure {
        let two: Real = Repr::new(IBig::from(2), 0);
        Enclosure { low: value(self.down.ln(&two, None)), high: value(self.up.ln(&two, None)) }
    }
}

fn rounded(x: &Real) -> Rounded {
    let (_, magnitude) = x.significand().clone().into_parts();
    LeadingBits::of(false, magnitude, x.exponent() as i64, true).rounded()
}

impl Enclosure {
    /// The number correctly rounded to f64 and f32, if both ends round alike.
    pub(crate) fn rounded(&self) -> Option<Rounded> {
        let [low, high] = [&self.low, &self.high].map(rounded);
        (low == high).then_some(low)
    }

    /// The lower end, rounded.
    pub(crate) fn low_rounded(&self) -> Rounded {
        rounded(&self.low)
    }
}

#[cfg(test)]
#[path = "../../tests/unit/enclosure.rs"]
mod tests;
