//! Intervals and dyadic rationals against each other and against integers.

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
        // WeightSum numbers: what i64 says, Dyadic says.
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
    for (low, high, most) in [(0.0, 1.0, 1.0), (-2.0, 1.0, 4.0), (-1.0, 0.0, 1.0), (-1e-200, 1e-200, 1e-307)]
    {
        let found = square(low, high);
        assert!(found.low == 0.0 && found.high >= high * high && found.high <= most * 1.001, "{found:?}");
    }
    let found = square(-3.0, -2.0);
    assert!(found.low <= 4.0 && found.low > 3.999 && found.high >= 9.0 && found.high < 9.001, "{found:?}");
}

#[test]
fn a_product_with_a_line_without_ends_has_none_either() {
    // Beside products of 0 and infinity, which are no numbers.
    let line = Interval::between(f64::NEG_INFINITY, f64::INFINITY);
    for part in [Interval::between(-1.0, 0.0), Interval::between(0.0, 2.0), Interval::between(-3.0, 4.0)] {
        for product in [part.mul(&line), line.mul(&part)] {
            assert_eq!((product.low, product.high), (f64::NEG_INFINITY, f64::INFINITY), "{part:?}");
        }
    }
}
