//! Where everything of a chart stands: each place is worked out from the numbers of the runs.

use raypencil_report::{Anchor, Colour, Mark};
use raypencil_sweep::{Axis, Chart, Outcome, SweepTable, Task};
use serde_json::json;

use super::finished::{finished, refused, results};

/// Left upper corner and size of the plot, pixels.
const LEFT: f64 = 92.0;
const ABOVE: f64 = 40.0;
const WIDTH: f64 = 520.0;
const HEIGHT: f64 = 320.0;

/// Blue, orange and green: the first three colours of Okabe and Ito.
const BLUE: Colour = [0, 114, 178];
const ORANGE: Colour = [213, 94, 0];
const GREEN: Colour = [0, 158, 115];

/// Distance in pixels below which two places are the same.
const SAME: f64 = 1e-9;

fn is_near([a, b]: [f64; 2], [x, y]: [f64; 2]) -> bool {
    (a - x).abs() < SAME && (b - y).abs() < SAME
}

/// A table with a result `y` of each run.
fn table(axes: &[&str], values: &[f64]) -> SweepTable {
    let outcomes = values.iter().map(|value| results(&[("y", json!(value))])).collect();
    SweepTable::new(&finished(Task::Render, axes, outcomes))
}

fn marks(table: &SweepTable, chart: &str) -> Vec<Mark> {
    Chart::parse(chart).unwrap().draw(table).unwrap().marks
}

/// Points, colour and width of all lines.
fn lines(marks: &[Mark]) -> impl Iterator<Item = (&[[f64; 2]], Colour, f64)> {
    marks.iter().filter_map(|mark| match mark {
        Mark::Line { points, colour, width } => Some((points.as_slice(), *colour, *width)),
        _ => None,
    })
}

/// Centre, radius and colour of all dots: each corner of a dot is as far from its centre.
fn dots(marks: &[Mark]) -> Vec<([f64; 2], f64, Colour)> {
    let dot = |mark: &Mark| {
        let Mark::Polygon { points, fill, .. } = mark else { return None };
        let [x, y] = [0, 1].map(|k: usize| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64);
        let distance = |p: &[f64; 2]| ((p[0] - x) * (p[0] - x) + (p[1] - y) * (p[1] - y)).sqrt();
        let radii: Vec<f64> = points.iter().map(distance).collect();
        assert!(radii.iter().all(|radius| (radius - radii[0]).abs() < SAME), "{radii:?}");
        Some(([x, y], radii[0], *fill))
    };
    marks.iter().filter_map(dot).collect()
}

/// Place and anchor of a text.
fn text_at(marks: &[Mark], wanted: &str) -> ([f64; 2], Anchor) {
    let text = |mark: &Mark| match mark {
        Mark::Text { at, text, anchor, .. } if text == wanted => Some((*at, *anchor)),
        _ => None,
    };
    marks.iter().find_map(text).unwrap_or_else(|| panic!("no text {wanted:?} in {marks:?}"))
}

/// Lines of three values of `g`, of which the second has no result: at x = 1 and x = 2 there are two runs of each.
fn three_lines() -> SweepTable {
    let y = |value: f64| results(&[("y", json!(value))]);
    let of_first = [10.0, 30.0].map(y);
    let of_second = [20.0, 40.0].map(y);
    let none: [Outcome; 2] = [refused(), refused()];
    let at = |runs: [[Outcome; 2]; 3]| runs.into_iter().flatten();
    let outcomes = at([of_first.clone(), none.clone(), [y(50.0), y(25.0)]]).chain(at([
        of_second,
        none,
        [y(0.0), y(5.0)],
    ]));
    SweepTable::new(&finished(Task::Render, &["x=1,2", "g=7,8,9", "seed=1,2"], outcomes.collect()))
}

/// Place of x among 1 and 2 with 4 % of their distance at both ends, and of y between 0 and 50 with 4 % above.
fn place(x: f64, y: f64) -> [f64; 2] {
    [LEFT + WIDTH * (x - 0.96) / 1.08, ABOVE + HEIGHT * (1.0 - y / 52.0)]
}

#[test]
fn lines_join_means_and_each_run_of_a_mean_has_a_dot() {
    let marks = marks(&three_lines(), "y,x,g");
    // The third value has the third colour, although nothing is drawn of the second.
    let means = [(BLUE, [20.0, 30.0]), (GREEN, [37.5, 2.5])];
    let drawn: Vec<_> =
        lines(&marks).filter(|(points, _, width)| *width == 1.6 && !points.is_empty()).collect();
    assert_eq!(drawn.len(), 2);
    for ((points, colour, _), (expected, [at_one, at_two])) in drawn.into_iter().zip(means) {
        assert_eq!((colour, points.len()), (expected, 2));
        assert!(
            is_near(points[0], place(1.0, at_one)) && is_near(points[1], place(2.0, at_two)),
            "{points:?}"
        );
    }
    let dots = dots(&marks);
    let has = |at: [f64; 2], radius: f64, colour: Colour| {
        dots.iter().any(|(own, r, fill)| is_near(*own, at) && (r - radius).abs() < SAME && *fill == colour)
    };
    for (x, y, colour) in [
        (1.0, 10.0, BLUE),
        (1.0, 30.0, BLUE),
        (2.0, 20.0, BLUE),
        (2.0, 40.0, BLUE),
        (1.0, 50.0, GREEN),
        (1.0, 25.0, GREEN),
        (2.0, 0.0, GREEN),
        (2.0, 5.0, GREEN),
    ] {
        assert!(has(place(x, y), 1.6, colour), "{x}, {y}: {dots:?}");
    }
    for (colour, means) in means {
        for (x, mean) in [1.0, 2.0].into_iter().zip(means) {
            assert!(has(place(x, mean), 3.5, colour), "{x}, {mean}: {dots:?}");
        }
    }
    // Eight runs, four means, and two colours of the key.
    assert_eq!(dots.len(), 8 + 4 + 2);
    assert_eq!(
        text_at(&marks, "line: mean of the runs; dots: each run"),
        ([LEFT + WIDTH, 28.0], Anchor::End)
    );
    // Where each place has one run, that run is the mean.
    let single = table(&["x=1,2"], &[50.0, 0.0]);
    let single = self::marks(&single, "y,x");
    assert_eq!(self::dots(&single).len(), 2);
    assert!(!single.iter().any(|mark| matches!(mark, Mark::Text { text, .. } if text.contains("mean"))));
}

#[test]
fn a_grid_of_lines_stands_at_the_labels_of_the_results() {
    let marks = marks(&three_lines(), "y,x,g");
    let grid: Vec<&[[f64; 2]]> = lines(&marks)
        .filter(|(_, colour, _)| *colour == [228, 230, 233])
        .map(|(points, ..)| points)
        .collect();
    assert_eq!(grid.len(), 6);
    for (k, points) in (0..).zip(grid) {
        let value = 10 * k;
        let [_, y] = place(1.0, f64::from(value));
        assert!(is_near(points[0], [LEFT, y]) && is_near(points[1], [LEFT + WIDTH, y]), "{points:?}");
        // The label is left of its line, and its digits lie on both sides of it.
        let ([right, base], anchor) = text_at(&marks, &value.to_string());
        assert!(right < LEFT && base > y && base < y + 10.0 && anchor == Anchor::End, "{value}");
    }
}

#[test]
fn the_key_stands_right_of_the_plot_and_has_the_values_that_are_drawn() {
    let table = three_lines();
    let drawing = Chart::parse("y,x,g").unwrap().draw(&table).unwrap();
    let marks = &drawing.marks;
    // 640 pixels, 60 for the marks of the key, and 8 for each of at least 12 letters.
    assert_eq!((drawing.width, drawing.height), (640 + 60 + 8 * 12, 420));
    let left = LEFT + WIDTH + 24.0;
    assert_eq!(text_at(marks, "g"), ([left, 53.0], Anchor::Start));
    assert!(!marks.iter().any(|mark| matches!(mark, Mark::Text { text, .. } if text == "8")));
    let dots = dots(marks);
    for (value, y, colour) in [("7", 73.0, BLUE), ("9", 93.0, GREEN)] {
        assert_eq!(text_at(marks, value), ([left + 28.0, y], Anchor::Start));
        let middle = y - 4.0;
        assert!(
            lines(marks).any(|line| line == (&[[left, middle], [left + 20.0, middle]], colour, 2.0)),
            "{value}"
        );
        let is_its_dot = |(at, radius, fill): &([f64; 2], f64, Colour)| {
            is_near(*at, [left + 10.0, middle]) && (radius - 3.5).abs() < SAME && *fill == colour
        };
        assert!(dots.iter().any(is_its_dot), "{value}: {dots:?}");
    }
    // Without a key there is no room for one.
    assert_eq!(Chart::parse("y,x").unwrap().draw(&table).unwrap().width, 640);
    // A long name of a value has its room.
    let long = format!("g={},short", "m".repeat(30));
    let long = self::table(&[&long], &[1.0, 2.0]);
    assert_eq!(Chart::parse("y,run,g").unwrap().draw(&long).unwrap().width, 640 + 60 + 8 * 30);
}

/// The line of a chart without a key.
fn line(table: &SweepTable, chart: &str) -> Vec<[f64; 2]> {
    let marks = marks(table, chart);
    lines(&marks).find(|(_, colour, width)| (*colour, *width) == (BLUE, 1.6)).expect("a line").0.to_vec()
}

#[test]
fn words_stand_beside_each_other_in_the_order_in_which_they_come() {
    let words = table(&["x=north,east,south"], &[50.0, 10.0, 0.0]);
    let found = line(&words, "y,x");
    assert_eq!(found.len(), 3);
    for (k, (found, value)) in found.into_iter().zip([50.0, 10.0, 0.0]).enumerate() {
        let [_, y] = place(1.0, value);
        // Three columns of the same width.
        assert!(is_near(found, [LEFT + WIDTH * (k as f64 + 0.5) / 3.0, y]), "{k}: {found:?}");
    }
    let marks = marks(&words, "y,x");
    let ([x, _], anchor) = text_at(&marks, "south");
    assert!((x - (LEFT + WIDTH * 2.5 / 3.0)).abs() < SAME && anchor == Anchor::Middle, "{x}");
    assert!(!line(&words, "y,run").is_empty());
}

#[test]
fn zero_is_an_end_of_results_of_one_sign_and_one_place_is_in_the_middle() {
    // From -50 to 0, with 4 % below.
    let below = line(&table(&["x=1,2"], &[-50.0, -10.0]), "y,x");
    let y = |value: f64| ABOVE + HEIGHT * (0.0 - value) / 52.0;
    assert!((below[0][1] - y(-50.0)).abs() < SAME && (below[1][1] - y(-10.0)).abs() < SAME, "{below:?}");
    // A single place has half of its own number to either side, and no result but 0 has room above.
    let marks = marks(&table(&["x=4"], &[0.0]), "y,x");
    assert!(dots(&marks).iter().any(|(at, ..)| is_near(*at, [LEFT + 0.5 * WIDTH, ABOVE + HEIGHT])));
    for (label, x) in [("2.0", 0.0), ("6.0", 1.0)] {
        let ([at, _], _) = text_at(&marks, label);
        assert!((at - (LEFT + x * WIDTH)).abs() < SAME, "{label}: {at}");
    }
}

#[test]
fn a_run_that_leaves_the_parameter_to_the_scene_has_no_place() {
    let axis = Axis::list_from_bytes(b"x,k\n1,1\n,2\n2,3\n", "list.csv".as_ref()).unwrap();
    let outcomes = [50.0, 20.0, 0.0].map(|value| results(&[("y", json!(value))])).to_vec();
    let mut list = finished(Task::Render, &["x=1,2,3"], outcomes);
    list.sweep.axes = vec![axis];
    let found = line(&SweepTable::new(&list), "y,x");
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(is_near(found[0], place(1.0, 50.0)) && is_near(found[1], place(2.0, 0.0)), "{found:?}");
}

#[test]
fn a_second_line_has_the_second_colour() {
    let marks = marks(&table(&["x=1,2", "g=1,2"], &[1.0, 2.0, 3.0, 4.0]), "y,x,g");
    let colours: Vec<Colour> =
        lines(&marks).filter(|(.., width)| *width == 1.6).map(|(_, colour, _)| colour).collect();
    assert_eq!(colours, [BLUE, ORANGE]);
}

#[test]
fn the_file_of_a_chart_has_the_names_of_its_numbers() {
    let stem = |text: &str| Chart::parse(text).unwrap().file_stem();
    assert_eq!(stem("a.hits,b"), "a.hits-over-b");
    assert_eq!(stem("a.hits, b , c"), "a.hits-over-b-by-c");
}
