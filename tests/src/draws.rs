//! Seeded random numbers, the same on every machine.

use std::f64::consts::TAU;

use glam::DVec3;

/// The generator SplitMix64. (G. Steele, D. Lea and C. Flood 2014, doi:10.1145/2660193.2660195)
///
/// ```
/// use raypencil_tests::draws::SplitMix64;
///
/// // Equal seeds give equal numbers.
/// let (mut a, mut b) = (SplitMix64::new(7), SplitMix64::new(7));
/// assert_eq!(a.between(2.0, 3.0), b.between(2.0, 3.0));
/// // A direction is a unit vector, but for some roundings of 2^-53.
/// assert!((a.direction().length() - 1.0).abs() < 1e-15);
/// ```
#[derive(Debug, Clone)]
pub struct SplitMix64 {
    state: u64,
}

impl SplitMix64 {
    /// The generator of a seed.
    pub fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// The next 64 bits.
    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut word = self.state;
        word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        word ^ (word >> 31)
    }

    /// A number drawn uniformly from [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A vector with each component drawn uniformly from [-bound, bound).
    pub fn vector(&mut self, bound: f64) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| self.between(-bound, bound)))
    }

    /// A direction drawn uniformly from the unit sphere.
    pub fn direction(&mut self) -> DVec3 {
        let (z, angle) = (self.between(-1.0, 1.0), self.between(0.0, TAU));
        let (sin, cos) = libm::sincos(angle);
        let level = (1.0 - z * z).sqrt();
        DVec3::new(level * cos, level * sin, z)
    }
}
