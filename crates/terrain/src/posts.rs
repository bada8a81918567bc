//! A regular grid of heights: what elevation models are, and what generated relief starts from.

use glam::{DVec2, DVec3};

/// Heights on a regular grid of points ("posts"), global frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Posts {
    /// Posts along x.
    pub columns: u32,
    /// Posts along y.
    pub rows: u32,
    /// Global x and y of post (0, 0), the one with the least of both, metres.
    pub corner: DVec2,
    /// From a post to the next along x, and along y, metres; both are positive.
    pub spacing: DVec2,
    /// Global z, metres, `columns` of them for each row, the row of least y first; NaN where it is not known.
    pub heights: Vec<f64>,
}

impl Posts {
    /// Where the post of that column and row stands.
    ///
    /// # Panics
    /// If there is no such post.
    pub fn at(&self, column: u32, row: u32) -> DVec3 {
        let place = self.corner + self.spacing * DVec2::new(f64::from(column), f64::from(row));
        place.extend(self.heights[row as usize * self.columns as usize + column as usize])
    }

    /// From the first post to the last along x and along y, metres.
    pub fn extent(&self) -> DVec2 {
        let steps = |count: u32| f64::from(count.saturating_sub(1));
        self.spacing * DVec2::new(steps(self.columns), steps(self.rows))
    }
}
