//! Sizes of rocks, by the law of Golombek and Rapp (1997).
//!
//! Rocks of diameter D and more cover the fraction F(D) = k exp(-q D) of the ground. Here k is the fraction that
//! all rocks cover, and q = 1.79 + 0.152 / k per metre. One rock covers pi D^2 / 4. Per square metre and metre of
//! diameter there are therefore -F'(D) / (pi D^2 / 4) = 4 k q exp(-q D) / (pi D^2) rocks, or
//! 4 k q exp(-q / v) / pi per unit of v = 1/D.
//!
//! Diameters are drawn from this density: events of a Poisson process of rate 4 k q / pi in v, from 1/largest to
//! 1/smallest, are kept with probability exp(-q D). The diameter of a rock is that of the circle with the
//! same area as its outline from above.

use super::rock_bodies::{MIN_DIAMETER_OF_128_FACES_M, MIN_DIAMETER_OF_512_FACES_M};
use crate::random_stream::{RandomStream, StreamPurpose};

/// Size distribution of the rocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rocks {
    /// Fraction k of the ground that rocks of all sizes would cover, 0 to 0.4. (Golombek et al. 2003 give 0.05 to
    /// 0.4)
    pub coverage: f64,
    /// Smallest diameter D_min, metres. The law continues below it with ever more and smaller rocks.
    pub smallest: f64,
    /// Largest diameter D_max, metres.
    pub largest: f64,
}

impl Rocks {
    /// Decay rate q of the law, per metre.
    pub fn decay(&self) -> f64 {
        1.79 + 0.152 / self.coverage
    }

    /// Fraction of the ground covered by rocks from `diameter` (metres) up to the largest: F(D) - F(D_max).
    pub fn cumulative_area(&self, diameter: f64) -> f64 {
        let share = |diameter: f64| self.coverage * libm::exp(-self.decay() * diameter);
        share(diameter) - share(self.largest)
    }

    /// Upper bound on the expected number of faces of the rocks on `area` square metres.
    pub(super) fn max_expected_faces(&self, area: f64) -> f64 {
        let from = |diameter: f64| {
            (1.0 / self.smallest.max(diameter) - 1.0 / self.largest).max(0.0) * self.rate(area)
        };
        // 32 faces for each rock, plus the additional faces of the larger ones.
        32.0 * from(0.0)
            + 96.0 * from(MIN_DIAMETER_OF_128_FACES_M)
            + 384.0 * from(MIN_DIAMETER_OF_512_FACES_M)
    }

    /// Rate of the Poisson process: events per unit of 1/D.
    fn rate(&self, area: f64) -> f64 {
        if self.coverage > 0.0 {
            area * 4.0 * self.coverage * self.decay() / std::f64::consts::PI
        } else {
            0.0
        }
    }

    /// Diameters of the rocks on `area` square metres, metres, in descending order. A smaller `smallest` with the
    /// same seed appends more rocks at the end.
    pub fn diameters(&self, area: f64, seed: u64) -> Vec<f64> {
        let rate = self.rate(area);
        let mut diameters = Vec::new();
        if !(rate > 0.0) {
            return diameters;
        }
        let mut random = RandomStream::new(seed, StreamPurpose::Rocks);
        let mut curvature = 1.0 / self.largest;
        loop {
            curvature += random.exponential() / rate;
            let diameter = 1.0 / curvature;
            if !(diameter >= self.smallest) {
                return diameters;
            }
            if random.uniform() < libm::exp(-self.decay() * diameter) {
                diameters.push(diameter);
            }
        }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/mars/rocks.rs"]
mod tests;
