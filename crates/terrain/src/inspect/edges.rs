//! Edges: which faces share each, and how these run along it.

use glam::DVec3;

use super::forest::{Forest, Joined};
use super::shape::Shapes;
use super::{Fate, Inspection, OpenPiece, at_face};

/// A side of a face, by the lower and the higher of its ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    low: u32,
    high: u32,
    face: u32,
    /// The face runs from the higher end to the lower.
    backwards: bool,
}

impl Side {
    fn length(&self, shapes: &Shapes) -> f64 {
        (shapes.vertex(self.high) - shapes.vertex(self.low)).length()
    }

    /// The middle, in the global frame.
    fn middle(&self, shapes: &Shapes) -> DVec3 {
        shapes.global((shapes.vertex(self.low) + shapes.vertex(self.high)) * 0.5)
    }
}

/// How faces hang together.
pub(super) struct Joints {
    /// Patches: faces over edges of two faces, unlike if one of them has to be turned to suit the other.
    pub(super) patches: Forest,
    /// Faces at an edge that has not just two.
    pub(super) at_rim: Vec<bool>,
    /// Faces, one at least of each patch that has no two sides.
    pub(super) one_sided: Vec<u32>,
}

/// Finds out which sides of the faces that stay belong together.
pub(super) fn join(shapes: &Shapes, welded: &[u32], fates: &[Fate], inspection: &mut Inspection) -> Joints {
    let count = shapes.mesh.faces().len();
    let sides = sorted_sides(shapes, welded, fates);
    let mut joints =
        Joints { patches: Forest::new(count), at_rim: vec![false; count], one_sided: Vec::new() };
    let mut components = Forest::new(count);
    inspection.components = fates.iter().filter(|fate| fate.stays()).count();
    let mut open = Vec::new();
    for edge in sides.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)) {
        let example = || at_face(edge[0].face, edge[0].middle(shapes));
        for pair in edge.windows(2) {
            let joined = components.join(pair[0].face, pair[1].face, false);
            inspection.components -= usize::from(joined == Joined::Newly);
        }
        match edge {
            [one, other] => {
                // Neighbours on one side of the surface run along their edge in opposite directions.
                let mismatched = one.backwards == other.backwards;
                if mismatched {
                    inspection.mismatched_edges.add(example);
                }
                if joints.patches.join(one.face, other.face, mismatched) == Joined::Contradicted {
                    joints.one_sided.push(one.face);
                }
            }
            _ => {
                edge.iter().for_each(|side| joints.at_rim[side.face as usize] = true);
                match edge {
                    [one] => open.push(*one),
                    _ => inspection.crowded_edges.add(example),
                }
            }
        }
    }
    drop((sides, components));
    gather_open(shapes, &open, inspection);
    joints
}

/// The sides of all faces that stay, those of one edge together.
fn sorted_sides(shapes: &Shapes, welded: &[u32], fates: &[Fate]) -> Vec<Side> {
    let staying = || shapes.faces().filter(|&face| fates[face as usize].stays());
    let mut sides = Vec::with_capacity(3 * staying().count());
    for face in staying() {
        let [a, b, c] = shapes.mesh.faces()[face as usize].map(|vertex| welded[vertex as usize]);
        for [from, to] in [[a, b], [b, c], [c, a]] {
            sides.push(Side { low: from.min(to), high: from.max(to), face, backwards: from > to });
        }
    }
    sides.sort_unstable();
    sides
}

/// Counts open edges, and puts them together at their ends.
fn gather_open(shapes: &Shapes, open: &[Side], inspection: &mut Inspection) {
    let found = &mut inspection.open_edges;
    found.count = open.len();
    if open.is_empty() {
        return;
    }
    let mut ends = Forest::new(shapes.mesh.vertices().len());
    for side in open {
        found.length += side.length(shapes);
        // An edge between what hangs together already closes one more loop.
        found.loops += usize::from(ends.join(side.low, side.high, false) != Joined::Newly);
    }
    let mut pieces: Vec<(u32, Side)> = open.iter().map(|side| (ends.root(side.low).0, *side)).collect();
    pieces.sort_unstable();
    for piece in pieces.chunk_by(|a, b| a.0 == b.0) {
        let first = piece[0].1;
        found.add_piece(OpenPiece {
            edges: piece.len(),
            length: piece.iter().map(|(_, side)| side.length(shapes)).sum(),
            example: at_face(first.face, first.middle(shapes)),
        });
    }
}
