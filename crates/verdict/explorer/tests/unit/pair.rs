//! Codes of differences and of bounds.

use super::*;

#[test]
fn ulps_are_steps_from_one_number_to_the_next() {
    assert_eq!(ulps_between(1.0, 1.0), 0);
    assert_eq!(ulps_between(1.0, 1.0_f64.next_up()), 1);
    assert_eq!(ulps_between(1.0, 1.0_f64.next_down()), -1);
    // Across a power of two the steps below are half as long.
    assert_eq!(ulps_between(2.0_f64.next_down(), 2.0_f64.next_up()), 2);
    // 2^52 steps from 1 to 2.
    assert_eq!((ulps_between(1.0, 2.0), ulps_between(2.0, 1.0)), (i32::MAX, -i32::MAX));
    assert_eq!(ulps_between(f64::NAN, 1.0), i32::MAX);
}

#[test]
fn bounds_keep_their_size_to_nine_percent() {
    let decoded = |code: u8| libm::exp2((f64::from(code) - 1.0) / 4.0 - 60.0);
    for bound in [1e-17, 3e-15, 1e-12, 2.5e-7, 1e-3, 7.0] {
        let code = code_of_bound(bound);
        assert!((decoded(code) / bound - 1.0).abs() < 0.091, "{bound}: {code}");
    }
    // 2^-60 m has the first code; what is smaller shares it, and no bound has none.
    assert_eq!((code_of_bound(libm::exp2(-60.0)), code_of_bound(1e-30)), (1, 1));
    assert_eq!((code_of_bound(0.0), code_of_bound(f64::NAN)), (0, 0));
    assert_eq!(code_of_bound(f64::INFINITY), 254);
}
