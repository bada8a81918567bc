//! Images by chance: a renderer that samples light at random against pencils drawn at random.
//!
//! Both have the same expectation in each pixel, the camera equation's (docs/theory/radiometry.md), and each brings the standard
//! error of its mean. Then z = (theirs - ours) / sqrt(their error^2 + our error^2) has mean 0 and variance 1, but for the
//! errors being estimates themselves: from n images its variance is (n - 1) / (n - 3), 1.095 for 24.

use crate::estimate::{Estimate, WayImage};
use raypencil_scene::Place;
use raypencil_scene::{Beam, FluxModel, Image, Mounted, Progress, Renderer, Request, Sampling, Scene};
use raypencil_tracer::Tracer;

/// How often pencils are drawn for an expectation.
pub(super) const DRAWS: u64 = 64;

/// As many pencils a beam is cut into at most, unless it has more.
const FINEST: u64 = 1 << 16;

/// A pixel counts if it is expected to get this part of the brightest one's flux.
const BRIGHT: f64 = 0.01;

/// What each beam's image is expected to be, from pencils drawn `draws` times, each by its own seed from 1 on. By the
/// radiometric model, whatever the scene's: the other is not what light does. Pencils are cut into finer ones, which are
/// the same light: their share is that of their area, and a profile that is divided by the sum over pencils comes nearer to
/// one that is divided by the integral.
pub fn expected_images(scene: &Scene, draws: u64, progress: &dyn Progress) -> Vec<Estimate> {
    let mesh = scene.mesh().clone();
    let beams = scene.beams().iter().map(|beam| Mounted { sensor: finer(beam.sensor), ..*beam }).collect();
    let scene = Scene::new(mesh, *scene.camera(), beams, scene.atmosphere(), FluxModel::Radiometric)
        .expect("a scene is one by either model");
    let camera = scene.camera().sensor;
    let mut running = vec![Running::new(camera.width as usize * camera.height as usize); scene.beams().len()];
    let tracer = Tracer::default();
    for seed in 1..=draws {
        if seed % 16 == 1 {
            progress.stage(&format!("drawing pencils at random: {} of {draws} times", seed - 1));
        }
        let sampling = Sampling::Jittered { seed };
        let output = tracer.render(&scene, &Request { camera: false, sampling, ..Request::EVERYTHING });
        for (running, image) in running.iter_mut().zip(&output.flux) {
            running.add(image.cells());
        }
    }
    running.into_iter().map(|running| running.finish(camera.width, camera.height)).collect()
}

/// A beam whose pencils are halved in both ways as often as [`FINEST`] allows.
fn finer(mut beam: Beam) -> Beam {
    while 4 * u64::from(beam.columns) * u64::from(beam.rows) <= FINEST {
        (beam.columns, beam.rows) = (2 * beam.columns, 2 * beam.rows);
    }
    beam
}

/// Mean and scatter as images come in. (B. P. Welford, "Note on a method for calculating corrected sums of squares and
/// products", Technometrics 4, 1962)
#[derive(Debug, Clone)]
struct Running {
    count: f64,
    /// Of each pixel, and last of their sum: the mean, and the sum of squares about it.
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

/// How far two estimates may be apart before it is no chance any more. Tuned: the z of 500 pixels goes beyond 5 once in
/// 3,000 times if they are normal, and about once in 50 with errors from 24 images.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChanceLimits {
    /// Of the totals, relative.
    pub total: f64,
    /// Of the totals, in combined standard errors.
    pub total_z: f64,
    /// Of the root mean square of z.
    pub rms: f64,
    /// Of the size of the mean of z.
    pub mean: f64,
    /// Of the size of any z.
    pub largest: f64,
}

/// The limits by which images are held to be of the same light.
pub const CHANCE_LIMITS: ChanceLimits =
    ChanceLimits { total: 1e-3, total_z: 3.0, rms: 1.25, mean: 0.25, largest: 5.0 };

/// An outsider's image and what was expected.
#[derive(Debug, Clone, PartialEq)]
pub struct ImageComparison {
    /// How it was made.
    pub way: String,
    /// Which beam's light.
    pub beam: usize,
    /// Bright pixels, those that count.
    pub pixels: usize,
    /// Their total and its standard error, W.
    pub theirs: [f64; 2],
    /// The total that was expected and its standard error, W.
    pub ours: [f64; 2],
    /// Root mean square of z over the bright pixels.
    pub z_rms: f64,
    /// Mean of z.
    pub z_mean: f64,
    /// The z of the largest size.
    pub z_largest: f64,
    /// Where that is; nowhere if no pixel counts.
    pub at: Option<Place>,
}

impl ImageComparison {
    /// By what part of the expected total theirs is larger.
    pub fn total_off(&self) -> f64 {
        self.theirs[0] / self.ours[0] - 1.0
    }

    /// The same in combined standard errors.
    pub fn total_z(&self) -> f64 {
        (self.theirs[0] - self.ours[0]) / libm::hypot(self.theirs[1], self.ours[1])
    }

    /// Whether chance explains the difference. Without a bright pixel nothing was compared, which is no pass.
    pub fn is_within(&self, limits: &ChanceLimits) -> bool {
        self.pixels > 0
            && self.total_off().abs() <= limits.total
            && self.total_z().abs() <= limits.total_z
            && self.z_rms <= limits.rms
            && self.z_mean.abs() <= limits.mean
            && self.z_largest.abs() <= limits.largest
    }
}

/// Compares an image by chance with the expected one of its beam.
pub fn compare_images(image: &WayImage, expected: &Estimate) -> ImageComparison {
    let theirs = &image.estimate;
    let brightest = expected.mean.cells().iter().copied().fold(0.0, f64::max);
    let mut found = ImageComparison {
        way: image.way.clone(),
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
            if expected.mean.at(i, j) <= BRIGHT * brightest {
                continue;
            }
            let off = theirs.mean.at(i, j) - expected.mean.at(i, j);
            let z = off / libm::hypot(theirs.error.at(i, j), expected.error.at(i, j));
            found.pixels += 1;
            found.z_rms += z * z;
            found.z_mean += z;
            // What is not a number counts as largest.
            if found.at.is_none() || z.abs() > found.z_largest.abs() || z.is_nan() {
                found.z_largest = z;
                found.at = Some(Place { sensor: raypencil_scene::SensorId::Camera, i, j });
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
        let found = compare_images(&WayImage { way: "w".into(), beam: 0, estimate: theirs }, &ours);
        assert_eq!(found.pixels, 3);
        assert!((found.z_rms - (5.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert!((found.z_mean + 1.0 / 3.0).abs() < 1e-15);
        assert_eq!((found.z_largest, found.at.map(|place| (place.i, place.j))), (-2.0, Some((1, 0))));
        // 164 against 152.5; errors sqrt(9 + 1 + 0.01) and sqrt(16 + 0.01).
        assert!((found.total_off() - (164.0 / 152.5 - 1.0)).abs() < 1e-15);
        assert!((found.total_z() - 11.5 / 26.02_f64.sqrt()).abs() < 1e-12);
        assert!(!found.is_within(&CHANCE_LIMITS), "7.5 % too much");
    }

    #[test]
    fn what_is_no_number_and_what_is_dark_does_not_pass() {
        let ours = estimate([1.0; 4], [1.0; 4]);
        let nan = estimate([1.0, f64::NAN, 1.0, 1.0], [1.0; 4]);
        let found = compare_images(&WayImage { way: "w".into(), beam: 0, estimate: nan }, &ours);
        assert!(!found.is_within(&CHANCE_LIMITS));
        let dark = estimate([0.0; 4], [0.0; 4]);
        let found = compare_images(&WayImage { way: "w".into(), beam: 0, estimate: dark.clone() }, &dark);
        assert!(!found.is_within(&CHANCE_LIMITS));
    }
}
