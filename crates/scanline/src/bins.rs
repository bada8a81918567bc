//! Stripe points sorted by the pixel they land in, so that a face meets those on its rows and no others. (§6:
//! "Checking only pixels that 'see' the stripe is one way of lowering the cost.")

use raypencil_scene::FaceId;

use crate::points::{Pixels, StripePoint};
use crate::rounding::PointError;
use crate::scan::{Corner, Line, SplitTriangle};

/// A point that something may hide.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Binned {
    /// Its place on the SPP, metres.
    pub(crate) at: Corner,
    /// 1/t of it: f_c / r.
    pub(crate) inverse_t: f64,
    /// d, metres.
    pub(crate) distance: f64,
    /// How far rounding may have moved it.
    pub(crate) error: PointError,
    /// The face it is on.
    pub(crate) face: FaceId,
    /// Which of the points it was made from.
    pub(crate) index: u32,
}

/// The part of the SPP that a face, or what clipping leaves of it, can reach, and how near it comes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reach {
    pub(crate) low: Corner,
    pub(crate) high: Corner,
    /// 1/t of its nearest corner. Over the face 1/t is nowhere larger.
    pub(crate) nearest: f64,
}

/// Points by pixel, over the smallest rectangle of pixels that holds them all: a counting sort.
#[derive(Debug)]
pub(crate) struct Bins {
    pixels: Pixels,
    /// Column and row of the rectangle's first pixel.
    first: [i64; 2],
    columns: i64,
    rows: i64,
    /// Where the points of each pixel start, row by row, and at last their count.
    starts: Vec<u32>,
    points: Vec<Binned>,
    contents: Vec<Row>,
}

/// What a row of pixels holds.
#[derive(Debug, Clone, Copy)]
struct Row {
    /// 1/t of its deepest point.
    deepest: f64,
    /// y of its uppermost and of its lowest point, metres on the SPP.
    top: f64,
    bottom: f64,
}

/// Some points in a row of pixels.
#[derive(Debug, Clone)]
pub(crate) struct Touched {
    row: usize,
    /// Which of all points.
    pub(crate) points: std::ops::Range<usize>,
}

impl Bins {
    /// Of those points that land on the image, their front turned to the camera: all others are invisible.
    pub(crate) fn of<'a>(
        pixels: Pixels,
        points: impl Iterator<Item = Option<&'a StripePoint>> + Clone,
    ) -> Self {
        let landed = points.enumerate().filter_map(|(index, point)| {
            let point = point.filter(|point| point.emission > 0.0)?;
            let landing = point.landing?;
            let binned = Binned {
                at: landing.at,
                inverse_t: landing.inverse_t,
                distance: point.distance,
                error: point.error,
                face: point.face,
                index: index as u32,
            };
            Some(([i64::from(landing.pixel.i), i64::from(landing.pixel.j)], binned))
        });
        let (mut first, mut last) = ([i64::MAX; 2], [i64::MIN; 2]);
        let mut count = 0;
        for (cell, _) in landed.clone() {
            first = [first[0].min(cell[0]), first[1].min(cell[1])];
            last = [last[0].max(cell[0]), last[1].max(cell[1])];
            count += 1;
        }
        if count == 0 {
            let (starts, points, contents) = (vec![0], Vec::new(), Vec::new());
            return Self { pixels, first: [0; 2], columns: 0, rows: 0, starts, points, contents };
        }
        let (columns, rows) = (last[0] - first[0] + 1, last[1] - first[1] + 1);
        let place = |[i, j]: [i64; 2]| ((j - first[1]) * columns + (i - first[0])) as usize;

        // Count, add up, put: points of one pixel stay in their order.
        let mut starts = vec![0_u32; (columns * rows) as usize + 1];
        let nothing = Row { deepest: f64::INFINITY, top: f64::INFINITY, bottom: f64::NEG_INFINITY };
        let mut contents = vec![nothing; rows as usize];
        let mut any = None;
        for (cell, point) in landed.clone() {
            starts[place(cell) + 1] += 1;
            let row = &mut contents[(cell[1] - first[1]) as usize];
            row.deepest = row.deepest.min(point.inverse_t);
            (row.top, row.bottom) = (row.top.min(point.at.y), row.bottom.max(point.at.y));
            any = Some(point);
        }
        for k in 1..starts.len() {
            starts[k] += starts[k - 1];
        }
        let mut next = starts.clone();
        let mut sorted = vec![any; count];
        for (cell, point) in landed {
            let next = &mut next[place(cell)];
            sorted[*next as usize] = Some(point);
            *next += 1;
        }
        let points = sorted.into_iter().flatten().collect();
        Self { pixels, first, columns, rows, starts, points, contents }
    }

    /// All points, pixel by pixel.
    pub(crate) fn points(&self) -> &[Binned] {
        &self.points
    }

    /// The points in the pixels of row `j`, columns `from..end`, as a range of all.
    #[inline]
    pub(crate) fn within(&self, j: u32, columns: std::ops::Range<u32>) -> std::ops::Range<usize> {
        let row = i64::from(j) - self.first[1];
        let from = (i64::from(columns.start) - self.first[0]).clamp(0, self.columns);
        let end = (i64::from(columns.end) - self.first[0]).clamp(from, self.columns);
        if row < 0 || row >= self.rows {
            return 0..0;
        }
        self.in_columns(row, from, end)
    }

    /// For every row of pixels that a face can touch, all of each pixel, the points in it, if they are not all
    /// nearer than the face.
    #[inline]
    pub(crate) fn touched<'a>(&'a self, reach: &Reach) -> impl Iterator<Item = Touched> + use<'a> {
        let (low, high) = (self.pixels.cell(reach.low), self.pixels.cell(reach.high));
        let from = (low[0] - self.first[0]).max(0);
        let end = (high[0] - self.first[0] + 1).min(self.columns);
        let top = (low[1] - self.first[1]).max(0);
        let bottom = if from < end { (high[1] - self.first[1] + 1).min(self.rows) } else { top };
        let nearest = reach.nearest;
        (top..bottom).filter_map(move |row| {
            if !(nearest > self.contents[row as usize].deepest) {
                return None;
            }
            let points = self.in_columns(row, from, end);
            (!points.is_empty()).then_some(Touched { row: row as usize, points })
        })
    }

    /// Those of the points that are in the pixels which a triangle touches in their own row, rather than anywhere.
    /// A triangle that leans across many rows has few of them.
    pub(crate) fn narrowed<L: Line>(
        &self,
        touched: Touched,
        triangle: &SplitTriangle<L>,
    ) -> std::ops::Range<usize> {
        let Row { top, bottom, .. } = self.contents[touched.row];
        let (left, right) = triangle.spans(top, bottom);
        if left > right {
            return 0..0;
        }
        let from = self.pixels.cell(Corner { x: left, y: top })[0] - self.first[0];
        let end = self.pixels.cell(Corner { x: right, y: top })[0] - self.first[0] + 1;
        let (from, end) = (from.clamp(0, self.columns), end.clamp(0, self.columns));
        self.in_columns(touched.row as i64, from, end)
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
