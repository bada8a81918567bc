//! Lengths that a file rounds coarsely: a step of the file is no step of the length, and explains none by itself.

use raypencil_files::{Step, Storage};
use raypencil_judge::{Quantity, Recorded};

use super::candidates::*;

/// The camera's depths alone, as whole numbers that were declared to be steps of `step` metres.
fn in_steps(step: f64, whole: impl Fn(f64) -> f64) -> Recorded {
    let mut candidate = only(&pyramids().exact, &[Quantity::Depth]);
    numbers(&mut candidate, |_, x| whole(x).round() * step);
    for storage in candidate.storage.values_mut() {
        *storage = Storage::Steps(Step::new(step).expect("a step"));
    }
    candidate
}

fn told(candidate: &Recorded) -> String {
    pyramids().diagnosis(candidate).map_or(String::new(), |found| found.sentence())
}

#[test]
fn a_wrong_step_is_told_as_the_factor_that_it_is() {
    // As they should be: whole millimetres, centimetres, metres.
    for (step, whole) in [(0.001, 1e3), (0.01, 1e2), (1.0, 1.0)] {
        assert_eq!(told(&in_steps(step, |depth| whole * depth)), "");
    }
    for (step, whole, words) in [
        (0.001, 100.0, "depth.Z is 0.1 times the true length ("),
        (0.001, 1.0, "lengths are in kilometres: "),
        (10.0, 1000.0, "depth.Z is 10000 times the true length ("),
        (5.0, 1000.0, "depth.Z is 5000 times the true length ("),
        (1.0, 1000.0, "lengths are in millimetres: "),
    ] {
        let told = told(&in_steps(step, |depth| whole * depth));
        assert!(
            told.starts_with(&format!("100 % of the wrong rays agree if {words}")),
            "{step} {whole}: {told}"
        );
        assert!(!told.contains(", and depth.Z ") && !told.contains("multiples"), "{told}");
    }
}

#[test]
fn inverse_depths_in_steps_are_one_mistake() {
    let told = told(&in_steps(0.001, |depth| 1000.0 / depth));
    assert!(
        told.starts_with("100 % of the wrong rays agree if depth.Z is 1 over the true length ("),
        "{told}"
    );
    assert!(!told.contains(", and depth.Z "), "{told}");
}

#[test]
fn the_smallest_numbers_of_half_precision_are_told_their_factor() {
    // Below 2^-14 half precision counts in steps of 2^-24: of a millionth of these lengths it keeps 3 to 8 bits.
    let step = 1.0 / f64::from(1 << 24);
    let mut candidate = only(&pyramids().exact, &[Quantity::Range]);
    numbers(&mut candidate, |_, x| (1e-6 * x / step).round_ties_even() * step);
    for storage in candidate.storage.values_mut() {
        *storage = Storage::F16;
    }
    let told = told(&candidate);
    assert!(
        told.starts_with("100 % of the wrong rays agree if range.T is 0.000001 times the true length ("),
        "{told}"
    );
    assert!(!told.contains("multiples"), "{told}");
}

#[test]
fn a_number_that_is_the_same_everywhere_shows_no_unit() {
    // 1 step everywhere, and the depths are 1 to 3 km for all that it shows.
    for (step, number) in [(0.001, 1.0), (0.001, 10.0), (10.0, 1.0), (1.0, 0.0)] {
        assert_eq!(told(&in_steps(step, |_| number)), "", "{step} {number}");
    }
}

#[test]
fn factors_that_are_nearly_one_are_told_in_full() {
    for (factor, words) in [
        (1.0 + 1e-6, "1.000001"),
        (1.0 + 1e-9, "1.000000001"),
        (1.0 - 1e-9, "0.999999999"),
        (1.0 + 1e-11, "1.00000000001"),
        (1.0 + 5e-13, "1.0000000000005"),
    ] {
        let mut candidate = only(&pyramids().exact, &[Quantity::Range]);
        ranges(&mut candidate, |_, x| x * factor);
        let told = told(&candidate);
        assert!(
            told.contains(&format!(" agree if range.T is {words} times the true length")),
            "{words}: {told}"
        );
    }
    for (factor, words) in [(1.0 + 1e-8, "1.00000001"), (1.0 + 5e-11, "1.00000000005"), (2.0, "2")] {
        let mut candidate = pyramids().exact.clone();
        flux(&mut candidate, |x| x * factor);
        candidate.storage.retain(|(_, item), _| !item.is_other_model);
        let told = told(&candidate);
        assert!(
            told.contains(&format!(" agree if the flux is {words} times the true one")),
            "{words}: {told}"
        );
    }
}
