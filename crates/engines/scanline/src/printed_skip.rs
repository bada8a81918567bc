//! `skip-rules = paper`: the skip rules of §4 word by word. Their conservative forms are in `skip`.
//!
//! | rule | as printed | what it costs |
//! | --- | --- | --- |
//! | 1a | "all vertices in front of the SPP" | nothing: the half-space in front is convex, so it contains the whole face |
//! | 1b | "the back side of the triangle is facing the sensor" | camera: nothing, since all its rays start in one point. Beam: see below |
//! | 3a | "all the vertices are to the left, right, above, or below the SS" | nothing: each is a half-space, which is convex (bounded by a plane through the projection centre or the focal axis, or by y = const for a beam's rows) |
//! | 3b | "all the vertices are in the SS but their range exceeds the maximum range of the sensor" | faces whose interior is nearer than their vertices |
//! | 3c | "none of the vertices or the sides of the triangle intersect the SS and the center point of the SS is not in the triangle" | camera: nothing. Its sides are straight, so a screen that no side meets is in the triangle, with its centre, or apart from it. Beam: faces whose curved sides enter the screen where the straight ones do not |
//!
//! **1b for a beam** is one decision per face, taken from the origin (0, 0, 0) of the beam's frame: a face is scanned
//! if it shows that point its front. It replaces the test that the exact form makes for every row. It errs where the
//! plane of a face passes between the middle of the sheet and a row's own origin (0, y, 0). It *loses* a front that
//! such a row sees while the middle sees the back. It *adds* a back that such a row sees while the middle sees the
//! front. An added back is scanned like any face: it may hide a true hit behind it, and its cosine of incidence is
//! negative.
//!
//! CHOICE: rules 3 are applied to each triangle that clipping leaves (`clip`, `stripe`), not to whole faces. §5 clips
//! before it transforms, §4 transforms before it applies the rules, and only what clipping leaves has a projection: a
//! vertex behind the SPP has none. So if a beam's faces are clipped to the stripe (`beam-edges = paper`), all vertices
//! are in the SS. Then 3a and 3c skip nothing more, and 3b compares the ranges of every face.
//!
//! CHOICE: the SS is closed. It reaches from border to border, half a cell beyond the outermost centres.

use crate::spp::SppPoint;
use crate::tables::Axis;

/// The sensor screen, SS: a rectangle on the SPP, metres.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SensorScreen {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

impl SensorScreen {
    pub(crate) fn new(columns: &Axis, rows: &Axis) -> Self {
        let ([left, right], [top, bottom]) = (columns.borders(), rows.borders());
        Self { left, right, top, bottom }
    }

    /// Whether rules 3 skip a triangle with these projected vertices. `too_far` tells whether the range of a vertex
    /// exceeds the maximum range.
    pub(crate) fn skips(&self, corners: &[SppPoint; 3], too_far: impl Fn(usize) -> bool) -> bool {
        self.skips_by_3a(corners) || self.skips_by_3b(corners, too_far) || self.skips_by_3c(corners)
    }

    /// 3a: all the vertices are to the left, right, above, or below the SS.
    fn skips_by_3a(&self, corners: &[SppPoint; 3]) -> bool {
        corners.iter().all(|corner| corner.x < self.left)
            || corners.iter().all(|corner| corner.x > self.right)
            || corners.iter().all(|corner| corner.y < self.top)
            || corners.iter().all(|corner| corner.y > self.bottom)
    }

    /// 3b: all the vertices are in the SS but their range exceeds the maximum range of the sensor.
    fn skips_by_3b(&self, corners: &[SppPoint; 3], too_far: impl Fn(usize) -> bool) -> bool {
        corners.iter().all(|corner| self.contains(corner)) && (0..3).all(too_far)
    }

    /// 3c: none of the vertices or the sides of the triangle intersect the SS and the center point of the SS
    /// is not in the triangle.
    fn skips_by_3c(&self, corners: &[SppPoint; 3]) -> bool {
        let [a, b, c] = corners;
        let centre = SppPoint { x: 0.5 * (self.left + self.right), y: 0.5 * (self.top + self.bottom) };
        !corners.iter().any(|corner| self.contains(corner))
            && ![(a, b), (b, c), (c, a)].iter().any(|(from, to)| self.intersects_side(from, to))
            && !triangle_contains(&centre, corners)
    }

    fn contains(&self, p: &SppPoint) -> bool {
        self.left <= p.x && p.x <= self.right && self.top <= p.y && p.y <= self.bottom
    }

    /// Whether the straight side between two points intersects the SS: neither an axis of the screen nor the line
    /// of the side separates them.
    fn intersects_side(&self, from: &SppPoint, to: &SppPoint) -> bool {
        if from.x.max(to.x) < self.left
            || from.x.min(to.x) > self.right
            || from.y.max(to.y) < self.top
            || from.y.min(to.y) > self.bottom
        {
            return false;
        }
        let side_of = |x: f64, y: f64| signed_double_area(from, to, &SppPoint { x, y });
        let sides = [
            side_of(self.left, self.top),
            side_of(self.right, self.top),
            side_of(self.right, self.bottom),
            side_of(self.left, self.bottom),
        ];
        !sides.iter().all(|side| *side > 0.0) && !sides.iter().all(|side| *side < 0.0)
    }
}

/// Twice the signed area of the triangle a, b, c.
fn signed_double_area(a: &SppPoint, b: &SppPoint, c: &SppPoint) -> f64 {
    (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
}

/// Whether a point is in a closed triangle of either orientation.
fn triangle_contains(p: &SppPoint, [a, b, c]: &[SppPoint; 3]) -> bool {
    let areas = [signed_double_area(a, b, p), signed_double_area(b, c, p), signed_double_area(c, a, p)];
    areas.iter().all(|area| *area >= 0.0) || areas.iter().all(|area| *area <= 0.0)
}

#[cfg(test)]
#[path = "../tests/unit/printed_skip.rs"]
mod tests;
