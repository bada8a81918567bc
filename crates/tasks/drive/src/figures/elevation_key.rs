//! The key of elevations.

use raypencil_report::{Anchor, Colour, Drawing, INK, LETTERS, Mark, SOFT, Scale, TICK_LENGTH_PX};

/// Number of colours in the key of elevations.
const KEY_CELLS: u32 = 128;

/// Width and height of the key, pixels.
const KEY_SIZE_PX: [f64; 2] = [14.0, 150.0];

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
