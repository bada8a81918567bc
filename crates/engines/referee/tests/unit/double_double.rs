//! Claimed errors against exact arithmetic, and roundings.

use super::*;
use crate::numbers::number::Dyadic;
use crate::numbers::rounding;
use dashu_int::Sign;
use proptest::prelude::*;

fn some_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>().prop_filter("moderate", |x| x.abs() < 1e40 && (*x == 0.0 || x.abs() > 1e-40)),
        -4.0f64..4.0,
        any::<f32>().prop_filter("moderate", |x| x.abs() < 1e20 && x.abs() > 1e-20).prop_map(f64::from),
        (-8i32..8).prop_map(f64::from),
    ]
}

/// Whether the exact number lies within the claimed error.
pub(super) fn holds(claimed: &DoubleDouble, exact: &Dyadic) -> bool {
    if claimed.error.is_infinite() {
        return true;
    }
    let off = exact.sub(&Dyadic::of(claimed.high)).sub(&Dyadic::of(claimed.low));
    off.square().sub(&Dyadic::of(claimed.error).square()).sign() != Some(Ordering::Greater)
}

/// Whether the claim holds for p / q.
pub(super) fn holds_quotient(claimed: &DoubleDouble, p: &Dyadic, q: &Dyadic) -> bool {
    let times = |x: f64| q.mul(&Dyadic::of(x));
    let off = p.sub(&times(claimed.high)).sub(&times(claimed.low));
    claimed.error.is_infinite()
        || off.square().sub(&times(claimed.error).square()).sign() != Some(Ordering::Greater)
}

/// A polynomial with cancellation and every operation but division.
fn poly<T: Number>([a, b, c, d]: [f64; 4]) -> T {
    let [a, b, c, d] = [a, b, c, d].map(T::of);
    let x = a.mul(&b).sub(&c.mul(&d)).mul(&a.sub(&d));
    x.add(&b.square().mul(&c)).sub(&x.mul(&d)).sub(&b.square().mul(&c).doubled())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn the_claim_holds_for_polynomials(a in some_number(), b in some_number(), c in some_number(), d in some_number()) {
        let all = [a, b, c, d];
        prop_assert!(holds(&poly::<DoubleDouble>(all), &poly::<Dyadic>(all)));
        let near = [a, b, a * (1.0 + f64::EPSILON), b];
        prop_assert!(holds(&poly::<DoubleDouble>(near), &poly::<Dyadic>(near)));
    }

    #[test]
    fn what_is_rounded_is_what_exact_arithmetic_rounds(
        a in some_number(), b in some_number(), c in some_number(), d in some_number()
    ) {
        let (p, q) = (poly::<DoubleDouble>([a, b, c, d]), poly::<DoubleDouble>([d, a, b, b]));
        let (exact_p, exact_q) = (poly::<Dyadic>([a, b, c, d]), poly::<Dyadic>([d, a, b, b]));
        prop_assume!(exact_q.sign() != Some(Ordering::Equal));
        if let Some(rounded) = p.over(&q).rounded() {
            prop_assert_eq!(rounded, rounding::quotient(&exact_p, &exact_q));
        }
        if let Some(rounded) = p.square().over(&q.square()).sqrt().rounded() {
            let exact = rounding::root(Sign::Positive, &exact_p.square(), &exact_q.square());
            prop_assert_eq!(rounded, exact);
        }
        if let Some(rounded) = p.square().add(&q.square()).sqrt().rounded() {
            let sum = exact_p.square().add(&exact_q.square());
            prop_assert_eq!(rounded, rounding::root(Sign::Positive, &sum, &Dyadic::of(1.0)));
        }
    }
}

#[test]
fn most_numbers_are_decided() {
    // Thirds, fifths ... and their roots: not one in a million needs more than this.
    let undecided = (1..20_000_u32)
        .filter(|&n| {
            let third = DoubleDouble::of(f64::from(n)).over(&DoubleDouble::of(f64::from(3 * n + 1)));
            third.rounded().is_none() || third.sqrt().rounded().is_none()
        })
        .count();
    assert_eq!(undecided, 0);
}

#[test]
fn what_cancels_to_nothing_is_still_bounded() {
    // a b - a b is 0 with some doubt; times another, and added to something, it is a small doubt of that.
    let (a, b) = (
        DoubleDouble::of(0.1).over(&DoubleDouble::of(3.0)),
        DoubleDouble::of(0.7).over(&DoubleDouble::of(11.0)),
    );
    let nothing = a.mul(&b).sub(&b.mul(&a));
    assert!(nothing.high == 0.0 && nothing.error > 0.0);
    let sum = a.add(&nothing.mul(&DoubleDouble::of(1e3)));
    assert_eq!(sum.rounded(), a.rounded());
    assert!(sum.rounded().is_some());
}

#[test]
fn what_is_out_of_range_is_unknown() {
    let tiny = DoubleDouble::of(1e-200);
    assert_eq!(tiny.mul(&tiny).rounded(), None);
    assert_eq!(DoubleDouble::of(1e200).mul(&DoubleDouble::of(1e200)), DoubleDouble::UNKNOWN);
    assert_eq!(DoubleDouble::of(1e200).mul(&DoubleDouble::of(1e200)).rounded(), None);
    assert_eq!(DoubleDouble::of(1.0).over(&DoubleDouble::of(0.0)).rounded(), None);
    assert_eq!(DoubleDouble::of(-1.0).sqrt().rounded(), None);
    assert_eq!(DoubleDouble::of(0.0).sqrt().rounded(), Some(Rounded::ZERO));
}

const UNIT: f64 = 0.5 * f64::EPSILON;

#[test]
fn quotients_of_what_may_be_0_are_unknown() {
    let one = DoubleDouble::of(1.0);
    // 1 to within 2, of which the first digits look harmless.
    let doubtful = DoubleDouble { error: 2.0, ..one };
    assert_eq!(one.over(&doubtful), DoubleDouble::UNKNOWN);
    // 1e-300: partial results might underflow.
    assert_eq!(DoubleDouble::of(1e-150).over(&DoubleDouble::of(1e150)), DoubleDouble::UNKNOWN);
    // And 0 over something is 0.
    assert_eq!(DoubleDouble::of(0.0).over(&DoubleDouble::of(3.0)), DoubleDouble::of(0.0));
}

#[test]
fn roots_and_quotients_are_good_to_a_hundred_bits() {
    for x in [2.0, 3.0, 1e-20, 7e30] {
        let root = DoubleDouble::of(x).sqrt();
        assert!(root.error < root.high * 1e-30, "{root:?}");
        let third = DoubleDouble::of(x).over(&DoubleDouble::of(3.0));
        assert!(third.error < third.high * 1e-30, "{third:?}");
    }
    // A number that might just be 0 has no root: the error for which the least it can be is 0 to the last bit.
    let doubt = |error: f64| DoubleDouble { error, ..DoubleDouble::of(1.0) };
    let mut error = 1.0;
    while doubt(error).lower_bound() < 0.0 {
        error = error.next_down();
    }
    assert!(doubt(error).lower_bound() < 1e-12);
    assert_eq!(doubt(error.next_up()).sqrt(), DoubleDouble::UNKNOWN);
    assert_eq!(doubt(2.0).sqrt(), DoubleDouble::UNKNOWN);
}

#[test]
fn a_midpoint_of_singles_is_decided_by_what_comes_after_the_double() {
    // Half way between 1 and the next f32.
    let high = 1.0 + 1.0 / (1u32 << 24) as f64;
    let (above, bit) = (1.0_f32.next_up(), UNIT * UNIT);
    let of = |low: f64, error: f64| DoubleDouble { high, low, error }.rounded();
    for error in [0.0, 0.25 * bit] {
        assert_eq!(of(bit, error), Some(Rounded { double: high, single: above }), "{error:e}");
        assert_eq!(of(-bit, error), Some(Rounded { double: high, single: 1.0 }), "{error:e}");
    }
    // Exactly on it: to the even one. Perhaps: unknown, on whichever side the middle is.
    assert_eq!(of(0.0, 0.0), Some(Rounded { double: high, single: 1.0 }));
    for low in [bit, 0.0, -bit] {
        assert_eq!(of(low, 4.0 * bit), None, "{low:e}");
    }
    // Elsewhere the side is of no account.
    let aside = DoubleDouble { high: 1.5, low: bit, error: 4.0 * bit };
    assert_eq!(aside.rounded(), Some(Rounded { double: 1.5, single: 1.5 }));
    // Where the ends round to two doubles nothing is certain.
    assert_eq!(DoubleDouble { high: 1.0, low: UNIT, error: bit }.rounded(), None);
    // The double is a neighbour of the first digits if those after them come near half a unit.
    let carried = DoubleDouble { high: 1.0, low: 1.5 * UNIT, error: 0.0 }.rounded();
    assert_eq!(carried, Some(Rounded { double: 1.0 + 2.0 * UNIT, single: 1.0 }));
}

#[test]
fn products_know_their_errors() {
    let word = |high: f64, low: f64, error: f64| DoubleDouble { high, low, error };
    // Of two doubles none; of longer numbers 8 u^2 of it, and what the factors bring.
    assert_eq!(DoubleDouble::of(0.1).mul(&DoubleDouble::of(0.7)).error, 0.0);
    let (a, b) = (word(3.0, UNIT, 0.0), word(-5.0, UNIT, 0.0));
    for (x, y) in [(a, b), (a, DoubleDouble::of(-5.0)), (DoubleDouble::of(3.0), b)] {
        let product = x.mul(&y);
        let by = product.error / (15.0 * PRODUCT_ERROR) - 1.0;
        assert!((0.0..1e-13).contains(&by), "{product:?}");
    }
    let product = word(3.0, 0.0, 1e-20).mul(&word(-5.0, 0.0, 1e-18));
    let by = product.error / (5e-20 + 3e-18) - 1.0;
    assert!((0.0..1e-12).contains(&by), "{product:?}");
    // Sums: 4 u^2, of longer numbers.
    assert_eq!(DoubleDouble::of(0.1).add(&DoubleDouble::of(0.7)).error, 0.0);
    for (x, y) in [(a, b), (a, DoubleDouble::of(-5.0)), (DoubleDouble::of(3.0), b)] {
        let by = x.add(&y).error / (2.0 * SUM_ERROR) - 1.0;
        assert!((0.0..1e-13).contains(&by), "{by:e}");
    }
    // Too large, even where the product is not; and too small, then by the sizes.
    assert_eq!(DoubleDouble::of(1e260).mul(&DoubleDouble::of(1e-30)), DoubleDouble::UNKNOWN);
    assert_eq!(DoubleDouble::of(1e-30).mul(&DoubleDouble::of(-1e260)), DoubleDouble::UNKNOWN);
    let tiny = DoubleDouble::of(1e-200).mul(&DoubleDouble::of(-1e-60));
    assert!(tiny.high == 0.0 && (1e-260..1.1e-260).contains(&tiny.error), "{tiny:?}");
}

#[test]
fn errors_of_roots_and_quotients_are_what_multiplying_back_leaves() {
    for x in [2.0, 3.0, 1e-20, 7e30] {
        let (x, three) = (DoubleDouble::of(x), DoubleDouble::of(3.0));
        let bare = |of: DoubleDouble| DoubleDouble { error: 0.0, ..of };
        let root = bare(x.sqrt());
        let rest = x.sub(&root.square());
        assert_eq!(x.sqrt().error, rest.upper_bound() / root.lower_bound() * ROUNDED_UP);
        let third = bare(x.over(&three));
        let rest = x.sub(&three.mul(&third));
        assert_eq!(x.over(&three).error, rest.upper_bound() / three.lower_bound() * ROUNDED_UP);
    }
}

/// A sign is that of the number, and not known if its error reaches 0. An exact number has one, whether it is one f64 or two.
#[test]
fn signs_are_those_of_all_that_the_number_may_be() {
    let of = |high: f64, low: f64, error: f64| DoubleDouble { high, low, error };
    for high in [1.0, 3.0, 1e-300] {
        let low = 0.5 * f64::EPSILON * high;
        for number in [of(high, 0.0, 0.0), of(high, -low, 0.0), of(high, low, 0.0), of(high, 0.0, 0.9 * high)]
        {
            assert_eq!(number.sign(), Some(Ordering::Greater), "{number:?}");
            assert_eq!(DoubleDouble::of(0.0).sub(&number).sign(), Some(Ordering::Less), "{number:?}");
        }
        assert_eq!(of(high, 0.0, high).sign(), None);
    }
    assert_eq!(DoubleDouble::of(0.0).sign(), Some(Ordering::Equal));
    assert_eq!(of(0.0, 0.0, 1e-300).sign(), None);
}
