//! Edges: the faces that share each edge, and their direction along it.

use glam::DVec3;

use super::disjoint_sets::{DisjointSets, UnionOutcome};
use super::geometry::MeshGeometry;
use super::report::{Inspection, Occurrence, OpenEdgePiece};
use super::status::FaceStatus;

/// Half-edge: a side of one face, by the lower and the higher of its two vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct HalfEdge {
    low: u32,
    high: u32,
    face: u32,
    /// The face runs from the higher vertex to the lower.
    backwards: bool,
}

impl HalfEdge {
    fn length(&self, geometry: &MeshGeometry) -> f64 {
        (geometry.vertex(self.high) - geometry.vertex(self.low)).length()
    }

    /// Midpoint, global frame, metres.
    fn middle(&self, geometry: &MeshGeometry) -> DVec3 {
        geometry.global((geometry.vertex(self.low) + geometry.vertex(self.high)) * 0.5)
    }
}

/// Connections between faces over edges.
pub(super) struct FaceConnectivity {
    /// Patches: faces connected over edges of two faces. Two faces are opposite if one must be turned to match
    /// the other.
    pub(super) patches: DisjointSets,
    /// Whether each face has an edge that is not shared by exactly two faces.
    pub(super) at_patch_border: Vec<bool>,
    /// At least one face of each non-orientable patch.
    pub(super) non_orientable: Vec<u32>,
}

/// Connects the faces of the surface over their edges, and counts open, non-manifold and mismatched edges.
pub(super) fn connect(
    geometry: &MeshGeometry,
    welded: &[u32],
    statuses: &[FaceStatus],
    inspection: &mut Inspection,
) -> FaceConnectivity {
    let count = geometry.mesh.faces().len();
    let half_edges = sorted_half_edges(geometry, welded, statuses);
    let mut connectivity = FaceConnectivity {
        patches: DisjointSets::new(count),
        at_patch_border: vec![false; count],
        non_orientable: Vec::new(),
    };
    let mut components = DisjointSets::new(count);
    inspection.components = statuses.iter().filter(|status| status.is_surface()).count();
    let mut open = Vec::new();
    for edge in half_edges.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)) {
        let example = || Occurrence::at_face(edge[0].face, edge[0].middle(geometry));
        for pair in edge.windows(2) {
            let outcome = components.union(pair[0].face, pair[1].face, false);
            inspection.components -= usize::from(outcome == UnionOutcome::Merged);
        }
        match edge {
            [one, other] => {
                // Consistent neighbours run along their edge in opposite directions.
                let mismatched = one.backwards == other.backwards;
                if mismatched {
                    inspection.inconsistent_edges.add(example);
                }
                if connectivity.patches.union(one.face, other.face, mismatched) == UnionOutcome::Contradictory
                {
                    connectivity.non_orientable.push(one.face);
                }
            }
            _ => {
                edge.iter()
                    .for_each(|half_edge| connectivity.at_patch_border[half_edge.face as usize] = true);
                match edge {
                    [one] => open.push(*one),
                    _ => inspection.non_manifold_edges.add(example),
                }
            }
        }
    }
    drop((half_edges, components));
    gather_open(geometry, &open, inspection);
    connectivity
}

/// Half-edges of all faces of the surface, sorted so that those of one edge are adjacent.
fn sorted_half_edges(geometry: &MeshGeometry, welded: &[u32], statuses: &[FaceStatus]) -> Vec<HalfEdge> {
    let staying = || geometry.faces().filter(|&face| statuses[face as usize].is_surface());
    let mut half_edges = Vec::with_capacity(3 * staying().count());
    for face in staying() {
        let [a, b, c] = geometry.mesh.faces()[face as usize].map(|vertex| welded[vertex as usize]);
        for [from, to] in [[a, b], [b, c], [c, a]] {
            half_edges.push(HalfEdge { low: from.min(to), high: from.max(to), face, backwards: from > to });
        }
    }
    half_edges.sort_unstable();
    half_edges
}

/// Counts open edges, and joins them to pieces at their vertices.
fn gather_open(geometry: &MeshGeometry, open: &[HalfEdge], inspection: &mut Inspection) {
    let found = &mut inspection.open_edges;
    found.count = open.len();
    if open.is_empty() {
        return;
    }
    let mut ends = DisjointSets::new(geometry.mesh.vertices().len());
    for half_edge in open {
        found.length += half_edge.length(geometry);
        // An edge within one piece closes one more loop.
        found.loops += usize::from(ends.union(half_edge.low, half_edge.high, false) != UnionOutcome::Merged);
    }
    let mut pieces: Vec<(u32, HalfEdge)> =
        open.iter().map(|half_edge| (ends.find(half_edge.low).0, *half_edge)).collect();
    pieces.sort_unstable();
    for piece in pieces.chunk_by(|a, b| a.0 == b.0) {
        let first = piece[0].1;
        found.add_piece(OpenEdgePiece {
            edges: piece.len(),
            length: piece.iter().map(|(_, half_edge)| half_edge.length(geometry)).sum(),
            example: Occurrence::at_face(first.face, first.middle(geometry)),
        });
    }
}
