//! Unit tests of `scan`: spans and their bounds.

use super::*;
use proptest::prelude::*;

/// A line n_x x + n_y y + c = 0, computed like the camera's lines.
#[derive(Debug, Clone, Copy)]
struct Straight([f64; 3]);

impl ProjectedLine for Straight {
    fn x_at(&self, y: f64) -> f64 {
        -(self.0[1] * y + self.0[2]) / self.0[0]
    }
}

fn triangle(points: [[f64; 2]; 3]) -> SplitTriangle<Straight> {
    let line = |[x, y]: [f64; 2], [x2, y2]: [f64; 2]| Straight([y2 - y, x - x2, x2 * y - x * y2]);
    let [a, b, c] = points;
    let corners = points.map(|[x, y]| SppPoint { x, y });
    SplitTriangle::new(corners, [line(a, b), line(b, c), line(c, a)])
}

proptest! {
    // Also for triangles as flat as rounding: the corners' y in steps of 2^-52 from 1.
    #[test]
    fn no_span_leaves_the_bounds_of_its_rows(
        x in [-1.0f64..1.0, -1.0..1.0, -1.0..1.0],
        y in [0u32..9, 0u32..9, 0u32..9],
        step in prop_oneof![Just(f64::EPSILON), Just(1e-3), Just(0.3)],
        rows in (-0.1f64..1.1, -0.1f64..1.1),
        at in 0.0f64..1.0,
    ) {
        let y = y.map(|steps| 1.0 + f64::from(steps) * step);
        let triangle = triangle([[x[0], y[0]], [x[1], y[1]], [x[2], y[2]]]);
        let height = |part: f64| 1.0 + part * 9.0 * step;
        let (low, high) = (height(rows.0.min(rows.1)), height(rows.0.max(rows.1)));
        let (left, right) = triangle.span_bounds(low, high);
        for y in [low, high, low + at * (high - low), triangle.top(), triangle.bottom(), y[0], y[1], y[2]] {
            if y < low || y > high || y < triangle.top() || y > triangle.bottom() {
                continue;
            }
            let span = triangle.span(y);
            prop_assert!(left <= span.0 && span.1 <= right, "{span:?} {left} {right}");
        }
    }
}

#[test]
fn the_bounds_of_a_side_are_tight() {
    // A side from (0, 0) down to (4, 8).
    let side = triangle([[0.0, 0.0], [4.0, 8.0], [10.0, 12.0]]).upper;
    for ((low, high), expected) in [
        ((2.0, 4.0), Some((1.0, 2.0))),
        ((-1.0, 4.0), Some((0.0, 2.0))),
        ((6.0, 9.0), Some((3.0, 4.0))),
        ((8.0, 9.0), Some((4.0, 4.0))),
        ((-3.0, 0.0), Some((0.0, 0.0))),
        ((-9.0, 99.0), Some((0.0, 4.0))),
        ((-3.0, -1.0), None),
        ((8.5, 9.0), None),
    ] {
        assert_eq!(side.crossing_bounds(low, high), expected, "{low} to {high}");
    }
    // A side that runs down to the left.
    let side = triangle([[4.0, 0.0], [0.0, 8.0], [10.0, 12.0]]).upper;
    assert_eq!(side.crossing_bounds(2.0, 4.0), Some((2.0, 3.0)));
    // A side along the rows: its bounds are its ends.
    let side = triangle([[1.0, 2.0], [5.0, 2.0], [3.0, 9.0]]).upper;
    assert_eq!((side.top.y, side.bottom.y), (2.0, 2.0));
    assert_eq!(side.crossing_bounds(1.0, 3.0), Some((1.0, 5.0)));
}
