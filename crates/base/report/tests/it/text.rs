//! Numbers, times and lists as people read them.

use std::time::Duration;

use raypencil_report::{count, escaped, list, number, quantity, time};

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
fn three_digits_stay_three_where_rounding_carries() {
    for exponent in -3..=2 {
        for mantissa in [1.0, 1.234, 9.899, 9.9849, 9.9949, 9.9951, 9.997, 9.9994, 9.9996] {
            let value: f64 = format!("{mantissa}e{exponent}").parse().unwrap();
            let text = number(value);
            let digits = text.replace('.', "");
            // Above 999.5 a whole number has four.
            let expected = if value >= 999.5 { 4 } else { 3 };
            assert_eq!(digits.trim_start_matches('0').len(), expected, "{value} is {text}");
            assert!((text.parse::<f64>().unwrap() - value).abs() <= 0.005 * value, "{value} is {text}");
        }
    }
}

#[test]
fn a_text_stays_one_text_in_an_element_and_in_an_attribute() {
    for text in ["a < b", "a > b", "a & b", "say \"no\"", "&quot;", "two\nlines", "\u{1b}[31m", "plain"] {
        let shown = escaped(text);
        assert!(!shown.contains(['<', '>', '"', '\n', '\u{1b}']), "{text:?} is {shown:?}");
        let entities = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&amp;", "&")];
        let read = entities.into_iter().fold(shown, |text, (entity, letter)| text.replace(entity, letter));
        assert_eq!(read, text.replace(|letter: char| letter.is_control(), " "));
    }
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
