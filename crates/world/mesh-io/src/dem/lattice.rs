//! Places of the posts on the map, and the posts inside a window.

use std::ops::RangeInclusive;

use glam::DVec2;
use raypencil_files::Fault;
use raypencil_terrain::indices_within;

use crate::dem::georeference::Placement;
use crate::dem::tags::tag_name;

/// Places of all posts of a file; rows are counted from the south.
pub(super) struct Lattice {
    /// Columns and rows.
    size: [u32; 2],
    /// Post of the first column and the southernmost row, metres of the map.
    pub(super) corner: DVec2,
    /// Distances between columns and between rows, metres.
    pub(super) spacing: DVec2,
}

impl Lattice {
    /// The posts of a file with `size` columns and rows of pixels.
    pub(super) fn new(placement: Placement, size: [u32; 2]) -> Self {
        let Placement { first: [x, y], column, row } = placement;
        let south = if row < 0.0 { y + row * f64::from(size[1] - 1) } else { y };
        Self { corner: DVec2::new(x, south), spacing: DVec2::new(column, row.abs()), size }
    }

    /// Columns and rows of the posts inside a window: x and y of its lower left corner, width and height, metres.
    pub(super) fn within(&self, window: Option<[f64; 4]>) -> Result<[RangeInclusive<u32>; 2], Fault> {
        let Some([x, y, width, height]) = window else {
            return Ok(self.size.map(|count| 0..=count - 1));
        };
        let found = || format!("x {x} to {}, y {y} to {} m", x + width, y + height);
        if !([x, y, width, height].iter().all(|value| value.is_finite()) && width > 0.0 && height > 0.0) {
            return Err(Fault::new(
                "window",
                found(),
                "x and y of its lower left corner, a width and a height",
            ));
        }
        let columns = indices_within(self.corner.x, self.spacing.x, self.size[0], x, x + width);
        let rows = indices_within(self.corner.y, self.spacing.y, self.size[1], y, y + height);
        match (columns, rows) {
            (Some(columns), Some(rows)) => Ok([columns, rows]),
            _ => {
                let steps = DVec2::new(f64::from(self.size[0] - 1), f64::from(self.size[1] - 1));
                let (low, high) = (self.corner, self.corner + self.spacing * steps);
                let posts = format!("posts of x {} to {}, y {} to {} m", low.x, high.x, low.y, high.y);
                Err(Fault::new("window", format!("no post in {}", found()), posts))
            }
        }
    }

    /// Place in messages about the number of posts.
    pub(super) fn place(&self, window: Option<[f64; 4]>) -> String {
        match window {
            Some(_) => "window".to_string(),
            None => format!("{} and {}", tag_name(256), tag_name(257)),
        }
    }
}
