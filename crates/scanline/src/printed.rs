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
#[path = "../tests/unit/printed.rs"]
mod tests;
