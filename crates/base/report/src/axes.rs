//! Axes to the left of a plot and below it.

use crate::drawing::{Anchor, Drawing, INK, LETTERS, SOFT};
use crate::paint::text_width;
use crate::scale::{Scale, Tick};

/// Length of a tick's line, pixels.
pub const TICK_LENGTH_PX: f64 = 5.0;

/// Least distance between two labels, and between a label and the name of its axis, pixels.
const MIN_GAP_PX: f64 = 6.0;

/// Ticks of which no two labels touch, if they stand in a row along a side of this length, pixels: every second, third, ... of
/// these.
///
/// ```
/// use raypencil_report::{Scale, Tick, apart_in_row};
///
/// let ticks = Scale::linear(0.0, 10.0).ticks(10);
/// assert_eq!(apart_in_row(ticks.clone(), 400.0).len(), 11);
/// // On 100 pixels each has ten: room for a digit, not for the two of "10" and a gap.
/// let labels: Vec<String> = apart_in_row(ticks, 100.0).into_iter().map(|tick| tick.label).collect();
/// assert_eq!(labels, ["0", "2", "4", "6", "8", "10"]);
/// ```
pub fn apart_in_row(ticks: Vec<Tick>, length: f64) -> Vec<Tick> {
    let touch = |pair: [&Tick; 2]| {
        let half = 0.5 * (text_width(&pair[0].label) + text_width(&pair[1].label));
        length * (pair[1].at - pair[0].at).abs() < half + MIN_GAP_PX
    };
    let every = |step: usize| ticks.iter().step_by(step).collect::<Vec<&Tick>>();
    let fits = |step: &usize| !every(*step).windows(2).any(|pair| touch([pair[0], pair[1]]));
    let step = (1..ticks.len()).find(fits).unwrap_or(ticks.len().max(1));
    every(step).into_iter().cloned().collect()
}

/// Width of the widest label, pixels; 0 without ticks.
pub fn widest(ticks: &[Tick]) -> f64 {
    ticks.iter().map(|tick| text_width(&tick.label)).fold(0.0, f64::max)
}

/// Draws the ticks below a plot and to its left, and the names of both axes. `at` is the plot's upper left corner and
/// `size` its width and height, pixels. Ticks lie at fractions of these, those of the rows counted from above. No label lies over
/// another one, nor over a name.
pub fn draw_axes(
    drawing: &mut Drawing,
    at: [f64; 2],
    size: [f64; 2],
    columns: Vec<Tick>,
    rows: Vec<Tick>,
    names: [&str; 2],
) {
    let ([left, above], [width, height]) = (at, size);
    let below = above + height;
    let columns = apart_in_row(columns, width);
    // The name of the rows stands left of their labels, as far to the left as on every plot if these are short.
    let name_x = (left - 8.0 - widest(&rows) - MIN_GAP_PX - 0.3 * LETTERS).min(18.0);
    for tick in columns {
        let x = left + tick.at * width;
        drawing.line(vec![[x, below], [x, below + TICK_LENGTH_PX]], SOFT, 1.0);
        drawing.text([x, below + 19.0], tick.label, Anchor::Middle, SOFT);
    }
    for tick in rows {
        let y = above + tick.at * height;
        drawing.line(vec![[left - TICK_LENGTH_PX, y], [left, y]], SOFT, 1.0);
        drawing.text([left - 8.0, y + 0.35 * LETTERS], tick.label, Anchor::End, SOFT);
    }
    drawing.text([left + 0.5 * width, below + 40.0], names[0], Anchor::Middle, INK);
    drawing.turned_text([name_x, above + 0.5 * height], names[1], Anchor::Middle, INK, -90.0);
}

/// Coordinates of at least this size are shown from a round offset: their labels would not fit beside a plot.
const MIN_OFFSET: f64 = 1e3;

/// Ticks of an axis from `low` to `high`, and its title. Coordinates far from 0, as maps have them, are counted from a round
/// number, which the title says.
///
/// ```
/// use raypencil_report::axis_from_offset;
///
/// let (ticks, title) = axis_from_offset("y", "m", [4_039_837.6, 4_039_847.2], 7);
/// assert_eq!(title, "y - 4039800, m");
/// assert_eq!(ticks[0].label, "38");
/// assert_eq!(axis_from_offset("x", "m", [-3.0, 4.0], 7).1, "x, m");
/// assert_eq!(axis_from_offset("x", "m", [990_000.0, 1_010_000.0], 7).1, "x - 900000, m");
/// ```
pub fn axis_from_offset(name: &str, unit: &str, [low, high]: [f64; 2], most: u32) -> (Vec<Tick>, String) {
    // A power of ten above the span: then the numbers that are left have few digits before the point.
    let mut step = 1.0;
    while step < high - low && step < 1e15 {
        step *= 10.0;
    }
    // A span that begins below that number is counted from one nearer to it.
    let from = |step: f64| (low / step).floor() * step;
    let offset = if from(10.0 * step) == 0.0 { from(step) } else { from(10.0 * step) };
    if !(low.abs().max(high.abs()) >= MIN_OFFSET && offset.is_finite() && offset != 0.0) {
        return (Scale::linear(low, high).ticks(most), format!("{name}, {unit}"));
    }
    let sign = if offset < 0.0 { '+' } else { '-' };
    let ticks = Scale::linear(low - offset, high - offset).ticks(most);
    (ticks, format!("{name} {sign} {}, {unit}", offset.abs()))
}
