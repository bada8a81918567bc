//! Unit tests of `printed`: numbers as programs print them, and how far each may then be off.

use super::*;

/// The decimals to which each number of the columns is good, x, y and z first.
fn decimals_of(columns: &[&[&str]]) -> Vec<Vec<i32>> {
    let names = ["x", "y", "z", "range"];
    let columns = columns.iter().zip(names).map(|(words, name)| {
        let values = words.iter().map(|word| word.parse().unwrap()).collect();
        let printed = words.iter().map(|word| Printed::of(word)).collect();
        (CloudColumn { name: name.into(), storage: CloudStorage::Double, values }, printed)
    });
    let of = |column: CloudColumn| match column.storage {
        CloudStorage::Decimal { decimals, of_single: false } => decimals,
        other => panic!("{other:?}"),
    };
    with_decimals(columns.collect()).into_iter().map(of).collect()
}

#[test]
fn a_number_has_its_decimals_and_digits() {
    for (word, decimals, digits) in [
        ("0.125", Some(3), 3),
        ("-1.50", Some(2), 3),
        ("1e2", Some(-2), 1),
        ("1.25E-3", Some(5), 3),
        ("0.0", Some(1), 0),
        ("-0", Some(0), 0),
        ("7.", Some(0), 1),
        ("1200", Some(0), 4),
        ("nan", None, 0),
        ("-inf", None, 0),
        ("1e-99999", Some(400), 1),
    ] {
        let found = Printed::of(word);
        assert_eq!((found.decimals, found.digits), (decimals, digits), "{word}");
        assert_eq!(found.has_exponent, word.contains(['e', 'E']), "{word}");
    }
}

/// `%.3f`, with and without zeros at the end.
#[test]
fn numbers_of_a_fixed_format_are_good_to_its_decimals() {
    let x: &[&str] = &["1.250", "13.125", "-0.500", "0.000"];
    assert_eq!(decimals_of(&[x, x, x]), [[3; 4]; 3]);
    let stripped: &[&str] = &["1.25", "13.125", "-0.501", "0", "nan"];
    assert_eq!(decimals_of(&[stripped, &["2.125", "0.001", "7", "0.375", "0"], &["0"; 5]]), [[3; 5]; 3]);
    // A column of its own format, beside others.
    let meters: &[&str] = &["1.25", "3.50", "0.00", "9.75"];
    assert_eq!(decimals_of(&[meters, x, x]), [[2; 4], [3; 4], [3; 4]]);
    // Whole numbers alone may be off by half of one.
    assert_eq!(decimals_of(&[&["1", "20"], &["0", "3"], &["0", "0"]]), [[0; 2]; 3]);
}

/// `%.6g`: the larger a number is, the fewer decimals are right. What is 0 is so.
#[test]
fn numbers_of_significant_digits_are_good_to_them() {
    let (x, y): (&[&str], &[&str]) = (
        &["12.3456", "123.457", "0.0123457", "12.5", "1234.57"],
        &["-3.14159", "2.71828", "0.333333", "9", "0"],
    );
    let found = decimals_of(&[x, y, &["0"; 5]]);
    assert_eq!(found, [[4, 3, 7, 4, 2], [5, 5, 6, 5, 400], [400; 5]]);
    // An exponent is one of significant digits.
    assert_eq!(decimals_of(&[&["1.250e+00", "2.500e+02"], &["0.000e+00"; 2], &["1.000e-03"; 2]])[0], [3, 1]);
    // A column beside the coordinates has its own format.
    assert_eq!(decimals_of(&[x, y, &["0"; 5], &["1.5", "0.25", "2.75", "3.125", "4.625"]])[3], [3; 5]);
}
