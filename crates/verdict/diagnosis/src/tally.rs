//! What a reason explains and what it breaks, and when that is enough.

/// A reason leaves at most one in so many of the wrong rays wrong, and breaks no more right ones than that. Tuned: rays
/// near an edge may differ twice.
pub(crate) const LEFT_ONE_IN: u64 = 50;

/// Wrong rays, at least, from which a reason is found.
///
/// A wrong ray agrees by chance once in four times at most: that is so of faces alone, where four neighbours are near; of
/// lengths it is one in thousands. Fewer than 2^14 reasons are tried, pairs among them. So twelve wrong rays that all
/// agree by chance are found in one recording of 4^12 / 2^14 = 1,024 at most.
pub(crate) const MIN_WRONG_RAYS: u64 = 12;

/// The same for a reason that another sensor's rays gave: it alone is tried, and 4^5 is as much.
pub(crate) const MIN_CONFIRMING_RAYS: u64 = 5;

/// Rays that were tried: how many of the wrong ones a reason explains, and how many of the right ones it breaks.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Tally {
    pub(crate) explained: u64,
    pub(crate) wrong: u64,
    pub(crate) broken: u64,
    pub(crate) right: u64,
}

impl Tally {
    /// Whether it is enough, of so many wrong and right rays in all, of which these were tried.
    pub(crate) fn is_enough(&self, least: u64, [all_wrong, all_right]: [u64; 2]) -> bool {
        let left = self.wrong - self.explained;
        let broken = u128::from(self.broken) * u128::from(all_right.max(self.right));
        self.wrong >= least
            && left * LEFT_ONE_IN <= self.wrong
            && broken * u128::from(LEFT_ONE_IN) <= u128::from(all_wrong) * u128::from(self.right)
    }

    /// Rays that are on the wrong side after it, of those that were tried.
    pub(crate) fn off(&self) -> u64 {
        self.wrong - self.explained + self.broken
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mistake_is_told_at_each_limit_and_not_beyond() {
        // Of 100 wrong rays and 1000 right ones.
        let is_enough = |wrong: u64, left: u64, broken: u64| {
            let tally = Tally { wrong, explained: wrong - left, broken, right: 1000 };
            tally.is_enough(MIN_WRONG_RAYS, [100, 1000])
        };
        assert!(is_enough(12, 0, 0) && !is_enough(11, 0, 0));
        // One wrong ray in fifty may stay wrong.
        assert!(is_enough(50, 1, 0) && !is_enough(49, 1, 0));
        // As many right rays may break: one for fifty wrong ones.
        assert!(is_enough(50, 0, 2) && !is_enough(50, 0, 3));
    }
}
