//! The unit square of displacements, subdivide where a margin cannot be told from its middle alone.
//!
//! The square is cut in four, and each part again, where it cannot be proven to be without a change from its own
//! middle. The parts are closed and cover the square; taken in the order of their distance from the ray, by the
//! larger of |dx| and |dy|, all nearer ones than the first unproven one are proven. So its distance is a lo.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::displacement::max_norm;

/// Parts that are looked at before the division gives up. CHOICE: a line across the square passes through a few
/// parts of each size on its way to where it is nearest, so that tens are enough for any of the 40 sizes; an edge
/// hidden closely behind a surface has to be followed with parts as small as it is close, which may take thousands. At
/// 2 to 7 microseconds each this bounds a single ray to less than a tenth of a second.
const MAX_SQUARES: u32 = 10_000;

/// Half sides below this, in cells, are not subdivide: the parts could only stay unproven.
const MIN_HALF_SIDE_CELLS: f64 = 1.0 / (1u64 << 40) as f64;

/// A part of the unit square. Its numbers are multiples of its half side, at most 1: exact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Square {
    pub(crate) middle: [f64; 2],
    pub(crate) half: f64,
}

impl Square {
    /// Its distance from the ray.
    fn nearest(&self) -> f64 {
        let [x, y] = self.middle.map(|part| (part.abs() - self.half).max(0.0));
        x.max(y)
    }

    fn farthest(&self) -> f64 {
        max_norm(self.middle) + self.half
    }

    pub(crate) fn corners(&self) -> [[f64; 2]; 4] {
        let h = self.half;
        [[-h, -h], [h, -h], [h, h], [-h, h]].map(|[x, y]| [self.middle[0] + x, self.middle[1] + y])
    }

    fn parts(&self) -> [Self; 4] {
        let half = 0.5 * self.half;
        Self { half, ..*self }.corners().map(|middle| Self { middle, half })
    }
}

/// Whether a witness is near enough: less than twice lo, with room for rounding.
pub(crate) fn is_tight(lo: f64, witness: Option<[f64; 2]>) -> bool {
    witness.is_some_and(|at| max_norm(at) <= 1.9 * lo || max_norm(at) <= 1e-9)
}

/// Divides the square, whose part within `lo` is proven, until the first part that cannot be proven is no nearer
/// than half the nearest witness.
///
/// `look` is asked about a part, and how far all is proven: `None` if the part is proven as well, else perhaps a
/// witness in it.
pub(crate) fn subdivide(
    mut lo: f64,
    mut witness: Option<[f64; 2]>,
    mut look: impl FnMut(&Square, f64) -> Option<Option<[f64; 2]>>,
) -> (f64, Option<[f64; 2]>) {
    let mut squares = vec![Square { middle: [0.0; 2], half: 1.0 }];
    // By distance, then by age: the same order everywhere. The bits of numbers that are not negative are in the
    // order of the numbers.
    let mut waiting = BinaryHeap::from([Reverse((0.0_f64.to_bits(), 0))]);
    let mut looked = 0;
    while let Some(Reverse((bits, index))) = waiting.pop() {
        let square = squares[index];
        lo = lo.max(f64::from_bits(bits));
        if is_tight(lo, witness) || looked == MAX_SQUARES {
            return (lo, witness);
        }
        if square.farthest() <= lo {
            continue;
        }
        looked += 1;
        let Some(found) = look(&square, lo) else { continue };
        if let Some(at) = found
            && witness.is_none_or(|best| max_norm(at) < max_norm(best))
        {
            witness = Some(at);
        }
        if square.half < MIN_HALF_SIDE_CELLS {
            return (lo, witness);
        }
        for part in square.parts() {
            waiting.push(Reverse((part.nearest().to_bits(), squares.len())));
            squares.push(part);
        }
    }
    // All of it is proven.
    (1.0, None)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Divides where the change is known: a part is proven if it certainly has none of it, a witness is a corner
    /// or the middle.
    fn margin(changed: impl Fn([f64; 2]) -> bool, free: impl Fn(&Square) -> bool) -> (f64, Option<f64>) {
        let (lo, witness) = subdivide(0.0, None, |square, _| {
            if free(square) {
                return None;
            }
            let places = square.corners().into_iter().chain([square.middle]).filter(|&at| changed(at));
            Some(places.min_by(|a, b| max_norm(*a).total_cmp(&max_norm(*b))))
        });
        (lo, witness.map(max_norm))
    }

    /// The distance of a square from a point, by the larger of both parts.
    fn apart(square: &Square, point: [f64; 2]) -> f64 {
        max_norm([square.middle[0] - point[0], square.middle[1] - point[1]]) - square.half
    }

    #[test]
    fn a_speck_is_found_and_never_passed_over() {
        // A square speck with a half side of 1/1024, its middle 0.37 away: the change begins at 0.37 - 1/1024.
        let (speck, small) = ([0.37, -0.21], 1.0 / 1024.0);
        let begins = 0.37 - small;
        let (lo, hi) = margin(
            |at| max_norm([at[0] - speck[0], at[1] - speck[1]]) <= small,
            |square| apart(square, speck) > small,
        );
        let hi = hi.expect("found");
        assert!(lo <= begins && begins <= hi && hi <= 1.9 * lo, "{lo} {hi}");
    }

    #[test]
    fn what_cannot_be_proven_bounds_lo_without_a_witness() {
        // A single point at which nothing changes, but which nothing proves either.
        let point = [-0.3, 0.6];
        let (lo, hi) = margin(|_| false, |square| apart(square, point) > 0.0);
        assert!(hi.is_none() && lo <= 0.6 && lo > 0.6 - 1e-9, "{lo}");
    }

    #[test]
    fn nothing_to_be_found_is_the_cap() {
        assert_eq!(margin(|_| false, |square| square.half <= 0.25), (1.0, None));
    }
}
