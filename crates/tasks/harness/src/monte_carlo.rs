//! A candidate's Monte Carlo images against pencils drawn at random, by a z-test of each pixel.
//!
//! Both have the same expectation in each pixel, the camera equation's (docs/theory/radiometry.md), and each brings the
//! standard error of its mean. Then z = (theirs - ours) / sqrt(their error^2 + our error^2) has mean 0 and variance 1,
//! except that the errors are estimates themselves: from n images the variance of z is (n - 1) / (n - 3), 1.095 for 24.

use raypencil_scene::{
    Beam, FluxModel, Image, Mounted, Place, Progress, Renderer, Request, Sampling, Scene, SensorId,
};
use raypencil_tracer::Tracer;

use crate::estimate::{Estimate, MonteCarloImage};

/// Number of realisations of an expected image: sets of pencils drawn at random.
pub(crate) const REALISATIONS: u64 = 64;

/// Beams are subdivided up to this many pencils; a beam that already has more is left as it is.
const MAX_PENCILS: u64 = 1 << 16;

/// Pixels count if their expected flux is above this share of the brightest pixel's.
const MIN_RELATIVE_FLUX: f64 = 0.01;

/// The expected image of each beam, from `realisations` sets of random pencils with the seeds 1, 2, ...
///
/// The flux model is radiometric whatever the scene's: a Monte Carlo renderer does not compute equation (1). Pencils
/// are subdivided, which changes no light: each part gets the share of its area, and a profile that is divided by its
/// sum over the pencils approaches one that is divided by its integral.
///
/// ```
/// # use std::sync::Arc;
/// # use glam::DVec3;
/// use raypencil_harness::{MonteCarloImage, Z_TEST_LIMITS, compare_images, expected_images};
/// # use raypencil_scene::{Atmosphere, FluxModel, Scene, Silent, rig};
///
/// # let mesh = raypencil_terrain::builtin("pyramids", 0.25).expect("a built-in name").into_mesh()?;
/// # let (camera, beams) = rig::default_rig(64, DVec3::ZERO, 0.0);
/// # let air = Atmosphere { attenuation: 0.0 };
/// # let scene = Scene::new(Arc::new(mesh), camera, beams, air, FluxModel::Radiometric)?;
/// let expected = expected_images(&scene, 4, &Silent);
/// // The expected image compared with itself: every z is 0.
/// let image = MonteCarloImage { integrator: "direct".into(), beam: 0, estimate: expected[0].clone() };
/// let comparison = compare_images(&image, &expected[0]);
/// assert_eq!((comparison.z_rms, comparison.total_off()), (0.0, 0.0));
/// assert!(comparison.is_within(&Z_TEST_LIMITS));
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
pub fn expected_images(scene: &Scene, realisations: u64, progress: &dyn Progress) -> Vec<Estimate> {
    let mesh = scene.mesh().clone();
    let beams =
        scene.beams().iter().map(|beam| Mounted { sensor: subdivided(beam.sensor), ..*beam }).collect();
    let scene = Scene::new(mesh, *scene.camera(), beams, scene.atmosphere(), FluxModel::Radiometric)
        .expect("a scene is valid with either flux model");
    let camera = scene.camera().sensor;
    let mut running = vec![Running::new(camera.width as usize * camera.height as usize); scene.beams().len()];
    let tracer = Tracer::default();
    for seed in 1..=realisations {
        if seed % 16 == 1 {
            progress.stage(&format!("drawing pencils at random: {} of {realisations} times", seed - 1));
        }
        let sampling = Sampling::Jittered { seed };
        let output = tracer.render(&scene, &Request { camera: false, sampling, ..Request::EVERYTHING });
        for (running, image) in running.iter_mut().zip(&output.flux) {
            running.add(image.cells());
        }
    }
    running.into_iter().map(|running| running.finish(camera.width, camera.height)).collect()
}

/// A beam whose pencils are halved along both axes as often as [`MAX_PENCILS`] allows.
fn subdivided(mut beam: Beam) -> Beam {
    while 4 * u64::from(beam.columns) * u64::from(beam.rows) <= MAX_PENCILS {
        (beam.columns, beam.rows) = (2 * beam.columns, 2 * beam.rows);
    }
    beam
}

/// Running mean and variance of images. (B. P. Welford, "Note on a method for calculating corrected sums of squares and
/// products", Technometrics 4, 1962)
#[derive(Debug, Clone)]
struct Running {
    count: f64,
    /// Mean and sum of squared deviations of each pixel; the last entry is for the sum over all pixels.
    moments: Vec<[f64; 2]>,
}

impl Running {
    fn new(pixels: usize) -> Self {
        Self { count: 0.0, moments: vec![[0.0; 2]; pixels + 1] }
    }

    fn add(&mut self, cells: &[f64]) {
        self.count += 1.0;
        let total: f64 = cells.iter().sum();
        for ([mean, squares], value) in self.moments.iter_mut().zip(cells.iter().copied().chain([total])) {
            let off = value - *mean;
            *mean += off / self.count;
            *squares += off * (value - *mean);
        }
    }

    fn finish(mut self, width: u32, height: u32) -> Estimate {
        let error = |squares: f64| (squares / (self.count - 1.0) / self.count).sqrt();
        let [total, squares] = self.moments.pop().expect("the sum is always there");
        let mean = self.moments.iter().map(|moments| moments[0]).collect();
        let errors = self.moments.iter().map(|moments| error(moments[1])).collect();
        Estimate {
            mean: Image::from_cells(width, height, mean),
            error: Image::from_cells(width, height, errors),
            total,
            total_error: error(squares),
        }
    }
}

/// Limits within which chance explains the difference between two estimates.
///
/// Tuned: among 500 pixels the largest |z| exceeds 5 once in 3,000 times if z is normal, and about once in 50 with
/// errors from 24 images.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ZTestLimits {
    /// Maximum relative difference of the totals.
    pub max_total_relative: f64,
    /// Maximum difference of the totals, in combined standard errors.
    pub max_total_z: f64,
    /// Maximum root mean square of z.
    pub max_z_rms: f64,
    /// Maximum |mean of z|.
    pub max_z_mean: f64,
    /// Maximum |z| of a pixel.
    pub max_z: f64,
}

/// The limits that decide whether two images show the same light.
pub const Z_TEST_LIMITS: ZTestLimits =
    ZTestLimits { max_total_relative: 1e-3, max_total_z: 3.0, max_z_rms: 1.25, max_z_mean: 0.25, max_z: 5.0 };

/// The comparison of a candidate's image with the expected one.
#[derive(Debug, Clone, PartialEq)]
pub struct ImageComparison {
    /// Name of the integrator that computed the image.
    pub integrator: String,
    /// Index of the beam.
    pub beam: usize,
    /// Number of bright pixels: those that count.
    pub pixels: usize,
    /// The candidate's total and its standard error, watts.
    pub theirs: [f64; 2],
    /// The expected total and its standard error, watts.
    pub ours: [f64; 2],
    /// Root mean square of z over the bright pixels.
    pub z_rms: f64,
    /// Mean of z.
    pub z_mean: f64,
    /// The z of the largest absolute value.
    pub z_largest: f64,
    /// The pixel with that z; `None` if no pixel counts.
    pub at: Option<Place>,
}

impl ImageComparison {
    /// Relative difference of the totals, (theirs - ours) / ours.
    pub fn total_off(&self) -> f64 {
        self.theirs[0] / self.ours[0] - 1.0
    }

    /// Difference of the totals in combined standard errors.
    pub fn total_z(&self) -> f64 {
        (self.theirs[0] - self.ours[0]) / libm::hypot(self.theirs[1], self.ours[1])
    }

    /// Whether chance explains the difference. An image without a bright pixel does not pass: nothing was compared.
    pub fn is_within(&self, limits: &ZTestLimits) -> bool {
        self.pixels > 0
            && self.total_off().abs() <= limits.max_total_relative
            && self.total_z().abs() <= limits.max_total_z
            && self.z_rms <= limits.max_z_rms
            && self.z_mean.abs() <= limits.max_z_mean
            && self.z_largest.abs() <= limits.max_z
    }
}

/// Compares a Monte Carlo image with the expected image of its beam.
pub fn compare_images(image: &MonteCarloImage, expected: &Estimate) -> ImageComparison {
    let theirs = &image.estimate;
    let brightest = expected.mean.cells().iter().copied().fold(0.0, f64::max);
    let mut found = ImageComparison {
        integrator: image.integrator.clone(),
        beam: image.beam,
        pixels: 0,
        theirs: [theirs.total, theirs.total_error],
        ours: [expected.total, expected.total_error],
        z_rms: 0.0,
        z_mean: 0.0,
        z_largest: 0.0,
        at: None,
    };
    for j in 0..expected.mean.height() {
        for i in 0..expected.mean.width() {
            if expected.mean.at(i, j) <= MIN_RELATIVE_FLUX * brightest {
                continue;
            }
            let off = theirs.mean.at(i, j) - expected.mean.at(i, j);
            let z = off / libm::hypot(theirs.error.at(i, j), expected.error.at(i, j));
            found.pixels += 1;
            found.z_rms += z * z;
            found.z_mean += z;
            // NaN counts as the largest.
            if found.at.is_none() || z.abs() > found.z_largest.abs() || z.is_nan() {
                found.z_largest = z;
                found.at = Some(Place { sensor: SensorId::Camera, i, j });
            }
        }
    }
    if found.pixels > 0 {
        found.z_rms = (found.z_rms / found.pixels as f64).sqrt();
        found.z_mean /= found.pixels as f64;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn estimate(mean: [f64; 4], error: [f64; 4]) -> Estimate {
        let image = |cells: [f64; 4]| Image::from_cells(2, 2, cells.to_vec());
        Estimate::of_independent_pixels(image(mean), image(error))
    }

    #[test]
    fn moments_are_those_of_three_images_by_hand() {
        // Pixel: 1, 2, 6: mean 3, squares 4 + 1 + 9 = 14, error sqrt(14 / 2 / 3); the other 0: totals are the same.
        let mut running = Running::new(2);
        for value in [1.0, 2.0, 6.0] {
            running.add(&[value, 0.0]);
        }
        let found = running.finish(2, 1);
        assert_eq!(found.mean.cells(), [3.0, 0.0]);
        let error = (14.0_f64 / 6.0).sqrt();
        assert!((found.error.at(0, 0) - error).abs() < 1e-15 && found.error.at(1, 0) == 0.0);
        assert_eq!((found.total, found.total_error), (3.0, found.error.at(0, 0)));
    }

    #[test]
    fn z_is_that_of_bright_pixels_by_hand() {
        // Pixels of 100, 50, 2 and 0.5: the last is below 1 % of the brightest. z = 5 / hypot(3, 4) = 1, -2 / 1, 0.
        let ours = estimate([100.0, 50.0, 2.0, 0.5], [4.0, 0.0, 0.1, 0.0]);
        let theirs = estimate([105.0, 48.0, 2.0, 9.0], [3.0, 1.0, 0.1, 0.0]);
        let found =
            compare_images(&MonteCarloImage { integrator: "w".into(), beam: 0, estimate: theirs }, &ours);
        assert_eq!(found.pixels, 3);
        assert!((found.z_rms - (5.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert!((found.z_mean + 1.0 / 3.0).abs() < 1e-15);
        assert_eq!((found.z_largest, found.at.map(|place| (place.i, place.j))), (-2.0, Some((1, 0))));
        // 164 against 152.5; errors sqrt(9 + 1 + 0.01) and sqrt(16 + 0.01).
        assert!((found.total_off() - (164.0 / 152.5 - 1.0)).abs() < 1e-15);
        assert!((found.total_z() - 11.5 / 26.02_f64.sqrt()).abs() < 1e-12);
        assert!(!found.is_within(&Z_TEST_LIMITS), "7.5 % too much");
    }

    #[test]
    fn nan_and_dark_images_do_not_pass() {
        let ours = estimate([1.0; 4], [1.0; 4]);
        let nan = estimate([1.0, f64::NAN, 1.0, 1.0], [1.0; 4]);
        let found =
            compare_images(&MonteCarloImage { integrator: "w".into(), beam: 0, estimate: nan }, &ours);
        assert!(!found.is_within(&Z_TEST_LIMITS));
        let dark = estimate([0.0; 4], [0.0; 4]);
        let found = compare_images(
            &MonteCarloImage { integrator: "w".into(), beam: 0, estimate: dark.clone() },
            &dark,
        );
        assert!(!found.is_within(&Z_TEST_LIMITS));
    }
}
