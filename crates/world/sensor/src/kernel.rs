//! Kernels: point spread functions on a raster. (Paper, §5; Goodman, Introduction to Fourier Optics, its reference 3)

use std::f64::consts::SQRT_2;

use raypencil_scene::SceneError;

use crate::airy::airy_pattern;

/// Kernel: how the light of one cell spreads over the cells around it. No weight is negative, and their sum is 1.
///
/// ```
/// use raypencil_sensor::Kernel;
///
/// // Weights are normalised: 1 + 2 + 5 = 8.
/// let kernel = Kernel::from_weights(3, 1, &[1.0, 2.0, 5.0])?;
/// assert_eq!([-1, 0, 1].map(|right| kernel.weight(right, 0)), [0.125, 0.25, 0.625]);
/// // A Gaussian ends at 6 sigma.
/// assert_eq!(Kernel::gaussian([2.0, 1.0]).half_widths(), [12, 6]);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Kernel {
    pub(crate) form_image: KernelForm,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum KernelForm {
    /// Product of a row and a column, each of an odd number of weights.
    Separable { across: Vec<f64>, down: Vec<f64> },
    /// Weights row by row; the numbers of columns and rows are odd.
    Dense { columns: usize, weights: Vec<f64> },
}

/// End of a Gaussian kernel, standard deviations: 2e-9 of the light lies beyond on each axis.
const GAUSSIAN_CUTOFF_SIGMAS: f64 = 6.0;
const MAX_SEPARABLE_HALF_WIDTH_CELLS: f64 = 16_384.0;
/// Maximum half width of a dense kernel, cells; its cost grows with the square.
const MAX_DENSE_HALF_WIDTH_CELLS: f64 = 512.0;

impl Kernel {
    /// Identity: light stays where it is.
    pub fn identity() -> Self {
        Self { form_image: KernelForm::Separable { across: vec![1.0], down: vec![1.0] } }
    }

    /// Gaussian of standard deviations `sigma` in cells, across and down, *integrated over each cell*: it is
    /// correct however narrow it is. Its second moment is sigma^2 + 1/12 (Sheppard), since light is known to
    /// cells only. A sigma of 0 is no blur.
    pub fn gaussian(sigma: [f64; 2]) -> Self {
        let [across, down] = sigma.map(|sigma| {
            if !(sigma > 0.0) {
                return vec![1.0];
            }
            let half = (GAUSSIAN_CUTOFF_SIGMAS * sigma).ceil().min(MAX_SEPARABLE_HALF_WIDTH_CELLS) as i32;
            let scale = 1.0 / (sigma * SQRT_2);
            // Differences of erfc on the right, mirrored: in the tail, differences of erf would cancel.
            let tail = |x: f64| libm::erfc(x * scale);
            let weight = |k: i32| match k.abs() {
                0 => 2.0 * libm::erf(0.5 * scale),
                k => tail(f64::from(k) - 0.5) - tail(f64::from(k) + 0.5),
            };
            normalised((-half..=half).map(weight).collect())
        });
        Self { form_image: KernelForm::Separable { across, down } }
    }

    /// Diffraction pattern of a round aperture with its first `rings` dark rings, on cells of `cell` metres. It
    /// is integrated over each cell by points no further apart than an eighth of lambda N.
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
                // By symmetry from the lower right quarter, so the kernel is symmetric to the bit.
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
        Self {
            form_image: KernelForm::Dense { columns: 2 * half[0] as usize + 1, weights: normalised(weights) },
        }
    }

    /// Kernel of given weights, row by row, normalised. The middle weight is for light that stays. Weights to its
    /// right move light to the right, weights below it move light down.
    ///
    /// # Errors
    /// If the sides are not odd or too long, the number of weights is not their product, or weights are negative,
    /// not finite or all 0.
    pub fn from_weights(columns: usize, rows: usize, weights: &[f64]) -> Result<Self, SceneError> {
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
                format!("{columns} x {rows} = {} weights", columns * rows),
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
        Ok(Self { form_image: KernelForm::Dense { columns, weights: normalised(weights.to_vec()) } })
    }

    /// Half widths: cells from the middle to the ends, across and down.
    pub fn half_widths(&self) -> [usize; 2] {
        match &self.form_image {
            KernelForm::Separable { across, down } => [across.len() / 2, down.len() / 2],
            KernelForm::Dense { columns, weights } => [columns / 2, weights.len() / columns / 2],
        }
    }

    /// Fraction of the light that moves `right` and `down` by so many cells.
    pub fn weight(&self, right: i32, down: i32) -> f64 {
        let half = self.half_widths().map(|half| half as i32);
        if right.abs() > half[0] || down.abs() > half[1] {
            return 0.0;
        }
        let (i, j) = ((right + half[0]) as usize, (down + half[1]) as usize);
        match &self.form_image {
            KernelForm::Separable { across, down } => across[i] * down[j],
            KernelForm::Dense { columns, weights } => weights[j * columns + i],
        }
    }
}

/// Weights divided by their sum, twice, so that the sum is 1 to a rounding or two.
fn normalised(mut weights: Vec<f64>) -> Vec<f64> {
    for _ in 0..2 {
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= sum);
    }
    weights
}
