//! Unit tests of `dark_pixels`.

use raypencil_scene::philox;

use super::*;
use crate::NoiseStream;

#[test]
fn words_are_philox() {
    let (seed, frame) = (0x0123_4567_89ab_cdef, 7 << 32 | 5);
    for first in [0, 42, u32::MAX - 3] {
        let words = random_words(seed, NoiseSource::Read, frame, first);
        for lane in 0..LANES {
            let counter = [first.wrapping_add(lane as u32), 5, 7, 2 << 24];
            let expected = philox(counter, [0x89ab_cdef, 0x0123_4567]);
            assert_eq!([0, 1, 2, 3].map(|word: usize| words[word][lane]), expected);
        }
    }
}

#[test]
fn the_bound_holds_at_both_ends_of_every_step() {
    const STEPS: u32 = 1 << 24;
    let unit = |step: u32| f64::from(step) / f64::from(STEPS);
    let (mut largest_of_x, mut largest_of_c) = (0.0_f64, 0.0_f64);
    for step in 0..STEPS {
        let quick = f64::from(minus_two_ln(step));
        let bound = 1.0 / f64::from(step) + f64::from(ERROR) * (1.0 + quick);
        let quick_cos = f64::from(cos_of_turn(step));
        for end in [step, step + 1] {
            let x = -2.0 * libm::log(unit(end));
            let cos = libm::cos(2.0 * std::f64::consts::PI * unit(end));
            if step > 0 {
                largest_of_x = largest_of_x.max((quick - x).abs() / bound);
            }
            largest_of_c = largest_of_c.max((quick_cos - cos).abs() / f64::from(ERROR));
        }
    }
    // The first is nearly reached by the steps of u alone, at the least of them.
    assert!((0.1..1.0).contains(&largest_of_x), "{largest_of_x} of the bound");
    assert!((0.05..0.9).contains(&largest_of_c), "{largest_of_c} of the bound");
    // The step at 0, which has no end, is never sure.
    assert_eq!(quick_normal(0, 0).1, f32::INFINITY);
}

#[test]
fn quick_normal_numbers_lie_within_their_bounds() {
    for pixel in 0..100_000 {
        let [h, _, v, _] = random_words(9, NoiseSource::Read, 3, pixel).map(|word| word[0]);
        let (quick, error) = quick_normal(h >> 8, v >> 8);
        let normal = NoiseStream::new(9, NoiseSource::Read, 3, pixel).normal();
        assert!((f64::from(quick) - normal).abs() <= f64::from(error), "pixel {pixel}: {quick} for {normal}");
    }
}

#[test]
fn sure_numbers_are_those_of_single_pixels_and_nearly_all_are_sure() {
    let cmos = ImageSensor::cmos();
    let dim = crate::DarkCurrent { rate: 5e3, ..crate::DarkCurrent::NONE };
    let kinds = [
        (cmos, 0.999),
        (ImageSensor { dark_current: dim, ..cmos }, 0.999),
        (ImageSensor { read_noise: 0.0, dark_current: dim, ..cmos }, 0.999),
        (ImageSensor { shot_noise: false, dark_current: dim, full_well: 1.0, ..cmos }, 0.999),
        // Half of the pixels at either end of the converter.
        (ImageSensor { bias: 0.0, ..cmos }, 0.999),
        (ImageSensor { bias: 255.0, bits: 8, ..cmos }, 0.999),
        // Numbers of many digits.
        (ImageSensor { gain: 1e3, bits: 16, bias: 3e4, ..cmos }, 0.9),
    ];
    for (sensor, least_sure) in kinds {
        let mean = sensor.dark_current.electrons_per_second() * sensor.exposure;
        let pixels = DarkPixels::new(&sensor, mean).expect("few electrons");
        let pattern: Lanes<f64> = std::array::from_fn(|lane| 0.3 * lane as f64 - 2.0);
        let mut sure_ones = 0;
        for first in (0..40_000).step_by(LANES) {
            let (numbers, sure) = pixels.numbers(4, first, &pattern);
            for lane in (0..LANES).filter(|lane| sure[*lane]) {
                let single = sensor.pixel(0.0, mean, 4, first as usize + lane, Some(pattern[lane]));
                assert_eq!(numbers[lane], sensor.digitised(single.signal), "{sensor:?}: {first} + {lane}");
                sure_ones += 1;
            }
        }
        assert!(f64::from(sure_ones) > least_sure * 40_000.0, "{sensor:?}: {sure_ones} sure");
    }
    assert!(DarkPixels::new(&cmos, 10.0).is_none());
}
