//! Things that hang together, and whether each is like or unlike the first of its kind. (Union-find with parity:
//! Tarjan 1975, with the sign of each link.)

/// Disjoint sets. The lowest number of a set is its root.
pub(super) struct Forest {
    links: Vec<u32>,
    /// Whether each is unlike what its link leads to.
    unlike: Vec<bool>,
}

/// What came of joining two.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Joined {
    /// Two sets have become one.
    Newly,
    /// They were in one set, and as like or unlike as was asked for.
    Already,
    /// They were in one set, and not so.
    Contradicted,
}

impl Forest {
    pub(super) fn new(count: usize) -> Self {
        let links = (0..count).map(|number| u32::try_from(number).expect("fewer than 2^32")).collect();
        Self { links, unlike: vec![false; count] }
    }

    /// The root of a number's set, and whether the number is unlike the root.
    pub(super) fn root(&mut self, number: u32) -> (u32, bool) {
        let (mut root, mut unlike) = (number, false);
        while self.links[root as usize] != root {
            unlike ^= self.unlike[root as usize];
            root = self.links[root as usize];
        }
        // Once more, so that all on the way lead straight to the root.
        let (mut at, mut rest) = (number, unlike);
        while self.links[at as usize] != root && at != root {
            let (next, step) = (self.links[at as usize], self.unlike[at as usize]);
            self.links[at as usize] = root;
            self.unlike[at as usize] = rest;
            rest ^= step;
            at = next;
        }
        (root, unlike)
    }

    /// Puts two sets together, such that `a` is unlike `b` or not.
    pub(super) fn join(&mut self, a: u32, b: u32, unlike: bool) -> Joined {
        let ((root_a, of_a), (root_b, of_b)) = (self.root(a), self.root(b));
        let between = of_a ^ of_b ^ unlike;
        if root_a == root_b {
            return if between { Joined::Contradicted } else { Joined::Already };
        }
        let (low, high) = (root_a.min(root_b), root_a.max(root_b));
        self.links[high as usize] = low;
        self.unlike[high as usize] = between;
        Joined::Newly
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn likeness_is_kept_along_chains() {
        // 4 - 3 - 2 - 1 - 0, each unlike the next: even numbers are like 0, odd ones unlike.
        let mut forest = Forest::new(6);
        for number in (1..5).rev() {
            assert_eq!(forest.join(number, number - 1, true), Joined::Newly);
        }
        for number in [4, 2, 3, 1, 0, 4] {
            assert_eq!(forest.root(number), (0, number % 2 == 1));
        }
        assert_eq!(forest.root(5), (5, false));
        assert_eq!(forest.join(4, 1, true), Joined::Already);
        assert_eq!(forest.join(4, 2, true), Joined::Contradicted);
    }
}
