//! Clipping of a triangle to its part at or beyond the SPP. (§5, figure 9)
//!
//! One vertex behind the plane leaves a quadrilateral, cut into two triangles; two vertices behind leave one triangle.
//! New corners are computed from the ends of the original edge in the scene's order, so both neighbours of an edge
//! get the same bits. The edge keeps its original projected line.

use glam::DVec3;

use crate::spp::{ProjectedLine, SppPoint};

/// An edge of a face in the sensor's frame, its ends in the scene's order.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Edge<L> {
    pub(crate) first: DVec3,
    pub(crate) second: DVec3,
    /// Whether the face runs through the edge from `second` to `first`.
    pub(crate) reversed: bool,
    pub(crate) line: L,
}

impl<L> Edge<L> {
    /// The crossing of the edge with the plane z = `spp`. The ends must lie on different sides.
    fn at_spp(&self, spp: f64) -> DVec3 {
        let s = (spp - self.first.z) / (self.second.z - self.first.z);
        let p = self.first + (self.second - self.first) * s;
        DVec3::new(p.x, p.y, spp)
    }
}

/// A triangle that is ready to be scanned: a whole face, or one triangle of what clipping leaves of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ClippedTriangle<L> {
    /// Its corners in the sensor's frame, metres.
    pub(crate) points: [DVec3; 3],
    /// Its corners on the SPP.
    pub(crate) corners: [SppPoint; 3],
    /// `lines[k]` joins corner k to k + 1.
    pub(crate) lines: [L; 3],
}

/// Makers of the lines that clipping adds.
pub(crate) struct AddedLines<C, D> {
    /// Along the SPP, between two new corners.
    pub(crate) along_spp: C,
    /// Between two corners of the quadrilateral.
    pub(crate) diagonal: D,
}

/// Calls `visit` with each triangle of the part of a face at or beyond the plane z = `spp`.
///
/// `vertices[k]` and `corners[k]` are the face's corners in space and on the SPP; the latter are used only for
/// vertices that are not behind the plane. `edges[k]` joins k and k + 1. A point on the plane projects to itself.
pub(crate) fn clip_at_spp<L: ProjectedLine>(
    spp: f64,
    vertices: [DVec3; 3],
    corners: [SppPoint; 3],
    edges: &[Edge<L>; 3],
    added_lines: AddedLines<impl Fn(DVec3, DVec3) -> L, impl Fn(DVec3, DVec3) -> L>,
    mut visit: impl FnMut(&ClippedTriangle<L>),
) {
    // Walk around the face: take over the corners beyond the plane, and add one where an edge crosses it. Each corner
    // is stored with the line of the side that leaves it.
    let mut polygon: [(DVec3, SppPoint, Option<L>); 4] =
        [(DVec3::ZERO, SppPoint { x: 0.0, y: 0.0 }, None); 4];
    let mut count = 0;
    let mut push = |point: DVec3, corner: SppPoint, leaving: Option<L>| {
        polygon[count] = (point, corner, leaving);
        count += 1;
    };
    for k in 0..3 {
        let next = (k + 1) % 3;
        let (here, there) = (vertices[k].z >= spp, vertices[next].z >= spp);
        let crossing = || {
            let p = edges[k].at_spp(spp);
            (p, SppPoint { x: p.x, y: p.y })
        };
        if here {
            push(vertices[k], corners[k], Some(edges[k].line));
        }
        if here && !there {
            // The side along the plane leaves from here. Its line is made below, when its end is known.
            let (p, corner) = crossing();
            push(p, corner, None);
        }
        if !here && there {
            let (p, corner) = crossing();
            push(p, corner, Some(edges[k].line));
        }
    }
    if count < 3 {
        return;
    }
    let side = |k: usize, next: usize| {
        polygon[k].2.unwrap_or_else(|| (added_lines.along_spp)(polygon[k].0, polygon[next].0))
    };
    let mut emit = |[a, b, c]: [usize; 3], lines: [L; 3]| {
        let points = [polygon[a].0, polygon[b].0, polygon[c].0];
        let corners = [polygon[a].1, polygon[b].1, polygon[c].1];
        visit(&ClippedTriangle { points, corners, lines });
    };
    if count == 3 {
        emit([0, 1, 2], [side(0, 1), side(1, 2), side(2, 0)]);
    } else {
        let diagonal = (added_lines.diagonal)(polygon[0].0, polygon[2].0);
        emit([0, 1, 2], [side(0, 1), side(1, 2), diagonal]);
        emit([0, 2, 3], [diagonal, side(2, 3), side(3, 0)]);
    }
}
