use raypencil_scene::Image;

/// An image that is known by chance, W per pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// The mean of independent images.
    pub mean: Image<f64>,
    /// Its standard error.
    pub error: Image<f64>,
    /// The mean of what the images add up to, W.
    pub total: f64,
    /// Its standard error.
    pub total_error: f64,
}

impl Estimate {
    /// Of an image whose pixels are independent of one another.
    pub fn of_independent_pixels(mean: Image<f64>, error: Image<f64>) -> Self {
        let total = mean.cells().iter().sum();
        let variance: f64 = error.cells().iter().map(|error| error * error).sum();
        Self { mean, error, total, total_error: variance.sqrt() }
    }
}

/// An image by chance: mean and standard error of independent ones.
#[derive(Debug, Clone)]
pub struct WayImage {
    /// How it was made: `direct` of `direct.mean.beam0`.
    pub way: String,
    /// Which beam's light.
    pub beam: usize,
    /// The image, W per pixel.
    pub estimate: Estimate,
}
