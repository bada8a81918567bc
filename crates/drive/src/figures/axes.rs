//! Axes to the left of a plot and below it, and the key of elevations.

use raypencil_report::{Anchor, Colour, Drawing, INK, LETTERS, Mark, SOFT, Scale, Tick};

/// Length of a tick's line, pixels.
const TICK_LENGTH_PX: f64 = 5.0;

/// Number of colours in the key of elevations.
const KEY_CELLS: u32 = 128;

/// Width and height of the key, pixels.
const KEY_SIZE_PX: [f64; 2] = [14.0, 150.0];

/// Draws the ticks below a plot and to its left, and the names of both axes. `at` is the plot's upper left corner and
/// `size` its width and height, pixels. Ticks lie at fractions of these, those of the rows counted from above.
pub(crate) fn draw_axes(
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

/// Draws a bar of the colours of elevations, the highest on top, with metres beside it. `at` is its upper left corner,
/// pixels; `colour` takes a fraction of the scale.
pub(crate) fn draw_elevation_key(
    drawing: &mut Drawing,
    at: [f64; 2],
    scale: Scale,
    colour: impl Fn(f64) -> Colour,
) {
    let ([left, above], [width, height]) = (at, KEY_SIZE_PX);
    drawing.text(at, "elevation, m", Anchor::Start, INK);
    let above = above + 12.0;
    let colour_of = |k: u32| Some(colour((f64::from(k) + 0.5) / f64::from(KEY_CELLS)));
    let cells = (0..KEY_CELLS).rev().map(colour_of).collect();
    drawing.marks.push(Mark::Cells { at: [left, above], size: KEY_SIZE_PX, columns: 1, cells });
    let (right, below) = (left + width, above + height);
    let rim = vec![[left, above], [right, above], [right, below], [left, below], [left, above]];
    drawing.line(rim, SOFT, 0.5);
    for tick in scale.ticks(6) {
        let y = below - tick.at * height;
        drawing.line(vec![[right, y], [right + TICK_LENGTH_PX, y]], SOFT, 1.0);
        drawing.text([right + 9.0, y + 0.35 * LETTERS], tick.label, Anchor::Start, SOFT);
    }
}
