//! Figures 11 and 14: the camera's view with the stripes.

use raypencil_report::{Anchor, Drawing, INK, Mark, Scale, draw_axes};

use crate::camera_view::{BEAM_COLOURS, CameraView};
use crate::figures::figure::{MARGINS_PX, PLOT_SIDE_PX};

/// Drawing of a view, with axes in pixels of the camera and a key of the beams' colours.
pub(super) fn camera_figure(view: &CameraView, beams: usize) -> Drawing {
    // Each pixel of the view covers a whole number of the page's pixels, so that all its rows have the same height.
    let share = (PLOT_SIDE_PX / f64::from(view.width.max(view.height))).floor().max(1.0);
    let [width, height] = [view.width, view.height].map(|side| share * f64::from(side));
    let [left, above, right, below] = MARGINS_PX;
    let page = [left + width + right, above + height + below].map(|side| side.ceil() as u32);
    let mut drawing = Drawing::new(page[0], page[1], "Camera view with stripes");
    drawing.marks.push(Mark::Cells {
        at: [left, above],
        size: [width, height],
        columns: view.width as usize,
        cells: view.pixels.iter().map(|&pixel| Some(pixel)).collect(),
    });
    let [columns, rows] = view.camera_size.map(|side| Scale::linear(0.0, f64::from(side)).ticks(6));
    draw_axes(&mut drawing, [left, above], [width, height], columns, rows, ["pixel column", "pixel row"]);
    for beam in 0..beams {
        let y = above + 14.0 + 20.0 * beam as f64;
        let x = left + width + 14.0;
        drawing.line(vec![[x, y], [x + 22.0, y]], BEAM_COLOURS[beam % BEAM_COLOURS.len()], 3.0);
        drawing.text([x + 30.0, y + 4.0], format!("beam {beam}"), Anchor::Start, INK);
    }
    drawing
}
