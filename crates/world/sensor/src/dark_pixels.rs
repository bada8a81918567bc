//! Digital numbers of pixels without light, many at once.
//!
//! Most pixels of a frame are dark: their numbers are of dark electrons, read noise and DSNU alone. Here the normal number of
//! the read noise is computed in single precision, with a bound of its error. Where the bound leaves open which digital number
//! comes out, none is given, and that pixel is computed as any other. So the numbers are the same to the bit.
//!
//! # The bound
//!
//! A normal number is n = sqrt(x) c, with x = -2 ln u and c = cos(2 pi v) of uniform u and v. Only the first 24 bits of u
//! are used here: u is within half a step of (h + 1/2) 2^-24, so that ln u changes by at most 1 / (2 h). With the computed
//! x' and c', and r' = sqrt(x'):
//!
//! ```text
//! |x' - x| <= d = 1/h + e (1 + x'),        |c' - c| <= e,        e = 2^-18
//! |r' - sqrt(x)| <= d / r'                 for (r' - sqrt(x)) (r' + sqrt(x)) = x' - x
//! |r' c' - sqrt(x) c| <= |r' - sqrt(x)| |c| + r' |c' - c| <= d / r' + e r'
//! ```
//!
//! Here e covers the polynomials, the steps of v and the roundings; the root and the product, in single precision too, have
//! another e r'. A test compares x' and c' with double precision at both ends of each of the 2^24 steps.

use crate::{ImageSensor, NoiseSource};

/// Pixels that are computed together.
pub(crate) const LANES: usize = 16;

/// A value for each of them.
pub(crate) type Lanes<T> = [T; LANES];

/// The error e of the bound.
const ERROR: f32 = 1.0 / (1 << 18) as f32;

/// 2^52: to add it to a smaller number is to round that to a whole number, which then stands in the last bits.
const WHOLE: f64 = (1_u64 << 52) as f64;

/// Largest mean of dark electrons. (Beyond, `poisson` does not search.)
const MAX_MEAN: f64 = 10.0;

pub(crate) struct DarkPixels<'s> {
    sensor: &'s ImageSensor,
    /// Expected dark electrons, and the probability that there are none.
    mean: f64,
    none: f64,
}

impl<'s> DarkPixels<'s> {
    /// `mean`: the expected dark electrons. `None` if so many are expected that each pixel is to be computed by itself.
    pub(crate) fn new(sensor: &'s ImageSensor, mean: f64) -> Option<Self> {
        (mean < MAX_MEAN).then(|| Self { sensor, mean, none: libm::exp(-mean) })
    }

    /// The digital numbers of the pixels from `first` on, and which of them are sure. `dark_signals`: their DSNU, electrons.
    pub(crate) fn numbers(
        &self,
        frame: u64,
        first: u32,
        dark_signals: &Lanes<f64>,
    ) -> (Lanes<u16>, Lanes<bool>) {
        let sensor = self.sensor;
        let electrons = self.electrons(frame, first);
        let [h, _, v, _] = random_words(sensor.seed, NoiseSource::Read, frame, first);
        let (mut numbers, mut sure) = ([0; LANES], [false; LANES]);
        for lane in 0..LANES {
            let (normal, error) = quick_normal(h[lane] >> 8, v[lane] >> 8);
            let offset = dark_signals[lane] + sensor.read_noise * f64::from(normal);
            let signal = sensor.bias + sensor.gain * (electrons[lane] + offset);
            // No sum of it is larger; each of the few roundings changes it by half of an epsilon.
            let largest = sensor.bias
                + sensor.gain * (electrons[lane] + dark_signals[lane].abs() + 16.0 * sensor.read_noise);
            let error =
                sensor.gain * sensor.read_noise * f64::from(error) + 8.0 * f64::EPSILON * (largest + 1.0);
            // The number is the whole part of `above`, and changes where that is whole. Beyond the converter's range it
            // does not.
            let above = signal + 0.5;
            let above = if above > 0.5 { above } else { 0.5 };
            let most = sensor.max_number() + 0.5;
            let above = if above < most { above } else { most };
            let rounded = (above - 0.5) + WHOLE;
            let fraction = above - (rounded - WHOLE);
            numbers[lane] = rounded.to_bits() as u16;
            sure[lane] = fraction > error && 1.0 - fraction > error;
        }
        (numbers, sure)
    }

    /// Dark electrons in the wells, as [`poisson`](crate::poisson) draws them.
    fn electrons(&self, frame: u64, first: u32) -> Lanes<f64> {
        let mut electrons = [0.0; LANES];
        if self.sensor.shot_noise {
            let [high, low, _, _] = random_words(self.sensor.seed, NoiseSource::Shot, frame, first);
            let mut left = [0.0; LANES];
            for lane in 0..LANES {
                // `NoiseStream::uniform`; 0x433 is the exponent of 2^52.
                let bits = (u64::from(high[lane]) << 20) | u64::from(low[lane] >> 12);
                left[lane] = (f64::from_bits(0x433 << 52 | bits) - WHOLE + 0.5) * (1.0 / WHOLE);
            }
            let (mut probability, mut k) = (self.none, 0.0);
            while k < 200.0 && left.iter().any(|left| *left > probability) {
                for lane in 0..LANES {
                    let goes_on = left[lane] > probability;
                    electrons[lane] += if goes_on { 1.0 } else { 0.0 };
                    left[lane] = if goes_on { left[lane] - probability } else { -1.0 };
                }
                k += 1.0;
                probability *= self.mean / k;
            }
        } else {
            electrons = [self.mean; LANES];
        }
        electrons.map(|electrons: f64| electrons.min(self.sensor.full_well))
    }
}

/// A standard normal number of the uniform numbers that begin with the bits `h` and `v`, 24 of each; and the bound of its
/// error.
#[inline(always)]
fn quick_normal(h: u32, v: u32) -> (f32, f32) {
    let x = minus_two_ln(h);
    let root = x.sqrt();
    let of_x = 1.0 / h as i32 as f32 + ERROR * (1.0 + x);
    (root * cos_of_turn(v), of_x / root + 2.0 * ERROR * root)
}

/// -2 ln((h + 1/2) 2^-24).
#[inline(always)]
fn minus_two_ln(h: u32) -> f32 {
    // h + 1/2 is rounded only beyond 2^23.
    let u = (h as i32 as f32 + 0.5) * (1.0 / (1 << 24) as f32);
    // u = 2^k m with m from sqrt(1/2) to sqrt(2); the constant has the bits of sqrt(1/2).
    let k = (u.to_bits() as i32 - 0x3f35_04f3) >> 23;
    let m = f32::from_bits((u.to_bits() as i32 - (k << 23)) as u32);
    // ln m = 2 artanh f; the next term is 2e-10.
    let f = (m - 1.0) / (m + 1.0);
    let ff = f * f;
    let ln_m = 2.0 * f * (1.0 + ff * (1.0 / 3.0 + ff * (1.0 / 5.0 + ff * (1.0 / 7.0 + ff * (1.0 / 9.0)))));
    -2.0 * (k as f32 * std::f32::consts::LN_2 + ln_m)
}

/// cos(2 pi (v + 1/2) 2^-24).
#[inline(always)]
fn cos_of_turn(v: u32) -> f32 {
    let turn = (v as i32 as f32 + 0.5) * (1.0 / (1 << 24) as f32);
    // cos(2 pi turn) = -sin(2 pi (1/4 - |turn - 1/2|)), of an angle between -pi/2 and pi/2; the next term is 6e-8.
    let angle = (0.25 - (turn - 0.5).abs()) * std::f32::consts::TAU;
    let square = angle * angle;
    let terms = [-1.0 / 6.0, 1.0 / 120.0, -1.0 / 5_040.0, 1.0 / 362_880.0, -1.0 / 39_916_800.0];
    let sum = terms.into_iter().rev().fold(0.0, |sum, term| (sum + term) * square);
    -angle * (1.0 + sum)
}

/// The four words of the first block of each pixel's [`NoiseStream`](crate::NoiseStream): [`philox`](raypencil_scene::philox)
/// of its counters.
fn random_words(seed: u64, source: NoiseSource, frame: u64, first: u32) -> [Lanes<u32>; 4] {
    let mut pixels = [0; LANES];
    (0..LANES).for_each(|lane| pixels[lane] = first.wrapping_add(lane as u32));
    let same = [frame as u32, (frame >> 32) as u32, (source as u32) << 24].map(|word| [word; LANES]);
    let (mut a, [mut b, mut c, mut d]) = (pixels, same);
    let mut key = [seed as u32, (seed >> 32) as u32];
    for _ in 0..10 {
        for lane in 0..LANES {
            let first = u64::from(0xd251_1f53_u32) * u64::from(a[lane]);
            let second = u64::from(0xcd9e_8d57_u32) * u64::from(c[lane]);
            a[lane] = (second >> 32) as u32 ^ b[lane] ^ key[0];
            b[lane] = second as u32;
            c[lane] = (first >> 32) as u32 ^ d[lane] ^ key[1];
            d[lane] = first as u32;
        }
        key = [key[0].wrapping_add(0x9e37_79b9), key[1].wrapping_add(0xbb67_ae85)];
    }
    [a, b, c, d]
}

#[cfg(test)]
#[path = "../tests/unit/dark_pixels.rs"]
mod tests;
