//! Axes to the left of a plot and below it.

use crate::drawing::{Anchor, Drawing, INK, LETTERS, SOFT};
use crate::scale::{Scale, Tick};

/// Length of a tick's line, pixels.
pub const TICK_LENGTH_PX: f64 = 5.0;

/// Draws the ticks below a plot and to its left, and the names of both axes. `at` is the plot's upper left corner and
/// `size` its width and height, pixels. Ticks lie at fractions of these, those of the rows counted from above.
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
    drawing.turned_text([18.0, above + 0.5 * height], names[1], Anchor::Middle, INK, -90.0);
}

/// Coordinates of at least this size are shown from a round offset: their labels would not fit beside a plot.
const MIN_OFFSET: f64 = 1e4;

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
/// ```
pub fn axis_from_offset(name: &str, unit: &str, [low, high]: [f64; 2], most: u32) -> (Vec<Tick>, String) {
    // A power of ten above the span: then the numbers that are left have few digits before the point.
    let mut step = 1.0;
    while step < high - low && step < 1e15 {
        step *= 10.0;
    }
    let step = step * 10.0;
    let offset = (low / step).floor() * step;
    if !(low.abs().max(high.abs()) >= MIN_OFFSET && offset.is_finite() && offset != 0.0) {
        return (Scale::linear(low, high).ticks(most), format!("{name}, {unit}"));
    }
    let sign = if offset < 0.0 { '+' } else { '-' };
    let ticks = Scale::linear(low - offset, high - offset).ticks(most);
    (ticks, format!("{name} {sign} {}, {unit}", offset.abs()))
}
