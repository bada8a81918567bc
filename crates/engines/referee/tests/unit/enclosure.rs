//! Enclosures against tables of constants, and their ends.

use super::*;
use crate::numbers::number::Number;

fn exactly(x: f64) -> Enclosure {
    Precision::new(128).magnitude(&Dyadic::of(x))
}

/// That the enclosure is narrow and holds `digits` 10^-places: what tables print.
fn holds(x: &Enclosure, digits: &str, places: u32) {
    let units: IBig = digits.parse().expect("digits");
    let scale = IBig::from(10).pow(places as usize);
    // low 10^places <= digits + 1 and high 10^places >= digits, as the printed digits are cut off.
    let scaled = |end: &Real| -> IBig {
        let product = end.significand() * &scale;
        match end.exponent() {
            shift @ 0.. => product << shift as usize,
            shift => product >> shift.unsigned_abs(),
        }
    };
    assert_eq!(scaled(&x.low), units, "{x:?}");
    assert!(scaled(&x.high) >= units && scaled(&x.high) <= units + 1, "{x:?}");
}

#[test]
fn constants_have_the_digits_of_the_tables() {
    // Abramowitz and Stegun, tables 1.1 and 4.2: pi, ln 2, e^-1, pi / 4.
    let precision = Precision::new(128);
    holds(&precision.pi(), "314159265358979323846264", 23);
    holds(&precision.ln_2(), "69314718055994530941723", 23);
    holds(&precision.exp_minus(&exactly(1.0)), "36787944117144232159552", 23);
    holds(&precision.atan(&exactly(1.0)), "78539816339744830961566", 23);
}

#[test]
fn ends_keep_their_sides() {
    let precision = Precision::new(64);
    let third = precision.div(&exactly(1.0), &exactly(3.0));
    assert!(third.low < third.high);
    let apart = precision.distance(&third, &third);
    assert!(apart.low == zero() && apart.high.sign() == Sign::Positive);
    let apart = precision.distance(&exactly(1.0), &third);
    let same = precision.distance(&third, &exactly(1.0));
    assert!(apart.low == same.low && apart.high == same.high && apart.low < apart.high);
    assert_eq!(precision.mul(&third, &exactly(3.0)).rounded(), Some(Rounded { double: 1.0, single: 1.0 }));
    // 1 + 2^-53 is a midpoint of f64: an enclosure around it decides nothing, its exact self does.
    let midpoint = precision.add(&exactly(1.0), &exactly(f64::EPSILON / 2.0));
    assert_eq!(midpoint.rounded().map(|r| r.double), Some(1.0));
    let around = precision.mul(&third, &precision.mul(&exactly(3.0), &midpoint));
    assert_eq!(around.rounded(), None);
}

#[test]
fn what_vanishes_is_zero() {
    let precision = Precision::new(128);
    let nothing = precision.exp_minus(&exactly(4e18));
    assert_eq!(nothing.rounded(), Some(Rounded::ZERO));
    assert_eq!(precision.exp_minus(&exactly(0.0)).rounded(), Some(Rounded { double: 1.0, single: 1.0 }));
    // exp(-740) is subnormal: 4.2e-322 is 85 times the least f64. (exp(740) = 2.4e321, by ln 10 = 2.302585)
    let small = precision.exp_minus(&exactly(740.0)).rounded().expect("decided");
    assert_eq!(small, Rounded { double: libm::exp(-740.0), single: 0.0 });
    assert!((80.0..90.0).contains(&(small.double / f64::from_bits(1))));
}
