//! Unit tests of `tables`: the search for a cell.

use super::*;
use proptest::prelude::*;

proptest! {
    // Expected: the answer of a linear search of the same table.
    #[test]
    fn a_search_finds_what_a_linear_search_finds(
        count in 1u32..40,
        centre in -50.0f64..50.0,
        pitch in 1e-6f64..1.0,
        at in -2.0f64..3.0,
        on in proptest::option::of(0u32..40),
        beside in -1i8..=1,
    ) {
        let axis = Axis::pixels(count, centre, pitch);
        let [low, high] = axis.borders();
        // Anywhere around the screen; or on a centre or next to one, where the first guess errs.
        let value = match on {
            Some(i) if i < count => match beside {
                -1 => axis.centre(i).next_down(),
                0 => axis.centre(i),
                _ => axis.centre(i).next_up(),
            },
            _ => low + at * (high - low),
        };
        let first = axis.centres().iter().position(|&c| c >= value).unwrap_or(count as usize);
        let end = axis.centres().iter().rposition(|&c| c <= value).map_or(0, |last| last + 1);
        prop_assert_eq!(axis.first_at_or_after(value), first as u32);
        prop_assert_eq!(axis.end_at_or_before(value), end as u32);
    }
}

#[test]
fn the_first_guess_of_a_centre_is_its_cell() {
    // With a wrong guess the search would still find the cell, but step by step.
    let axes = [
        Axis::pixels(7, 2.25, 0.5),
        Axis::pixels(640, -300.0, 7.4e-6),
        Axis::grid_columns(5, 0.3),
        Axis::grid_columns(1024, 0.1),
        Axis::grid_rows(3, 0.02),
        Axis::grid_rows(256, 0.005),
    ];
    for axis in axes {
        for index in 0..axis.count() {
            let off = axis.approximate_index(axis.centre(index)) - f64::from(index);
            assert!(off.abs() < 1e-9, "{axis:?}: cell {index} is guessed {off} cells beside");
        }
    }
}

#[test]
fn infinities_and_nan_stay_on_the_screen() {
    let axis = Axis::grid_columns(8, 0.1);
    assert_eq!((axis.first_at_or_after(f64::INFINITY), axis.end_at_or_before(f64::INFINITY)), (8, 8));
    assert_eq!((axis.first_at_or_after(-f64::INFINITY), axis.end_at_or_before(-f64::INFINITY)), (0, 0));
    assert_eq!(axis.end_at_or_before(f64::NAN), 0);
}

#[test]
fn a_guess_that_is_too_large_is_corrected() {
    // So far from the principal point that neighbouring centres are one number. The guess for it is the second of them.
    let axis = Axis::pixels(4, 2.0 / f64::EPSILON, 1.0);
    assert_eq!(axis.centre(1), axis.centre(2));
    assert_eq!(axis.approximate_index(axis.centre(1)), 2.0);
    assert_eq!((axis.first_at_or_after(axis.centre(1)), axis.end_at_or_before(axis.centre(1))), (1, 3));
}
