//! Speckle: the grain of laser light on rough ground. (Goodman, Speckle Phenomena in Optics; docs/theory/sensor.md)
//!
//! The ground is rough on the scale of a wavelength, so that the light of each point of it reaches the image with a phase
//! of its own. The amplitude U of the image is then a complex normal number, and its intensity |U|^2 varies from place to
//! place about the mean that optics without interference would give. How far this grain extends is a matter of the
//! aperture: subjective speckle.

use std::f64::consts::{FRAC_1_SQRT_2, PI, SQRT_2};

use rayon::prelude::*;
use raypencil_scene::{Camera, Image, SceneError, check_range};

use crate::{NoiseSource, NoiseStream};

/// Cells along the side of the squares in which the grain is computed.
const TILE: u32 = 64;

/// End of the kernel of the amplitude, in units of `grain`. The covariance of the intensities is off by less than 2e-4.
const CUTOFF_GRAINS: f64 = 4.0;

/// Maximum number of parts of a cell along its side.
const MAX_PARTS: f64 = 64.0;

/// Maximum grain, cells.
const MAX_GRAIN_CELLS: f64 = 32.0;

/// Speckle of a laser's light on the image.
///
/// The intensity is multiplied by 1 + C (|U|^2 - 1). U is a complex normal field of mean square 1, new in each cell of a
/// lattice and filtered by a Gaussian, so that the factors of two places at the distance d have the covariance
/// C^2 exp(-d^2 / (2 grain^2)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Speckle {
    /// Contrast C: standard deviation over mean of the intensity at a point, 0 to 1. It is 1 for one polarisation of
    /// a laser of one frequency, and 1 / sqrt(M) where M independent patterns of equal strength add up.
    pub contrast: f64,
    /// Grain: standard deviation of the Gaussian that the covariance of the intensity is, metres on the image.
    pub grain: f64,
}

/// Choice of one pattern of speckle: another seed or number gives another, independent one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SpecklePattern {
    /// Seed of the sensor's noise.
    pub seed: u64,
    /// Number of the pattern. Its lowest 56 bits count.
    pub number: u64,
}

impl Speckle {
    /// Speckle of this contrast behind a camera's aperture. `wavelength` in metres.
    ///
    /// The grain is (sqrt 2 / pi) lambda N, with N = f_c / D. f_c is the distance of the image plane, so that N is the
    /// working f-number, that of the lens times 1 + magnification. CHOICE: a Gaussian whose area 2 pi grain^2 is the one
    /// of a round aperture, the integral of (2 J1(v) / v)^2, which is 4 (lambda N)^2 / pi.
    ///
    /// ```
    /// # use raypencil_scene::{Camera, Lens};
    /// use raypencil_sensor::Speckle;
    ///
    /// # let camera = Camera {
    /// #     width: 8, height: 8, pixel_pitch: [9e-6; 2], focal_length: 8e-3, principal_point: [4.0; 2],
    /// #     aperture: 2e-3, lens: Lens::CLEAR, max_range: 20.0,
    /// # };
    /// // 8 mm / 2 mm = f/4. At 810 nm lambda N is 3.24 um, and 0.4502 of it is 1.458 um.
    /// let speckle = Speckle::behind(&camera, 810e-9, 1.0);
    /// assert!((speckle.grain - 1.4585e-6).abs() < 1e-10);
    /// // 81 um^2 of a pixel hold some eight speckles: 1 / sqrt(8).
    /// assert!((speckle.contrast_in([9e-6; 2]) - 0.354).abs() < 1e-3);
    /// ```
    pub fn behind(camera: &Camera, wavelength: f64, contrast: f64) -> Self {
        Self { contrast, grain: SQRT_2 / PI * wavelength * camera.focal_length / camera.aperture }
    }

    /// Contrast of the light on an evenly lit rectangle of these sides, metres: C sqrt(q(a) q(b)) with
    /// q(p) = sqrt(2 pi) (g / p) erf(p / (g sqrt 2)) - 2 (g / p)^2 (1 - exp(-p^2 / (2 g^2))), g the grain.
    pub fn contrast_in(&self, sides: [f64; 2]) -> f64 {
        let [across, down] = sides.map(|side| {
            let share = self.grain / side;
            let end = 0.5 / (share * share);
            (2.0 * PI).sqrt() * share * libm::erf(end.sqrt()) + 2.0 * share * share * libm::expm1(-end)
        });
        self.contrast * (across * down).sqrt()
    }

    /// Multiplies an image by the pattern, and returns the light that this took away, watts (negative: added). `cell` is
    /// the size of a cell of the image, metres. Dark cells stay dark.
    pub(crate) fn apply(&self, image: &mut Image<f64>, cell: [f64; 2], pattern: SpecklePattern) -> f64 {
        let before: f64 = image.cells().iter().sum();
        let field = Field::new(self.grain, cell, pattern);
        let (width, height) = (image.width(), image.height());
        let tiles: Vec<[u32; 2]> = (0..height.div_ceil(TILE))
            .flat_map(|j| (0..width.div_ceil(TILE)).map(move |i| [i * TILE, j * TILE]))
            .collect();
        let lit = |[i, j]: [u32; 2]| lit_box(image, [i, j], [(i + TILE).min(width), (j + TILE).min(height)]);
        let boxes: Vec<LitBox> = tiles.into_iter().filter_map(lit).collect();
        let intensities: Vec<Vec<f64>> = boxes.par_iter().map(|lit| field.intensities(lit)).collect();
        for (LitBox { first, end }, intensities) in boxes.iter().zip(intensities) {
            let cells = (first[1]..end[1]).flat_map(|j| (first[0]..end[0]).map(move |i| (i, j)));
            for ((i, j), intensity) in cells.zip(intensities) {
                image.set(i, j, image.at(i, j) * (1.0 + self.contrast * (intensity - 1.0)));
            }
        }
        before - image.cells().iter().sum::<f64>()
    }

    /// Checks that the contrast is in its range.
    ///
    /// # Errors
    /// Names the first invalid field, as a part of `field`.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(|| format!("{field}.contrast"), self.contrast, 0.0, 1.0, "")?;
        check_range(|| format!("{field}.grain"), self.grain, 1e-9, 1e-1, "m")
    }

    /// Checks that the grain suits cells of these sizes, metres: a 64th of a cell to 32 cells.
    ///
    /// # Errors
    /// Names the grain, as a part of `field`.
    pub fn validate_on(&self, field: &str, cell: [f64; 2]) -> Result<(), SceneError> {
        let least = cell[0].max(cell[1]) / MAX_PARTS;
        let most = cell[0].min(cell[1]) * MAX_GRAIN_CELLS;
        if (least..=most).contains(&self.grain) {
            return Ok(());
        }
        let um = 1e6;
        let value = format!("{:.3} um, (sqrt 2 / pi) lambda f / D", um * self.grain);
        let expected = format!(
            "{:.3} to {:.3} um, a 64th of a cell to 32 cells: another aperture or `oversampling`",
            um * least,
            um * most
        );
        Err(SceneError::new(format!("{field}.grain"), value, expected))
    }
}

/// Rectangle of cells: those from `first` on, before `end`.
struct LitBox {
    first: [u32; 2],
    end: [u32; 2],
}

/// Smallest rectangle that holds all light of a part of the image; `None` if that is dark.
fn lit_box(image: &Image<f64>, first: [u32; 2], end: [u32; 2]) -> Option<LitBox> {
    let is_lit = |i: u32, j: u32| image.at(i, j) != 0.0;
    let row_is_lit = |j: &u32| (first[0]..end[0]).any(|i| is_lit(i, *j));
    let upper = (first[1]..end[1]).find(row_is_lit)?;
    let lower = (first[1]..end[1]).rev().find(row_is_lit)?;
    let column_is_lit = |i: &u32| (upper..=lower).any(|j| is_lit(*i, j));
    let left = (first[0]..end[0]).find(column_is_lit)?;
    let right = (first[0]..end[0]).rev().find(column_is_lit)?;
    Some(LitBox { first: [left, upper], end: [right + 1, lower + 1] })
}

/// The field U of a pattern, on a lattice that is at least as fine as the grain.
struct Field {
    pattern: SpecklePattern,
    /// Points of the lattice in a cell, across and down.
    parts: [usize; 2],
    /// Weights of the filter, across and down: an odd number, whose squares add up to 1.
    weights: [Vec<f64>; 2],
}

impl Field {
    fn new(grain: f64, cell: [f64; 2], pattern: SpecklePattern) -> Self {
        let parts = cell.map(|size| (size / grain).ceil().max(1.0));
        let weights = [0, 1].map(|axis| {
            let grain = grain * parts[axis] / cell[axis];
            let half = (CUTOFF_GRAINS * grain).ceil() as i32;
            let weights = (-half..=half).map(|k| libm::exp(-0.5 * f64::from(k * k) / (grain * grain)));
            let mut weights: Vec<f64> = weights.collect();
            let length = weights.iter().map(|weight| weight * weight).sum::<f64>().sqrt();
            weights.iter_mut().for_each(|weight| *weight /= length);
            weights
        });
        Self { pattern, parts: parts.map(|parts| parts as usize), weights }
    }

    /// Mean |U|^2 over each cell of a rectangle, row by row.
    fn intensities(&self, lit: &LitBox) -> Vec<f64> {
        let cells = [0, 1].map(|axis| (lit.end[axis] - lit.first[axis]) as usize);
        let [columns, rows] = [0, 1].map(|axis| cells[axis] * self.parts[axis]);
        let taps = [0, 1].map(|axis| self.weights[axis].len());
        let [left, upper] = [0, 1].map(|axis| {
            let first = lit.first[axis].wrapping_mul(self.parts[axis] as u32);
            first.wrapping_sub((taps[axis] / 2) as u32)
        });
        // Each row of the lattice, filtered across.
        let mut across = Vec::with_capacity(columns * (rows + taps[1] - 1));
        let mut fresh = Vec::new();
        for row in 0..rows + taps[1] - 1 {
            let place = |column: usize| [left.wrapping_add(column as u32), upper.wrapping_add(row as u32)];
            fresh.clear();
            fresh.extend((0..columns + taps[0] - 1).map(|column| self.amplitude(place(column))));
            across.extend(fresh.windows(taps[0]).map(|window| weighted(&self.weights[0], window.iter())));
        }
        let mut sums = vec![0.0; cells[0] * cells[1]];
        for row in 0..rows {
            for column in 0..columns {
                let below = across[row * columns + column..].iter().step_by(columns);
                let [re, im] = weighted(&self.weights[1], below);
                sums[row / self.parts[1] * cells[0] + column / self.parts[0]] += re * re + im * im;
            }
        }
        let points = (self.parts[0] * self.parts[1]) as f64;
        sums.iter_mut().for_each(|sum| *sum /= points);
        sums
    }

    /// Complex normal number of mean square 1 at a point of the lattice: (n + i n') / sqrt 2.
    fn amplitude(&self, place: [u32; 2]) -> [f64; 2] {
        let SpecklePattern { seed, number } = self.pattern;
        let mut stream = NoiseStream::at_place(seed, NoiseSource::Speckle, number, place);
        let radius = FRAC_1_SQRT_2 * (-2.0 * libm::log(stream.uniform())).sqrt();
        let (sin, cos) = libm::sincos(2.0 * PI * stream.uniform());
        [radius * cos, radius * sin]
    }
}

fn weighted<'a>(weights: &[f64], values: impl Iterator<Item = &'a [f64; 2]>) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for (weight, value) in weights.iter().zip(values) {
        sum[0] += weight * value[0];
        sum[1] += weight * value[1];
    }
    sum
}
