//! Forms by hand: radii, sums, moves and combinations.

use super::*;

const U: f64 = UNIT_ROUNDOFF;

/// A form without an error of its own.
fn form(constant: f64, x: f64, y: f64, xy: f64) -> Form {
    Form { constant, x, y, xy, error: 0.0, bend: 0.0 }
}

/// As near as a few roundings of `expected`.
#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 4.0 * U * expected.abs(), "{found:e} {expected:e}");
}

#[test]
fn a_form_of_intervals_has_their_doubts_and_its_evaluation_for_an_error() {
    let range = |low: f64, high: f64| Interval { low, high };
    let found = Form::of([range(1.0, 1.5), range(2.0, 2.25), range(-1.0, -0.875), range(0.5, 0.5625)]);
    assert_eq!([found.constant, found.x, found.y, found.xy], [1.25, 2.125, -0.9375, 0.53125]);
    assert_eq!(found.bend, 0.0);
    // 1/4 + 1/8 + 1/16 + 1/32, and 16 u of 4.84375.
    near(found.error, (0.46875 + 16.0 * U * 4.84375) * (1.0 + 16.0 * U));
    let exactly = |value: f64| range(value, value);
    let found = Form::of([exactly(1.0), exactly(-2.0), exactly(4.0), exactly(0.0)]);
    near(found.error, 16.0 * U * 7.0 * (1.0 + 16.0 * U));
    // Of nothing at all there is still a doubt, so that 0 is never certain.
    assert!(Form::of([exactly(0.0); 4]).error > 0.0);
}

#[test]
fn radii_are_roots() {
    // b r^2 + a r = c: 1 and 2 make 3 at r = 1, which is not beyond it.
    let tiny = 1.0 / (1u64 << 40) as f64;
    let unit = form(3.0, 1.0, -1.0, -1.0);
    near(unit.holds_within(), 1.0 - tiny);
    assert_eq!(unit.fails_within(), 0.0);
    assert_eq!(form(-3.0 - 1e-14, 1.0, -1.0, -1.0).fails_within(), 1.0);
    near(form(-3.0, 1.0, -1.0, -1.0).fails_within(), 1.0 - tiny);
    // r^2 / 2 + r = 3/4, half of the square from the bend.
    let half = Form { bend: 0.25, ..form(0.75, -0.5, 0.5, 0.25) };
    near(half.holds_within(), (2.5_f64.sqrt() - 1.0) * (1.0 - tiny));
    // The error is taken off first.
    near(Form { error: 0.25, ..form(0.75, 1.0, 0.0, 0.0) }.holds_within(), 0.5 * (1.0 - tiny));
    near(Form { error: 0.25, ..form(-0.75, 1.0, 0.0, 0.0) }.fails_within(), 0.5 * (1.0 - tiny));
    // A level form holds everywhere, or nowhere for certain; what is infinite tells nothing.
    assert_eq!(form(1e-300, 0.0, 0.0, 0.0).holds_within(), 1.0);
    assert_eq!(form(0.0, 0.0, 0.0, 0.0).holds_within(), 0.0);
    assert_eq!(form(f64::INFINITY, f64::INFINITY, 0.0, 0.0).holds_within(), 0.0);
}

#[test]
fn sums_moves_and_signs_by_hand() {
    let a = Form { error: 0.5, bend: 0.25, ..form(1.0, 2.0, -3.0, 4.0) };
    let b = Form { error: 0.125, bend: 2.0, ..form(-5.0, 6.0, 7.0, -8.0) };
    for weight in [0.5, -0.5] {
        let found = a.plus(&b, weight);
        let by_hand = [1.0 - 5.0 * weight, 2.0 + 6.0 * weight, -3.0 + 7.0 * weight, 4.0 - 8.0 * weight];
        assert_eq!([found.constant, found.x, found.y, found.xy], by_hand);
        // |weight| 2 and 1/4; 1/2 and |weight| 1/8, and 16 u of 10 and |weight| 26.
        near(found.bend, 1.25 * (1.0 + 8.0 * U));
        near(found.error, (0.5625 + 16.0 * U * 23.0) * (1.0 + 8.0 * U));
    }
    near(
        form(1.0, 2.0, -3.0, 4.0).plus(&form(-5.0, 6.0, 7.0, -8.0), -0.5).error,
        16.0 * U * 23.0 * (1.0 + 8.0 * U),
    );

    let moved = a.about([0.5, -0.25]);
    // 1 + 2/2 + 3/4 - 4/8; 2 - 4/4; -3 + 4/2.
    assert_eq!([moved.constant, moved.x, moved.y, moved.xy, moved.bend], [2.25, 1.0, -1.0, 4.0, 0.0]);
    near(moved.error, (0.75 + 16.0 * U * 10.0) * (1.0 + 8.0 * U));
    near(form(1.0, 2.0, -3.0, 4.0).about([0.5, -0.25]).error, 16.0 * U * 10.0 * (1.0 + 8.0 * U));
    // About the ray itself nothing changes, nor is anything rounded.
    assert_eq!((a.about([0.0; 2]).error, a.about([0.0; 2]).bend), (0.5, 0.25));
    assert_eq!(a.about([0.0, 1.0]).constant, -2.0);
    assert_eq!(a.about([1.0, 0.0]).constant, 3.0);

    // 1 + 2/2 + 3/4 - 4/8 at (1/2, -1/4); certain beyond error and bend together.
    assert_eq!(a.at([0.5, -0.25]), 2.25);
    let doubt = |constant: f64| Form { error: 0.5, bend: 0.25, ..form(constant, 0.0, 0.0, 0.0) };
    let asked =
        [0.75 + 1e-9, 0.75, 0.0, -0.75, -0.75 - 1e-9].map(|value| doubt(value).is_positive_at([0.3, 0.1]));
    assert_eq!(asked, [Some(true), None, None, None, Some(false)]);

    let back = a.negated();
    assert_eq!(
        [back.constant, back.x, back.y, back.xy, back.error, back.bend],
        [-1.0, -2.0, 3.0, -4.0, 0.5, 0.25]
    );
    let scaled = a.scaled(0.5);
    let by_hand = [1.0, 1.0, -1.5, 1.0, 0.5, 0.0625];
    assert_eq!([scaled.constant, scaled.x, scaled.y, scaled.xy, scaled.error, scaled.bend], by_hand);
}

#[test]
fn two_conditions_that_exclude_each_other_fail_together() {
    let all_but = 1.0 - 2.0 / (1u64 << 40) as f64;
    // dx >= 3/4 and dx <= 1/2, and the same along dy.
    for (along, against) in [
        (form(-0.75, 1.0, 0.0, 0.0), form(0.5, -1.0, 0.0, 0.0)),
        (form(-0.75, 0.0, 1.0, 0.0), form(0.5, 0.0, -1.0, 0.0)),
    ] {
        for (a, b) in [(along, against), (against, along)] {
            assert!(certainly_fails(&[a, b], 0, 1.0) >= all_but);
            // Kept apart, only the first alone; and so if that is enough.
            near(certainly_fails(&[a, b], 2, 1.0), 0.75 * (1.0 - 1.0 / (1u64 << 40) as f64));
            assert!(certainly_fails(&[a, b], 0, 0.7) < 0.76);
            assert!(certainly_fails(&[a, b], 1, 1.0) >= all_but);
        }
    }
    // Both hold at dx = 0.6: no square but that of the first.
    let found = certainly_fails(&[form(-0.6, 1.0, 0.0, 0.0), form(0.75, -1.0, 0.0, 0.0)], 0, 1.0);
    assert!((0.599..0.601).contains(&found), "{found}");
    // With the same slope a sum is never level.
    let found = certainly_fails(&[form(-0.5, 1.0, 0.0, 0.0), form(-0.25, 1.0, 0.0, 0.0)], 0, 1.0);
    assert!((0.499..0.501).contains(&found), "{found}");
    // Of three, the last two.
    let forms = [form(9.0, 0.0, 0.0, 0.0), form(-0.75, 1.0, 0.0, 0.0), form(0.5, -1.0, 0.0, 0.0)];
    assert!(certainly_fails(&forms, 1, 1.0) >= all_but);
    assert!(certainly_fails(&forms, 2, 1.0) >= all_but);
    assert!(certainly_fails(&forms, 3, 1.0) < 0.76);
}

#[test]
fn a_line_leaves_where_another_condition_holds() {
    // The line dx = 0 or dy = 0, of either sign; the other holds from 1/2 on.
    for (edge, other) in [
        (form(0.0, 1.0, 0.0, 0.0), form(-0.5, 1.0, 0.0, 0.0)),
        (form(0.0, -2.0, 0.0, 0.0), form(-0.5, 1.0, 0.0, 0.0)),
        (form(0.0, 0.0, 1.0, 0.0), form(-0.5, 0.0, 1.0, 0.0)),
        (form(0.0, 0.0, -2.0, 0.0), form(-0.5, 0.0, 1.0, 0.0)),
    ] {
        assert_eq!(line_leaves(&edge, &other), 1.0);
    }
    // On the line dx = 1/2 the other, dx >= 1/4, holds.
    assert_eq!(line_leaves(&form(-0.5, 1.0, 0.0, 0.0), &form(-0.25, 1.0, 0.0, 0.0)), 0.0);
    // No quotient: nothing.
    assert_eq!(line_leaves(&form(-0.5, 0.0, 0.0, 0.0), &form(-0.25, 1.0, 0.0, 0.0)), 0.0);
}
