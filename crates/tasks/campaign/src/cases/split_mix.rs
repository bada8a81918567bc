//! Random numbers of a seed, by index or in sequence. (G. Steele, D. Lea and C. Flood, "Fast splittable pseudorandom
//! number generators", 2014: SplitMix64)

use std::f64::consts::TAU;

use glam::DVec3;

/// Output `index`, from 0, of SplitMix64 with this seed.
pub fn hash(seed: u64, index: u64) -> u64 {
    let mut z = seed.wrapping_add((index.wrapping_add(1)).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Output `index` as a number from -1 to 1.
pub fn hash_unit(seed: u64, index: u64) -> f64 {
    (hash(seed, index) >> 11) as f64 / f64::from(1u32 << 31) / f64::from(1 << 21) - 1.0
}

/// The outputs of SplitMix64 in sequence, from output 1 on. Output 0 is left out, since the scenes of all campaigns so
/// far were made without it.
pub(crate) struct SplitMix64 {
    seed: u64,
    index: u64,
}

impl SplitMix64 {
    pub(crate) fn new(seed: u64) -> Self {
        Self { seed, index: 0 }
    }

    pub(crate) fn next_u64(&mut self) -> u64 {
        self.index += 1;
        hash(self.seed, self.index)
    }

    /// A whole number from 0 to `count - 1`.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.next_u64() % count as u64) as usize
    }

    /// A number from 0 to 1.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// 1 or -1.
    pub(crate) fn sign(&mut self) -> f64 {
        if self.next_u64() & 1 == 0 { 1.0 } else { -1.0 }
    }

    /// 10^x with x from `low` to `high`.
    pub(crate) fn power_of_ten(&mut self, low: f64, high: f64) -> f64 {
        libm::pow(10.0, low + (high - low) * self.unit())
    }

    /// A unit vector, uniform on the sphere.
    pub(crate) fn direction(&mut self) -> DVec3 {
        let z = 2.0 * self.unit() - 1.0;
        let (sin, cos) = libm::sincos(TAU * self.unit());
        let level = (1.0 - z * z).sqrt();
        DVec3::new(level * cos, level * sin, z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_of_seed_0_are_those_of_the_reference() {
        // S. Vigna's splitmix64.c, seed 0.
        let reference = [0xe220_a839_7b1d_cdaf, 0x6e78_9e6a_a1b9_65f4, 0x06c4_5d18_8009_454f];
        assert_eq!([0, 1, 2].map(|index| hash(0, index)), reference);
        let mut random = SplitMix64::new(0);
        assert_eq!([(); 2].map(|()| random.next_u64()), reference[1..]);
        // As numbers from -1 to 1: whole numbers below 2^64 in units of 2^63, but for their last 11 bits.
        let unit = |whole: u64| whole as f64 / (1_u64 << 63) as f64 - 1.0;
        for (index, whole) in (0..).zip(reference) {
            assert!((hash_unit(0, index) - unit(whole)).abs() < 1e-15, "{index}");
        }
        // The signs of the outputs after those: the last bit tells.
        let signs = [(); 8].map(|()| random.sign());
        let mut again = SplitMix64::new(0);
        assert_eq!([(); 2].map(|()| again.next_u64()), reference[1..]);
        assert_eq!(signs, [(); 8].map(|()| 1.0 - 2.0 * (again.next_u64() & 1) as f64));
    }
}
