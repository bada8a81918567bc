//! Step 9: the light stripes of an image, extracted column by column. (Paper, §3 and §6)

use rayon::prelude::*;
use raypencil_scene::{Image, SceneError};

use crate::check::check_range;
use crate::otsu::otsu;

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
pub enum Place {
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
    pub place: Place,
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
    /// Where the stripe was measured, rows from the image's upper border: j + 1/2 for [`Place::Pixel`].
    pub row: f64,
}

/// How many columns are turned upright at a time. Tuned: a cache holds them.
const STRIP: usize = 32;

/// Lit rows `first..=last` of one column, and where the lower edge lies.
struct Run {
    first: usize,
    last: usize,
    edge: f64,
}

impl Extraction {
    /// The paper's: a fixed threshold, whole pixels. (§6)
    pub fn thresholding(level: f64) -> Self {
        Self { detection: Detection::Fixed(level), place: Place::Pixel, least_rows: 1 }
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
        let mut left_out = 0;
        for column in self.columns(image) {
            if column.len() == beams {
                for (stripe, edge) in stripes.iter_mut().zip(column.into_iter().rev()) {
                    stripe.push(edge);
                }
            } else if !column.is_empty() {
                left_out += 1;
            }
        }
        for stripe in &mut stripes {
            stripe.sort_by_key(|edge| (edge.j, edge.i));
        }
        (stripes, left_out)
    }

    /// The edges of each column, from the top.
    fn columns<T: Copy + Into<f64> + Sync>(&self, image: &Image<T>) -> Vec<Vec<EdgePoint>> {
        let level = match self.detection {
            Detection::Fixed(level) | Detection::Gradient(level) => Some(level),
            Detection::Otsu => otsu(image),
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
            let columns = STRIP.min(width - first);
            let mut values = vec![0.0; columns * height];
            for (j, row) in image.cells().chunks_exact(width.max(1)).enumerate() {
                for (i, &cell) in row[first..first + columns].iter().enumerate() {
                    values[i * height + j] = cell.into();
                }
            }
            let upright = values.chunks_exact(height.max(1)).enumerate();
            upright.map(|(i, values)| column(first + i, values)).collect()
        };
        (0..width.div_ceil(STRIP)).into_par_iter().flat_map_iter(|n| strip(n * STRIP)).collect()
    }

    fn measure(&self, values: &[f64], i: u32, run: &Run) -> EdgePoint {
        let last = run.last as f64 + 0.5;
        match self.place {
            Place::Pixel => EdgePoint { i, j: run.last as u32, row: last },
            Place::SubPixel => EdgePoint { i, j: run.last as u32, row: run.edge },
            Place::Centroid => {
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
mod tests {
    use super::*;

    /// An image of 8 columns and 40 rows: light of value 100 between two edges given for each column, rows from the
    /// top, each pixel by the share of it that is lit; 5 elsewhere.
    fn stripes(of_column: impl Fn(u32) -> Vec<(f64, f64)>) -> Image<f64> {
        let mut image = Image::filled(8, 40, 5.0);
        for i in 0..8 {
            for (upper, lower) in of_column(i) {
                for j in 0..40 {
                    let (top, bottom) = (f64::from(j), f64::from(j + 1));
                    let share = (bottom.min(lower) - top.max(upper)).max(0.0);
                    image.set(i, j, image.at(i, j) + 95.0 * share);
                }
            }
        }
        image
    }

    #[test]
    fn whole_pixels_by_threshold() {
        // Rows 10 to 12 fully lit and 13 by a tenth (14.5) in columns 2 and 5; column 5 one row lower.
        let image = stripes(|i| match i {
            2 => vec![(10.0, 13.1)],
            5 => vec![(11.0, 14.1)],
            _ => vec![],
        });
        let edges = Extraction::thresholding(50.0).edges(&image);
        let expected = [EdgePoint { i: 2, j: 12, row: 12.5 }, EdgePoint { i: 5, j: 13, row: 13.5 }];
        assert_eq!(edges, expected);
        // Of a digital image likewise.
        let digital = Image::from_cells(8, 40, image.cells().iter().map(|&value| value as u16).collect());
        assert_eq!(Extraction::thresholding(50.0).edges(&digital), expected);
    }

    #[test]
    fn edges_come_in_row_major_order_and_runs_are_told_apart() {
        // Two runs in column 1, and one in column 0 between them.
        let image = stripes(|i| match i {
            0 => vec![(15.0, 17.0)],
            1 => vec![(10.0, 12.0), (20.0, 21.0)],
            _ => vec![],
        });
        let places = |edges: &[EdgePoint]| edges.iter().map(|edge| (edge.j, edge.i)).collect::<Vec<_>>();
        let extraction = Extraction::thresholding(50.0);
        assert_eq!(places(&extraction.edges(&image)), [(11, 1), (16, 0), (20, 1)]);
        // A run of one row is noise if two are asked for.
        assert_eq!(places(&Extraction { least_rows: 2, ..extraction }.edges(&image)), [(11, 1), (16, 0)]);
    }

    #[test]
    fn wide_images_are_read_in_strips() {
        // A stripe that falls by a row for each column, over three strips of which the last is not full.
        let width = 2 * STRIP as u32 + 5;
        let mut image = Image::filled(width, width + 3, 0_u16);
        (0..width).for_each(|i| image.set(i, i + 1, 9));
        let edges = Extraction::thresholding(5.0).edges(&image);
        assert_eq!(edges.len(), width as usize);
        assert!(edges.iter().zip(0..).all(|(edge, i)| (edge.i, edge.j) == (i, i + 1)));
        assert!(Extraction::thresholding(5.0).edges(&Image::<u16>::from_cells(0, 0, vec![])).is_empty());
    }

    #[test]
    fn a_run_that_the_border_cuts_off_has_no_lower_edge() {
        let image = stripes(|i| if i == 3 { vec![(37.0, 40.0)] } else { vec![(0.0, 2.0)] });
        let edges = Extraction::thresholding(50.0).edges(&image);
        assert_eq!(edges.len(), 7);
        assert!(edges.iter().all(|edge| edge.i != 3 && edge.j == 1));
    }

    #[test]
    fn sub_pixel_edges_and_centroids() {
        // A stripe from 10 to 13 + f, threshold half way between dark and light. The crossing is exact for f = 0, 1/2
        // and 1, and otherwise off by |1/2 + 1/(2 (1 - f)) - 1 - f| at most: 0.086 at f = 0.29 (1 - sqrt(1/2)).
        let extraction = Extraction { place: Place::SubPixel, ..Extraction::thresholding(52.5) };
        for share in [0.0, 0.1, 0.29, 0.45, 0.5, 0.6, 0.75, 0.95] {
            let image = stripes(|_| vec![(10.0, 13.0 + share)]);
            for edge in extraction.edges(&image) {
                assert!((edge.row - 13.0 - share).abs() < 0.0858, "{} for {share}", edge.row - 13.0);
            }
        }
        let exact = extraction.edges(&stripes(|_| vec![(10.0, 13.5)]));
        assert!((exact[0].row - 13.5).abs() < 1e-12);
        // Lit from 10 to 13 on a dark of 5: the centroid is the middle, 11.5.
        let centroid = Extraction { place: Place::Centroid, ..extraction };
        let edge = centroid.edges(&stripes(|_| vec![(10.0, 13.0)]))[0];
        assert_eq!((edge.j, edge.row), (11, 11.5));
    }

    #[test]
    fn edges_by_gradient_do_not_need_a_level() {
        // A stripe of 20 and one of 100 in the same image on a ramp of dark: one threshold cannot take both well. The
        // lower edges are between rows 12 and 13.
        let mut image = Image::filled(2, 30, 0.0);
        for (i, light) in [(0, 20.0), (1, 100.0)] {
            for j in 0..30 {
                let lit = if (10..13).contains(&j) { light } else { 0.0 };
                image.set(i, j, lit + 2.0 * f64::from(j));
            }
        }
        let extraction =
            Extraction { detection: Detection::Gradient(8.0), place: Place::Pixel, least_rows: 1 };
        let rows: Vec<u32> = extraction.edges(&image).iter().map(|edge| edge.j).collect();
        assert_eq!(rows, [12, 12]);
        // Symmetric differences about the border 13: the vertex is there.
        let fine = Extraction { place: Place::SubPixel, ..extraction }.edges(&image);
        assert!(fine.iter().all(|edge| (edge.row - 13.0).abs() < 1e-12));
    }

    #[test]
    fn a_second_fall_without_a_rise_begins_below_the_first() {
        // Differences 100, -40, -5, -55: a rise into row 1, falls below rows 1 and 3, so runs 1..=1 and 2..=3. The
        // second's centroid is (60 * 2.5 + 55 * 3.5) / 115.
        let image = Image::from_cells(1, 5, vec![0.0, 100.0, 60.0, 55.0, 0.0]);
        let extraction =
            Extraction { detection: Detection::Gradient(8.0), place: Place::Centroid, least_rows: 1 };
        let edges = extraction.edges(&image);
        let expected = [EdgePoint { i: 0, j: 1, row: 1.5 }, EdgePoint { i: 0, j: 2, row: 342.5 / 115.0 }];
        assert_eq!(edges, expected);
        // One row and two: the second is not taken for four.
        let rows = |least_rows| Extraction { least_rows, ..extraction }.edges(&image).len();
        assert_eq!((rows(2), rows(3)), (1, 0));
        // Without any rise the first run is the border's: differences -40, -5, -55, rows 0..=0 and 1..=2.
        let cut_off = Image::from_cells(1, 4, vec![100.0, 60.0, 55.0, 0.0]);
        let rows: Vec<f64> = extraction.edges(&cut_off).iter().map(|edge| edge.row).collect();
        assert_eq!(rows, [0.5, 227.5 / 115.0]);
    }

    #[test]
    fn otsu_needs_no_level() {
        let image = stripes(|i| vec![(10.0 + f64::from(i), 13.0 + f64::from(i))]);
        let extraction = Extraction { detection: Detection::Otsu, ..Extraction::thresholding(0.0) };
        assert_eq!(extraction.edges(&image), Extraction::thresholding(52.5).edges(&image));
        // An image of one value holds no stripe.
        assert!(extraction.edges(&Image::filled(4, 4, 7.0)).is_empty());
    }

    #[test]
    fn two_beams_in_one_exposure_by_order() {
        // Column 0 holds both stripes, column 1 one alone, column 2 three, the others none.
        let image = stripes(|i| match i {
            0 => vec![(10.0, 12.0), (20.0, 22.0)],
            1 => vec![(20.0, 22.0)],
            2 => vec![(10.0, 12.0), (15.0, 16.0), (20.0, 22.0)],
            _ => vec![],
        });
        let (stripes, left_out) = Extraction::thresholding(50.0).edges_by_order(&image, 2);
        assert_eq!(left_out, 2);
        // The near beam's stripe is the lower one.
        assert_eq!(stripes[0], [EdgePoint { i: 0, j: 21, row: 21.5 }]);
        assert_eq!(stripes[1], [EdgePoint { i: 0, j: 11, row: 11.5 }]);
        assert!(Extraction::thresholding(f64::NAN).validate("stripes").is_err());
        assert!(Extraction::thresholding(1.0).validate("stripes").is_ok());
    }
}
