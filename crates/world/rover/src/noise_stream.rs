//! Random numbers keyed by (seed, purpose, index), from `scene`'s Philox4x32-10.

use raypencil_scene::philox;

/// Use of a random number. Each use has its own stream. Never reuse or renumber one: a seed would change its meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// Random walk of the inertial position.
    PositionWalk = 1,
    /// Error of a position fix by the beacons.
    PositionFix = 2,
    /// Noise of the measured pitch and roll.
    Tilt = 3,
    /// Noise of the measured heading.
    Heading = 4,
    /// Noise of the proximity sensor.
    Proximity = 5,
}

/// The random numbers of one seed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NoiseStream {
    pub seed: u64,
}

/// First value of the third counter word. Jittered pencils use 0 to 63 there, the indices of a scene's beams.
const NOISE_COUNTER_BASE: u32 = 1 << 16;

impl NoiseStream {
    /// Two independent numbers, uniformly distributed in (0, 1).
    fn uniform(&self, purpose: Purpose, index: u64) -> [f64; 2] {
        let counter = [index as u32, (index >> 32) as u32, NOISE_COUNTER_BASE + purpose as u32, 0];
        let [a, b, _, _] = philox(counter, [self.seed as u32, (self.seed >> 32) as u32]);
        // An odd multiple of 2^-33: never 0, never 1.
        [a, b].map(|word| (f64::from(word) + 0.5) * (1.0 / (1_u64 << 32) as f64))
    }

    /// Two independent numbers of the normal distribution with mean 0 and standard deviation 1. (Box and Muller, 1958)
    pub fn gaussians(&self, purpose: Purpose, index: u64) -> [f64; 2] {
        let [share, turn] = self.uniform(purpose, index);
        let radius = (-2.0 * libm::log(share)).sqrt();
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * turn);
        [radius * cos, radius * sin]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_differ_by_seed_purpose_and_index() {
        let draw = |seed, purpose, index| NoiseStream { seed }.gaussians(purpose, index);
        let first = draw(1, Purpose::Tilt, 7);
        assert_eq!(first, draw(1, Purpose::Tilt, 7));
        for other in
            [draw(2, Purpose::Tilt, 7), draw(1, Purpose::Heading, 7), draw(1, Purpose::Tilt, 7 + (1 << 32))]
        {
            assert_ne!(first, other);
        }
    }

    #[test]
    fn numbers_are_philox_of_their_counters() {
        // Key: the seed's halves. Counter: the index's halves, 2^16 and the purpose, 0. A word w is (w + 1/2) / 2^32.
        let stream = NoiseStream { seed: 0x0123_4567_89ab_cdef };
        let [a, b, _, _] = philox([7, 3, 65_536 + 5, 0], [0x89ab_cdef, 0x0123_4567]);
        let [share, turn] = stream.uniform(Purpose::Proximity, (3 << 32) | 7);
        assert_eq!(
            [share, turn].map(|part| part * 8_589_934_592.0),
            [a, b].map(|word| 2.0 * f64::from(word) + 1.0)
        );
        // Box and Muller: the sum of squares is -2 ln(share); the direction is `turn` times a full circle.
        let [x, y] = stream.gaussians(Purpose::Proximity, (3 << 32) | 7);
        assert!((x * x + y * y + 2.0 * libm::log(share)).abs() < 1e-14);
        let angle = libm::atan2(y, x) / std::f64::consts::TAU;
        assert!((angle - turn + (turn - angle).round()).abs() < 1e-15, "{angle} and {turn}");
    }

    #[test]
    fn gaussians_have_their_moments() {
        // For n = 20000 the means of x, x^2 and xy have the standard errors 1, sqrt(2) and 1, over sqrt(n). Bound: four
        // standard errors.
        let stream = NoiseStream { seed: 11 };
        let mut sums = [0.0; 3];
        for index in 0..20_000 {
            let [x, y] = stream.gaussians(Purpose::Proximity, index);
            for (sum, term) in sums.iter_mut().zip([x, x * x - 1.0, x * y]) {
                *sum += term / 20_000.0;
            }
        }
        let error = 1.0 / f64::sqrt(20_000.0);
        assert!(sums[0].abs() < 4.0 * error && sums[1].abs() < 5.66 * error && sums[2].abs() < 4.0 * error);
    }
}
