//! exp and atan of pairs against enclosures of 512 bits, which know other series.

use proptest::prelude::*;

use super::*;
use crate::numbers::enclosure::{Enclosure, Precision};
use crate::numbers::number::Dyadic;

const BITS: usize = 512;

/// How far the number is from the true one, in parts of its own claim: at most 1 if that holds.
fn off(claimed: &DoubleDouble, truth: &Enclosure) -> f64 {
    let precision = Precision::new(BITS);
    let [high, low, error] = claimed.parts();
    assert!(error > 0.0 && error.is_finite(), "{claimed:?}");
    let number = precision.magnitude(&Dyadic::of(high).add(&Dyadic::of(low)));
    let away = precision.distance(truth, &number);
    precision.div(&away, &precision.magnitude(&Dyadic::of(error))).low_rounded().double
}

/// That the claim holds, and is narrow: a part of the number.
fn assert_claim(claimed: &DoubleDouble, truth: &Enclosure, narrow: f64) {
    let off = off(claimed, truth);
    assert!(off <= 1.0, "{claimed:?} is off by {off} of its error");
    let [high, _, error] = claimed.parts();
    assert!(error <= high * narrow, "{claimed:?}");
}

/// a + b as a pair and without rounding.
fn sum(a: f64, b: f64) -> (DoubleDouble, Enclosure) {
    let exact = Precision::new(BITS).magnitude(&Dyadic::of(a).add(&Dyadic::of(b)));
    (DoubleDouble::of(a).add(&DoubleDouble::of(b)), exact)
}

/// a / b, which a pair has with an error.
fn quotient(a: f64, b: f64) -> (DoubleDouble, Enclosure) {
    let precision = Precision::new(BITS);
    let [over, under] = [a, b].map(|x| precision.magnitude(&Dyadic::of(x)));
    (DoubleDouble::of(a).over(&DoubleDouble::of(b)), precision.div(&over, &under))
}

/// Numbers from 1e-30 to `most`, all sizes alike.
fn up_to(most: f64) -> impl Strategy<Value = f64> {
    (-30.0..libm::log10(most)).prop_map(|power| libm::pow(10.0, power))
}

#[test]
fn ln_2_is_that_of_the_enclosures() {
    assert_claim(&LN_2, &Precision::new(BITS).ln_2(), 1e-33);
    assert_claim(&DoubleDouble::PI, &Precision::new(BITS).pi(), 1e-32);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn exp_is_that_of_the_enclosures(a in up_to(499.0), part in 0.0f64..1e-16, b in 0.5f64..2.0) {
        let precision = Precision::new(BITS);
        for (x, exact) in [sum(a, a * part), quotient(a * 0.5, b)] {
            // An argument of 500 with an error of 2^-103 has one of 500 times that, and so has exp.
            assert_claim(&exp_minus(&x), &precision.exp_minus(&exact), 1e-26);
        }
    }

    #[test]
    fn atan_is_that_of_the_enclosures(a in up_to(1e30), part in 0.0f64..1e-16, b in 0.5f64..2.0) {
        let precision = Precision::new(BITS);
        for (x, exact) in [sum(a, a * part), quotient(a, b)] {
            assert_claim(&atan(&x), &precision.atan(&exact), 1e-29);
        }
    }
}

/// Where the reduction of the argument changes: halves of ln 2, and 45 degrees.
#[test]
fn claims_hold_on_both_sides_of_each_seam() {
    let precision = Precision::new(BITS);
    for k in 0..700 {
        let seam = (f64::from(k) + 0.5) * std::f64::consts::LN_2;
        for x in [seam.next_down(), seam, seam.next_up()] {
            let (x, exact) = sum(x, 0.0);
            assert_claim(&exp_minus(&x), &precision.exp_minus(&exact), 1e-27);
        }
    }
    for x in [1.0_f64.next_down(), 1.0, 1.0_f64.next_up()] {
        let (x, exact) = sum(x, 0.0);
        assert_claim(&atan(&x), &precision.atan(&exact), 1e-29);
    }
    // At 45 degrees no quotient and no pi adds to the error.
    let [high, _, error] = atan(&DoubleDouble::of(1.0)).parts();
    assert!(high == std::f64::consts::FRAC_PI_4 && error < 1e-30, "{error:e}");
}

#[test]
fn what_is_out_of_reach_is_unknown_and_zero_is_not() {
    let of = DoubleDouble::of;
    for x in [500.0, 1e300, f64::MAX] {
        assert_eq!(exp_minus(&of(x)), DoubleDouble::UNKNOWN, "{x}");
    }
    assert_eq!(exp_minus(&DoubleDouble::UNKNOWN), DoubleDouble::UNKNOWN);
    assert_eq!(atan(&DoubleDouble::UNKNOWN), DoubleDouble::UNKNOWN);
    let rounded = |x: DoubleDouble| x.rounded().map(|rounded| rounded.double);
    assert_eq!(rounded(exp_minus(&of(0.0))), Some(1.0));
    assert_eq!(rounded(atan(&of(0.0))), Some(0.0));
}

/// Otherwise every value would take enclosures after all.
#[test]
fn most_values_are_decided() {
    let undecided = (1..20_000).filter(|&n| {
        let x = DoubleDouble::of(f64::from(n)).over(&DoubleDouble::of(997.0));
        exp_minus(&x).rounded().is_none() || atan(&x).rounded().is_none()
    });
    assert_eq!(undecided.count(), 0);
}
