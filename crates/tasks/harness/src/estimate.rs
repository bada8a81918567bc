//! Monte Carlo images: the mean of independent images and its standard error.

use raypencil_scene::Image;

/// A Monte Carlo estimate of an image, watts per pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Mean of independent images.
    pub mean: Image<f64>,
    /// Standard error of the mean.
    pub error: Image<f64>,
    /// Mean of the images' sums over all pixels, watts.
    pub total: f64,
    /// Standard error of the total, watts.
    pub total_error: f64,
}

impl Estimate {
    /// An estimate whose pixels are statistically independent, so that their variances add up to that of the total.
    pub fn of_independent_pixels(mean: Image<f64>, error: Image<f64>) -> Self {
        let total = mean.cells().iter().sum();
        let variance: f64 = error.cells().iter().map(|error| error * error).sum();
        Self { mean, error, total, total_error: variance.sqrt() }
    }
}

/// A Monte Carlo image by a candidate: one beam's light on the camera's image.
#[derive(Debug, Clone)]
pub struct MonteCarloImage {
    /// Name of the integrator that computed it: `direct` in the channel `direct.mean.beam0`.
    pub integrator: String,
    /// Index of the beam.
    pub beam: usize,
    /// The image, watts per pixel.
    pub estimate: Estimate,
}
