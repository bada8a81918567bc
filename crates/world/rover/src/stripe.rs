//! Step 9: extraction of the light stripes, column by column. (Paper, §3 and §6)

use rayon::prelude::*;
use raypencil_scene::{Image, SceneError, check_range};

use crate::otsu::otsu_threshold;

/// Method that separates lit from dark pixels. "Finally, thresholding or edge detection is performed to extract the
/// light stripes from the image." (§3)
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Detection {
    /// Fixed threshold: a pixel at or above this value is lit. "Extraction of the stripe edges is currently performed
    /// by simple thresholding." (§6)
    Fixed(f64),
    /// Threshold as a share of the image's largest value, from 0 to 1: for images of flux, whose unit says nothing about
    /// what is bright.
    Share(f64),
    /// Threshold from the image's histogram. (N. Otsu, "A threshold selection method from gray-level histograms", 1979)
    Otsu,
    /// Edge detection: an edge is a local extremum of the difference of vertical neighbours, of at least this size.
    Gradient(f64),
}

/// Row of a stripe that is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StripeLocation {
    /// Middle of the last lit pixel, as in the paper: "the camera pixels that correspond to edge points are
    /// known" (§7).
    #[default]
    Pixel,
    /// Row at which the values, interpolated linearly between pixel centres, cross the threshold. With
    /// [`Detection::Gradient`]: the vertex of the parabola through three differences.
    SubPixel,
    /// Centroid of the light: each row weighted by its value. It lies on the middle plane of the light sheet, not on
    /// its lower edge plane: triangulate with `SheetPlane::Middle`.
    Centroid,
}

impl StripeLocation {
    /// Standard error of a measured row, pixels.
    ///
    /// The middle of a pixel stands for an edge anywhere in it: a uniform distribution of width 1 has the standard
    /// deviation 1 / sqrt(12). So does the centroid of a stripe that lit one row alone: it is the middle of that pixel, wherever in
    /// it the light lies. CHOICE for the others: a tenth, which the table of `docs/evidence/results.md` bears out.
    pub fn row_error(self, edge: &EdgePoint) -> f64 {
        let one_row = (edge.row - (f64::from(edge.j) + 0.5)).abs() <= ROW_ROUNDING;
        match self {
            Self::Pixel => (1.0_f64 / 12.0).sqrt(),
            Self::Centroid if one_row => (1.0_f64 / 12.0).sqrt(),
            Self::SubPixel | Self::Centroid => 0.1,
        }
    }
}

/// A centroid this near to the middle of its pixel is that middle, pixels: its quotient is rounded.
const ROW_ROUNDING: f64 = 1e-9;

/// Settings of the stripe extraction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extraction {
    /// Method that separates lit from dark pixels.
    pub detection: Detection,
    /// Row of a stripe that is measured.
    pub place: StripeLocation,
    /// Minimum run of lit rows that counts as a stripe.
    pub least_rows: u32,
}

/// Measured edge of a stripe in one column of the image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgePoint {
    /// Column of the pixel.
    pub i: u32,
    /// Row of the last lit pixel; for [`StripeLocation::Centroid`] the row of the centroid.
    pub j: u32,
    /// Measured row, in pixels from the image's upper border: j + 1/2 for [`StripeLocation::Pixel`].
    pub row: f64,
}

/// A run of lit rows in a column, with its edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LitRun {
    pub first: u32,
    pub last: u32,
    pub edge: EdgePoint,
}

/// Columns that are transposed at a time. Tuned: they fit into a cache.
const COLUMNS_PER_STRIP: usize = 32;

/// Lit rows `first..=last` of one column; `edge` is the sub-pixel row of the lower edge.
struct Run {
    first: usize,
    last: usize,
    edge: f64,
}

impl Extraction {
    /// The paper's extraction: a fixed threshold and whole pixels. (§6)
    pub fn thresholding(level: f64) -> Self {
        Self { detection: Detection::Fixed(level), place: StripeLocation::Pixel, least_rows: 1 }
    }

    /// Lower edges in an image of one beam, in row-major order. The lower edge of a stripe is the image of the light in
    /// the beam's lower edge plane.
    ///
    /// CHOICE: a column may hold several runs of lit pixels (a rock and the ground behind it). Each gives an edge,
    /// since each edge is triangulated alone. A run that is cut off by the image's lower border gives none.
    ///
    /// ```
    /// use raypencil_rover::{EdgePoint, Extraction};
    /// use raypencil_scene::Image;
    ///
    /// // A stripe on rows 3 and 4 of column 1. Its last lit pixel is in row 4, whose middle is at 4.5.
    /// let mut image = Image::filled(3, 8, 0.0);
    /// image.set(1, 3, 200.0);
    /// image.set(1, 4, 120.0);
    /// let edges = Extraction::thresholding(50.0).edges(&image);
    /// assert_eq!(edges, [EdgePoint { i: 1, j: 4, row: 4.5 }]);
    /// ```
    pub fn edges<T: Copy + Into<f64> + Sync>(&self, image: &Image<T>) -> Vec<EdgePoint> {
        let runs = self.columns(image).into_iter().flatten();
        let mut edges: Vec<EdgePoint> = runs.map(|run| run.edge).collect();
        edges.sort_by_key(|edge| (edge.j, edge.i));
        edges
    }

    /// Runs of each column, from the top.
    pub(crate) fn columns<T: Copy + Into<f64> + Sync>(&self, image: &Image<T>) -> Vec<Vec<LitRun>> {
        let level = match self.detection {
            Detection::Fixed(level) | Detection::Gradient(level) => Some(level),
            Detection::Share(share) => {
                let largest = image.cells().iter().map(|&cell| cell.into()).fold(0.0, f64::max);
                // A dark image has no stripes.
                (largest > 0.0).then_some(share * largest)
            }
            Detection::Otsu => otsu_threshold(image),
        };
        let Some(level) = level else { return vec![Vec::new(); image.width() as usize] };
        let (width, height) = (image.width() as usize, image.height() as usize);
        let column = |i: usize, values: &[f64]| -> Vec<LitRun> {
            let runs = match self.detection {
                Detection::Gradient(_) => runs_between_edges(values, level),
                _ => runs_above(values, level),
            };
            let long = runs.into_iter().filter(|run| run.last - run.first + 1 >= self.least_rows as usize);
            let lit = |run: Run| {
                let [first, last] = [run.first, run.last].map(|row| row as u32);
                LitRun { first, last, edge: self.measure(values, i as u32, &run) }
            };
            long.map(lit).collect()
        };
        // Images are stored row by row: transpose some columns at a time.
        let strip = |first: usize| -> Vec<Vec<LitRun>> {
            let columns = COLUMNS_PER_STRIP.min(width - first);
            let mut values = vec![0.0; columns * height];
            for (j, row) in image.cells().chunks_exact(width.max(1)).enumerate() {
                for (i, &cell) in row[first..first + columns].iter().enumerate() {
                    values[i * height + j] = cell.into();
                }
            }
            let transposed = values.chunks_exact(height.max(1)).enumerate();
            transposed.map(|(i, values)| column(first + i, values)).collect()
        };
        (0..width.div_ceil(COLUMNS_PER_STRIP))
            .into_par_iter()
            .flat_map_iter(|n| strip(n * COLUMNS_PER_STRIP))
            .collect()
    }

    fn measure(&self, values: &[f64], i: u32, run: &Run) -> EdgePoint {
        let last = run.last as f64 + 0.5;
        match self.place {
            StripeLocation::Pixel => EdgePoint { i, j: run.last as u32, row: last },
            StripeLocation::SubPixel => EdgePoint { i, j: run.last as u32, row: run.edge },
            StripeLocation::Centroid => {
                let (mut light, mut moment) = (0.0, 0.0);
                for j in run.first..=run.last {
                    light += values[j];
                    moment += values[j] * (j as f64 + 0.5);
                }
                // Negative values (after subtraction of an unlit image) may leave no light: take the run's middle.
                let middle = 0.5 * (run.first + run.last + 1) as f64;
                let row = if light > 0.0 { moment / light } else { middle };
                EdgePoint { i, j: row as u32, row }
            }
        }
    }

    /// Checks every field. The error names the first one that is out of range.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        match self.detection {
            Detection::Fixed(level) => check_range(|| format!("{field}.level"), level, -1e30, 1e30, "")?,
            Detection::Gradient(level) => {
                check_range(|| format!("{field}.gradient"), level, 1e-300, 1e30, "")?
            }
            Detection::Share(share) => check_range(|| format!("{field}.share"), share, 1e-9, 1.0, "")?,
            Detection::Otsu => {}
        }
        check_range(|| format!("{field}.least_rows"), f64::from(self.least_rows), 1.0, 1e6, "rows")
    }
}

/// Runs of values at or above `level` that end inside the image.
fn runs_above(values: &[f64], level: f64) -> Vec<Run> {
    let mut runs = Vec::new();
    let mut first = None;
    for (j, &value) in values.iter().enumerate() {
        if value >= level {
            first.get_or_insert(j);
        } else if let Some(first) = first.take() {
            let last = j - 1;
            let edge = last as f64 + 0.5 + (values[last] - level) / (values[last] - value);
            runs.push(Run { first, last, edge });
        }
    }
    runs
}

/// Runs between a rise and a fall: local extrema of the difference of at least `min_difference`.
fn runs_between_edges(values: &[f64], min_difference: f64) -> Vec<Run> {
    // differences[j] belongs to the border between rows j and j + 1.
    let differences: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let at = |j: usize, step: isize| {
        j.checked_add_signed(step).and_then(|j| differences.get(j)).copied().unwrap_or(0.0)
    };
    let mut runs = Vec::new();
    let mut first = None;
    for (j, &difference) in differences.iter().enumerate() {
        let (above, below) = (at(j, -1), at(j, 1));
        if difference >= min_difference && difference > above && difference >= below {
            first = Some(j + 1);
        } else if difference <= -min_difference && difference < above && difference <= below {
            // Without a rise, the light begins at the image's upper border: its lower edge counts all the same. After
            // an earlier fall, it begins below that one.
            let first = first.take().unwrap_or(runs.last().map_or(0, |run: &Run| run.last + 1));
            // Vertex of the parabola through the three differences. Its curvature is positive at a minimum.
            let curvature = above - 2.0 * difference + below;
            let shift = if curvature > 0.0 { 0.5 * (above - below) / curvature } else { 0.0 };
            runs.push(Run { first, last: j, edge: (j + 1) as f64 + shift });
        }
    }
    runs
}

#[cfg(test)]
#[path = "../tests/unit/stripe.rs"]
mod tests;
