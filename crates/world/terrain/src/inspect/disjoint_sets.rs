//! Disjoint sets whose members are the same as or opposite to their root: union-find with parity. (Tarjan 1975,
//! with a sign on each link)

/// Disjoint sets. The root of a set is its lowest number.
pub(super) struct DisjointSets {
    links: Vec<u32>,
    /// Whether each member is opposite to the target of its link.
    opposite: Vec<bool>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum UnionOutcome {
    /// Two sets became one.
    Merged,
    /// Both were in one set already, with the relation asked for.
    Consistent,
    /// Both were in one set already, with the other relation.
    Contradictory,
}

impl DisjointSets {
    pub(super) fn new(count: usize) -> Self {
        let links = (0..count).map(|number| u32::try_from(number).expect("fewer than 2^32")).collect();
        Self { links, opposite: vec![false; count] }
    }

    /// Root of a number's set, and whether the number is opposite to the root.
    pub(super) fn find(&mut self, number: u32) -> (u32, bool) {
        let (mut root, mut opposite) = (number, false);
        while self.links[root as usize] != root {
            opposite ^= self.opposite[root as usize];
            root = self.links[root as usize];
        }
        // Path compression: every member on the way links straight to the root.
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

    /// Joins two sets so that `a` is opposite to `b`, or the same.
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
    fn parity_is_kept_along_chains() {
        // The chain 4 - 3 - 2 - 1 - 0, each opposite to the next: even numbers are the same as 0, odd ones
        // opposite.
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
