//! How far the ground rises above a plane.

use glam::DVec3;

use crate::ground_faces::{Face, GroundFaces, Search};
use crate::rectangle::Rectangle;

/// A plane over a rectangle: z = middle + along a + across b, in its local coordinates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane {
    /// Height over the middle, above the mesh's origin, metres.
    pub(crate) middle: f64,
    /// Slope along the rectangle.
    pub(crate) along: f64,
    /// Slope across the rectangle.
    pub(crate) across: f64,
}

/// The ground point that is highest above a plane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Excess {
    /// Height above the plane, metres; negative below it.
    pub(crate) height: f64,
    /// The point, in the rectangle's local coordinates, metres.
    pub(crate) point: DVec3,
    /// Index of its face.
    face: u32,
}

/// The search for it. Over one clipped triangle the height above a plane is linear: a corner has the maximum.
struct HighestExcess<'a> {
    rectangle: &'a Rectangle,
    plane: Plane,
    /// Lowest height of the plane over the rectangle, above the mesh's origin, metres.
    lowest: f64,
    best: Option<Excess>,
}

impl Search for HighestExcess<'_> {
    fn can_matter(&self, top: f64) -> bool {
        self.best.as_ref().is_none_or(|best| top - self.lowest >= best.height)
    }

    fn visit(&mut self, face: &Face) {
        let corners = face.corners.map(|corner| self.rectangle.local(corner));
        let [a, b, c] = corners;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        if !self.rectangle.may_overlap(low, high) || !self.can_matter(high.z) {
            return;
        }
        let Plane { middle, along, across } = self.plane;
        for &point in self.rectangle.clip(corners).corners() {
            let height = point.z - (middle + along * point.x + across * point.y);
            let excess = Excess { height, point, face: face.index };
            let from_middle = |excess: &Excess| excess.point.truncate().length_squared();
            let is_better = self.best.as_ref().is_none_or(|best| {
                let nearer = (from_middle(&excess), excess.face) < (from_middle(best), best.face);
                height > best.height || (height == best.height && nearer)
            });
            if is_better {
                self.best = Some(excess);
            }
        }
    }
}

/// The ground point in a rectangle that is highest above a plane. Of several corners, the one nearest to the middle,
/// then that of the face with the lowest index. `None` if there is no ground.
pub(crate) fn highest_excess(ground: &GroundFaces, rectangle: &Rectangle, plane: Plane) -> Option<Excess> {
    let lowest =
        plane.middle - plane.along.abs() * rectangle.half_length - plane.across.abs() * rectangle.half_width;
    let mut highest = HighestExcess { rectangle, plane, lowest, best: None };
    ground.search(rectangle, &mut highest);
    highest.best
}

#[cfg(test)]
#[path = "../tests/unit/belly.rs"]
mod tests;
