//! One formula, evaluated in either of two arithmetics: pairs of f64, or enclosures of growing precision.

use std::sync::OnceLock;

use crate::numbers::double_double::DoubleDouble;
use crate::numbers::elementary;
use crate::numbers::enclosure::{Enclosure, Precision};
use crate::numbers::number::{Dyadic, Number};
use crate::numbers::rounding::Rounded;

/// A value whose rounding no tried precision decides; it holds one of the two nearest numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Undecided(pub Rounded);

/// The precisions tried one after the other, in bits. A value that neither is a midpoint of two f64 nor was
/// constructed to lie near one needs the second of them once in 2^60 cases.
const PRECISIONS_BITS: [usize; 5] = [128, 256, 512, 1024, 2048];

/// The operations of a formula in positive numbers.
pub(crate) trait Arithmetic {
    /// The numbers in which polynomials of rays and faces are evaluated.
    type Exact: Number;
    /// The numbers in which the formula is evaluated.
    type Real: Clone;

    /// |x|.
    fn abs(&self, x: &Self::Exact) -> Self::Real;
    fn add(&self, x: &Self::Real, y: &Self::Real) -> Self::Real;
    /// |x - y|.
    fn distance(&self, x: &Self::Real, y: &Self::Real) -> Self::Real;
    fn mul(&self, x: &Self::Real, y: &Self::Real) -> Self::Real;
    fn div(&self, x: &Self::Real, y: &Self::Real) -> Self::Real;
    fn sqrt(&self, x: &Self::Real) -> Self::Real;
    /// exp(-x).
    fn exp_minus(&self, x: &Self::Real) -> Self::Real;
    fn atan(&self, x: &Self::Real) -> Self::Real;
    fn pi(&self) -> Self::Real;
    fn ln_2(&self) -> Self::Real;
    /// The sum of a beam's weights: from the cache, or computed by `form`.
    fn weight_sum(&self, cache: &WeightSum, form: impl FnOnce() -> Self::Real) -> Self::Real;

    /// |x| of an f64.
    fn exact(&self, x: f64) -> Self::Real {
        self.abs(&Self::Exact::of(x))
    }
}

/// The sum of a beam's weights, cached for each arithmetic.
#[derive(Debug, Default)]
pub(crate) struct WeightSum {
    fast: OnceLock<DoubleDouble>,
    enclosures: [OnceLock<Enclosure>; PRECISIONS_BITS.len()],
}

/// Pairs of f64.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fast;

impl Arithmetic for Fast {
    type Exact = DoubleDouble;
    type Real = DoubleDouble;

    fn abs(&self, x: &DoubleDouble) -> DoubleDouble {
        x.abs()
    }

    fn add(&self, x: &DoubleDouble, y: &DoubleDouble) -> DoubleDouble {
        x.add(y)
    }

    fn distance(&self, x: &DoubleDouble, y: &DoubleDouble) -> DoubleDouble {
        x.sub(y).abs()
    }

    fn mul(&self, x: &DoubleDouble, y: &DoubleDouble) -> DoubleDouble {
        x.mul(y)
    }

    fn div(&self, x: &DoubleDouble, y: &DoubleDouble) -> DoubleDouble {
        x.over(y)
    }

    fn sqrt(&self, x: &DoubleDouble) -> DoubleDouble {
        x.sqrt()
    }

    fn exp_minus(&self, x: &DoubleDouble) -> DoubleDouble {
        elementary::exp_minus(x)
    }

    fn atan(&self, x: &DoubleDouble) -> DoubleDouble {
        elementary::atan(x)
    }

    fn pi(&self) -> DoubleDouble {
        DoubleDouble::PI
    }

    fn ln_2(&self) -> DoubleDouble {
        elementary::LN_2
    }

    fn weight_sum(&self, cache: &WeightSum, form: impl FnOnce() -> DoubleDouble) -> DoubleDouble {
        *cache.fast.get_or_init(form)
    }
}

/// Enclosures with one of the precisions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PrecisionLevel {
    index: usize,
    precision: Precision,
}

impl Arithmetic for PrecisionLevel {
    type Exact = Dyadic;
    type Real = Enclosure;

    fn abs(&self, x: &Dyadic) -> Enclosure {
        self.precision.magnitude(x)
    }

    fn add(&self, x: &Enclosure, y: &Enclosure) -> Enclosure {
        self.precision.add(x, y)
    }

    fn distance(&self, x: &Enclosure, y: &Enclosure) -> Enclosure {
        self.precision.distance(x, y)
    }

    fn mul(&self, x: &Enclosure, y: &Enclosure) -> Enclosure {
        self.precision.mul(x, y)
    }

    fn div(&self, x: &Enclosure, y: &Enclosure) -> Enclosure {
        self.precision.div(x, y)
    }

    fn sqrt(&self, x: &Enclosure) -> Enclosure {
        self.precision.sqrt(x)
    }

    fn exp_minus(&self, x: &Enclosure) -> Enclosure {
        self.precision.exp_minus(x)
    }

    fn atan(&self, x: &Enclosure) -> Enclosure {
        self.precision.atan(x)
    }

    fn pi(&self) -> Enclosure {
        self.precision.pi()
    }

    fn ln_2(&self) -> Enclosure {
        self.precision.ln_2()
    }

    fn weight_sum(&self, cache: &WeightSum, form: impl FnOnce() -> Enclosure) -> Enclosure {
        cache.enclosures[self.index].get_or_init(form).clone()
    }
}

/// Rounds a value correctly: by its pair of f64 if that is certain, else by enclosures of growing precision.
pub(crate) fn decide_rounding(
    fast: DoubleDouble,
    enclose: impl Fn(&PrecisionLevel) -> Enclosure,
) -> Result<Rounded, Undecided> {
    if let Some(rounded) = fast.rounded() {
        return Ok(rounded);
    }
    let mut last = Rounded::ZERO;
    for (index, bits) in PRECISIONS_BITS.into_iter().enumerate() {
        let enclosure = enclose(&PrecisionLevel { index, precision: Precision::new(bits) });
        match enclosure.rounded() {
            Some(rounded) => return Ok(rounded),
            None => last = enclosure.low_rounded(),
        }
    }
    Err(Undecided(last))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_on_a_midpoint_is_undecided_and_what_does_not_is_decided() {
        // (1 + 2^-53 + more) / 7 times 7. The quotient is rounded: 2^53 + 1 is no multiple of 7 (but of 3).
        let value = |more: f64| {
            decide_rounding(DoubleDouble::UNKNOWN, |a| {
                let half_way = a.add(&a.exact(1.0), &a.exact(f64::EPSILON / 2.0));
                let number = a.add(&half_way, &a.exact(more));
                a.mul(&a.div(&number, &a.exact(7.0)), &a.exact(7.0))
            })
        };
        let one = Rounded { double: 1.0, single: 1.0 };
        assert_eq!(value(0.0), Err(Undecided(one)));
        // 2^-600 more takes 1024 bits.
        let up = Rounded { double: 1.0 + f64::EPSILON, single: 1.0 };
        assert_eq!(value(libm::scalbn(1.0, -600)), Ok(up));
    }

    #[test]
    fn both_arithmetics_agree() {
        fn formula<A: Arithmetic>(a: &A) -> A::Real {
            let third = a.div(&a.exact(1.0), &a.exact(-3.0));
            let root = a.sqrt(&a.add(&third, &a.exact(2.0)));
            a.mul(&a.pi(), &a.distance(&third, &root))
        }
        let fast = formula(&Fast).rounded().expect("decided");
        assert_eq!(decide_rounding(DoubleDouble::UNKNOWN, formula), Ok(fast));
        // pi |1/3 - sqrt(7/3)| = 3.7516...
        assert!((fast.double - std::f64::consts::PI * ((7.0f64 / 3.0).sqrt() - 1.0 / 3.0)).abs() < 1e-15);
    }
}
