//! Step 4a: a projected triangle as two triangles with a common horizontal side, and the span that a row
//! cuts from it. (§4, figures 4 and 5)
//!
//! Why no cell slips between two faces: where a row crosses a side is computed from that side alone, from
//! its ends in one order (that of their positions in the scene), so both faces that share the side get the
//! same bits x. The sides that a row crosses in a sheet of faces therefore cut it into intervals [x_0, x_1],
//! [x_1, x_2], ... that leave out no number between the first and the last x, even if rounding has put some
//! of them in the wrong order. Corners are compared with the row in the same way in every face. At a row
//! that passes exactly through the middle corner, both halves count.

/// A corner of a triangle on the SPP, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Corner {
    pub(crate) x: f64,
    pub(crate) y: f64,
}

/// The image of a straight line in space on the SPP: a straight line for the camera, a curve for a beam (or
/// what the paper draws instead, `stripe::Chord`).
pub(crate) trait Line: Copy {
    /// Where it crosses the row at `y`. May be anything, even NaN, where the line runs along the row.
    fn x_at(&self, y: f64) -> f64;
}

/// One side of a projected triangle.
#[derive(Debug, Clone, Copy)]
struct Side<L> {
    top: Corner,
    bottom: Corner,
    line: L,
}

impl<L: Line> Side<L> {
    /// Where the row at `y`, not above the top and not below the bottom, crosses this side.
    #[inline]
    fn crossing(&self, y: f64) -> f64 {
        if y == self.top.y {
            return self.top.x;
        }
        if y == self.bottom.y {
            return self.bottom.x;
        }
        // Between its ends a side is monotonic in both transformations; rounding may overshoot where it
        // runs almost along the row. `max` and `min` take the other operand for a NaN.
        let (left, right) = if self.top.x <= self.bottom.x {
            (self.top.x, self.bottom.x)
        } else {
            (self.bottom.x, self.top.x)
        };
        self.line.x_at(y).max(left).min(right)
    }

    /// Bounds of every crossing by rows from `low` to `high`; `None` if none of them crosses this side. For the
    /// camera's straight lines only.
    ///
    /// Exact ones, without room for rounding: where such a line crosses is monotonic in y *as it is computed*, its
    /// product, sum and quotient each being so; unless it runs along the rows, which shows in what is not finite.
    fn crossings(&self, low: f64, high: f64) -> Option<(f64, f64)> {
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

impl<L: Line> SplitTriangle<L> {
    /// From three corners; `lines[k]` joins corner k to corner k + 1.
    #[inline]
    pub(crate) fn new(corners: [Corner; 3], lines: [L; 3]) -> Self {
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
        // The line between corners m and n is the one that starts at the earlier of them in the cycle.
        let line = |m: usize, n: usize| if (m + 1) % 3 == n { lines[m] } else { lines[n] };
        let side = |m: usize, n: usize| Side { top: corners[m], bottom: corners[n], line: line(m, n) };
        Self { long: side(top, bottom), upper: side(top, middle), lower: side(middle, bottom) }
    }

    pub(crate) fn top(&self) -> f64 {
        self.long.top.y
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.long.bottom.y
    }

    /// The closed interval of x that the row at `y`, within top and bottom, cuts from the triangle.
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

    /// Bounds of the spans of all rows from `low` to `high`, for the camera's straight lines; the first is larger if none of them meets the triangle.
    pub(crate) fn spans(&self, low: f64, high: f64) -> (f64, f64) {
        let sides = [&self.long, &self.upper, &self.lower];
        let crossings = sides.into_iter().filter_map(|side| side.crossings(low, high));
        crossings.fold((f64::INFINITY, f64::NEG_INFINITY), |bounds, (left, right)| {
            (bounds.0.min(left), bounds.1.max(right))
        })
    }
}

#[cfg(test)]
#[path = "../tests/unit/scan.rs"]
mod tests;
