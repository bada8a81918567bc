//! `beam-edges = paper`: a face clipped to a beam's stripe, and straight lines between what is left of its
//! vertices. (§5, figures 8 and 9)
//!
//! "By clipping, we force the transformed triangles to have vertices within the beam grid, and since beam
//! thickness is small, the non-linearity of the triangle sides becomes insignificant." How insignificant is
//! for this switch to show: a side that crosses the sheet from (x, z) to (x', z') has its middle at
//! g (x + x') / (z + z'), and the straight line at g (x/z + x'/z') / 2. They agree where z = z' (a side
//! parallel to the grid), where x/z = x'/z' (a vertical line of the grid), and where the side lies in a row;
//! these are the paper's "vertical and horizontal lines".
//!
//! What is kept is watertight in spite of that: a side that two faces share is cut from its ends in the
//! scene's order, so both get the same two points, and the line between them, bit for bit.

use glam::DVec3;

use crate::clip::{Edge, Piece};
use crate::scan::{Corner, Line};

/// The room between a beam's grid and infinity: z >= g, |y| <= T/2, |x| <= z w/g.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stripe {
    /// g, metres.
    pub(crate) grid_distance: f64,
    /// w, metres.
    pub(crate) half_width: f64,
    /// T/2, metres.
    pub(crate) half_thickness: f64,
}

/// The image of a side: the straight line between its projected ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Chord {
    first: Corner,
    second: Corner,
}

impl Line for Chord {
    #[inline]
    fn x_at(&self, y: f64) -> f64 {
        let s = (y - self.first.y) / (self.second.y - self.first.y);
        self.first.x + (self.second.x - self.first.x) * s
    }
}

/// A corner of what clipping has left so far.
#[derive(Debug, Clone, Copy)]
struct Kept {
    point: DVec3,
    /// Whether the side to the next corner runs against the scene's order of its ends. Sides along a cut are
    /// this face's own; for them either is right.
    reversed: bool,
}

/// A triangle and a corner for each of the five planes.
const MOST_CORNERS: usize = 8;

/// A convex polygon.
#[derive(Debug, Clone, Copy)]
struct Polygon {
    corners: [Kept; MOST_CORNERS],
    count: usize,
}

impl Polygon {
    fn new() -> Self {
        Self { corners: [Kept { point: DVec3::ZERO, reversed: false }; MOST_CORNERS], count: 0 }
    }

    fn keep(&mut self, corner: Kept) {
        self.corners[self.count] = corner;
        self.count += 1;
    }

    /// The part where `distance` from a plane is not negative; `onto` puts a point of the cut on the plane.
    fn cut(&self, distance: impl Fn(DVec3) -> f64, onto: impl Fn(DVec3) -> DVec3) -> Self {
        let mut part = Self::new();
        for k in 0..self.count {
            let (here, there) = (self.corners[k], self.corners[(k + 1) % self.count]);
            let (of_here, of_there) = (distance(here.point), distance(there.point));
            if of_here >= 0.0 {
                part.keep(here);
            }
            if (of_here >= 0.0) != (of_there >= 0.0) {
                // From the ends in the scene's order, for both faces that share the side.
                let (first, second) =
                    if here.reversed { (there.point, here.point) } else { (here.point, there.point) };
                let (of_first, of_second) =
                    if here.reversed { (of_there, of_here) } else { (of_here, of_there) };
                let p = first + (second - first) * (of_first / (of_first - of_second));
                part.keep(Kept { point: onto(p), reversed: here.reversed });
            }
        }
        part
    }
}

impl Stripe {
    /// Calls `visit` with each triangle of the part of a face within the stripe.
    ///
    /// `edges[k]` joins `vertices[k]` to k + 1.
    pub(crate) fn clip<L>(
        &self,
        vertices: [DVec3; 3],
        edges: &[Edge<L>; 3],
        mut visit: impl FnMut(&Piece<Chord>),
    ) {
        let (g, w, half) = (self.grid_distance, self.half_width, self.half_thickness);
        let mut polygon = Polygon::new();
        for k in 0..3 {
            polygon.keep(Kept { point: vertices[k], reversed: edges[k].reversed });
        }
        // Figure 9: z >= g. Of three corners one behind leaves four, two behind leave three.
        polygon = polygon.cut(|p| p.z - g, |p| DVec3::new(p.x, p.y, g));
        // Figure 8: |y| <= T/2, then |x| <= z w/g.
        polygon = polygon.cut(|p| p.y + half, |p| DVec3::new(p.x, -half, p.z));
        polygon = polygon.cut(|p| half - p.y, |p| DVec3::new(p.x, half, p.z));
        polygon = polygon.cut(|p| w * p.z + g * p.x, |p| DVec3::new(-w * p.z / g, p.y, p.z));
        polygon = polygon.cut(|p| w * p.z - g * p.x, |p| DVec3::new(w * p.z / g, p.y, p.z));
        if polygon.count < 3 {
            return;
        }

        // The vertices of what is left, on the grid (figure 7). All lie within it; rounding may say otherwise.
        let kept = &polygon.corners[..polygon.count];
        let mut corners = [Corner { x: 0.0, y: 0.0 }; MOST_CORNERS];
        for (corner, Kept { point, .. }) in corners.iter_mut().zip(kept) {
            *corner = Corner { x: (g * point.x / point.z).clamp(-w, w), y: point.y.clamp(-half, half) };
        }

        // A fan of triangles from the first corner. CHOICE: the paper says two triangles for a quadrilateral
        // (figure 9) and nothing of polygons with more corners (figure 8); a fan is the same for four. And
        // it is one polygon that is cut by all planes, not the two triangles of figure 9 each by itself:
        // that would only add lines across the face.
        let last = polygon.count - 1;
        let side = |k: usize| {
            let (from, to) = (corners[k], corners[if k == last { 0 } else { k + 1 }]);
            let (first, second) = if kept[k].reversed { (to, from) } else { (from, to) };
            Chord { first, second }
        };
        let diagonal = |k: usize| Chord { first: corners[0], second: corners[k] };
        for k in 1..last {
            visit(&Piece {
                points: [kept[0].point, kept[k].point, kept[k + 1].point],
                corners: [corners[0], corners[k], corners[k + 1]],
                lines: [
                    if k == 1 { side(0) } else { diagonal(k) },
                    side(k),
                    if k + 1 == last { side(last) } else { diagonal(k + 1) },
                ],
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shared_side_is_the_same_line_in_both_faces() {
        let stripe = Stripe { grid_distance: 1.0, half_width: 1.0, half_thickness: 0.5 };
        let [a, b] = [[0.1, 0.3, 2.0], [0.3, -0.1, 2.2]];
        let faces = [[a, b, [-0.3, 0.2, 2.1]], [b, a, [0.4, 0.4, 2.4]]];
        let on_grid = |[x, y, z]: [f64; 3]| Corner { x: x / z, y };
        let ends = [on_grid(a), on_grid(b)];
        let mut lines = Vec::new();
        for [p, q, r] in faces {
            // Wherever the cycle begins, the shared side is the first, the second or the last.
            for cycle in [[p, q, r], [q, r, p], [r, p, q]] {
                let edges = [0, 1, 2].map(|k| {
                    let (from, to) = (cycle[k], cycle[(k + 1) % 3]);
                    let reversed = to < from;
                    let [first, second] = if reversed { [to, from] } else { [from, to] };
                    Edge { first: first.into(), second: second.into(), reversed, line: () }
                });
                stripe.clip(cycle.map(DVec3::from_array), &edges, |piece| {
                    let shared = piece
                        .lines
                        .into_iter()
                        .filter(|line| ends.contains(&line.first) && ends.contains(&line.second));
                    lines.extend(shared.map(|line| [line.first, line.second]));
                });
            }
        }
        // From the end that comes first in the scene, whichever way the face runs.
        assert_eq!(lines, [ends; 6]);
    }
}
