//! Axes of coordinates far from 0.

use raypencil_report::axis_from_offset;

/// The number that a title says is left out of the labels: `y - 4039800, m`, `y + 4039800, m`.
fn offset(title: &str) -> f64 {
    let number = title.trim_end_matches(", m");
    match (number.split_once(" - "), number.split_once(" + ")) {
        (Some((_, subtracted)), _) => subtracted.parse().unwrap(),
        (_, Some((_, added))) => -added.parse::<f64>().unwrap(),
        _ => 0.0,
    }
}

#[test]
fn a_label_and_the_number_in_the_title_are_a_coordinate_of_the_axis_on_either_side_of_0() {
    for (low, high) in [
        (4_039_837.6, 4_039_847.2),
        (990_000.0, 1_010_000.0),
        (1_234.5, 1_239.0),
        (-3.0, 4.0),
        (-900.0, 900.0),
        (-2_000.0, 2_000.0),
    ] {
        for [low, high] in [[low, high], [-high, -low]] {
            let (ticks, title) = axis_from_offset("y", "m", [low, high], 7);
            assert!(ticks.len() > 1, "{title}");
            for tick in ticks {
                let label: f64 = tick.label.replace('\u{2212}', "-").parse().unwrap();
                let at = offset(&title) + label;
                assert!(
                    (low..=high).contains(&at),
                    "{} on the axis {title}, from {low} to {high}",
                    tick.label
                );
                assert!((tick.at - (at - low) / (high - low)).abs() < 1e-9, "{title}: {tick:?}");
            }
        }
    }
}
