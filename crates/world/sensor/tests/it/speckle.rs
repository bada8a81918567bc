//! Speckle against its laws: that of its intensity, its covariance, its contrast on a pixel, and what it does to the middle of
//! a spot.
//!
//! Seeds are fixed, so every test always has the same outcome. The level tells how rarely a field that obeys the law would fail:
//! |z| >= 3.72 is 1 in 5,000.

use raypencil_scene::{Camera, Image, Lens};
use raypencil_sensor::{Optics, Speckle, SpecklePattern};

const LEVEL: f64 = 3.72;
const WAVELENGTH: f64 = 810e-9;

/// Camera with pixels of 9 um whose aperture gives this grain, pixels.
fn camera(side: u32, grain_px: f64) -> Camera {
    let aperture = std::f64::consts::SQRT_2 / std::f64::consts::PI * WAVELENGTH * 8e-3 / (grain_px * 9e-6);
    Camera {
        width: side,
        height: side,
        pixel_pitch: [9e-6, 9e-6],
        focal_length: 8e-3,
        principal_point: [f64::from(side) / 2.0; 2],
        aperture,
        lens: Lens::CLEAR,
        max_range: 20.0,
    }
}

/// Image of this light, which the camera sees by a pattern of speckle.
fn speckled(camera: &Camera, contrast: f64, light: &Image<f64>, number: u64) -> Image<f64> {
    let speckle = Some(Speckle::behind(camera, WAVELENGTH, contrast));
    let optics = Optics { speckle, ..Optics::PERFECT };
    optics.filter(camera, light.clone(), SpecklePattern { seed: 7, number }).optical
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

#[test]
fn intensities_are_exponential_about_the_light_and_their_covariance_is_a_gaussian() {
    const SIDE: u32 = 1024;
    let camera = camera(SIDE, 1.5);
    let found = speckled(&camera, 1.0, &Image::filled(SIDE, SIDE, 1.0), 3);
    let cells = f64::from(SIDE) * f64::from(SIDE);
    // The covariances of a cell with all others add up to 2 pi grain^2, its own variance being 1.
    let correlated = 2.0 * std::f64::consts::PI * 1.5 * 1.5;
    let error = (correlated / cells).sqrt();
    let all = mean(found.cells().iter().copied());
    assert!((all - 1.0).abs() < LEVEL * error, "mean {all}");
    // P(I > t) = exp(-t). The indicators of two cells are correlated by no more than their intensities are (all
    // coefficients of the law's expansion in |mu|^2 are at least 0, and add up to 1).
    for t in [0.25, 1.0, 2.0, 4.0] {
        let share = mean(found.cells().iter().map(|&cell| f64::from(u8::from(cell > t))));
        let expected = libm::exp(-t);
        let bound = LEVEL * (expected * (1.0 - expected)).sqrt() * error;
        assert!((share - expected).abs() < bound, "{share} above {t}, not {expected} within {bound}");
    }
    // The variance of a product (I - 1) (I' - 1) is at most 9, the fourth moment of an exponential number about its mean; its
    // covariance with others is of at most twice the area.
    let bound = LEVEL * 3.0 * (2.0 * correlated / cells).sqrt();
    for [right, down] in [[0, 0], [1, 0], [0, 1], [2, 1], [0, 3], [5, 5]] {
        let pairs = (0..SIDE - down).flat_map(|j| (0..SIDE - right).map(move |i| (i, j)));
        let products = pairs.map(|(i, j)| (found.at(i, j) - 1.0) * (found.at(i + right, j + down) - 1.0));
        let expected = libm::exp(-0.5 * f64::from(right * right + down * down) / (1.5 * 1.5));
        let covariance = mean(products);
        assert!((covariance - expected).abs() < bound, "{covariance} at {right}, {down}, not {expected}");
    }
}

#[test]
fn the_numbers_are_those_of_the_definition() {
    // By another program, from the definition: philox, Box and Muller, and the filter. A grain of 1.5 cells: 13 taps.
    let pattern = SpecklePattern { seed: 0x0123_4567_89ab_cdef, number: 0x00ab_cdef_0123_4567 };
    let found = |grain_px: f64| {
        let camera = camera(32, grain_px);
        let speckle = Some(Speckle::behind(&camera, WAVELENGTH, 1.0));
        let optics = Optics { speckle, ..Optics::PERFECT };
        optics.filter(&camera, Image::filled(32, 32, 1.0), pattern).optical
    };
    let coarse = found(1.5);
    for ([i, j], expected) in DEFINED {
        assert!((coarse.at(i, j) / expected - 1.0).abs() < 1e-12, "{} at {i}, {j}", coarse.at(i, j));
    }
    // A grain of 0.6 cells: the mean of 2 x 2 points of a lattice, on which the grain is 1.2.
    assert!((found(0.6).at(17, 5) / 0.156_389_982_950_930_98 - 1.0).abs() < 1e-12);
}

/// Column and row, and the intensity there.
const DEFINED: [([u32; 2], f64); 3] = [
    ([0, 0], 0.341_736_358_589_957_8),
    ([17, 5], 0.425_508_840_577_881_7),
    ([31, 31], 0.861_056_360_989_965_1),
];

#[test]
fn a_pixel_averages_over_its_speckles() {
    // The default camera: f/4 at 810 nm, a grain of 0.16205 pixels. The lattice has 7 points along a pixel.
    const SIDE: u32 = 256;
    let grain = 0.162_056_937;
    let camera = camera(SIDE, grain);
    let speckle = Speckle::behind(&camera, WAVELENGTH, 1.0);
    // The mean over pairs of lattice points is the variance along an axis, and the closed form is that mean for ever finer
    // lattices. The integrand is the triangle 1 - |u| times a Gaussian: its kink costs the sum 1 / (6 n^2), all else is of the
    // fourth order.
    let lattice = |points: i32| {
        let pairs = (0..points).flat_map(|a| (0..points).map(move |b| f64::from(a - b) / f64::from(points)));
        mean(pairs.map(|apart| libm::exp(-0.5 * apart * apart / (grain * grain))))
    };
    let closed = speckle.contrast_in([9e-6, 9e-6]);
    for points in [7, 20, 60] {
        let kink = 1.0 / (6.0 * f64::from(points * points));
        assert!((lattice(points) - closed - kink).abs() < 0.1 * kink, "{} {closed}", lattice(points));
    }
    assert!((closed - 0.3536).abs() < 1e-4, "{closed}");
    let half = Speckle { contrast: 0.5, ..speckle };
    assert_eq!(half.contrast_in([9e-6, 9e-6]), 0.5 * closed);
    // A large area has the speckles of its size, and a point has one.
    let area = 2.0 * std::f64::consts::PI * speckle.grain * speckle.grain;
    let large = speckle.contrast_in([1e-3, 2e-3]);
    assert!((large / (area / 2e-6).sqrt() - 1.0).abs() < 2e-3, "{large}");
    assert!((speckle.contrast_in([1e-9, 1e-9]) - 1.0).abs() < 1e-6);

    let found = speckled(&camera, 1.0, &Image::filled(SIDE, SIDE, 1.0), 1);
    let variance = mean(found.cells().iter().map(|cell| (cell - 1.0) * (cell - 1.0)));
    let expected = lattice(7) * lattice(7);
    // A sum of M exponential numbers has the fourth moment 3 / M^2 + 6 / M^3, M = 1 / expected. Squares of neighbouring
    // pixels are correlated by less than a tenth in all, which the factor 1.1 covers.
    let error = expected * ((2.0 + 6.0 * expected) / f64::from(SIDE * SIDE) * 1.1).sqrt();
    assert!((variance - expected).abs() < LEVEL * error, "{variance} {expected} {error}");
}

/// Moment of the light's place about the middle, over all light that is expected: pixels across and down.
fn moments(image: &Image<f64>, expected: f64) -> [f64; 2] {
    let middle = f64::from(image.width()) / 2.0;
    let mut sums = [0.0; 2];
    for j in 0..image.height() {
        for i in 0..image.width() {
            sums[0] += image.at(i, j) * (f64::from(i) + 0.5 - middle);
            sums[1] += image.at(i, j) * (f64::from(j) + 0.5 - middle);
        }
    }
    sums.map(|sum| sum / expected)
}

#[test]
fn the_middle_of_a_spot_errs_as_coherent_triangulation_must() {
    // A round Gaussian spot of standard deviation s, and speckle of grain g: the variance of its middle is
    // (C g)^2 s^4 / (g^2 + 2 s^2)^2. For a spot of many speckles that is (C g / 2)^2, whatever its size:
    // C lambda N / (pi sqrt 2) = C lambda / (2 pi sin u') / sqrt 2, of Dorsch, Haeusler and Herrmann.
    const PATTERNS: u64 = 500;
    const SIDE: u32 = 88;
    let spot = |s: f64| {
        let away = |k: u32| (f64::from(k) + 0.5 - 44.0) / s;
        let at = |k: u32| libm::exp(-0.5 * away(k) * away(k));
        let cells = (0..SIDE).flat_map(|j| (0..SIDE).map(move |i| at(i) * at(j))).collect();
        Image::from_cells(SIDE, SIDE, cells)
    };
    for (grain, s) in [(1.1, 4.0), (1.1, 7.0), (2.2, 7.0)] {
        let (camera, light) = (camera(SIDE, grain), spot(s));
        let total: f64 = light.cells().iter().sum();
        let both = |contrast, number| moments(&speckled(&camera, contrast, &light, number), total);
        let squares = (0..PATTERNS).flat_map(|number| both(1.0, number)).map(|moment| moment * moment);
        let found = mean(squares).sqrt();
        let expected = grain * s * s / (grain * grain + 2.0 * s * s);
        // Nearly normal numbers: their excess kurtosis is at most 6 over the number of speckles, 1 + 2 s^2 / g^2 > 20. The
        // spot ends at 6 s, which takes less than 1e-6 of its fourth moment.
        let error = 0.5 * (2.3 / (2.0 * PATTERNS as f64)).sqrt();
        assert!((found / expected - 1.0).abs() < LEVEL * error, "{found} {expected} for {grain} and {s}");
        // The moment is linear in the light, and so in the contrast.
        let (whole, tenth) = (both(1.0, 5), both(0.1, 5));
        assert!((tenth[0] / whole[0] - 0.1).abs() < 1e-9 && (tenth[1] / whole[1] - 0.1).abs() < 1e-9);
        // In the units of the limit: pixels of 9 um, sin u' = D / (2 f_c).
        let limit = WAVELENGTH / (2.0 * std::f64::consts::PI * (camera.aperture / (2.0 * 8e-3))) / 9e-6;
        let share = expected / limit;
        let short = 1.0 + 0.5 * (grain / s) * (grain / s);
        assert!((share * short * std::f64::consts::SQRT_2 - 1.0).abs() < 1e-12, "{share}");
    }
}

#[test]
fn a_pattern_is_its_seed_and_its_number() {
    let camera = camera(48, 0.5);
    let speckle = Some(Speckle::behind(&camera, WAVELENGTH, 0.9));
    let optics = Optics { speckle, ..Optics::PERFECT };
    let light = Image::filled(48, 48, 1.0);
    let of = |seed, number| optics.filter(&camera, light.clone(), SpecklePattern { seed, number }).optical;
    assert_eq!(of(1, 2), of(1, 2));
    let all = [of(1, 2), of(2, 2), of(1 << 32, 2), of(1, 3), of(1, 2 << 32), of(1, 1 << 55)];
    for (index, a) in all.iter().enumerate() {
        assert!(all[index + 1..].iter().all(|b| a != b), "{index}");
    }
    // Of the number the lowest 56 bits count.
    assert_eq!(of(1, 2 | 1 << 56), all[0]);
    // Where the light lies changes no factor; a part of the light has the factors that all of it has.
    let mut part = Image::filled(48, 48, 0.0);
    (5..30).for_each(|i| (7..9).for_each(|j| part.set(i, j, 2.0)));
    let lit = optics.filter(&camera, part.clone(), SpecklePattern { seed: 1, number: 2 }).optical;
    for (index, (factor, light)) in all[0].cells().iter().zip(part.cells()).enumerate() {
        assert_eq!(lit.cells()[index], light * factor);
    }
    // The contrast is at most 1, so that no light is negative.
    assert!(all.iter().all(|image| image.cells().iter().all(|cell| *cell >= 0.0)));
}
