//! Errors of position and attitude, and the fixes that correct them.

use glam::{DVec2, DVec3};
use raypencil_rover::{Attitude, Localisation, LocalisationErrors, PositionFixes, Stance};
use raypencil_terrain::HeightIndex;

fn stance() -> Stance {
    Stance { position: DVec3::new(-9.3, 0.2, 0.04), attitude: Attitude::default(), residual: 0.0 }
}

fn ground() -> HeightIndex {
    HeightIndex::new(&raypencil_terrain::builtin("pyramids", 0.25).unwrap().into_mesh().unwrap())
}

#[test]
fn without_errors_the_truth_is_read() {
    let mut localisation = Localisation::new(LocalisationErrors::default(), 1, 10.0);
    for _ in 0..3 {
        let sensed = localisation.read(&stance(), &ground());
        assert_eq!(sensed.position, DVec2::new(-9.3, 0.2));
        assert_eq!(sensed.attitude, Attitude::default());
        // The vehicle is 4 cm above a plane at 0.
        assert_eq!(sensed.proximity, Some(0.04));
    }
}

#[test]
fn drift_grows_until_a_fix_takes_it_away() {
    // 0.02 m/s at 10 frames per second are 2 mm per frame. Frames 0, 50 and 100 have fixes without noise.
    let fixes = Some(PositionFixes { every_frames: 50, noise: 0.0 });
    let errors = LocalisationErrors {
        position_drift: DVec2::new(0.02, 0.0),
        heading_drift: 0.01,
        fixes,
        ..LocalisationErrors::default()
    };
    assert!(errors.validate("sensors").is_ok());
    let (mut localisation, ground) = (Localisation::new(errors, 1, 10.0), ground());
    for frame in 0..120_u32 {
        let sensed = localisation.read(&stance(), &ground);
        let expected = 0.002 * f64::from(frame % 50);
        assert!((sensed.position.x + 9.3 - expected).abs() < 1e-12, "frame {frame}");
        // A fix does not correct the heading: it drifts by 1 mrad per frame.
        assert!((sensed.attitude.heading - 0.001 * f64::from(frame)).abs() < 1e-12);
    }
}

#[test]
fn a_walk_has_the_spread_of_its_time() {
    // A walk of 0.01 m in 1 s has a standard deviation of 0.01 sqrt(25) = 0.05 m after 25 s. Over 400 seeds the mean
    // square is 0.0025, within four relative standard errors of sqrt(2 / 400). There are four frames in a second: with
    // one, the time of a frame and its root would be alike.
    let errors = LocalisationErrors { position_walk: 0.01, ..LocalisationErrors::default() };
    let mut mean_square = 0.0;
    let ground = ground();
    for seed in 0..400 {
        let mut localisation = Localisation::new(errors, seed, 4.0);
        let last = (0..=100).map(|_| localisation.read(&stance(), &ground)).last().unwrap();
        let error = last.position.x + 9.3;
        mean_square += error * error / 400.0;
    }
    assert!((mean_square / 0.0025 - 1.0).abs() < 0.283, "{mean_square}");
}

#[test]
fn each_error_is_added_to_the_truth_in_proportion() {
    // A vehicle that turns and leans, and biases of its angles: all sums are exact in binary.
    let attitude = |heading, pitch_down, roll_right| Attitude { heading, pitch_down, roll_right };
    let truth = Stance { attitude: attitude(0.5, 0.25, -0.125), ..stance() };
    let (bias, ground) = (attitude(0.0625, 0.03125, 0.015_625), ground());
    // The errors of frame 1 of a seed, with noise of this size. The same seed draws the same numbers.
    let errors_of = |noise: f64, frame_rate: f64| {
        let errors = LocalisationErrors {
            position_walk: noise,
            attitude_bias: bias,
            attitude_noise: noise,
            proximity_noise: noise,
            ..LocalisationErrors::default()
        };
        let mut localisation = Localisation::new(errors, 3, frame_rate);
        let sensed = [0, 1].map(|_| localisation.read(&truth, &ground))[1];
        let Attitude { heading, pitch_down, roll_right } = sensed.attitude;
        let angles = [heading - 0.5625, pitch_down - 0.281_25, roll_right + 0.109_375];
        let walk = sensed.position - truth.position.truncate();
        (angles, walk, sensed.proximity.unwrap() - 0.04)
    };
    let (angles, walk, proximity) = errors_of(0.0, 1.0);
    assert_eq!((angles, walk), ([0.0; 3], DVec2::ZERO));
    assert!(proximity.abs() < 1e-15);

    let (once, twice) = (errors_of(0.01, 1.0), errors_of(0.02, 1.0));
    let is_double = |twice: f64, once: f64| once != 0.0 && (twice - 2.0 * once).abs() < 1e-12;
    assert!(once.0.iter().zip(twice.0).all(|(once, twice)| is_double(twice, *once)), "{once:?} {twice:?}");
    assert!(is_double(twice.1.x, once.1.x) && is_double(twice.1.y, once.1.y));
    assert!(is_double(twice.2, once.2));
    // A frame of a quarter of a second walks half as far as one of a second; the other errors do not know of time.
    let quarter = errors_of(0.01, 4.0);
    assert!(is_double(once.1.x, quarter.1.x) && is_double(once.1.y, quarter.1.y));
    assert_eq!((quarter.0, quarter.2), (once.0, once.2));
}

#[test]
fn errors_out_of_range_are_named() {
    let errors = LocalisationErrors { attitude_noise: -1.0, ..LocalisationErrors::default() };
    assert!(errors.validate("sensors").unwrap_err().to_string().contains("sensors.attitude_noise is -1"));
}

#[test]
fn noise_is_new_in_every_frame_and_another_in_every_sensor() {
    // Six columns of noise over many frames: steps of the walk in x and y, heading, pitch, roll, proximity, each of
    // standard deviation 1 in units of its own. The walk takes steps of walk / sqrt(frame rate). With n frames, a mean
    // square has the standard error sqrt(2 / n), and a mean product of independent numbers 1 / sqrt(n). Five of them are
    // allowed, which one of 150 figures exceeds in one of 10,000 runs by chance; and the seed is fixed.
    const FRAMES: usize = 4000;
    let errors = LocalisationErrors {
        position_walk: 0.02,
        attitude_noise: 1e-3,
        proximity_noise: 0.01,
        ..LocalisationErrors::default()
    };
    let (mut localisation, ground, stance) = (Localisation::new(errors, 7, 4.0), ground(), stance());
    let mut walked = DVec2::ZERO;
    let mut columns: [Vec<f64>; 6] = Default::default();
    for frame in 0..=FRAMES {
        let sensed = localisation.read(&stance, &ground);
        let position = sensed.position - stance.position.truncate();
        let (step, angles) = (position - walked, sensed.attitude);
        walked = position;
        if frame == 0 {
            continue;
        }
        let of_frame = [
            step.x / 0.01,
            step.y / 0.01,
            angles.heading / 1e-3,
            angles.pitch_down / 1e-3,
            angles.roll_right / 1e-3,
            (sensed.proximity.unwrap() - 0.04) / 0.01,
        ];
        columns.iter_mut().zip(of_frame).for_each(|(column, number)| column.push(number));
    }
    assert_are_independent(&columns);

    // Each fix of a position has an error of its own as well.
    let fixes = Some(PositionFixes { every_frames: 1, noise: 0.05 });
    let mut fixed = Localisation::new(LocalisationErrors { fixes, ..LocalisationErrors::default() }, 7, 4.0);
    let errors =
        (0..FRAMES).map(|_| (fixed.read(&stance, &ground).position - stance.position.truncate()) / 0.05);
    let errors: Vec<DVec2> = errors.collect();
    assert_are_independent(&[
        errors.iter().map(|error| error.x).collect(),
        errors.iter().map(|error| error.y).collect(),
    ]);
}

/// Columns of numbers of variance 1: no column follows another, nor itself some frames ago.
fn assert_are_independent(columns: &[Vec<f64>]) {
    for (index, a) in columns.iter().enumerate() {
        let count = a.len() as f64;
        let mean = a.iter().sum::<f64>() / count;
        let square = a.iter().map(|number| number * number).sum::<f64>() / count;
        assert!(mean.abs() < 5.0 / count.sqrt(), "column {index}: mean {mean}");
        assert!((square - 1.0).abs() < 5.0 * (2.0 / count).sqrt(), "column {index}: mean square {square}");
        for (other, b) in columns.iter().enumerate() {
            for lag in [0, 1, 2, 5] {
                if lag == 0 && other == index {
                    continue;
                }
                let products = a[lag..].iter().zip(b).map(|(now, before)| now * before);
                let product = products.sum::<f64>() / count;
                assert!(
                    product.abs() < 5.0 / count.sqrt(),
                    "{index} and {other}, {lag} frames ago: {product}"
                );
            }
        }
    }
}
