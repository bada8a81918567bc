//! Pseudo-random numbers that depend on the seed alone. Unit tests include this file as well.

// Each test binary compiles its own copy and uses a part of it.
#![allow(dead_code)]

/// The generator splitmix64. (Steele, Lea and Flood, 2014, doi:10.1145/2660193.2660195)
pub struct SplitMix64(pub u64);

impl SplitMix64 {
    /// 64 random bits.
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    /// A number from 0 to 1, 1 excluded: a multiple of 2^-53.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number from -1 to 1, 1 excluded: a multiple of 2^-52.
    pub fn part(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// A number between two others.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A whole number below `count`.
    pub fn below(&mut self, count: u32) -> u32 {
        ((self.unit() * f64::from(count)) as u32).min(count - 1)
    }
}
