//! `beam-edges = paper`: a face clipped to a beam's stripe, with straight lines between the projected corners of
//! the remaining polygon. (§5, figures 8 and 9)
//!
//! "By clipping, we force the transformed triangles to have vertices within the beam grid, and since beam
//! thickness is small, the non-linearity of the triangle sides becomes insignificant." This switch shows how
//! insignificant. A side that crosses the sheet from (x, z) to (x', z') has its middle at g (x + x') / (z + z'); the
//! straight line has it at g (x/z + x'/z') / 2. The two agree where z = z' (a side parallel to the grid), where
//! x/z = x'/z' (a vertical line of the grid), and where the side lies in a row. These are the paper's "vertical and
//! horizontal lines".
//!
//! The result is watertight all the same. A side that two faces share is cut from its ends in the scene's order, so
//! both faces get the same two points, and the same line between them, bit for bit.

use glam::DVec3;

use crate::clip::{ClippedTriangle, Edge};
use crate::spp::{ProjectedLine, SppPoint};

/// The volume from a beam's grid to infinity: z >= g, |y| <= T/2, |x| <= z w/g.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StripeVolume {
    /// g, metres.
    pub(crate) grid_distance: f64,
    /// w, metres.
    pub(crate) half_width: f64,
    /// T/2, metres.
    pub(crate) half_thickness: f64,
}

/// The straight line between the two projected ends of a side.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Chord {
    first: SppPoint,
    second: SppPoint,
}

impl ProjectedLine for Chord {
    #[inline]
    fn x_at(&self, y: f64) -> f64 {
        let s = (y - self.first.y) / (self.second.y - self.first.y);
        self.first.x + (self.second.x - self.first.x) * s
    }
}

/// A corner of a polygon.
#[derive(Debug, Clone, Copy)]
struct PolygonCorner {
    point: DVec3,
    /// Whether the side to the next corner runs against the scene's order of its ends. A side along a cut belongs to
    /// this face alone; either value is right for it.
    reversed: bool,
}

/// The three corners of a triangle, and one more for each of the five planes.
const MAX_POLYGON_CORNERS: usize = 8;

/// A convex polygon.
#[derive(Debug, Clone, Copy)]
struct Polygon {
    corners: [PolygonCorner; MAX_POLYGON_CORNERS],
    count: usize,
}

impl Polygon {
    fn new() -> Self {
        let corner = PolygonCorner { point: DVec3::ZERO, reversed: false };
        Self { corners: [corner; MAX_POLYGON_CORNERS], count: 0 }
    }

    fn push(&mut self, corner: PolygonCorner) {
        self.corners[self.count] = corner;
        self.count += 1;
    }

    /// The part where the signed `distance` from a plane is not negative. `onto_plane` moves a computed crossing
    /// exactly onto the plane.
    fn clip(&self, distance: impl Fn(DVec3) -> f64, onto_plane: impl Fn(DVec3) -> DVec3) -> Self {
        let mut part = Self::new();
        for k in 0..self.count {
            let (here, there) = (self.corners[k], self.corners[(k + 1) % self.count]);
            let (distance_here, distance_there) = (distance(here.point), distance(there.point));
            if distance_here >= 0.0 {
                part.push(here);
            }
            if (distance_here >= 0.0) != (distance_there >= 0.0) {
                // From the ends in the scene's order, in both faces that share the side.
                let (first, second) =
                    if here.reversed { (there.point, here.point) } else { (here.point, there.point) };
                let (distance_first, distance_second) = if here.reversed {
                    (distance_there, distance_here)
                } else {
                    (distance_here, distance_there)
                };
                let p = first + (second - first) * (distance_first / (distance_first - distance_second));
                part.push(PolygonCorner { point: onto_plane(p), reversed: here.reversed });
            }
        }
        part
    }
}

impl StripeVolume {
    /// Calls `visit` with each triangle of the part of a face within the volume. `edges[k]` joins `vertices[k]` to
    /// k + 1.
    pub(crate) fn clip<L>(
        &self,
        vertices: [DVec3; 3],
        edges: &[Edge<L>; 3],
        mut visit: impl FnMut(&ClippedTriangle<Chord>),
    ) {
        let (g, w, half) = (self.grid_distance, self.half_width, self.half_thickness);
        let mut polygon = Polygon::new();
        for k in 0..3 {
            polygon.push(PolygonCorner { point: vertices[k], reversed: edges[k].reversed });
        }
        // Figure 9: z >= g. One of three vertices behind leaves four corners, two behind leave three.
        polygon = polygon.clip(|p| p.z - g, |p| DVec3::new(p.x, p.y, g));
        // Figure 8: |y| <= T/2, then |x| <= z w/g.
        polygon = polygon.clip(|p| p.y + half, |p| DVec3::new(p.x, -half, p.z));
        polygon = polygon.clip(|p| half - p.y, |p| DVec3::new(p.x, half, p.z));
        polygon = polygon.clip(|p| w * p.z + g * p.x, |p| DVec3::new(-w * p.z / g, p.y, p.z));
        polygon = polygon.clip(|p| w * p.z - g * p.x, |p| DVec3::new(w * p.z / g, p.y, p.z));
        if polygon.count < 3 {
            return;
        }

        // The polygon's corners on the grid (figure 7). All lie within the grid; the clamp undoes rounding.
        let polygon_corners = &polygon.corners[..polygon.count];
        let mut corners = [SppPoint { x: 0.0, y: 0.0 }; MAX_POLYGON_CORNERS];
        for (corner, PolygonCorner { point, .. }) in corners.iter_mut().zip(polygon_corners) {
            *corner = SppPoint { x: (g * point.x / point.z).clamp(-w, w), y: point.y.clamp(-half, half) };
        }

        // A fan of triangles from the first corner. CHOICE: the paper makes two triangles of a quadrilateral
        // (figure 9) and says nothing of polygons with more corners (figure 8). A fan gives the same for four
        // corners. Also, one polygon is clipped by all planes, not the two triangles of figure 9 each by itself;
        // that would only add lines across the face.
        let last = polygon.count - 1;
        let side = |k: usize| {
            let (from, to) = (corners[k], corners[if k == last { 0 } else { k + 1 }]);
            let (first, second) = if polygon_corners[k].reversed { (to, from) } else { (from, to) };
            Chord { first, second }
        };
        let diagonal = |k: usize| Chord { first: corners[0], second: corners[k] };
        for k in 1..last {
            visit(&ClippedTriangle {
                points: [polygon_corners[0].point, polygon_corners[k].point, polygon_corners[k + 1].point],
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

    /// The pieces of a face, and the most that a corner of one is outside of the volume, metres.
    fn pieces_of(stripe: StripeVolume, vertices: [DVec3; 3]) -> (usize, f64) {
        let StripeVolume { grid_distance: g, half_width: w, half_thickness: half } = stripe;
        let edges = [0, 1, 2].map(|k| Edge {
            first: vertices[k],
            second: vertices[(k + 1) % 3],
            reversed: false,
            line: (),
        });
        let (mut count, mut outside) = (0, f64::NEG_INFINITY);
        stripe.clip(vertices, &edges, |piece| {
            count += 1;
            for p in piece.points {
                outside = outside.max(g - p.z).max(p.y.abs() - half).max(p.x.abs() - p.z * w / g);
            }
        });
        (count, outside)
    }

    #[test]
    fn what_is_left_of_a_face_is_within_the_volume() {
        let stripe = StripeVolume { grid_distance: 1.0, half_width: 1.0, half_thickness: 0.5 };
        // Across the plane of the grid, which leaves four corners and so two pieces, or three corners.
        let [near, far, other] = [[0.1, 0.2, 0.5], [0.3, -0.1, 2.0], [-0.4, 0.1, 3.0]].map(DVec3::from_array);
        let behind = near.with_z(-0.5);
        for (vertices, pieces) in
            [([near, far, other], 2), ([behind, far, other], 2), ([near, behind, far], 1), ([near; 3], 0)]
        {
            let (count, outside) = pieces_of(stripe, vertices);
            assert_eq!(count, pieces, "{vertices:?}");
            assert!(outside < 1e-15, "{vertices:?} {outside}");
        }
        // Across each of the sides.
        for corner in [[0.0, 0.9, 2.0], [0.0, -0.9, 2.0], [4.0, 0.0, 2.0], [-4.0, 0.0, 2.0]] {
            let (count, outside) = pieces_of(stripe, [DVec3::from_array(corner), far, other]);
            assert_eq!(count, 2, "{corner:?}");
            assert!(outside < 1e-15, "{corner:?} {outside}");
        }
        // A vertex on the plane of the grid is within: it adds no corner.
        let on_grid = near.with_z(1.0);
        for vertices in [[on_grid, far, other], [far, on_grid, other], [far, other, on_grid]] {
            assert_eq!(pieces_of(stripe, vertices).0, 1, "{vertices:?}");
        }
    }

    #[test]
    fn a_shared_side_is_the_same_line_in_both_faces() {
        let stripe = StripeVolume { grid_distance: 1.0, half_width: 1.0, half_thickness: 0.5 };
        let [a, b] = [[0.1, 0.3, 2.0], [0.3, -0.1, 2.2]];
        let faces = [[a, b, [-0.3, 0.2, 2.1]], [b, a, [0.4, 0.4, 2.4]]];
        let on_grid = |[x, y, z]: [f64; 3]| SppPoint { x: x / z, y };
        let ends = [on_grid(a), on_grid(b)];
        let mut lines = Vec::new();
        for [p, q, r] in faces {
            // The shared side is the first, the second or the last, depending on where the cycle begins.
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
        // From the end that comes first in the scene's order, whichever way the face runs.
        assert_eq!(lines, [ends; 6]);
    }
}
