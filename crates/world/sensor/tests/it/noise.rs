//! Each term of the noise against its law.
//!
//! Seeds are fixed, so every test always has the same outcome. The level tells how rarely a sensor that obeys the
//! law would fail: |z| >= 3.72 is 1 in 5,000.

use raypencil_scene::Image;
use raypencil_sensor::{DarkCurrent, ImageSensor, NoiseSource, NoiseStream, poisson};

const LEVEL: f64 = 3.72;

/// Sensor without noise: 1 DN per electron, 16 bits.
const PLAIN: ImageSensor = ImageSensor { gain: 1.0, exposure: 1.0, ..ImageSensor::ideal() };

/// Flux that makes one electron, watts.
fn watts_per_electron(sensor: &ImageSensor) -> f64 {
    1.0 / sensor.photoelectrons(1.0)
}

fn flat(sensor: &ImageSensor, side: u32, electrons: f64) -> Image<f64> {
    Image::filled(side, side, electrons * watts_per_electron(sensor))
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn variance(values: &[f64]) -> f64 {
    let mean = mean(values);
    values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (values.len() - 1) as f64
}

fn assert_mean(values: &[f64], expected: f64, variance: f64, what: &str) {
    let z = (mean(values) - expected) / (variance / values.len() as f64).sqrt();
    assert!(z.abs() < LEVEL, "mean of {what}: {} for {expected}, z = {z}", mean(values));
}

/// `fourth` is the fourth central moment of the law: the variance of a variance is (fourth - variance^2) / n.
fn assert_variance(values: &[f64], expected: f64, fourth: f64, what: &str) {
    let z = (variance(values) - expected) / ((fourth - expected * expected) / values.len() as f64).sqrt();
    assert!(z.abs() < LEVEL, "variance of {what}: {} for {expected}, z = {z}", variance(values));
}

/// Quantile of chi-square, for the probability of a standard normal number above `z`. (Wilson and Hilferty)
fn chi_square_bound(freedom: f64, z: f64) -> f64 {
    let part = 2.0 / (9.0 * freedom);
    let root = 1.0 - part + z * part.sqrt();
    freedom * (root * root * root)
}

/// Compares counts with expectations by chi-square. Neighbours are merged until at least 20 are expected.
fn assert_chi_square(pairs: impl Iterator<Item = (f64, f64)>, what: &str) {
    let mut bins: Vec<(f64, f64)> = Vec::new();
    let mut open = (0.0, 0.0);
    for (count, expected) in pairs {
        open = (open.0 + count, open.1 + expected);
        if open.1 >= 20.0 {
            bins.push(open);
            open = (0.0, 0.0);
        }
    }
    if let Some(last) = bins.last_mut() {
        *last = (last.0 + open.0, last.1 + open.1);
    }
    let chi_square: f64 =
        bins.iter().map(|(count, expected)| (count - expected) * (count - expected) / expected).sum();
    let freedom = (bins.len() - 1) as f64;
    let (low, high) = (chi_square_bound(freedom, -LEVEL), chi_square_bound(freedom, LEVEL));
    assert!(chi_square < high && chi_square > low, "{what}: chi-square {chi_square} of {freedom}");
}

#[test]
fn poisson_has_its_law() {
    const DRAWS: u32 = 1_000_000;
    for (number, expected) in [0.3, 3.0, 9.999, 10.0, 30.0, 300.0, 3e4].into_iter().enumerate() {
        let draws: Vec<f64> = (0..DRAWS)
            .map(|index| {
                poisson(expected, &mut NoiseStream::new(2026, NoiseSource::Shot, number as u64, index))
            })
            .collect();
        assert!(draws.iter().all(|k| *k >= 0.0 && *k == k.floor()));
        assert_mean(&draws, expected, expected, "Poisson");
        assert_variance(&draws, expected, expected + 3.0 * expected * expected, "Poisson");

        // One bin for each k within 12 standard deviations, and one beyond.
        let end = (expected + 12.0 * expected.sqrt() + 12.0) as usize;
        let mut counts = vec![0.0; end + 1];
        for k in &draws {
            counts[(*k as usize).min(end)] += 1.0;
        }
        let chance = |k: usize| {
            let k = k as f64;
            libm::exp(k * libm::log(expected) - expected - libm::lgamma(k + 1.0))
        };
        let pairs = counts.iter().enumerate().map(|(k, count)| (*count, f64::from(DRAWS) * chance(k)));
        assert_chi_square(pairs, &format!("Poisson of mean {expected}"));
    }
}

#[test]
fn poisson_of_much_light_and_of_none() {
    let draw = |mean: f64, pixel: u32| poisson(mean, &mut NoiseStream::new(3, NoiseSource::Shot, 0, pixel));
    for nothing in [0.0, -1.0, f64::NAN] {
        assert_eq!(draw(nothing, 0), 0.0);
    }
    // On both sides of the limit of PTRS.
    for expected in [0.9e8, 1e12] {
        let draws: Vec<f64> = (0..50_000).map(|pixel| draw(expected, pixel)).collect();
        assert_mean(&draws, expected, expected, "much light");
        assert_variance(&draws, expected, 3.0 * expected * expected, "much light");
        assert!(draws.iter().all(|k| *k == k.floor()));
    }
}

#[test]
fn normal_has_its_law() {
    const DRAWS: u32 = 200_000;
    let mut stream = NoiseStream::new(5, NoiseSource::Read, 0, 0);
    let draws: Vec<f64> = (0..DRAWS).map(|_| stream.normal()).collect();
    assert_mean(&draws, 0.0, 1.0, "normal");
    assert_variance(&draws, 1.0, 3.0, "normal");
    // Bins of width 0.1 from -4 to 4, and one on either side.
    let below = |x: f64| 0.5 * libm::erfc(-x * std::f64::consts::FRAC_1_SQRT_2);
    let side = |bin: usize| -4.0 + 0.1 * bin as f64;
    let mut counts = [0.0; 82];
    for x in &draws {
        counts[((x + 4.1) / 0.1).clamp(0.0, 81.0) as usize] += 1.0;
    }
    let chance = |bin: usize| match bin {
        0 => below(-4.0),
        81 => below(-4.0),
        bin => below(side(bin)) - below(side(bin - 1)),
    };
    let pairs = counts.iter().enumerate().map(|(bin, count)| (*count, f64::from(DRAWS) * chance(bin)));
    assert_chi_square(pairs, "normal");
}

#[test]
fn uniform_has_its_law() {
    let mut stream = NoiseStream::new(6, NoiseSource::Read, 0, 0);
    let mut counts = [0.0; 100];
    for _ in 0..100_000 {
        counts[(stream.uniform() * 100.0) as usize] += 1.0;
    }
    assert_chi_square(counts.iter().map(|count| (*count, 1000.0)), "uniform");
}

#[test]
fn shot_noise_is_poissons() {
    let sensor = ImageSensor { shot_noise: true, seed: 11, ..PLAIN };
    let frame = sensor.expose(&flat(&sensor, 300, 400.0), None, 0);
    assert_mean(frame.electrons.cells(), 400.0, 400.0, "shot noise");
    assert_variance(frame.electrons.cells(), 400.0, 400.0 + 3.0 * 400.0 * 400.0, "shot noise");
    // Another frame has other noise of the same law: the difference has twice the variance.
    let next = sensor.expose(&flat(&sensor, 300, 400.0), None, 1);
    let pairs = frame.electrons.cells().iter().zip(next.electrons.cells());
    let differences: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
    assert_mean(&differences, 0.0, 800.0, "difference of frames");
    // Fourth central moment of a difference: 2 (400 + 3 400^2) + 6 400^2.
    assert_variance(&differences, 800.0, 800.0 + 12.0 * 400.0 * 400.0, "difference of frames");
}

#[test]
fn read_noise_is_normal_and_new_in_each_frame() {
    let sensor = ImageSensor { read_noise: 12.0, gain: 0.5, bias: 1000.0, seed: 12, ..PLAIN };
    let dark = flat(&sensor, 300, 0.0);
    let (first, second) = (sensor.expose(&dark, None, 0), sensor.expose(&dark, None, 1));
    // 0.5 DN per electron: sigma 6 DN.
    assert_mean(first.signal.cells(), 1000.0, 36.0, "read noise");
    assert_variance(first.signal.cells(), 36.0, 3.0 * 36.0 * 36.0, "read noise");
    let pairs = first.signal.cells().iter().zip(second.signal.cells());
    let products: Vec<f64> = pairs.map(|(a, b)| (a - 1000.0) * (b - 1000.0)).collect();
    assert_mean(&products, 0.0, 36.0 * 36.0, "product of two frames");
}

#[test]
fn fixed_patterns_are_fixed() {
    let sensor = ImageSensor { prnu: 0.01, dsnu: 5.0, bias: 500.0, seed: 13, ..PLAIN };
    let take = |electrons, frame| sensor.expose(&flat(&sensor, 300, electrons), None, frame);
    let (dark, light) = (take(0.0, 0), take(10_000.0, 1));
    assert_mean(dark.signal.cells(), 500.0, 25.0, "DSNU");
    assert_variance(dark.signal.cells(), 25.0, 3.0 * 625.0, "DSNU");
    // 1 % of 10,000: sigma 100.
    assert_mean(light.electrons.cells(), 10_000.0, 1e4, "PRNU");
    assert_variance(light.electrons.cells(), 1e4, 3e8, "PRNU");
    // The pattern is the same in every frame, and another with another seed.
    assert_eq!(take(10_000.0, 77).signal, light.signal);
    let other = ImageSensor { seed: 14, ..sensor };
    assert_ne!(other.expose(&flat(&sensor, 300, 10_000.0), None, 1).signal, light.signal);
    // PRNU scales with the light: twice the light, twice the pattern.
    let twice = take(20_000.0, 2);
    for (once, twice) in light.electrons.cells().iter().zip(twice.electrons.cells()) {
        assert!((2.0 * once - twice).abs() < 1e-9 * twice);
    }
}

#[test]
fn dark_frames_follow_time_and_temperature() {
    // 1000 electrons per second at 293.15 K double every 7 K: 4000 per second at 307.15 K.
    let dark = DarkCurrent {
        rate: 1000.0,
        reference_temperature: 293.15,
        doubling_kelvins: 7.0,
        temperature: 307.15,
    };
    assert!((dark.electrons_per_second() - 4000.0).abs() < 1e-9);
    // In 50 ms there are 200 electrons. With read noise of 10 electrons and DSNU of 5 the variance is 200 + 100 +
    // 25 electrons^2.
    let sensor = ImageSensor {
        exposure: 0.05,
        shot_noise: true,
        dark_current: dark,
        read_noise: 10.0,
        dsnu: 5.0,
        gain: 4.0,
        bias: 100.0,
        seed: 15,
        ..PLAIN
    };
    let frame = sensor.expose(&Image::filled(300, 300, 0.0), None, 0);
    let numbers: Vec<f64> = frame.numbers.cells().iter().map(|number| f64::from(*number)).collect();
    // K^2 sigma^2, and 1/12 for quantisation.
    let expected = 16.0 * 325.0 + 1.0 / 12.0;
    assert_mean(&numbers, 100.0 + 4.0 * 200.0, expected, "dark frame");
    // Fourth moment: that of a normal law, plus the excess 200 K^4 of Poisson's law.
    assert_variance(&numbers, expected, 3.0 * expected * expected + 256.0 * 200.0, "dark frame");
}

#[test]
fn quantisation_adds_a_twelfth() {
    // A ramp of flux spreads the signal evenly over 200 DN: rounding has variance 1/12 and mean 0.
    let ramp: Vec<f64> =
        (0..100_000).map(|index| 0.002 * f64::from(index) * watts_per_electron(&PLAIN)).collect();
    let frame = PLAIN.expose(&Image::from_cells(1000, 100, ramp), None, 0);
    let errors: Vec<f64> =
        frame.numbers.cells().iter().zip(frame.signal.cells()).map(|(n, s)| f64::from(*n) - s).collect();
    assert!(errors.iter().all(|error| error.abs() <= 0.5));
    assert!(mean(&errors).abs() < 0.003 && (variance(&errors) * 12.0 - 1.0).abs() < 0.003);
}

#[test]
fn the_slope_of_photon_transfer_is_the_gain() {
    // EMVA 1288: sigma_y^2 = K^2 sigma_d^2 + sigma_q^2 + K (mu_y - mu_y.dark). The variance is temporal: it is
    // estimated from pairs of frames with the same fixed patterns.
    let sensor = ImageSensor { bias: 100.0, seed: 16, ..ImageSensor::cmos() };
    let of_level = |level: u64| {
        let flux = flat(&sensor, 300, 500.0 * level as f64);
        let [a, b] = [0, 1].map(|frame| sensor.expose(&flux, None, 2 * level + frame).numbers);
        let pairs: Vec<(f64, f64)> =
            a.cells().iter().zip(b.cells()).map(|(a, b)| (f64::from(*a), f64::from(*b))).collect();
        let mean = mean(&pairs.iter().map(|(a, b)| 0.5 * (a + b)).collect::<Vec<_>>());
        (mean, 0.5 * variance(&pairs.iter().map(|(a, b)| a - b).collect::<Vec<_>>()))
    };
    // At most 5,000 electrons, half of the well.
    let points: Vec<(f64, f64)> = (0..=10).map(of_level).collect();
    // Weighted least squares: the variance of a variance is 2 variance^2 / n.
    let n = 90_000.0;
    let (mut w, mut x, mut y, mut xx, mut xy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (mean, variance) in &points {
        let weight = n / (2.0 * variance * variance);
        w += weight;
        x += weight * mean;
        y += weight * variance;
        xx += weight * mean * mean;
        xy += weight * mean * variance;
    }
    let slope = (w * xy - x * y) / (w * xx - x * x);
    let error = (w / (w * xx - x * x)).sqrt();
    assert!((slope - sensor.gain).abs() < LEVEL * error, "{slope} +- {error} for {}", sensor.gain);
    assert!(error < 0.003 * sensor.gain, "{error}");
    // Without light: K^2 sigma_d^2 + 1/12.
    let dark = sensor.gain * sensor.gain * sensor.read_noise * sensor.read_noise + 1.0 / 12.0;
    assert!((points[0].1 / dark - 1.0).abs() < LEVEL * (2.0 / n).sqrt(), "{} for {dark}", points[0].1);
}

#[test]
fn the_response_is_a_straight_line() {
    let sensor = ImageSensor { seed: 17, ..ImageSensor::cmos() };
    for electrons in [0.0, 100.0, 1000.0, 5000.0, 9000.0] {
        let frame = sensor.expose(&flat(&sensor, 300, electrons), None, 9);
        let numbers: Vec<f64> = frame.numbers.cells().iter().map(|number| f64::from(*number)).collect();
        let dark = sensor.dark_current.electrons_per_second() * sensor.exposure;
        let prnu = sensor.prnu * electrons;
        let electronic = electrons + dark + prnu * prnu + 2.4 * 2.4 + 0.6 * 0.6;
        let expected = sensor.bias + sensor.gain * (electrons + dark);
        assert_mean(&numbers, expected, sensor.gain * sensor.gain * electronic + 1.0 / 12.0, "response");
    }
}

#[test]
fn wells_and_converters_fill_up() {
    // The well fills first: 10,700 electrons are 4095 DN, and more light changes nothing.
    let sensor = ImageSensor { read_noise: 0.0, dsnu: 0.0, ..ImageSensor::cmos() };
    let frame = sensor.expose(&flat(&sensor, 50, 1e5), None, 0);
    assert!(frame.electrons.cells().iter().all(|electrons| *electrons == 10_700.0));
    assert!(frame.numbers.cells().iter().all(|number| *number == 4095));
    // The converter fills first.
    let steep = ImageSensor { gain: 10.0, bits: 8, ..PLAIN };
    assert_eq!(steep.expose(&flat(&steep, 1, 25.0), None, 0).numbers.at(0, 0), 250);
    assert_eq!(steep.expose(&flat(&steep, 1, 26.0), None, 0).numbers.at(0, 0), 255);
    // Clipping at 0: half of the read noise is lost.
    let low = ImageSensor { read_noise: 10.0, seed: 18, ..PLAIN };
    let frame = low.expose(&flat(&low, 100, 0.0), None, 0);
    let zeros = frame.numbers.cells().iter().filter(|number| **number == 0).count() as f64;
    // P(signal < 1/2) = Phi(0.05) = 0.5199.
    assert!((zeros - 5199.0).abs() < LEVEL * 50.0, "{zeros}");
}
