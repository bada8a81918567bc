//! Short integers against those of any length.

use proptest::collection::vec;
use proptest::prelude::*;

use super::*;

/// Few bits of a limb set, or none, or all: carries run far.
fn limb() -> impl Strategy<Value = u64> {
    prop_oneof![any::<u64>(), Just(0), Just(u64::MAX), Just(1), Just(1 << 63)]
}

fn integer(longest: usize) -> impl Strategy<Value = ShortInteger> {
    (vec(limb(), 0..=longest), any::<bool>()).prop_map(|(given, is_negative)| {
        let mut limbs = [0; LIMBS];
        limbs[..given.len()].copy_from_slice(&given);
        ShortInteger::trimmed(limbs, given.len(), is_negative)
    })
}

/// The number, and that it is stored in the one way in which it may be.
fn long(short: ShortInteger) -> IBig {
    assert!(short.limbs[short.length()..].iter().all(|&limb| limb == 0), "{short:?}");
    assert!(short.length == 0 || short.limbs[short.length() - 1] != 0, "{short:?}");
    assert!(short.length > 0 || !short.is_negative, "{short:?}");
    short.to_long()
}

fn fits(long: &IBig) -> bool {
    let (_, magnitude) = long.clone().into_parts();
    magnitude.to_le_bytes().len() <= 8 * LIMBS
}

proptest! {
    #[test]
    fn sums_are_those_of_long_integers(a in integer(LIMBS), b in integer(LIMBS)) {
        for (is_difference, expected) in [(false, long(a) + long(b)), (true, long(a) - long(b))] {
            prop_assert_eq!(a.sum(&b, is_difference).map(long), fits(&expected).then_some(expected));
        }
        prop_assert_eq!(a.sum(&a.negated(), false).map(long), Some(IBig::ZERO));
        prop_assert_eq!(a.sum(&a, true).map(long), Some(IBig::ZERO));
        for is_difference in [false, true] {
            prop_assert_eq!(a.sum(&ShortInteger::ZERO, is_difference).map(long), Some(long(a)));
        }
        prop_assert_eq!(ShortInteger::ZERO.sum(&a, true).map(long), Some(-long(a)));
        prop_assert_eq!(a.sign(), long(a).cmp(&IBig::ZERO));
    }

    #[test]
    fn products_are_those_of_long_integers(a in integer(LIMBS), b in integer(LIMBS)) {
        let expected = long(a) * long(b);
        match a.times(&b) {
            Some(product) => prop_assert_eq!(long(product), expected),
            // One limb more than it has may be asked for.
            None => prop_assert!(a.length() + b.length() > LIMBS),
        }
    }

    #[test]
    fn shifts_are_those_of_long_integers(a in integer(LIMBS), bits in 0..1200_usize) {
        let expected = long(a) << bits;
        prop_assert_eq!(a.shifted(bits).map(long), fits(&expected).then_some(expected));
    }
}
