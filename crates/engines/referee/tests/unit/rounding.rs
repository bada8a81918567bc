//! Exact quotients and roots against IEEE 754.

use super::*;
use crate::numbers::number::Number;
use proptest::prelude::*;

fn exactly(x: f64) -> Dyadic {
    Dyadic::of(x)
}

proptest! {
    #[test]
    fn a_quotient_is_what_ieee_754_says(a in any::<f64>(), b in any::<f64>()) {
        // The machine's division is correctly rounded, subnormal results and overflow included.
        prop_assume!(a.is_finite() && b.is_finite() && b != 0.0);
        let rounded = quotient(&exactly(a), &exactly(b));
        prop_assert_eq!(rounded.double, a / b);
    }

    #[test]
    fn a_quotient_of_singles_is_what_ieee_754_says(a in any::<f32>(), b in any::<f32>()) {
        prop_assume!(a.is_finite() && b.is_finite() && b != 0.0);
        let rounded = quotient(&exactly(a.into()), &exactly(b.into()));
        prop_assert_eq!(rounded.single, a / b);
    }

    #[test]
    fn a_root_is_what_ieee_754_says(a in any::<f64>(), b in any::<f32>()) {
        prop_assume!(a.is_finite() && b.is_finite());
        let rounded = root(Sign::Positive, &exactly(a.abs()), &exactly(1.0));
        prop_assert_eq!(rounded.double, a.abs().sqrt());
        let rounded = root(Sign::Negative, &exactly(b.abs().into()), &exactly(1.0));
        prop_assert_eq!(rounded.single, -b.abs().sqrt());
    }

    #[test]
    fn a_root_of_a_square_is_exact(a in any::<f64>(), b in any::<f64>()) {
        prop_assume!(a.is_finite() && b.is_finite() && b != 0.0);
        // Every f64 quotient, decided where it lies exactly on a midpoint of f32 as well.
        let (a, b) = (exactly(a), exactly(b));
        let rounded = root(Sign::Positive, &a.square(), &b.square());
        let expected = quotient(&a, &b);
        prop_assert_eq!(rounded.double, expected.double.abs());
        prop_assert_eq!(rounded.single, expected.single.abs());
    }

    #[test]
    fn the_side_settles_a_single(a in any::<f64>(), half in any::<bool>()) {
        prop_assume!(a.is_finite());
        // A midpoint of two f32 half the time, and something very near it otherwise.
        let single = a as f32;
        prop_assume!(single.is_finite() && single.next_up().is_finite());
        let midpoint = 0.5 * f64::from(single) + 0.5 * f64::from(single.next_up());
        let double = if half { midpoint } else { midpoint.next_up() };
        let tiny = exactly(f64::from_bits(1));
        for (side, number) in [
            (Ordering::Less, exactly(double).sub(&tiny)),
            (Ordering::Equal, exactly(double)),
            (Ordering::Greater, exactly(double).add(&tiny)),
        ] {
            let expected = quotient(&number, &exactly(1.0));
            prop_assume!(expected.double == double);
            prop_assert_eq!(Rounded::beside(double, side), expected);
        }
    }
}

#[test]
fn midpoints_go_to_the_even_neighbour() {
    // 1 + 2^-53 lies between 1 and 1 + 2^-52; 1 + 3 2^-53 between that and 1 + 2^-51.
    let unit = exactly(f64::EPSILON / 2.0);
    let one = exactly(1.0);
    let at = |units: u32| quotient(&one.add(&unit.mul(&Dyadic::of_integer(units))), &one).double;
    assert_eq!(at(1), 1.0);
    assert_eq!(at(3), 1.0 + 2.0 * f64::EPSILON);
    // The same as roots of their squares.
    let square = |units: u32| one.add(&unit.mul(&Dyadic::of_integer(units))).square();
    assert_eq!(root(Sign::Positive, &square(1), &one).double, 1.0);
    assert_eq!(root(Sign::Positive, &square(3), &one).double, 1.0 + 2.0 * f64::EPSILON);
    // A hair more than the midpoint goes up.
    let hair = exactly(1e-300);
    assert_eq!(root(Sign::Positive, &square(1).add(&hair), &one).double, 1.0 + f64::EPSILON);
}

/// A number of 3 bits over one of 5 is shifted by 2 bits more than the quotient is to have; one that is long enough is not shifted.
#[test]
fn a_dividend_is_shifted_by_what_the_quotient_wants() {
    let [three, five, hundred] = [3, 5, 100].map(|bits: usize| UBig::ONE << (bits - 1));
    assert_eq!(shift_for(70, &three, &five), 72);
    assert_eq!(shift_for(141, &five, &three), 139);
    assert_eq!(shift_for(70, &hundred, &five), 0);
}
