//! How wrong a program in rounded arithmetic may be about a line of sight, and still be honest.
//!
//! Such a program has the line's ends and the corners of a face only rounded, so that an edge may seem to it on the other side
//! of the line. Across the line, at a share s of the way from the point to the camera, the error is at most the sum of
//!
//! * that of every point: a subtraction, a rotation and the crossing of an edge;
//! * that of the hit point: its error along the pencil, times the sine between pencil and line, times 1 - s;
//! * the [slip](crate::hits::rounded_face::edge_slip) of the face's edges, which grows with its aspect.
//!
//! Of all this only the last decimal digits of the answer depend, so it is computed in f64.

use glam::DVec3;

use crate::hits::aspect::aspect;
use crate::hits::face::Face;
use crate::hits::rounded_face::edge_slip;
use crate::trees::bvh::InBox;

/// Roundings of a side of an edge in this file's own f64, relative to the product of the three lengths: a cross product and a
/// dot product, rounded up.
const OWN_ROUNDINGS: f64 = 8.0 * f64::EPSILON / 2.0;

/// A line of sight, as a program with this unit roundoff may see it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RoundedLine {
    /// The point that is seen, and the camera's projection centre.
    pub(crate) ends: [DVec3; 2],
    /// The error of any point across the line, metres.
    pub(crate) position: f64,
    /// The error of the hit point along the pencil, as it shows across the line, metres.
    pub(crate) hit: f64,
    /// The share of the way that lies before the image plane, as seen from the camera: f / r.
    pub(crate) image_plane: f64,
    /// u.
    pub(crate) unit_roundoff: f64,
}

/// An edge of a face where a line passes nearest to it.
#[derive(Debug, Clone, Copy)]
struct NearestEdge {
    /// From the line to the edge, across the line, metres.
    across: DVec3,
    /// The share of the way from the point, s.
    share: f64,
}

impl RoundedLine {
    /// How far beside its place this face may seem to end, if that is as far as its nearest edge: the way across the line to
    /// that edge, metres. `None` if the program must know on which side of the edge the line is, or if the edge is not on
    /// the way.
    pub(crate) fn uncertain_edge(&self, face: &Face) -> Option<DVec3> {
        let [point, centre] = self.ends;
        let way = centre - point;
        let corners = face.corners();
        let n = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let (kappa, longest) = (aspect(corners), face.longest_edge());
        let size = point.length().max(centre.length()) + way.length() + longest;
        let uncertain = (0..3).filter_map(|k| {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let nearest = self.nearest(a, b);
            let slip = edge_slip(kappa, n, b - a, way, size, self.unit_roundoff);
            let error = self.position + self.hit * (1.0 - nearest.share).clamp(0.0, 1.0) + slip;
            let beyond = error / way.length();
            let is_on_way = nearest.share >= -beyond && nearest.share <= 1.0 - self.image_plane + beyond;
            // Not a number where the face is too thin for f64: then its edges are anywhere.
            (is_on_way && !(nearest.across.length() > error)).then_some(nearest.across)
        });
        uncertain.min_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
    }

    /// Where the line passes nearest to an edge.
    fn nearest(&self, a: DVec3, b: DVec3) -> NearestEdge {
        let [point, centre] = self.ends;
        let (way, edge) = (centre - point, b - a);
        let across = |p: DVec3| p - way * (p.dot(way) / way.length_squared());
        // Seen along the line, the point of the edge that is nearest to it.
        let (from, along) = (across(a - point), across(edge));
        let at = (-from.dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let at = if at.is_nan() { 0.0 } else { at };
        let nearest = a + edge * at - point;
        NearestEdge { across: across(nearest), share: nearest.dot(way) / way.length_squared() }
    }

    /// The line moved sideways.
    pub(crate) fn moved(&self, by: DVec3) -> Self {
        Self { ends: self.ends.map(|end| end + by), ..*self }
    }

    /// Whether the line meets a face on its way, from either side; yes where f64 leaves that open.
    pub(crate) fn meets(&self, face: &Face) -> bool {
        let [point, centre] = self.ends;
        let way = centre - point;
        let corners = face.corners();
        let [a, b, c] = corners.map(|corner| corner - point);
        let n = (b - a).cross(c - a);
        let share = n.dot(a) / n.dot(way);
        let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| {
            let error = OWN_ROUNDINGS * way.length() * from.length() * to.length();
            let side = way.dot(from.cross(to));
            [side > error, side < -error]
        });
        let is_inside = (0..2).any(|side| sides.iter().all(|sides| !sides[side]));
        is_inside && share > 0.0 && share <= 1.0 - self.image_plane
    }
}

#[cfg(test)]
#[path = "../../tests/unit/rounded_line.rs"]
mod tests;
