//! Sheets: whether the nearest range is continuous over a square of displacements.
//!
//! # The proof
//!
//! For a square of radius r around a centre, a face is *possible* if no condition of its own (edges, front, plane,
//! range, or two of them combined) fails over all of the square. Start at a possible face and cross each of its edges
//! that may lie in the square to a face that has the same edge the other way round, and so on. The faces crossed are
//! a *sheet without an end* if every such edge has a face on its other side, and the front, plane and range
//! conditions of all these faces hold over all of the square. (At a fold one of the two faces shows its back: a fold
//! is an end.)
//!
//! Take any point x of the square in the image of such a face F. On an edge through x lies a mate, whose image begins
//! at that edge on the other side, for both show their fronts. At x the mate has the range of F, for it has the
//! edge's own points. If x is a corner, mates follow one another around it, all the same way round and all with that
//! corner, until every direction is covered. So around x there are faces of the sheet in every direction whose ranges
//! at x are F's, and it follows:
//!
//! 1. The images of the sheet cover the square: together they are closed, not empty, and have no border in it.
//! 2. The least range over some such sheets is continuous: near x it is at most F's plus a term that vanishes at x,
//!    for all F at x. As faces are closed and finite in number, it does not fall below the least at x either.
//!
//! Suppose the nearest face's sheet has no end, and every other possible face either lies in a sheet without an end
//! or is certainly met after all faces of the first sheet (which are everywhere, by 1). Then the nearest range over
//! the square is that least range, and by 2 there is no jump. If there is no possible face at all, all of the square
//! misses.
//!
//! "Certainly after": the order of two faces is a form, and so is the condition that one is met nearer than the whole
//! triangle of the other. Faces beyond the range of all triangles of the first sheet in the square are not even
//! looked up.
//!
//! Edges tell that a triangle lies beside the square only if its front is known to show: all edge forms are negative
//! inside of a triangle seen from behind. So nothing is concluded from a mate but what its corners say, and an edge
//! is absent by its own line and its own two ends alone.
//!
//! # The largest such square
//!
//! It needs no search. An edge that is absent from the square of radius d has to be crossed in larger squares only,
//! and so have all faces behind it. Each face enters at the least d over all paths to it, where the d of a path is
//! the greatest d on it. `sheet` takes the faces in the order of their d, as Dijkstra's algorithm does. A sheet ends
//! at the least radius at which a face that has entered fails a condition, or at which an edge without a mate enters
//! the square.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::hits::face_forms::{FaceForms, beside};
use crate::hits::neighbourhood::{EdgeMate, Neighbourhood};
use crate::rays::form::{Form, certainly_fails, line_leaves};

/// Radii about one centre that can be proven for one face.
#[derive(Debug, Clone, Copy)]
struct ProvenRadii {
    edges: [Form; 3],
    /// Radius within which the face is not possible.
    absent: f64,
    /// Radius within which front, plane and range hold.
    holds: f64,
    /// Radius within which each edge does not lie; known up to `holds`.
    edge_absent: [f64; 3],
}

impl ProvenRadii {
    fn of(face: &FaceForms<'_>, centre: [f64; 2]) -> Self {
        let own = face.conditions().map(|form| form.about(centre));
        let [a, b, c, front, plane, range] = own;
        let edges = [a, b, c];
        let others = [front, plane, range];
        let holds = others.iter().map(Form::holds_within).fold(1.0, f64::min);
        let known = face.is_before();
        let [p, q, r] = &face.corners;
        let mut absent = own.iter().map(Form::fails_within).fold(beside([p, q, r], centre), f64::max);
        if absent < 1.0 && (holds < 1.0 || !known) {
            absent = absent.max(certainly_fails(&own, if known { 3 } else { 0 }, 1.0));
        }
        // A segment lies beside a square by its line or by a side of the square.
        let edge_absent = [0, 1, 2].map(|k: usize| {
            let (edge, next) = (&edges[k], (k + 1) % 3);
            let mut best = edge.holds_within().max(edge.fails_within());
            if best < 1.0 {
                best = best.max(beside([&face.corners[k], &face.corners[next]], centre));
            }
            if best < 1.0 && !known {
                // Where the front shows, no point of the edge lies outside of the other two edges.
                let others = [&edges[next], &edges[(k + 2) % 3]];
                best = others.into_iter().map(|other| line_leaves(edge, other)).fold(best, f64::max);
            }
            best
        });
        Self { edges, absent, holds, edge_absent }
    }
}

/// A sheet: the radius up to which it has no end, and its faces with the radius at which each enters.
struct Sheet {
    radius: f64,
    faces: Vec<(usize, f64)>,
}

/// The proofs about one centre, with the radii of each face cached.
struct ContinuityProof<'n, 'a> {
    near: &'n mut Neighbourhood<'a>,
    centre: [f64; 2],
    radii: Vec<Option<ProvenRadii>>,
}

impl Neighbourhood<'_> {
    /// A radius of at most `cap` within which the nearest range is certainly continuous around `centre`; 0 if there
    /// is none. The square of radius `cap` must lie within a cell of the ray.
    pub(crate) fn continuous_within(&mut self, centre: [f64; 2], nearest: &[usize], cap: f64) -> f64 {
        let mut around = ContinuityProof { near: self, centre, radii: Vec::new() };
        match nearest.first() {
            Some(&first) => around.continuous(first, cap),
            None => around.all_miss(cap),
        }
    }

    /// The faces of the sheet of a face that is met at `centre`, if the sheet has no end within `half`: every ray of
    /// that square meets one of them.
    pub(crate) fn covering_sheet(&mut self, centre: [f64; 2], start: usize, half: f64) -> Option<Vec<usize>> {
        let sheet = ContinuityProof { near: self, centre, radii: Vec::new() }.sheet(start, half);
        (sheet.radius >= half).then(|| sheet.faces.iter().map(|&(index, _)| index).collect())
    }

    /// Whether every ray of a square of radius `half` around `centre` certainly hits, and the indices of all faces
    /// that may be among its nearest.
    pub(crate) fn possible(&mut self, centre: [f64; 2], half: f64) -> (bool, Vec<usize>) {
        // The nearest face's sheet may end at a silhouette, and a face behind it may have a sheet without an end.
        let nearest = self.nearest_at(centre);
        let is_met = |face: &FaceForms<'_>| {
            face.conditions().iter().all(|form| form.is_positive_at(centre) == Some(true))
        };
        let mut starts = nearest.first().copied().into_iter().collect::<Vec<_>>();
        if let Some(&first) = nearest.first() {
            let others = (0..self.faces.len()).filter(|&index| index != first && is_met(&self.faces[index]));
            starts.extend(others);
        }
        let mut around = ContinuityProof { near: self, centre, radii: Vec::new() };
        for start in starts {
            // A sheet without an end covers the square: no face behind it is nearest.
            let sheet = around.sheet(start, half);
            if sheet.radius < half {
                continue;
            }
            let mut faces: Vec<usize> = sheet.faces.iter().map(|&(index, _)| index).collect();
            for index in 0..around.near.faces.len() {
                let is_other = !sheet.faces.iter().any(|&(kept, _)| kept == index);
                if is_other
                    && around.radii_of(index).absent < half
                    && around.behind(index, &sheet, half) < half
                {
                    faces.push(index);
                }
            }
            return (true, faces);
        }
        around.near.extend_to_max_range();
        let count = around.near.faces.len();
        (false, (0..count).filter(|&index| around.radii_of(index).absent < half).collect())
    }
}

impl ContinuityProof<'_, '_> {
    fn radii_of(&mut self, index: usize) -> ProvenRadii {
        if self.radii.len() <= index {
            self.radii.resize(self.near.faces.len(), None);
        }
        *self.radii[index].get_or_insert_with(|| ProvenRadii::of(&self.near.faces[index], self.centre))
    }

    fn all_miss(&mut self, cap: f64) -> f64 {
        self.near.extend_to_max_range();
        (0..self.near.faces.len())
            .fold(cap, |r, index| if r > 0.0 { r.min(self.radii_of(index).absent) } else { r })
    }

    fn continuous(&mut self, first: usize, cap: f64) -> f64 {
        let sheet = self.sheet(first, cap);
        let mut r = sheet.radius;
        // Faces of sheets without an end make no jump.
        let mut continuous = vec![false; self.near.faces.len()];
        let mark = |continuous: &mut Vec<bool>, sheet: &Sheet| {
            for &(index, enters) in &sheet.faces {
                if enters < sheet.radius {
                    if continuous.len() <= index {
                        continuous.resize(index + 1, false);
                    }
                    continuous[index] = true;
                }
            }
        };
        mark(&mut continuous, &sheet);
        // All faces that may be met before the first sheet's end are known by now; the number of faces may still
        // grow.
        let mut index = 0;
        while index < self.near.faces.len() && r > 0.0 {
            let known = continuous.get(index).copied().unwrap_or(false);
            if !known && self.radii_of(index).absent < r {
                let behind = self.behind(index, &sheet, r);
                let mut enough = behind.max(self.radii_of(index).absent);
                if enough < r {
                    let own = self.sheet(index, r);
                    enough = enough.max(own.radius);
                    if own.radius >= r {
                        mark(&mut continuous, &own);
                    }
                }
                r = r.min(enough);
            }
            index += 1;
        }
        r
    }

    /// The sheet of a face, followed up to the radius `cap`.
    fn sheet(&mut self, start: usize, cap: f64) -> Sheet {
        let mut r = cap;
        let mut faces: Vec<(usize, f64)> = Vec::new();
        let mut enters = vec![f64::INFINITY; self.near.faces.len()];
        let mut done = vec![false; self.near.faces.len()];
        // Bits of numbers that are not negative are in the order of the numbers.
        let mut waiting = BinaryHeap::from([Reverse((0.0_f64.to_bits(), start))]);
        enters[start] = 0.0;
        while let Some(Reverse((bits, index))) = waiting.pop() {
            let d = f64::from_bits(bits);
            if d >= r {
                break;
            }
            if std::mem::replace(&mut done[index], true) {
                continue;
            }
            faces.push((index, d));
            // Its mates, and faces that it hides, may lie as far as its far end.
            if self.near.extend_to(self.near.faces[index].farthest) {
                enters.resize(self.near.faces.len(), f64::INFINITY);
                done.resize(self.near.faces.len(), false);
            }
            let radii = self.radii_of(index);
            r = r.min(radii.holds.max(d));
            for k in 0..3 {
                let at = radii.edge_absent[k].max(d);
                if at >= r {
                    continue;
                }
                match self.mate(index, k) {
                    None => r = r.min(at),
                    Some(EdgeMate::Beside) => {}
                    Some(EdgeMate::Near(mate)) => {
                        if at < enters[mate] {
                            enters[mate] = at;
                            waiting.push(Reverse((at.to_bits(), mate)));
                        }
                    }
                }
            }
        }
        Sheet { radius: r, faces }
    }

    /// The face on the other side of edge `k`. Where more than two faces share an edge, any front is valid: this
    /// returns the one whose conditions hold farthest.
    fn mate(&mut self, index: usize, k: usize) -> Option<EdgeMate> {
        let mates = self.near.mates(index, k);
        if mates.len() <= 1 || mates.contains(&EdgeMate::Beside) {
            return mates.into_iter().max_by_key(|mate| *mate == EdgeMate::Beside);
        }
        let goes_on = |mate: &EdgeMate, around: &mut Self| match mate {
            EdgeMate::Near(mate) => around.radii_of(*mate).holds,
            EdgeMate::Beside => 1.0,
        };
        let mut best: Option<(EdgeMate, f64)> = None;
        for mate in mates {
            let far = goes_on(&mate, self);
            if best.is_none_or(|(_, best)| far > best) {
                best = Some((mate, far));
            }
        }
        best.map(|(mate, _)| mate)
    }

    /// A radius within which a face is certainly not met at or before any face of a sheet that is met: the largest
    /// that can be shown, or one of at least `enough`.
    fn behind(&mut self, index: usize, sheet: &Sheet, enough: f64) -> f64 {
        let mut least = enough;
        for &(kept, enters) in &sheet.faces {
            if enters >= least {
                continue;
            }
            let (face, other) = (self.radii_of(index), self.radii_of(kept));
            let before = self.near.faces[index].at_or_before(&self.near.faces[kept]).about(self.centre);
            let mut radius = before.fails_within().max(other.absent).max(enters);
            if radius < least {
                // Where the ray lies in a face's plane the form vanishes, but the distance does not.
                let sooner = self.near.sooner(kept, index).about(self.centre);
                radius = radius.max(sooner.holds_within());
            }
            if radius < least {
                let ([a, b, c], [d, e, f]) = (face.edges, other.edges);
                radius = radius.max(certainly_fails(&[a, b, c, d, e, f, before], 0, least));
            }
            least = least.min(radius);
            if least <= 0.0 {
                break;
            }
        }
        least
    }
}

#[cfg(test)]
#[path = "../../tests/unit/sheet.rs"]
mod tests;
