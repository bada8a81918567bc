//! Subdivision of the unit square of displacements, for margins that the square's middle alone does not prove.
//!
//! The square is cut in four, and each part again, as long as a part cannot be proven free of a change from its own
//! middle. The parts are closed and cover the square. They are taken in the order of their distance from the ray, by
//! the larger of |dx| and |dy|. So all parts nearer than the first unproven one are proven, and its distance is a
//! valid lo.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::rays::displacement::max_norm;

/// Maximum number of parts examined before the subdivision gives up. CHOICE: a line across the square crosses a few
/// parts of each size on the way to its nearest point, so tens of parts suffice for all 40 sizes. An edge hidden
/// closely behind a surface needs parts as small as its depth behind it, which may take thousands. At 2 to 7
/// microseconds each, the limit keeps a ray below a tenth of a second.
const MAX_SQUARES: u32 = 10_000;

/// Smallest half side that is divided, cells: smaller parts would stay unproven too.
const MIN_HALF_SIDE_CELLS: f64 = 1.0 / (1u64 << 40) as f64;

/// A part of the unit square. Its coordinates are multiples of its half side, at most 1: exact in f64.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Square {
    pub(crate) middle: [f64; 2],
    pub(crate) half: f64,
}

impl Square {
    /// The distance of its nearest point from the ray.
    fn nearest(&self) -> f64 {
        let [x, y] = self.middle.map(|part| (part.abs() - self.half).max(0.0));
        x.max(y)
    }

    /// The distance of its farthest point from the ray, or more.
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

/// Subdivides the unit square until the first unproven part is no nearer than half the nearest witness; returns lo
/// and the witness. All within the given `lo` is already proven.
///
/// `examine` gets a part and the current lo. It returns `None` if the part is proven, else `Some`, with a witness in
/// or near the part if it finds one.
pub(crate) fn subdivide(
    mut lo: f64,
    mut witness: Option<[f64; 2]>,
    mut examine: impl FnMut(&Square, f64) -> Option<Option<[f64; 2]>>,
) -> (f64, Option<[f64; 2]>) {
    let mut squares = vec![Square { middle: [0.0; 2], half: 1.0 }];
    // Order by distance, then by age: the same order on every machine. The bits of numbers that are not negative are
    // in the order of the numbers.
    let mut waiting = BinaryHeap::from([Reverse((0.0_f64.to_bits(), 0))]);
    let mut examined = 0;
    while let Some(Reverse((bits, index))) = waiting.pop() {
        let square = squares[index];
        lo = lo.max(f64::from_bits(bits));
        if is_tight(lo, witness) || examined == MAX_SQUARES {
            return (lo, witness);
        }
        if square.farthest() <= lo {
            continue;
        }
        examined += 1;
        let Some(found) = examine(&square, lo) else { continue };
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
    // All of the square is proven.
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
    fn parts_are_divided_down_to_the_smallest_half_side() {
        let (point, mut smallest) = ([-0.3, 0.6], 1.0_f64);
        subdivide(0.0, None, |square, _| {
            let is_unproven = apart(square, point) <= 0.0;
            is_unproven.then(|| {
                smallest = smallest.min(square.half);
                None
            })
        });
        assert_eq!(smallest, 0.5 * MIN_HALF_SIDE_CELLS);
    }

    #[test]
    fn nothing_to_be_found_is_the_cap() {
        assert_eq!(margin(|_| false, |square| square.half <= 0.25), (1.0, None));
    }
}
