//! Random numbers of a seed. (G. Steele, D. Lea and C. Flood, "Fast splittable pseudorandom number generators", 2014)

/// SplitMix64: one 64-bit number per call, the same on every machine.
pub(crate) struct SplitMix64 {
    state: u64,
}

impl SplitMix64 {
    pub(crate) fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    pub(crate) fn next_u64(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.state;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    /// A number `low + k step`, at most `high`, each k with the same probability.
    pub(crate) fn between(&mut self, low: f64, high: f64, step: f64) -> f64 {
        let steps = ((high - low) / step).round() as u64;
        low + step * (self.next_u64() % (steps + 1)) as f64
    }

    /// One of `choices`, each with the same probability.
    pub(crate) fn one_of<'a>(&mut self, choices: &[&'a str]) -> &'a str {
        choices[(self.next_u64() % choices.len() as u64) as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_of_seed_0_are_those_of_the_reference() {
        // S. Vigna's splitmix64.c, seed 0.
        let mut numbers = SplitMix64::new(0);
        let first = [(); 3].map(|()| numbers.next_u64());
        assert_eq!(first, [0xe220_a839_7b1d_cdaf, 0x6e78_9e6a_a1b9_65f4, 0x06c4_5d18_8009_454f]);
    }
}
