//! Corridor of the crevasses: the cells that an opening touches, which the sheet leaves out, and the posts among them.

use glam::DVec2;

use super::crevasses::{Crevasse, distance_to_segment};
use super::relief::Relief;

/// Distance from an opening up to which posts give way to it, in diagonals of a cell. Each point of a cell is within
/// half a diagonal of a corner: so each cell that an opening touches has a corner this near.
const CLEARANCE_DIAGONALS: f64 = 0.55;

/// Cells that openings touch, and the posts that give way to them.
#[derive(Debug)]
pub(super) struct Corridor {
    columns: u32,
    rows: u32,
    /// Whether a post is near an opening; empty without crevasses.
    near: Vec<bool>,
}

impl Corridor {
    pub(super) fn new(relief: &Relief, crevasses: &[Crevasse]) -> Self {
        let posts = &relief.posts;
        let [columns, rows] = [posts.columns, posts.rows];
        let mut near = vec![false; if crevasses.is_empty() { 0 } else { posts.heights.len() }];
        let corner = posts.corner - relief.middle;
        for crevasse in crevasses {
            let reach = crevasse.max_half_width() + CLEARANCE_DIAGONALS * posts.spacing.length();
            for ends in crevasse.nodes.windows(2) {
                let low = (ends[0].min(ends[1]) - reach - corner) / posts.spacing;
                let high = (ends[0].max(ends[1]) + reach - corner) / posts.spacing;
                let range = |low: f64, high: f64, count: u32| {
                    low.ceil().clamp(0.0, f64::from(count)) as u32..(high.max(-1.0).floor() + 1.0) as u32
                };
                for row in range(low.y, high.y, rows).start..range(low.y, high.y, rows).end.min(rows) {
                    for column in
                        range(low.x, high.x, columns).start..range(low.x, high.x, columns).end.min(columns)
                    {
                        let place = corner + posts.spacing * DVec2::new(f64::from(column), f64::from(row));
                        if distance_to_segment(place, [ends[0], ends[1]]) < reach {
                            near[row as usize * columns as usize + column as usize] = true;
                        }
                    }
                }
            }
        }
        Self { columns, rows, near }
    }

    fn is_near(&self, [column, row]: [u32; 2]) -> bool {
        !self.near.is_empty() && self.near[row as usize * self.columns as usize + column as usize]
    }

    /// Whether a post is in a corridor and is left out. Posts on the border of the ground stay.
    pub(super) fn has_post(&self, [column, row]: [u32; 2]) -> bool {
        let inner = (1..self.columns - 1).contains(&column) && (1..self.rows - 1).contains(&row);
        inner && self.is_near([column, row])
    }

    /// Whether a cell belongs to a corridor.
    pub(super) fn has_cell(&self, [column, row]: [u32; 2]) -> bool {
        [[0, 0], [1, 0], [0, 1], [1, 1]].iter().any(|[i, j]| self.is_near([column + i, row + j]))
    }

    /// Its cells, row by row.
    pub(super) fn cells(&self) -> impl Iterator<Item = [u32; 2]> {
        let all = if self.near.is_empty() { 0 } else { self.rows - 1 };
        (0..all)
            .flat_map(|row| (0..self.columns - 1).map(move |column| [column, row]))
            .filter(|&cell| self.has_cell(cell))
    }
}
