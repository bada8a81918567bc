//! Step 4a: a projected triangle as two triangles with a common horizontal side, and the span that a row cuts from
//! it. (§4, figures 4 and 5)
//!
//! Why no cell slips between two faces: the crossing of a row with a side is computed from that side alone, from its
//! ends in one order (that of their positions in the scene). So both faces that share the side get the same bits x.
//! The sides that a row crosses in a sheet of faces cut the row into intervals [x_0, x_1], [x_1, x_2], ... These leave
//! out no number between the first and the last x, even if rounding has put some of the x in the wrong order.
//! Corners are compared with the row in the same way in every face. In a row exactly through the middle corner, both
//! halves of the triangle count.

use crate::spp::{ProjectedLine, SppPoint};

/// One side of a projected triangle.
#[derive(Debug, Clone, Copy)]
struct Side<L> {
    top: SppPoint,
    bottom: SppPoint,
    line: L,
}

impl<L: ProjectedLine> Side<L> {
    /// The x at which the row at `y`, from the top to the bottom of this side, crosses it.
    #[inline]
    fn crossing(&self, y: f64) -> f64 {
        if y == self.top.y {
            return self.top.x;
        }
        if y == self.bottom.y {
            return self.bottom.x;
        }
        // Between its ends a side is monotonic in both transformations. Rounding may overshoot where it runs almost
        // along the row. `max` and `min` return the other operand for a NaN.
        let (left, right) = if self.top.x <= self.bottom.x {
            (self.top.x, self.bottom.x)
        } else {
            (self.bottom.x, self.top.x)
        };
        self.line.x_at(y).max(left).min(right)
    }

    /// Bounds of the crossings of all rows from `low` to `high`; `None` if no such row crosses this side. For the
    /// camera's straight lines only.
    ///
    /// The bounds are exact, without a margin for rounding. The crossing of such a line is monotonic in y *as it is
    /// computed*, because its product, sum and quotient are. The exception is a line that runs along the rows; its
    /// crossings are not finite.
    fn crossing_bounds(&self, low: f64, high: f64) -> Option<(f64, f64)> {
        let (low, high) = (low.max(self.top.y), high.min(self.bottom.y));
        if low > high {
            return None;
        }
        let (left, right) = (self.top.x.min(self.bottom.x), self.top.x.max(self.bottom.x));
        let (at_low, at_high) = (self.line.x_at(low), self.line.x_at(high));
        if !(at_low.is_finite() && at_high.is_finite()) {
            return Some((left, right));
        }
        let (at_low, at_high) = (at_low.clamp(left, right), at_high.clamp(left, right));
        let mut bounds = (at_low.min(at_high), at_low.max(at_high));
        for end in [self.top, self.bottom] {
            if low <= end.y && end.y <= high {
                bounds = (bounds.0.min(end.x), bounds.1.max(end.x));
            }
        }
        Some(bounds)
    }
}

/// A triangle on the SPP, split at the height of its middle corner. (§4, 4a)
#[derive(Debug, Clone, Copy)]
pub(crate) struct SplitTriangle<L> {
    /// From the top corner to the bottom corner.
    long: Side<L>,
    /// From the top corner to the middle one.
    upper: Side<L>,
    /// From the middle corner to the bottom one.
    lower: Side<L>,
}

impl<L: ProjectedLine> SplitTriangle<L> {
    /// Splits the triangle of three corners. `lines[k]` joins corner k to corner k + 1.
    #[inline]
    pub(crate) fn new(corners: [SppPoint; 3], lines: [L; 3]) -> Self {
        let [mut top, mut middle, mut bottom] = [0, 1, 2];
        if corners[middle].y < corners[top].y {
            (top, middle) = (middle, top);
        }
        if corners[bottom].y < corners[middle].y {
            (middle, bottom) = (bottom, middle);
        }
        if corners[middle].y < corners[top].y {
            (top, middle) = (middle, top);
        }
        // The line between corners m and n has the index of the corner that comes first in the cycle.
        let line = |m: usize, n: usize| if (m + 1) % 3 == n { lines[m] } else { lines[n] };
        let side = |m: usize, n: usize| Side { top: corners[m], bottom: corners[n], line: line(m, n) };
        Self { long: side(top, bottom), upper: side(top, middle), lower: side(middle, bottom) }
    }

    /// y of the top corner, metres.
    pub(crate) fn top(&self) -> f64 {
        self.long.top.y
    }

    /// y of the bottom corner, metres.
    pub(crate) fn bottom(&self) -> f64 {
        self.long.bottom.y
    }

    /// The closed interval of x that the row at `y`, from top to bottom, cuts from the triangle.
    #[inline]
    pub(crate) fn span(&self, y: f64) -> (f64, f64) {
        let x = self.long.crossing(y);
        let (mut left, mut right) = (x, x);
        if y <= self.upper.bottom.y {
            let x = self.upper.crossing(y);
            (left, right) = (left.min(x), right.max(x));
        }
        if y >= self.lower.top.y {
            let x = self.lower.crossing(y);
            (left, right) = (left.min(x), right.max(x));
        }
        (left, right)
    }

    /// Bounds of the spans of all rows from `low` to `high`; the first exceeds the second if no such row meets the
    /// triangle. For the camera's straight lines only.
    pub(crate) fn span_bounds(&self, low: f64, high: f64) -> (f64, f64) {
        let sides = [&self.long, &self.upper, &self.lower];
        let crossings = sides.into_iter().filter_map(|side| side.crossing_bounds(low, high));
        crossings.fold((f64::INFINITY, f64::NEG_INFINITY), |bounds, (left, right)| {
            (bounds.0.min(left), bounds.1.max(right))
        })
    }
}

#[cfg(test)]
#[path = "../tests/unit/scan.rs"]
mod tests;
