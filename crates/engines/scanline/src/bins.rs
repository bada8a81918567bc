//! The stripe points sorted by pixel, so that a face is tested only against points on its rows. (§6: "Checking only
//! pixels that 'see' the stripe is one way of lowering the cost.")

use raypencil_scene::FaceId;

use crate::points::{PixelGrid, StripePoint};
use crate::rounding::PointError;
use crate::scan::SplitTriangle;
use crate::spp::{ProjectedLine, SppPoint};

/// A stripe point that a face may hide.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BinnedPoint {
    /// The point on the SPP.
    pub(crate) on_spp: SppPoint,
    /// 1/t of the point: f_c / r.
    pub(crate) inverse_t: f64,
    /// d, metres.
    pub(crate) distance: f64,
    /// Displacement of the point by rounding.
    pub(crate) error: PointError,
    /// The face that the point is on.
    pub(crate) face: FaceId,
    /// Index of the point among those that the bins were made from.
    pub(crate) index: u32,
}

/// Bounds of a projected triangle: a rectangle on the SPP, and the largest 1/t.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ProjectedBounds {
    pub(crate) low: SppPoint,
    pub(crate) high: SppPoint,
    /// 1/t of the nearest corner. 1/t is nowhere larger on the triangle.
    pub(crate) max_inverse_t: f64,
}

/// The points by pixel, over the smallest rectangle of pixels that contains them all. (A counting sort.)
#[derive(Debug)]
pub(crate) struct Bins {
    pixels: PixelGrid,
    /// Column and row of the rectangle's first pixel.
    first: [i64; 2],
    columns: i64,
    rows: i64,
    /// Index of the first point of each pixel, row by row; the last entry is the number of points.
    starts: Vec<u32>,
    points: Vec<BinnedPoint>,
    row_extents: Vec<RowExtent>,
}

/// The extent of the points in one row of pixels.
#[derive(Debug, Clone, Copy)]
struct RowExtent {
    /// 1/t of the deepest point.
    min_inverse_t: f64,
    /// y of the uppermost and of the lowest point, metres on the SPP.
    top: f64,
    bottom: f64,
}

/// The points of one row of pixels that a triangle may hide.
#[derive(Debug, Clone)]
pub(crate) struct RowPoints {
    row: usize,
    /// A range of [`Bins::points`].
    pub(crate) points: std::ops::Range<usize>,
}

impl Bins {
    /// Sorts the points that are on the image and show the camera their front. All others are invisible anyway.
    pub(crate) fn new<'a>(
        pixels: PixelGrid,
        points: impl Iterator<Item = Option<&'a StripePoint>> + Clone,
    ) -> Self {
        let on_image = points.enumerate().filter_map(|(index, point)| {
            let point = point.filter(|point| point.cos_theta > 0.0)?;
            let image = point.image?;
            let binned = BinnedPoint {
                on_spp: image.on_spp,
                inverse_t: image.inverse_t,
                distance: point.distance,
                error: point.error,
                face: point.face,
                index: index as u32,
            };
            Some(([i64::from(image.pixel.i), i64::from(image.pixel.j)], binned))
        });
        let (mut first, mut last) = ([i64::MAX; 2], [i64::MIN; 2]);
        let mut count = 0;
        for (cell, _) in on_image.clone() {
            first = [first[0].min(cell[0]), first[1].min(cell[1])];
            last = [last[0].max(cell[0]), last[1].max(cell[1])];
            count += 1;
        }
        if count == 0 {
            let (starts, points, row_extents) = (vec![0], Vec::new(), Vec::new());
            return Self { pixels, first: [0; 2], columns: 0, rows: 0, starts, points, row_extents };
        }
        let (columns, rows) = (last[0] - first[0] + 1, last[1] - first[1] + 1);
        let cell_index = |[i, j]: [i64; 2]| ((j - first[1]) * columns + (i - first[0])) as usize;

        // Count, sum up, place: the points of one pixel keep their order.
        let mut starts = vec![0_u32; (columns * rows) as usize + 1];
        let empty = RowExtent { min_inverse_t: f64::INFINITY, top: f64::INFINITY, bottom: f64::NEG_INFINITY };
        let mut row_extents = vec![empty; rows as usize];
        let mut any = None;
        for (cell, point) in on_image.clone() {
            starts[cell_index(cell) + 1] += 1;
            let row = &mut row_extents[(cell[1] - first[1]) as usize];
            row.min_inverse_t = row.min_inverse_t.min(point.inverse_t);
            (row.top, row.bottom) = (row.top.min(point.on_spp.y), row.bottom.max(point.on_spp.y));
            any = Some(point);
        }
        for k in 1..starts.len() {
            starts[k] += starts[k - 1];
        }
        let mut next = starts.clone();
        let mut sorted = vec![any; count];
        for (cell, point) in on_image {
            let next = &mut next[cell_index(cell)];
            sorted[*next as usize] = Some(point);
            *next += 1;
        }
        let points = sorted.into_iter().flatten().collect();
        Self { pixels, first, columns, rows, starts, points, row_extents }
    }

    /// All points, pixel by pixel.
    pub(crate) fn points(&self) -> &[BinnedPoint] {
        &self.points
    }

    /// The points in some pixels of row `j`, as a range of [`Self::points`].
    #[inline]
    pub(crate) fn in_row(&self, j: u32, columns: std::ops::Range<u32>) -> std::ops::Range<usize> {
        let row = i64::from(j) - self.first[1];
        let from = (i64::from(columns.start) - self.first[0]).clamp(0, self.columns);
        let end = (i64::from(columns.end) - self.first[0]).clamp(from, self.columns);
        if row < 0 || row >= self.rows {
            return 0..0;
        }
        self.in_columns(row, from, end)
    }

    /// The points in the pixels that some bounds touch, by row. A row is left out if all its points are nearer than
    /// the bounds.
    #[inline]
    pub(crate) fn rows_touched<'a>(
        &'a self,
        bounds: &ProjectedBounds,
    ) -> impl Iterator<Item = RowPoints> + use<'a> {
        let (low, high) = (self.pixels.cell(bounds.low), self.pixels.cell(bounds.high));
        let from = (low[0] - self.first[0]).max(0);
        let end = (high[0] - self.first[0] + 1).min(self.columns);
        let top = (low[1] - self.first[1]).max(0);
        let bottom = if from < end { (high[1] - self.first[1] + 1).min(self.rows) } else { top };
        let max_inverse_t = bounds.max_inverse_t;
        (top..bottom).filter_map(move |row| {
            if !(max_inverse_t > self.row_extents[row as usize].min_inverse_t) {
                return None;
            }
            let points = self.in_columns(row, from, end);
            (!points.is_empty()).then_some(RowPoints { row: row as usize, points })
        })
    }

    /// The points in those pixels that a triangle touches within their own row. They are few for a triangle that
    /// leans across many rows.
    pub(crate) fn narrow<L: ProjectedLine>(
        &self,
        row_points: RowPoints,
        triangle: &SplitTriangle<L>,
    ) -> std::ops::Range<usize> {
        let RowExtent { top, bottom, .. } = self.row_extents[row_points.row];
        let (left, right) = triangle.span_bounds(top, bottom);
        if left > right {
            return 0..0;
        }
        let from = self.pixels.cell(SppPoint { x: left, y: top })[0] - self.first[0];
        let end = self.pixels.cell(SppPoint { x: right, y: top })[0] - self.first[0] + 1;
        let (from, end) = (from.clamp(0, self.columns), end.clamp(0, self.columns));
        self.in_columns(row_points.row as i64, from, end)
    }

    #[inline]
    fn in_columns(&self, row: i64, from: i64, end: i64) -> std::ops::Range<usize> {
        let row = row * self.columns;
        self.starts[(row + from) as usize] as usize..self.starts[(row + end) as usize] as usize
    }
}

#[cfg(test)]
#[path = "../tests/unit/bins.rs"]
mod tests;
