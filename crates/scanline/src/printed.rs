//! `skip-rules = paper`: the skip rules of §4 word by word. Their conservative forms are in `skip`.
//!
//! | rule | as printed | what it costs |
//! | --- | --- | --- |
//! | 1a | "all vertices in front of the SPP" | nothing: the half-space in front is convex, so it holds the whole face |
//! | 1b | "the back side of the triangle is facing the sensor" | camera: nothing, all its rays start in one point. Beam: see below |
//! | 3a | "all the vertices are to the left, right, above, or below the SS" | nothing: each is a half-space (a plane through the projection centre or the focal axis, y = const for a beam's rows), which is convex |
//! | 3b | "all the vertices are in the SS but their range exceeds the maximum range of the sensor" | faces whose interior is nearer than their vertices |
//! | 3c | "none of the vertices or the sides of the triangle intersect the SS and the center point of the SS is not in the triangle" | camera: nothing, its sides are straight: a screen that no side meets lies in the triangle with its centre, or not at all. Beam: faces whose curved sides come into the screen where the straight ones do not |
//!
//! **1b for a beam** is one decision for a face, taken from the origin (0, 0, 0) of the beam's frame: the
//! range map's faces "are" those that show that point their front. It therefore replaces the question that
//! every row asks in the exact form, and errs where the plane of a face passes between the middle of the
//! sheet and a row's own origin (0, y, 0). It *loses* the front that such a row sees while the middle sees
//! the back, and it *adds* the back that such a row sees while the middle sees the front. An added back is
//! scanned like any face: it may hide a true hit behind it, and its cosine of incidence is negative.
//!
//! CHOICE: rules 3 are asked of the triangles that clipping leaves (`clip`, `stripe`), each by itself, not of
//! whole faces: §5 clips before it transforms, §4 transforms before it asks, and only what clipping leaves
//! has a projection at all: a vertex behind the SPP has none. Hence, if a beam's faces are clipped to the
//! stripe (`beam-edges = paper`), all vertices are in the SS: 3a and 3c skip nothing more, and 3b is asked of
//! every face.
//!
//! CHOICE: the SS is closed; it reaches from border to border, half a cell beyond the outermost centres.

use crate::scan::Corner;
use crate::tables::Axis;

/// The sensor screen, SS.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Screen {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

impl Screen {
    pub(crate) fn new(columns: &Axis, rows: &Axis) -> Self {
        let ([left, right], [top, bottom]) = (columns.borders(), rows.borders());
        Self { left, right, top, bottom }
    }

    /// Whether rules 3 skip a triangle of these projected vertices; `too_far` says of a vertex whether its
    /// range exceeds the maximum.
    pub(crate) fn skips(&self, corners: &[Corner; 3], too_far: impl Fn(usize) -> bool) -> bool {
        self.is_beside(corners) || self.is_in_but_too_far(corners, too_far) || self.is_apart(corners)
    }

    /// 3a: all the vertices are to the left, right, above, or below the SS.
    fn is_beside(&self, corners: &[Corner; 3]) -> bool {
        corners.iter().all(|corner| corner.x < self.left)
            || corners.iter().all(|corner| corner.x > self.right)
            || corners.iter().all(|corner| corner.y < self.top)
            || corners.iter().all(|corner| corner.y > self.bottom)
    }

    /// 3b: all the vertices are in the SS but their range exceeds the maximum range of the sensor.
    fn is_in_but_too_far(&self, corners: &[Corner; 3], too_far: impl Fn(usize) -> bool) -> bool {
        corners.iter().all(|corner| self.holds(corner)) && (0..3).all(too_far)
    }

    /// 3c: none of the vertices or the sides of the triangle intersect the SS and the center point of the SS
    /// is not in the triangle.
    fn is_apart(&self, corners: &[Corner; 3]) -> bool {
        let [a, b, c] = corners;
        let centre = Corner { x: 0.5 * (self.left + self.right), y: 0.5 * (self.top + self.bottom) };
        !corners.iter().any(|corner| self.holds(corner))
            && ![(a, b), (b, c), (c, a)].iter().any(|(from, to)| self.meets_side(from, to))
            && !is_within(&centre, corners)
    }

    fn holds(&self, p: &Corner) -> bool {
        self.left <= p.x && p.x <= self.right && self.top <= p.y && p.y <= self.bottom
    }

    /// Whether the straight side between two points intersects the SS: neither an axis of the screen nor the
    /// side itself separates them.
    fn meets_side(&self, from: &Corner, to: &Corner) -> bool {
        if from.x.max(to.x) < self.left
            || from.x.min(to.x) > self.right
            || from.y.max(to.y) < self.top
            || from.y.min(to.y) > self.bottom
        {
            return false;
        }
        let beyond = |x: f64, y: f64| turn(from, to, &Corner { x, y });
        let beyond = [
            beyond(self.left, self.top),
            beyond(self.right, self.top),
            beyond(self.right, self.bottom),
            beyond(self.left, self.bottom),
        ];
        !beyond.iter().all(|side| *side > 0.0) && !beyond.iter().all(|side| *side < 0.0)
    }
}

/// Twice the signed area of a, b, c.
fn turn(a: &Corner, b: &Corner, c: &Corner) -> f64 {
    (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
}

/// Whether a point is in a closed triangle, whichever way round that runs.
fn is_within(p: &Corner, [a, b, c]: &[Corner; 3]) -> bool {
    let turns = [turn(a, b, p), turn(b, c, p), turn(c, a, p)];
    turns.iter().all(|turn| *turn >= 0.0) || turns.iter().all(|turn| *turn <= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The square from -1 to 1.
    fn screen() -> Screen {
        Screen::new(&Axis::of_grid(4, 1.0), &Axis::of_grid(4, 1.0))
    }

    fn corners(points: [[f64; 2]; 3]) -> [Corner; 3] {
        points.map(|[x, y]| Corner { x, y })
    }

    #[test]
    fn rule_3a_wants_all_vertices_on_one_side() {
        // All left of -1; all above -1.
        assert!(screen().is_beside(&corners([[-2.0, 0.0], [-1.1, 5.0], [-9.0, -5.0]])));
        assert!(screen().is_beside(&corners([[-2.0, -1.1], [0.0, -3.0], [5.0, -2.0]])));
        // None in the screen, but not all on *one* side. A vertex on the border is not beside it.
        assert!(!screen().is_beside(&corners([[-2.0, 0.0], [0.0, -2.0], [-2.0, -2.0]])));
        assert!(!screen().is_beside(&corners([[-2.0, 0.0], [-1.0, 5.0], [-9.0, -5.0]])));
    }

    /// From -1 to 3 and from -2 to 4, its centre at (1, 1).
    fn oblong() -> Screen {
        Screen::new(&Axis::of_pixels(4, 1.0, 1.0), &Axis::of_pixels(6, 2.0, 1.0))
    }

    #[test]
    fn every_side_of_the_screen_counts_and_borders_belong_to_it() {
        // A triangle around the middle of each side, its nearest vertex beyond the border, on it, and within.
        for (step, beside) in [(1e-9, true), (0.0, false), (-1e-9, false)] {
            let left = [[-1.0 - step, 1.0], [-2.0, 0.0], [-2.0, 2.0]];
            let right = [[3.0 + step, 1.0], [4.0, 0.0], [4.0, 2.0]];
            let above = [[1.0, -2.0 - step], [0.0, -3.0], [2.0, -3.0]];
            let below = [[1.0, 4.0 + step], [0.0, 5.0], [2.0, 5.0]];
            for triangle in [left, right, above, below] {
                assert_eq!(oblong().is_beside(&corners(triangle)), beside, "{triangle:?}");
                assert_eq!(oblong().is_apart(&corners(triangle)), beside, "{triangle:?}");
            }
        }
    }

    #[test]
    fn a_side_whose_line_crosses_the_screen_may_end_before_it() {
        let meets = |from: [f64; 2], to: [f64; 2]| {
            let [from, to] = [from, to].map(|[x, y]| Corner { x, y });
            (oblong().meets_side(&from, &to), oblong().meets_side(&to, &from))
        };
        for (from, to) in [
            ([0.9, -9.0], [1.0, -2.1]),
            ([1.0, 4.1], [0.9, 9.0]),
            ([-9.0, 0.9], [-1.1, 1.0]),
            ([3.1, 1.0], [9.0, 0.9]),
        ] {
            assert_eq!(meets(from, to), (false, false), "{from:?} {to:?}");
        }
        // On to the border and beyond.
        for (from, to) in [
            ([0.9, -9.0], [1.0, -2.0]),
            ([1.0, 4.0], [0.9, 9.0]),
            ([-9.0, 0.9], [9.0, 1.0]),
            ([-2.0, 3.0], [1.0, 5.0]),
        ] {
            assert_eq!(meets(from, to), (true, true), "{from:?} {to:?}");
        }
        // Past the corner (-1, 4) on the outer side: 3.9 + 1.5 (x + 2) > 4 + ... at x = -1 it is at y = 5.4.
        assert_eq!(meets([-2.0, 3.9], [1.0, 8.4]), (false, false));
    }

    #[test]
    fn the_centre_of_the_screen_is_its_own() {
        // Each holds the screen and little to its left or above it.
        assert!(!oblong().is_apart(&corners([[-1.2, -20.0], [-1.2, 20.0], [30.0, 0.0]])));
        assert!(!oblong().is_apart(&corners([[-20.0, -2.5], [20.0, -2.5], [0.0, 40.0]])));
    }

    #[test]
    fn rule_3b_wants_all_vertices_in_the_screen_and_all_too_far() {
        let within = corners([[-1.0, -1.0], [1.0, 0.0], [0.0, 0.5]]);
        assert!(screen().is_in_but_too_far(&within, |_| true));
        assert!(!screen().is_in_but_too_far(&within, |k| k != 1));
        let across = corners([[-1.0, -1.0], [1.1, 0.0], [0.0, 0.5]]);
        assert!(!screen().is_in_but_too_far(&across, |_| true));
    }

    #[test]
    fn rule_3c_tells_triangles_apart_from_the_screen() {
        // Beyond the corner (1, 1): the side from (3, 0) to (0, 3) passes at x + y = 3 > 2, both borders' reach.
        assert!(screen().is_apart(&corners([[3.0, 0.0], [0.0, 3.0], [3.0, 3.0]])));
        // x + y = 1.9 cuts the corner off.
        assert!(!screen().is_apart(&corners([[1.9, 0.0], [0.0, 1.9], [3.0, 3.0]])));
        let cut = corners([[3.0, -1.1], [-1.1, 3.0], [3.0, 3.0]]);
        assert!(!cut.iter().any(|corner| screen().holds(corner)));
        assert!(!screen().is_apart(&cut));
        // Around the whole screen: no vertex or side meets it, its centre decides. Either way round.
        let around = [[-9.0, -3.0], [9.0, -3.0], [0.0, 9.0]];
        assert!(!screen().is_apart(&corners(around)));
        assert!(!screen().is_apart(&corners([around[1], around[0], around[2]])));
    }
}
