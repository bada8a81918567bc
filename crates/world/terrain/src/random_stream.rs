//! Random numbers keyed by (seed, purpose): ChaCha with 8 rounds. (D. J. Bernstein, 2008)

use glam::DVec3;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Purpose of a stream. Streams are independent: more features of one kind do not move the others.
///
/// The discriminants are part of the key: never reuse or renumber one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StreamPurpose {
    Relief = 1,
    Grid = 2,
    Materials = 3,
    Boulders = 4,
    Overhangs = 5,
    Walls = 6,
    Slivers = 7,
    DuplicateFaces = 8,
    ZeroAreaFaces = 9,
    UnreferencedVertices = 10,
    Diagonals = 11,
    Octaves = 12,
    Craters = 13,
    Rocks = 14,
    RockPlaces = 15,
    RockShapes = 16,
    Crevasses = 17,
    Corners = 18,
    FineOctaves = 19,
    FineDiagonals = 20,
    Rims = 21,
}

/// Random numbers of one (seed, purpose): ChaCha's key stream, read in order.
pub(crate) struct RandomStream(ChaCha8Rng);

impl RandomStream {
    pub(crate) fn new(seed: u64, purpose: StreamPurpose) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..16].copy_from_slice(&(purpose as u64).to_le_bytes());
        Self(ChaCha8Rng::from_seed(key))
    }

    /// Uniform number in [0, 1). It is a multiple of 2^-53, so the conversion is exact.
    pub(crate) fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
    }

    /// Uniform number in [low, high).
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Uniform index in 0..count: the high half of a product, with a bias below 2^-32. `count` must not be 0.
    pub(crate) fn index_below(&mut self, count: usize) -> usize {
        let count = u64::try_from(count).expect("counts of faces fit 64 bits");
        ((u128::from(self.0.next_u64()) * u128::from(count)) >> 64) as usize
    }

    /// Fair coin: true with probability 1/2.
    pub(crate) fn coin(&mut self) -> bool {
        self.0.next_u64() >> 63 == 1
    }

    /// Exponential number of mean 1: the waiting time in a Poisson process of unit rate.
    pub(crate) fn exponential(&mut self) -> f64 {
        // 1 - u lies in (0, 1]: the logarithm is finite.
        -libm::log(1.0 - self.uniform())
    }

    /// Standard normal number. (Box and Muller, 1958; the second one of each pair is dropped)
    pub(crate) fn normal(&mut self) -> f64 {
        let radius = (2.0 * self.exponential()).sqrt();
        radius * libm::cos(std::f64::consts::TAU * self.uniform())
    }

    /// Unit vector, uniform over the sphere: a random point of the unit ball, normalised. (von Neumann, 1951)
    pub(crate) fn unit_vector(&mut self) -> DVec3 {
        loop {
            let mut coordinate = || self.between(-1.0, 1.0);
            let v = DVec3::new(coordinate(), coordinate(), coordinate());
            let length_squared = v.dot(v);
            if (1e-6..=1.0).contains(&length_squared) {
                return v / length_squared.sqrt();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_differ_by_seed_and_by_purpose_only() {
        let first = |seed, purpose| RandomStream::new(seed, purpose).uniform();
        assert_eq!(first(1, StreamPurpose::Grid), first(1, StreamPurpose::Grid));
        assert_ne!(first(1, StreamPurpose::Grid), first(2, StreamPurpose::Grid));
        assert_ne!(first(1, StreamPurpose::Grid), first(1, StreamPurpose::Relief));
    }

    #[test]
    fn draws_stay_in_their_ranges() {
        let mut random = RandomStream::new(3, StreamPurpose::Grid);
        for _ in 0..10_000 {
            assert!((0.0..1.0).contains(&random.uniform()));
            assert!((-2.0..5.0).contains(&random.between(-2.0, 5.0)));
            assert!(random.index_below(3) < 3);
            assert!(random.exponential() >= 0.0);
            assert!(random.normal().is_finite());
            assert!((random.unit_vector().length() - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn a_coin_is_fair() {
        // 5000 of 10,000, with a standard deviation of 50.
        let mut random = RandomStream::new(4, StreamPurpose::Grid);
        let heads = (0..10_000).filter(|_| random.coin()).count();
        assert!(heads.abs_diff(5000) < 200, "{heads}");
    }

    #[test]
    fn waits_and_gaussians_have_their_moments() {
        // The mean of n = 1e5 draws of a quantity of variance v has the standard error sqrt(v / n). The variances
        // are 1 and 20 for the exponential x and x^2 (moments n!), and 1, 2 and 96 for the Gaussian x, x^2 and
        // x^4. The bound is 4 standard errors.
        let mut random = RandomStream::new(5, StreamPurpose::Octaves);
        let mut sums = [0.0; 5];
        for _ in 0..100_000 {
            let (wait, x) = (random.exponential(), random.normal());
            for (sum, term) in sums.iter_mut().zip([wait, wait * wait, x, x * x, x * x * x * x]) {
                *sum += term / 1e5;
            }
        }
        let expected = [(1.0, 1.0), (2.0, 20.0), (0.0, 1.0), (1.0, 2.0), (3.0, 96.0)];
        for (sum, (mean, variance)) in sums.into_iter().zip(expected) {
            let z: f64 = (sum - mean) / f64::sqrt(variance / 1e5);
            assert!(z.abs() < 4.0, "{sum} for {mean}: {z} standard errors");
        }
    }
}
