//! Point spread functions, and the kernels that they are on a raster. (Paper, §5; Goodman, Introduction to Fourier
//! Optics, its reference 3)

use std::f64::consts::SQRT_2;

use raypencil_scene::SceneError;

use crate::airy::airy_pattern;
use crate::check::check_range;

/// A length on the image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Extent {
    /// In pixels of the camera, across and down alike.
    Pixels(f64),
    /// In metres on the image plane.
    Metres(f64),
}

impl Extent {
    /// In cells across and down, `cell` metres each, `oversampling` to a pixel.
    pub(crate) fn in_cells(self, cell: [f64; 2], oversampling: u32) -> [f64; 2] {
        match self {
            Self::Pixels(pixels) => [pixels * f64::from(oversampling); 2],
            Self::Metres(metres) => cell.map(|size| metres / size),
        }
    }

    pub(crate) fn validate(self, field: &str) -> Result<(), SceneError> {
        match self {
            Self::Pixels(pixels) => check_range(field, "pixels", pixels, 0.0, 1e3, "pixels"),
            Self::Metres(metres) => check_range(field, "metres", metres, 0.0, 1e-2, "m"),
        }
    }
}

/// What an optical system makes of a point, the same everywhere on the image.
#[derive(Debug, Clone, PartialEq)]
pub enum Psf {
    /// A Gaussian: what many small aberrations, or the spread of charge, add up to.
    Gaussian {
        /// Standard deviation along each axis.
        sigma: Extent,
    },
    /// The diffraction of a round aperture.
    Airy {
        /// Of the light, metres.
        wavelength: f64,
        /// Focal length over aperture.
        f_number: f64,
        /// How many dark rings the kernel holds. Cost grows as its square; what lies beyond (2 / (pi^2 rings), 2.5 %
        /// with 8) is put back within by normalising.
        rings: u32,
    },
    /// Numbers, on the cells of the fine image.
    Numbers(Kernel),
}

impl Psf {
    /// The kernel on cells of `cell` metres, `oversampling` to a pixel.
    pub fn kernel(&self, cell: [f64; 2], oversampling: u32) -> Kernel {
        match self {
            Self::Gaussian { sigma } => Kernel::gaussian(sigma.in_cells(cell, oversampling)),
            Self::Airy { wavelength, f_number, rings } => Kernel::airy(*wavelength, *f_number, *rings, cell),
            Self::Numbers(kernel) => kernel.clone(),
        }
    }

    /// Refuses numbers that no kernel could be made of, naming the field.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        match self {
            Self::Gaussian { sigma } => sigma.validate(&format!("{field}.sigma")),
            Self::Airy { wavelength, f_number, rings } => {
                check_range(field, "wavelength", *wavelength, 1e-8, 1e-3, "m")?;
                check_range(field, "f_number", *f_number, 0.1, 1e4, "")?;
                check_range(field, "rings", f64::from(*rings), 1.0, 100.0, "rings")
            }
            // Valid by construction.
            Self::Numbers(_) => Ok(()),
        }
    }
}

/// A kernel: how the light of one cell spreads over those around it. Its weights are not negative and add up to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Kernel {
    pub(crate) form: KernelForm,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum KernelForm {
    /// The product of a row and a column, each of an odd number of weights.
    Separable { across: Vec<f64>, down: Vec<f64> },
    /// Row by row, an odd number of columns and rows.
    Dense { columns: usize, weights: Vec<f64> },
}

/// A Gaussian ends there, in standard deviations: 2e-9 of it lies beyond on each axis.
const GAUSSIAN_CUTOFF_SIGMAS: f64 = 6.0;
/// No kernel reaches further, in cells: a product, and a table (whose cost is the square).
const MAX_SEPARABLE_HALF_WIDTH_CELLS: f64 = 16_384.0;
const MAX_DENSE_HALF_WIDTH_CELLS: f64 = 512.0;

impl Kernel {
    /// Light stays where it is.
    pub fn identity() -> Self {
        Self { form: KernelForm::Separable { across: vec![1.0], down: vec![1.0] } }
    }

    /// A Gaussian of standard deviations `sigma` in cells, across and down, *integrated over each cell*: so it is
    /// right however narrow it is, and its second moment is sigma^2 + 1/12 (Sheppard), light being known to cells
    /// only. A sigma of 0 is no blur at all.
    pub fn gaussian(sigma: [f64; 2]) -> Self {
        let [across, down] = sigma.map(|sigma| {
            if !(sigma > 0.0) {
                return vec![1.0];
            }
            let half = (GAUSSIAN_CUTOFF_SIGMAS * sigma).ceil().min(MAX_SEPARABLE_HALF_WIDTH_CELLS) as i32;
            let scale = 1.0 / (sigma * SQRT_2);
            // Differences of erfc on the right, mirrored: in the tail those of erf would cancel.
            let tail = |x: f64| libm::erfc(x * scale);
            let weight = |k: i32| match k.abs() {
                0 => 2.0 * libm::erf(0.5 * scale),
                k => tail(f64::from(k) - 0.5) - tail(f64::from(k) + 0.5),
            };
            normalised((-half..=half).map(weight).collect())
        });
        Self { form: KernelForm::Separable { across, down } }
    }

    /// The diffraction pattern of a round aperture, with its first `rings` dark rings, on cells of `cell` metres:
    /// integrated over each cell by points no further apart than an eighth of lambda N.
    pub fn airy(wavelength: f64, f_number: f64, rings: u32, cell: [f64; 2]) -> Self {
        let unit = wavelength * f_number;
        // Zeros of J1 are near pi (n + 1/4).
        let end = (f64::from(rings) + 0.25) * unit;
        let half = cell.map(|size| (end / size).ceil().min(MAX_DENSE_HALF_WIDTH_CELLS) as i32);
        let points = cell.map(|size| (8.0 * size / unit).ceil().clamp(4.0, 64.0) as u32);
        let place = |axis: usize, k: i32, point: u32| {
            (f64::from(k) - 0.5 + (f64::from(point) + 0.5) / f64::from(points[axis])) * cell[axis]
        };
        let mut weights = Vec::new();
        for j in -half[1]..=half[1] {
            for i in -half[0]..=half[0] {
                // By symmetry from the lower right quarter, so that the kernel is symmetric to the bit.
                let (i, j) = (i.abs(), j.abs());
                let mut sum = 0.0;
                for n in 0..points[1] {
                    let y = place(1, j, n);
                    for m in 0..points[0] {
                        let x = place(0, i, m);
                        let radius = (x * x + y * y).sqrt();
                        // The kernel is round.
                        if radius <= end {
                            sum += airy_pattern(radius, wavelength, f_number);
                        }
                    }
                }
                weights.push(sum);
            }
        }
        Self { form: KernelForm::Dense { columns: 2 * half[0] as usize + 1, weights: normalised(weights) } }
    }

    /// A kernel of given weights, row by row, normalised. The middle one is for light that stays; what is right of it
    /// says how much moves right, what is below it how much moves down.
    ///
    /// # Errors
    /// If the sides are not odd, the number of weights is not their product, or weights are negative, not finite or
    /// all 0.
    pub fn from_numbers(columns: usize, rows: usize, weights: &[f64]) -> Result<Self, SceneError> {
        let longest = 2 * MAX_DENSE_HALF_WIDTH_CELLS as usize + 1;
        for (side, count) in [("columns", columns), ("rows", rows)] {
            if count % 2 == 0 || count > longest {
                let expected = format!("an odd number up to {longest}");
                return Err(SceneError::new(format!("kernel.{side}"), count, expected));
            }
        }
        if weights.len() != columns * rows {
            return Err(SceneError::new(
                "kernel.weights",
                weights.len(),
                format!("{} of them", columns * rows),
            ));
        }
        // Up to 1e100, so that the sum stays finite.
        for (index, weight) in weights.iter().enumerate() {
            if !(0.0..=1e100).contains(weight) {
                return Err(SceneError::new(format!("kernel.weights[{index}]"), weight, "0 to 1e100"));
            }
        }
        if !(weights.iter().sum::<f64>() > 1e-100) {
            return Err(SceneError::new("kernel.weights", "all 0", "a sum above 1e-100"));
        }
        Ok(Self { form: KernelForm::Dense { columns, weights: normalised(weights.to_vec()) } })
    }

    /// How far it reaches from its middle, in cells across and down.
    pub fn half_widths(&self) -> [usize; 2] {
        match &self.form {
            KernelForm::Separable { across, down } => [across.len() / 2, down.len() / 2],
            KernelForm::Dense { columns, weights } => [columns / 2, weights.len() / columns / 2],
        }
    }

    /// The share of light that moves `right` and `down` by so many cells.
    pub fn weight(&self, right: i32, down: i32) -> f64 {
        let half = self.half_widths().map(|half| half as i32);
        if right.abs() > half[0] || down.abs() > half[1] {
            return 0.0;
        }
        let (i, j) = ((right + half[0]) as usize, (down + half[1]) as usize);
        match &self.form {
            KernelForm::Separable { across, down } => across[i] * down[j],
            KernelForm::Dense { columns, weights } => weights[j * columns + i],
        }
    }
}

/// Weights divided by their sum, and once more, so that the sum is 1 to a rounding or two.
fn normalised(mut weights: Vec<f64>) -> Vec<f64> {
    for _ in 0..2 {
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= sum);
    }
    weights
}
