//! Random numbers as a function of their use: the same bits in any order and on any thread.

use std::f64::consts::PI;

use raypencil_scene::philox;

/// Source of noise. Each has its own random numbers, whatever the seed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoiseSource {
    /// Shot noise: the number of electrons in a frame.
    Shot = 1,
    /// Read noise of a frame.
    Read = 2,
    /// PRNU: the sensitivity of a pixel, the same in every frame.
    Prnu = 3,
    /// DSNU: the offset of a pixel's dark signal, the same in every frame.
    Dsnu = 4,
    /// Speckle: the amplitude of laser light on the image.
    Speckle = 5,
}

/// Random numbers of one pixel, one noise source, one frame: Philox of these counters.
#[derive(Debug, Clone)]
pub struct NoiseStream {
    key: [u32; 2],
    counter: [u32; 4],
    spare: Option<f64>,
}

impl NoiseStream {
    /// Stream of key (`seed`) and counters (`pixel`, `frame`, `source` and a count of blocks).
    ///
    /// The last word is never 0, so no block coincides with one of the draws of `scene`'s jittered pencils.
    pub fn new(seed: u64, source: NoiseSource, frame: u64, pixel: u32) -> Self {
        Self {
            key: [seed as u32, (seed >> 32) as u32],
            counter: [pixel, frame as u32, (frame >> 32) as u32, (source as u32) << 24],
            spare: None,
        }
    }

    /// First block of a column and a row, in place of a pixel. Columns and rows before the first are counted modulo 2^32;
    /// the lowest 56 bits of `number` count.
    pub(crate) fn at_place(seed: u64, source: NoiseSource, number: u64, [column, row]: [u32; 2]) -> Self {
        let high = (number >> 32) as u32 & 0x00ff_ffff;
        Self {
            key: [seed as u32, (seed >> 32) as u32],
            counter: [column, row, number as u32, (source as u32) << 24 | high],
            spare: None,
        }
    }

    /// Uniform number in (0, 1): an odd multiple of 2^-53, so never 0 or 1.
    pub fn uniform(&mut self) -> f64 {
        if let Some(number) = self.spare.take() {
            return number;
        }
        let [a, b, c, d] = philox(self.counter, self.key);
        self.counter[3] = self.counter[3].wrapping_add(1);
        // 52 bits and a half: exact in f64.
        let unit = |high: u32, low: u32| {
            let bits = (u64::from(high) << 20) | u64::from(low >> 12);
            (bits as f64 + 0.5) * (1.0 / (1_u64 << 52) as f64)
        };
        self.spare = Some(unit(c, d));
        unit(a, b)
    }

    /// Standard normal number. (Box and Muller, 1958; the tail ends at 8.6 standard deviations, beyond which
    /// 1e-17 of the law lies)
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * libm::log(self.uniform())).sqrt();
        radius * libm::cos(2.0 * PI * self.uniform())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stream_reads_its_blocks_in_order() {
        let mut stream = NoiseStream::new(0x0123_4567_89ab_cdef, NoiseSource::Read, (7 << 32) | 5, 42);
        for block in 0..3 {
            let words = philox([42, 5, 7, (2 << 24) + block], [0x89ab_cdef, 0x0123_4567]);
            for pair in words.chunks(2) {
                // The first 52 of 64 bits, and a half.
                let bits = (u64::from(pair[0]) << 32 | u64::from(pair[1])) >> 12;
                assert_eq!(stream.uniform() * 9_007_199_254_740_992.0, (2 * bits + 1) as f64);
            }
        }
    }

    #[test]
    fn seed_purpose_frame_and_pixel_each_give_another_stream() {
        let first = |seed, source, frame, pixel| NoiseStream::new(seed, source, frame, pixel).uniform();
        let all = [
            first(1, NoiseSource::Shot, 0, 0),
            first(2, NoiseSource::Shot, 0, 0),
            first(1 << 32, NoiseSource::Shot, 0, 0),
            first(1, NoiseSource::Read, 0, 0),
            first(1, NoiseSource::Shot, 1, 0),
            first(1, NoiseSource::Shot, 1 << 32, 0),
            first(1, NoiseSource::Shot, 0, 1),
        ];
        for (index, a) in all.iter().enumerate() {
            assert!(all[index + 1..].iter().all(|b| a != b), "{all:?}");
        }
    }
}
