//! The ray that represents a pencil: its central ray, or one drawn within it. The draw is a definition, so that
//! every renderer draws the same ray.

/// How pencils are sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sampling {
    /// Their central rays.
    #[default]
    Centres,
    /// One ray in each pencil's cell of the grid, uniform over it. alpha and y are that ray's.
    Jittered {
        /// Seed of the draws; other seeds give other rays.
        seed: u64,
    },
}

impl Sampling {
    /// Displacement of the ray of pencil (i, j) of a beam from the centre of its cell: columns to the right and
    /// rows down, in cells, each in [-1/2, 1/2).
    ///
    /// Jittered: the first two words of Philox4x32-10 of key (seed) and counter (i, j, beam, 0), each an odd
    /// multiple of 2^-33 after the shift, so that it is exact in `f64`.
    ///
    /// ```
    /// use raypencil_scene::Sampling;
    ///
    /// assert_eq!(Sampling::Centres.offset(0, 5, 7), [0.0, 0.0]);
    /// let jittered = Sampling::Jittered { seed: 1 };
    /// // The same pencil has the same ray in every renderer; its neighbour has another one.
    /// assert_eq!(jittered.offset(0, 5, 7), jittered.offset(0, 5, 7));
    /// assert_ne!(jittered.offset(0, 5, 7), jittered.offset(0, 6, 7));
    /// ```
    pub fn offset(&self, beam: usize, i: u32, j: u32) -> [f64; 2] {
        let Self::Jittered { seed } = *self else { return [0.0; 2] };
        let [x, y, _, _] = philox([i, j, beam as u32, 0], [seed as u32, (seed >> 32) as u32]);
        [x, y].map(|word| (f64::from(word) + 0.5) * (1.0 / (1_u64 << 32) as f64) - 0.5)
    }
}

/// Philox4x32 with ten rounds: random words as a function of a counter and a key. (J. Salmon, M. Moraes,
/// R. Dror and D. Shaw, "Parallel random numbers: as easy as 1, 2, 3", 2011)
pub fn philox(mut counter: [u32; 4], mut key: [u32; 2]) -> [u32; 4] {
    let product = |a: u32, b: u32| {
        let product = u64::from(a) * u64::from(b);
        ((product >> 32) as u32, product as u32)
    };
    for _ in 0..10 {
        let (high_0, low_0) = product(0xd251_1f53, counter[0]);
        let (high_1, low_1) = product(0xcd9e_8d57, counter[2]);
        counter = [high_1 ^ counter[1] ^ key[0], low_1, high_0 ^ counter[3] ^ key[1], low_0];
        key = [key[0].wrapping_add(0x9e37_79b9), key[1].wrapping_add(0xbb67_ae85)];
    }
    counter
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn philox_gives_its_authors_vectors() {
        // From the known answers of Random123.
        assert_eq!(philox([0; 4], [0; 2]), [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]);
        assert_eq!(
            philox([u32::MAX; 4], [u32::MAX; 2]),
            [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]
        );
        assert_eq!(
            philox([0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344], [0xa409_3822, 0x299f_31d0]),
            [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1]
        );
    }

    #[test]
    fn offsets_fill_the_cell_evenly() {
        assert_eq!(Sampling::Centres.offset(1, 2, 3), [0.0, 0.0]);
        let jittered = Sampling::Jittered { seed: 7 };
        let mut quarters = [0_u32; 4];
        for i in 0..1000 {
            let [x, y] = jittered.offset(0, i, 5);
            assert!((-0.5..0.5).contains(&x) && (-0.5..0.5).contains(&y));
            quarters[usize::from(x < 0.0) + 2 * usize::from(y < 0.0)] += 1;
        }
        // 250 each, standard deviation sqrt(1000 3/16) = 13.7.
        assert!(quarters.iter().all(|count| count.abs_diff(250) < 69), "{quarters:?}");
        assert_ne!(jittered.offset(0, 1, 2), jittered.offset(1, 1, 2));
        assert_ne!(jittered.offset(0, 1, 2), Sampling::Jittered { seed: 8 }.offset(0, 1, 2));
    }
}
