//! A picture with its axes, scale bar and rings.

use crate::picture::Reduction;
use crate::scale::{Scale, Tick};

/// A picture is at least a `FLATTEST`th as high as wide: flatter ones are stretched.
const FLATTEST: u64 = 8;

/// One picture with what surrounds it.
#[derive(Debug)]
pub struct Plot {
    pub title: String,
    /// What it shows, for those who do not see it.
    pub alt: String,
    pub source: String,
    pub width: u32,
    pub height: u32,
    /// Differences are drawn cell by cell, ranges smoothly.
    pub of_differences: bool,
    pub bar: Option<Bar>,
    pub note: String,
    pub marks: Vec<Ring>,
}

/// A scale bar.
#[derive(Debug, Clone)]
pub struct Bar {
    pub gradient: String,
    pub ticks: Vec<Tick>,
    pub label: &'static str,
    /// Whether the legend names hits on one side only.
    pub one_sided: bool,
    /// Whether the legend names marks of defects.
    pub marked: bool,
}

/// A ring around one or more defects, by its place in the picture from 0 to 1.
#[derive(Debug)]
pub struct Ring {
    pub across: f64,
    pub down: f64,
    pub title: String,
}

/// Whether a picture takes the width of the page, and how many columns' widths it is high.
pub fn shape(width: u32, height: u32) -> (bool, u64) {
    let drawn_height = u64::from(height) * u64::from(stretch(width, height));
    (u64::from(width) >= 3 * drawn_height, drawn_height)
}

/// How many times as high as columns are wide the rows are drawn.
pub fn stretch(width: u32, height: u32) -> u32 {
    (u64::from(width) / (FLATTEST * u64::from(height))).max(1) as u32
}

/// Indices of cells, each label at the middle of its cell.
pub fn cells_axis(cells: u32, most: u32) -> Vec<Tick> {
    Scale::linear(-0.5, f64::from(cells) - 0.5).ticks(most.min(cells))
}

/// What becomes of cells for which there is no room.
pub fn reduced_to(Reduction { columns, rows }: Reduction) -> Option<String> {
    (columns > 1 || rows > 1).then(|| {
        format!(
            "Reduced to fit: {columns} × {rows} cells become one, the middle one of a map and the farthest \
             from zero of a difference."
        )
    })
}
