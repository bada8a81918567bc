//! Figure with its file name and caption, and the layout that figures share.

use raypencil_report::Drawing;

/// Longest side of a plot, pixels.
pub(crate) const PLOT_SIDE_PX: f64 = 560.0;

/// Margins around a plot, pixels: left, above, right, below.
pub(crate) const MARGINS_PX: [f64; 4] = [64.0, 24.0, 160.0, 56.0];

pub(crate) struct Figure {
    /// Name of its files, without `.svg` and `.png`.
    pub stem: &'static str,
    pub caption: String,
    pub drawing: Drawing,
}
