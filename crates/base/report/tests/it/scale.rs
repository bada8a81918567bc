//! Scales: round ticks at the places of their values, for any span.

use raypencil_report::{Scale, Spread, Tick};

fn labels(low: f64, high: f64, most: u32) -> Vec<String> {
    Scale::linear(low, high).ticks(most).into_iter().map(|tick| tick.label).collect()
}

#[test]
fn ticks_are_round_numbers() {
    assert_eq!(labels(2.1, 19.8, 5), ["5", "10", "15"]);
    assert_eq!(labels(0.0, 1024.0, 6), ["0", "200", "400", "600", "800", "1000"]);
    assert_eq!(labels(3.43, 3.47, 4), ["3.43", "3.44", "3.45", "3.46", "3.47"]);
    assert_eq!(labels(-6.4e-14, 6.4e-14, 4), ["−5e−14", "0", "5e−14"]);
    assert_eq!(labels(-1.0, 1.0, 4), ["−1.0", "−0.5", "0", "0.5", "1.0"]);
}

#[test]
fn ticks_lie_where_their_values_do() {
    let ticks = Scale::linear(-2.0, 6.0).ticks(4);
    let at: Vec<f64> = ticks.iter().map(|tick| tick.at).collect();
    assert_eq!(at, [0.0, 0.25, 0.5, 0.75, 1.0]);
}

#[test]
fn deep_ranges_are_even_in_their_reciprocals() {
    let scale = Scale::of_ranges([2.0, 20.0]).unwrap();
    // 1/2 - 1/4 of 1/2 - 1/20: five ninths.
    assert!((scale.fraction(4.0) - 5.0 / 9.0).abs() < 1e-15);
    let labels: Vec<String> = scale.ticks(6).into_iter().map(|tick| tick.label).collect();
    assert_eq!(labels, ["2", "3", "5", "10"]);
    assert_eq!(Scale::of_ranges([2.0, 4.0]), Some(Scale::linear(2.0, 4.0)));
}

#[test]
fn differences_are_even_in_their_roots() {
    let scale = Scale::symmetric([6.4e-14]).unwrap();
    assert_eq!(scale.fraction(0.0), 0.5);
    assert!((scale.fraction(-1.6e-14) - 0.25).abs() < 1e-15);
    let ticks = scale.ticks(5);
    let labels: Vec<&str> = ticks.iter().map(|tick| tick.label.as_str()).collect();
    assert_eq!(labels, ["−5e−14", "−1e−14", "0", "1e−14", "5e−14"]);
    assert!(ticks.is_sorted_by(|a, b| a.at < b.at));
}

#[test]
fn sizes_of_differences_begin_at_zero() {
    let scale = Scale::from_zero([1e-3, 4e-3, f64::INFINITY]).unwrap();
    assert_eq!((scale.low, scale.high), (0.0, 4e-3));
    // A quarter of the largest is half way.
    assert_eq!((scale.fraction(0.0), scale.fraction(1e-3), scale.fraction(4e-3)), (0.0, 0.5, 1.0));
    let ticks = scale.ticks(5);
    assert_eq!(ticks[0], Tick { label: "0".into(), at: 0.0 });
    assert!(ticks.len() >= 3 && ticks.is_sorted_by(|a, b| a.at < b.at), "{ticks:?}");
}

#[test]
fn no_span_has_one_tick_in_the_middle() {
    assert_eq!(Scale::linear(3.0, 3.0).ticks(5), [Tick { label: "3".into(), at: 0.5 }]);
    assert_eq!(Scale::linear(3.0, 3.0).fraction(3.0), 0.5);
}

#[test]
fn a_span_of_one_rounding_is_labelled_by_its_ends() {
    assert_eq!(labels(1.0, 1.0 + f64::EPSILON, 5), ["1", "1.0000000000000002"]);
}

#[test]
fn ticks_stay_few_for_any_span() {
    for exponent in -300..300 {
        let unit: f64 = format!("1e{exponent}").parse().unwrap();
        for digits in [1.0, 1.9, 2.0, 4.3, 9.99] {
            let ticks = Scale::linear(-unit * digits, unit * digits).ticks(6);
            assert!((3..=7).contains(&ticks.len()), "{ticks:?}");
            assert!(ticks.iter().any(|tick| tick.label == "0" && tick.at == 0.5));
        }
    }
}

#[test]
fn what_is_not_finite_has_no_place() {
    assert_eq!(Scale::of([f64::NAN, f64::INFINITY]), None);
    assert_eq!(Scale::of([2.0, f64::INFINITY, 1.0]), Some(Scale::linear(1.0, 2.0)));
    let symmetric = Scale { low: -3.0, high: 3.0, spread: Spread::SignedRoot };
    assert_eq!(Scale::symmetric([1.0, -3.0]), Some(symmetric));
}
