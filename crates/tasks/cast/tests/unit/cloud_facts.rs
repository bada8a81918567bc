//! What explains the fields of a cloud, and the steps in which its numbers are printed.

use super::*;

/// What is known of the wrong keys and of the wrong numbers of returns: whether there are any, and what explains them.
fn facts(keys: (bool, Option<&str>), numbers: (bool, Option<&str>), has_strays: bool) -> CloudFacts {
    let some = |is: bool| if is { vec![3] } else { Vec::new() };
    CloudFacts {
        frame: CloudFrame::Mesh,
        source: None,
        points: 9,
        returns_of_beam: None,
        assigned: BY_DIRECTION,
        strays: some(has_strays),
        has_range: false,
        steps: None,
        excused: 0,
        keys: Vec::new(),
        unjudged: Vec::new(),
        wrong_keys: some(keys.0),
        keys_why: keys.1.map(str::to_string),
        numbered: 9,
        number_field: None,
        wrong_numbers: some(numbers.0),
        numbers_why: numbers.1.map(str::to_string),
    }
}

#[test]
fn fields_are_explained_if_all_that_are_wrong_are() {
    let (none, late, other) =
        ((false, None), (true, Some("times are late")), (true, Some("numbers count from 0")));
    let why = |keys, numbers| facts(keys, numbers, false).why();
    assert_eq!(why(none, none), None);
    assert_eq!(why(late, none).as_deref(), Some("times are late"));
    assert_eq!(why(none, other).as_deref(), Some("numbers count from 0"));
    assert_eq!(why(late, other).as_deref(), Some("times are late, and numbers count from 0"));
    assert_eq!(why(late, (true, None)), None);
    assert_eq!(why((true, None), other), None);
}

#[test]
fn what_is_wrong_beside_a_reason_follows_it() {
    let (none, late) = ((false, None), (true, Some("times are late")));
    let unknown = (true, None);
    let beside = |keys, numbers, has_strays, is_laid| {
        facts(keys, numbers, has_strays).beside("100.0000 % agree if rows are reversed", is_laid)
    };
    assert_eq!(beside(none, none, false, false), "");
    assert_eq!(beside(late, none, false, false), ", and times are late");
    assert_eq!(beside(late, unknown, false, false), ", and times are late; something else is wrong, too");
    assert_eq!(beside(none, none, true, false), "; something else is wrong, too");
    // Points on other rays may be all that is wrong.
    assert_eq!(beside(unknown, none, true, true), "");
    // What the reason says already is not said again.
    let same = facts(late, none, false).beside("100.0000 % agree if times are late", false);
    assert_eq!(same, "");
}

#[test]
fn steps_are_told_where_they_are_coarser_than_single_precision() {
    let column = |values: &[f64], decimals: &[i32]| CloudColumn {
        name: "x".into(),
        storage: CloudStorage::Decimal { decimals: decimals.to_vec(), of_single: false },
        values: values.to_vec(),
    };
    let steps = |column: &CloudColumn| printed_steps([column].into_iter(), &[true, true, false]);
    let of = |values: [f64; 2], decimals: [i32; 2]| {
        // The last one is no point.
        let [a, b] = values;
        let [of_a, of_b] = decimals;
        steps(&column(&[a, b, 1e9], &[of_a, of_b, -9]))
    };
    assert_eq!(of([1.25, -2.5], [2, 2]).as_deref(), Some("steps of 0.01 m"));
    assert_eq!(of([1.25, -2.5], [2, 1]).as_deref(), Some("steps of up to 0.1 m"));
    // 0 is printed without decimals.
    assert_eq!(of([1.25, 0.0], [2, 0]).as_deref(), Some("steps of 0.01 m"));
    // Numbers of single precision that are nearly 2 stand at most 2^-22 apart, which is 2.4e-7.
    assert_eq!(of([2.0, -1.0], [6, 6]).as_deref(), Some("steps of 0.000001 m"));
    assert_eq!(of([2.0, -1.0], [7, 7]), None);
    assert_eq!(of([0.0, 0.0], [2, 2]), None);
    let single = CloudColumn { storage: CloudStorage::Single, ..column(&[1.25, 2.5, 0.0], &[]) };
    assert_eq!(steps(&single), None);
}
