//! Things that hang together, and whether each is like or unlike the first of its kind. (Union-find with parity:
//! Tarjan 1975, with the sign of each link.)

/// Disjoint sets. The lowest number of a set is its root.
pub(super) struct DisjointSets {
    links: Vec<u32>,
    /// Whether each is unlike what its link leads to.
    opposite: Vec<bool>,
}

/// What came of joining two.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum UnionOutcome {
    /// Two sets have become one.
    Merged,
    /// They were in one set, and as like or unlike as was asked for.
    Consistent,
    /// They were in one set, and not so.
    Contradictory,
}

impl DisjointSets {
    pub(super) fn new(count: usize) -> Self {
        let links = (0..count).map(|number| u32::try_from(number).expect("fewer than 2^32")).collect();
        Self { links, opposite: vec![false; count] }
    }

    /// The root of a number's set, and whether the number is unlike the root.
    pub(super) fn find(&mut self, number: u32) -> (u32, bool) {
        let (mut root, mut opposite) = (number, false);
        while self.links[root as usize] != root {
            opposite ^= self.opposite[root as usize];
            root = self.links[root as usize];
        }
        // Once more, so that all on the way lead straight to the root.
        let (mut at, mut rest) = (number, opposite);
        while self.links[at as usize] != root && at != root {
            let (next, step) = (self.links[at as usize], self.opposite[at as usize]);
            self.links[at as usize] = root;
            self.opposite[at as usize] = rest;
            rest ^= step;
            at = next;
        }
        (root, opposite)
    }

    /// Puts two sets together, such that `a` is unlike `b` or not.
    pub(super) fn union(&mut self, a: u32, b: u32, opposite: bool) -> UnionOutcome {
        let ((root_a, of_a), (root_b, of_b)) = (self.find(a), self.find(b));
        let between = of_a ^ of_b ^ opposite;
        if root_a == root_b {
            return if between { UnionOutcome::Contradictory } else { UnionOutcome::Consistent };
        }
        let (low, high) = (root_a.min(root_b), root_a.max(root_b));
        self.links[high as usize] = low;
        self.opposite[high as usize] = between;
        UnionOutcome::Merged
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn likeness_is_kept_along_chains() {
        // 4 - 3 - 2 - 1 - 0, each unlike the next: even numbers are like 0, odd ones unlike.
        let mut sets = DisjointSets::new(6);
        for number in (1..5).rev() {
            assert_eq!(sets.union(number, number - 1, true), UnionOutcome::Merged);
        }
        for number in [4, 2, 3, 1, 0, 4] {
            assert_eq!(sets.find(number), (0, number % 2 == 1));
        }
        assert_eq!(sets.find(5), (5, false));
        assert_eq!(sets.union(4, 1, true), UnionOutcome::Consistent);
        assert_eq!(sets.union(4, 2, true), UnionOutcome::Contradictory);
    }
}
