//! Numbers, times and lists as people read them.

use std::time::Duration;

use raypencil_report::{count, list, number, quantity, time};

#[test]
fn counts_have_their_thousands_apart() {
    let counts = [0, 7, 999, 1000, 1_081_344, 201_326_592].map(count);
    assert_eq!(counts, ["0", "7", "999", "1,000", "1,081,344", "201,326,592"]);
}

#[test]
fn numbers_have_three_digits() {
    let cases = [
        (0.0, "0"),
        (1.0, "1.00"),
        (-0.25, "-0.250"),
        (0.031_24, "0.0312"),
        (0.001, "0.00100"),
        (0.999_96, "1.00"),
        (17.25, "17.2"),
        (1234.0, "1234"),
        (6.394e-14, "6.39e-14"),
        (123_456.0, "1.23e5"),
        (f64::NAN, "NaN"),
        (f64::INFINITY, "infinite"),
    ];
    for (value, text) in cases {
        assert_eq!(number(value), text);
    }
    assert_eq!(quantity(2.0, "m"), "2.00 m");
}

#[test]
fn times_have_a_fitting_unit() {
    let times = [412, 41_200, 4_120_000].map(|micros| time(Duration::from_micros(micros)));
    assert_eq!(times, ["412 µs", "41.2 ms", "4.12 s"]);
}

#[test]
fn lists_read_as_sentences() {
    assert_eq!(list(&["a", "b", "c"]), "a, b and c");
    assert_eq!(list(&["a"]), "a");
}
