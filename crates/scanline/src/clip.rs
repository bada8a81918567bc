//! Clipping a triangle to the part at or beyond the SPP. (§5, figure 9)
//!
//! One vertex behind the plane leaves a quadrilateral, cut into two triangles; two leave one triangle. New
//! corners are computed from the ends of the original edge in the scene's order, so that both neighbours
//! of an edge get the same bits; the edge keeps its original line.

use glam::DVec3;

use crate::scan::{Corner, Line};

/// An edge of a face in the sensor's frame, its ends in the scene's order.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Edge<L> {
    pub(crate) first: DVec3,
    pub(crate) second: DVec3,
    /// Whether that is the order opposite to the face's own.
    pub(crate) reversed: bool,
    pub(crate) line: L,
}

impl<L> Edge<L> {
    /// Where the edge crosses the plane z = `spp`; its ends lie on different sides.
    fn at_plane(&self, spp: f64) -> DVec3 {
        let s = (spp - self.first.z) / (self.second.z - self.first.z);
        let p = self.first + (self.second - self.first) * s;
        DVec3::new(p.x, p.y, spp)
    }
}

/// A triangle of a face, or of what clipping leaves of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Piece<L> {
    /// Its corners in the sensor's frame.
    pub(crate) points: [DVec3; 3],
    /// Their projections.
    pub(crate) corners: [Corner; 3],
    /// `lines[k]` joins corner k to k + 1.
    pub(crate) lines: [L; 3],
}

/// The lines that clipping adds.
pub(crate) struct NewLines<C, D> {
    /// Along the SPP, between two new corners.
    pub(crate) along_plane: C,
    /// Between two corners of the quadrilateral.
    pub(crate) diagonal: D,
}

/// Calls `visit` with each triangle of the part of a face at or beyond the plane z = `spp`.
///
/// `vertices[k]` and `corners[k]` are the face's corners in space and on the SPP (the latter only used
/// where the former is not behind the plane), `edges[k]` joins k and k + 1. A point on the plane projects
/// to itself.
pub(crate) fn clip_at_plane<L: Line>(
    spp: f64,
    vertices: [DVec3; 3],
    corners: [Corner; 3],
    edges: &[Edge<L>; 3],
    new_lines: NewLines<impl Fn(DVec3, DVec3) -> L, impl Fn(DVec3, DVec3) -> L>,
    mut visit: impl FnMut(&Piece<L>),
) {
    // Walk around the face: keep the corners in front, add one where an edge crosses the plane. Each
    // corner is stored with the line of the side that leaves it.
    let mut kept: [(DVec3, Corner, Option<L>); 4] = [(DVec3::ZERO, Corner { x: 0.0, y: 0.0 }, None); 4];
    let mut count = 0;
    let mut keep = |point: DVec3, corner: Corner, leaving: Option<L>| {
        kept[count] = (point, corner, leaving);
        count += 1;
    };
    for k in 0..3 {
        let next = (k + 1) % 3;
        let (here, there) = (vertices[k].z >= spp, vertices[next].z >= spp);
        let on_plane = || {
            let p = edges[k].at_plane(spp);
            (p, Corner { x: p.x, y: p.y })
        };
        if here {
            keep(vertices[k], corners[k], Some(edges[k].line));
        }
        if here && !there {
            // The side along the plane leaves from here; its line needs the corner where it ends.
            let (p, corner) = on_plane();
            keep(p, corner, None);
        }
        if !here && there {
            let (p, corner) = on_plane();
            keep(p, corner, Some(edges[k].line));
        }
    }
    if count < 3 {
        return;
    }
    let side =
        |k: usize, next: usize| kept[k].2.unwrap_or_else(|| (new_lines.along_plane)(kept[k].0, kept[next].0));
    let mut piece = |[a, b, c]: [usize; 3], lines: [L; 3]| {
        let (points, corners) = ([kept[a].0, kept[b].0, kept[c].0], [kept[a].1, kept[b].1, kept[c].1]);
        visit(&Piece { points, corners, lines });
    };
    if count == 3 {
        piece([0, 1, 2], [side(0, 1), side(1, 2), side(2, 0)]);
    } else {
        let diagonal = (new_lines.diagonal)(kept[0].0, kept[2].0);
        piece([0, 1, 2], [side(0, 1), side(1, 2), diagonal]);
        piece([0, 2, 3], [diagonal, side(2, 3), side(3, 0)]);
    }
}
