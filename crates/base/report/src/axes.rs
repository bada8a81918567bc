//! Axes to the left of a plot and below it.

use crate::drawing::{Anchor, Drawing, INK, LETTERS, SOFT};
use crate::scale::Tick;

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
