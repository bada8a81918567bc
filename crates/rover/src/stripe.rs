//! Step 9: the light stripes of an image, extracted column by column. (Paper, §3 and §6)

use rayon::prelude::*;
use raypencil_scene::{Image, SceneError};

use crate::check::check_range;
use crate::otsu::otsu_threshold;

/// How light is told from dark. "Finally, thresholding or edge detection is performed to extract the light stripes
/// from the image." (§3)
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Detection {
    /// A pixel at or above this value is lit. "Extraction of the stripe edges is currently performed by simple
    /// thresholding." (§6)
    Fixed(f64),
    /// The value is the one that best parts the image's histogram in two. (N. Otsu, "A threshold selection method
    /// from gray-level histograms", 1979)
    Otsu,
    /// An edge is where the difference of two pixels, one above the other, is extreme and at least this.
    Gradient(f64),
}

/// Which place of the stripe is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StripeLocation {
    /// The middle of the last lit pixel, as in the paper: "the camera pixels that correspond to edge points are
    /// known" (§7).
    #[default]
    Pixel,
    /// Where the values, linear from one pixel's middle to the next, cross the threshold; with
    /// [`Detection::Gradient`] the vertex of a parabola through three differences.
    SubPixel,
    /// The middle of the light, each row weighted by its value. It lies on the middle plane of the sheet, not on
    /// its lower edge plane: triangulate with [`crate::SheetPlane::Middle`].
    Centroid,
}

/// How stripes are extracted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extraction {
    /// What is lit.
    pub detection: Detection,
    /// What is measured of it.
    pub place: StripeLocation,
    /// Fewer lit rows than this are noise.
    pub least_rows: u32,
}

/// The lower edge of a stripe in one column of the image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgePoint {
    /// Column of the pixel.
    pub i: u32,
    /// Row of the last lit pixel, or of the one that holds the centroid.
    pub j: u32,
    /// Where the stripe was measured, rows from the image's upper border: j + 1/2 for [`StripeLocation::Pixel`].
    pub row: f64,
}

/// How many columns are turned upright at a time. Tuned: a cache holds them.
const COLUMNS_PER_STRIP: usize = 32;

/// Lit rows `first..=last` of one column, and where the lower edge lies.
struct Run {
    first: usize,
    last: usize,
    edge: f64,
}

impl Extraction {
    /// The paper's: a fixed threshold, whole pixels. (§6)
    pub fn thresholding(level: f64) -> Self {
        Self { detection: Detection::Fixed(level), place: StripeLocation::Pixel, least_rows: 1 }
    }

    /// The lower edges in an image of one beam, in row-major order. The lower edge of the stripe is where the
    /// light of the beam's lower edge plane lands.
    ///
    /// CHOICE: a column may hold several runs of lit pixels (a rock and the ground behind it); each is an edge of
    /// its own, since each is triangulated by itself. A run that the image's lower border cuts off has none.
    pub fn edges<T: Copy + Into<f64> + Sync>(&self, image: &Image<T>) -> Vec<EdgePoint> {
        let mut edges: Vec<EdgePoint> = self.columns(image).into_iter().flatten().collect();
        edges.sort_by_key(|edge| (edge.j, edge.i));
        edges
    }

    /// The edges of all `beams` in one exposure: in each column the lowest run belongs to beam 0, the next one up
    /// to beam 1. Also says how many columns hold light but not one run for each beam: they are left out.
    ///
    /// CHOICE: nothing is guessed. The order holds as long as no beam meets the ground so near that its stripe
    /// rises above the next one's; exposing the beams in turn has no such limit.
    pub fn edges_by_order<T: Copy + Into<f64> + Sync>(
        &self,
        image: &Image<T>,
        beams: usize,
    ) -> (Vec<Vec<EdgePoint>>, usize) {
        let mut stripes = vec![Vec::new(); beams];
        let mut columns_left_out = 0;
        for column in self.columns(image) {
            if column.len() == beams {
                for (stripe, edge) in stripes.iter_mut().zip(column.into_iter().rev()) {
                    stripe.push(edge);
                }
            } else if !column.is_empty() {
                columns_left_out += 1;
            }
        }
        for stripe in &mut stripes {
            stripe.sort_by_key(|edge| (edge.j, edge.i));
        }
        (stripes, columns_left_out)
    }

    /// The edges of each column, from the top.
    fn columns<T: Copy + Into<f64> + Sync>(&self, image: &Image<T>) -> Vec<Vec<EdgePoint>> {
        let level = match self.detection {
            Detection::Fixed(level) | Detection::Gradient(level) => Some(level),
            Detection::Otsu => otsu_threshold(image),
        };
        let Some(level) = level else { return vec![Vec::new(); image.width() as usize] };
        let (width, height) = (image.width() as usize, image.height() as usize);
        let column = |i: usize, values: &[f64]| -> Vec<EdgePoint> {
            let runs = match self.detection {
                Detection::Gradient(_) => runs_between_edges(values, level),
                _ => runs_above(values, level),
            };
            let long = runs.into_iter().filter(|run| run.last - run.first + 1 >= self.least_rows as usize);
            long.map(|run| self.measure(values, i as u32, &run)).collect()
        };
        // Images lie row by row: columns are turned upright some at a time.
        let strip = |first: usize| -> Vec<Vec<EdgePoint>> {
            let columns = COLUMNS_PER_STRIP.min(width - first);
            let mut values = vec![0.0; columns * height];
            for (j, row) in image.cells().chunks_exact(width.max(1)).enumerate() {
                for (i, &cell) in row[first..first + columns].iter().enumerate() {
                    values[i * height + j] = cell.into();
                }
            }
            let upright = values.chunks_exact(height.max(1)).enumerate();
            upright.map(|(i, values)| column(first + i, values)).collect()
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
                // Values below zero (dark current taken off) may leave no light: then the run's middle.
                let middle = 0.5 * (run.first + run.last + 1) as f64;
                let row = if light > 0.0 { moment / light } else { middle };
                EdgePoint { i, j: row as u32, row }
            }
        }
    }

    /// Refuses a level or a length that is none.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        match self.detection {
            Detection::Fixed(level) => check_range(field, "level", level, -1e30, 1e30, "")?,
            Detection::Gradient(level) => check_range(field, "gradient", level, 1e-300, 1e30, "")?,
            Detection::Otsu => {}
        }
        check_range(field, "least_rows", f64::from(self.least_rows), 1.0, 1e6, "rows")
    }
}

/// Runs of values at or above `level` that end within the image.
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

/// Runs between a rising and a falling difference of at least `least`, each the steepest of its neighbours.
fn runs_between_edges(values: &[f64], least: f64) -> Vec<Run> {
    // differences[j] is across the border between rows j and j + 1.
    let differences: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let at = |j: usize, step: isize| {
        j.checked_add_signed(step).and_then(|j| differences.get(j)).copied().unwrap_or(0.0)
    };
    let mut runs = Vec::new();
    let mut first = None;
    for (j, &difference) in differences.iter().enumerate() {
        let (above, below) = (at(j, -1), at(j, 1));
        if difference >= least && difference > above && difference >= below {
            first = Some(j + 1);
        } else if difference <= -least && difference < above && difference <= below {
            // Without a rise the image's upper border cuts the light off: its lower edge is one all the same. Below
            // another fall the light goes on from there.
            let first = first.take().unwrap_or(runs.last().map_or(0, |run: &Run| run.last + 1));
            // The vertex of the parabola through the three differences; its curvature is positive here.
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
