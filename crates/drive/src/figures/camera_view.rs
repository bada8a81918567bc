//! Figures 11 and 14: what the camera sees, with the stripes on it.

use crate::figures::axes::axes;
use crate::figures::{MARGIN, PLOT};
use crate::view::{BEAM_COLOURS, View};
use raypencil_report::{Anchor, Drawing, INK, Mark, Scale};

pub(super) fn camera_view(view: &View, beams: usize) -> Drawing {
    // Whole pixels of the page to each of the view, so that no line of the picture is drawn wider than another.
    let share = (PLOT / f64::from(view.width.max(view.height))).floor().max(1.0);
    let [width, height] = [view.width, view.height].map(|side| share * f64::from(side));
    let [left, above, right, below] = MARGIN;
    let page = [left + width + right, above + height + below].map(|side| side.ceil() as u32);
    let mut drawing = Drawing::new(page[0], page[1], "Camera view with stripes");
    drawing.marks.push(Mark::Cells {
        at: [left, above],
        size: [width, height],
        columns: view.width as usize,
        cells: view.pixels.iter().map(|&pixel| Some(pixel)).collect(),
    });
    let [columns, rows] = view.camera.map(|side| Scale::linear(0.0, f64::from(side)).ticks(6));
    axes(&mut drawing, [left, above], [width, height], columns, rows, ["pixel column", "pixel row"]);
    for beam in 0..beams {
        let y = above + 14.0 + 20.0 * beam as f64;
        let x = left + width + 14.0;
        drawing.line(vec![[x, y], [x + 22.0, y]], BEAM_COLOURS[beam % BEAM_COLOURS.len()], 3.0);
        drawing.text([x + 30.0, y + 4.0], format!("beam {beam}"), Anchor::Start, INK);
    }
    drawing
}
