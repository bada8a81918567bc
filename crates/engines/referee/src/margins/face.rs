//! The margin `face`: the least displacement that changes the set of nearest faces.
//!
//! Displacements are measured by the larger of |dx| and |dy|, in cells. Within lo no displaced ray changes the set
//! (proven); at hi one does (the witness is judged exactly). Both are capped at 1.
//!
//! # The proof of lo
//!
//! A square |dx|, |dy| <= r changes nothing if, over all of it, the nearest face F meets its own conditions and every
//! other face G breaks one: an edge, the front, the plane or the range of its own, or the condition to be met at or
//! before F. Each condition is a form g (see `form`), so a radius up to which it holds, or fails, is the root of a
//! quadratic.
//!
//! Where a corner of G points at the ray, no single condition fails for long, though G lies beside the square. Of two
//! convex polygons that do not meet, a side of one separates them. For G's edges this is decided by its corners
//! (`face_forms::beside`). For its other conditions it takes two together: if g1 >= 0 and g2 >= 0, then g1 + w g2 >=
//! 0 for any w > 0. The weights that make the combined slope in x or in y vanish are the best for a square.
//!
//! A face that lies beyond all points of F's triangle or plane over the unit square need not be examined: it is met
//! after F wherever F is met.

use crate::hits::face::Face;
use crate::hits::face_forms::beside;
use crate::hits::neighbourhood::Neighbourhood;
use crate::hits::region::{Region, holds_between};
use crate::margins::margin::Margin;
use crate::margins::subdivision::{is_tight, subdivide};
use crate::rays::displacement::max_norm;
use crate::rays::form::{Form, certainly_fails};

/// The margin of the set of nearest faces.
pub(crate) fn face_margin(near: &Neighbourhood<'_>, nearest: &[usize]) -> Margin {
    let search = FaceMarginSearch::of(near, nearest, [0.0; 2], 1.0);
    let lo = search.lo;
    if lo >= 1.0 {
        return Margin::CAPPED;
    }
    let witness = search.witness();
    if is_tight(lo, witness) || lo <= 0.0 {
        return Margin::of(lo, witness);
    }
    // A part with the same faces at its middle, and which keeps them, is free of a change.
    let (lo, witness) = subdivide(lo, witness, |square, _| {
        let differs = |at: [f64; 2]| near.nearest_at(at) != nearest;
        let changed = differs(square.middle);
        if !changed && FaceMarginSearch::of(near, nearest, square.middle, square.half).lo >= square.half {
            return None;
        }
        let places = square.corners().into_iter().filter(|&at| differs(at));
        let places = places.chain(changed.then_some(square.middle));
        Some(places.min_by(|a, b| max_norm(*a).total_cmp(&max_norm(*b))))
    });
    Margin::of(lo, witness)
}

/// The search for the margin, about a centre at which `nearest` are the nearest faces.
struct FaceMarginSearch<'a> {
    near: &'a Neighbourhood<'a>,
    nearest: &'a [usize],
    centre: [f64; 2],
    lo: f64,
    events: Vec<Event>,
}

/// An event that may change the verdict first, and the radius at which it may happen.
struct Event {
    radius: f64,
    kind: EventKind,
}

/// The kinds of events.
enum EventKind {
    /// A condition of a nearest face begins to fail.
    Fails(Form),
    /// All conditions of another face, given by its index, begin to hold together.
    Enters(usize),
}

impl<'a> FaceMarginSearch<'a> {
    /// Finds `lo`, at most `cap`, and the events that limit it.
    fn of(near: &'a Neighbourhood<'a>, nearest: &'a [usize], centre: [f64; 2], cap: f64) -> Self {
        let mut search = Self { near, nearest, centre, lo: cap, events: Vec::new() };
        let faces = &near.faces;
        // The nearest faces must keep their own conditions.
        for form in nearest.iter().flat_map(|&index| faces[index].conditions()) {
            let form = form.about(centre);
            let radius = form.holds_within();
            if radius < cap {
                search.lo = search.lo.min(radius);
                search.events.push(Event { radius, kind: EventKind::Fails(form) });
            }
        }
        // Several faces at one point stay together only if they lie in one plane.
        let of = |index: usize| -> &Face { faces[index].face };
        if let [first, others @ ..] = nearest
            && others.iter().any(|&other| !of(*first).is_coplanar_with(of(other)))
        {
            search.lo = 0.0;
        }
        // Every other face must stay out.
        for index in 0..faces.len() {
            if !nearest.contains(&index) {
                search.keep_out(index);
            }
        }
        search.events.sort_by(|a, b| a.radius.total_cmp(&b.radius));
        search
    }

    /// Lowers `lo` to a radius within which a face is certainly not among the nearest.
    fn keep_out(&mut self, index: usize) {
        let (face, centre) = (&self.near.faces[index], self.centre);
        let fails = face.edges().iter().map(|edge| edge.about(centre).fails_within());
        let clear = fails.fold(0.0, f64::max);
        // An edge shared with the nearest face gives the same radius but for rounding: no event.
        let enough = self.lo * (1.0 - 1.0 / (1u64 << 20) as f64);
        if clear >= enough {
            self.lo = self.lo.min(clear);
            return;
        }
        let [a, b, c] = &face.corners;
        let mut clear = beside([a, b, c], centre).max(clear);
        if let Some(&nearest) = self.nearest.first() {
            clear = self.near.sooner(nearest, index).about(centre).holds_within().max(clear);
        }
        if clear < enough {
            let apart = if face.is_before() { 3 } else { 0 };
            clear = certainly_fails(&self.conditions(index, enough), apart, enough).max(clear);
        }
        if clear < self.lo {
            self.lo = clear;
            self.events.push(Event { radius: clear, kind: EventKind::Enters(index) });
        }
    }

    /// The conditions for a face to be met first, edges first. Conditions that hold within `r` anyway are left out,
    /// except the edges.
    fn conditions(&self, index: usize, r: f64) -> Vec<Form> {
        let face = &self.near.faces[index];
        let mut forms = Vec::with_capacity(7);
        forms.extend(face.edges().iter().map(|edge| edge.about(self.centre)));
        let before = self.nearest.first().map(|&nearest| face.at_or_before(&self.near.faces[nearest]));
        let others = face.conditions()[3..].iter().copied().chain(before).map(|form| form.about(self.centre));
        forms.extend(others.filter(|form| form.holds_within() < r));
        forms
    }

    /// A displaced ray with another verdict, as near as it can be found.
    fn witness(&self) -> Option<[f64; 2]> {
        // All faces that could hide the nearest ones are known. Where no known face is met, or another one is, the
        // verdict differs, whatever lies beyond.
        let differs = |at: [f64; 2]| self.near.nearest_at(at) != self.nearest;
        let mut best: Option<[f64; 2]> = None;
        // Keeps a nearer witness; returns whether it is near enough to stop.
        let try_witness = |best: &mut Option<[f64; 2]>, at: [f64; 2]| {
            let nearer = best.is_none_or(|best| max_norm(at) < max_norm(best));
            if nearer && max_norm(at) <= 1.0 && differs(at) {
                *best = Some(at);
            }
            best.is_some_and(|best| self.is_near_enough(best))
        };
        for event in &self.events {
            match &event.kind {
                EventKind::Fails(form) => {
                    // The corner of the square at which the form vanishes first.
                    let away = |slope: f64| if slope > 0.0 { -1.0 } else { 1.0 };
                    let corner = [away(form.x), away(form.y)];
                    // Beyond the root by twice the form's error, and then farther.
                    let doubt = 2.25 * form.error / (form.x.abs() + form.y.abs());
                    for further in [1e-9, 1e-6, 1e-3, 0.1, 0.7] {
                        let r = event.radius * (1.0 + further) + doubt * (1.0 + further * 1e2);
                        if try_witness(&mut best, [corner[0] * r, corner[1] * r]) {
                            return best;
                        }
                    }
                }
                EventKind::Enters(index) => {
                    if self.towards(&self.conditions(*index, 2.0), |at| try_witness(&mut best, at)) {
                        return best;
                    }
                }
            }
            if best.is_some_and(|best| max_norm(best) <= 1.9 * event.radius) {
                return best;
            }
        }
        // Faces so thin that a beam bends them by more than their width: try points of the triangles themselves.
        for event in &self.events {
            if is_tight(event.radius, best) {
                break;
            }
            if let EventKind::Enters(index) = event.kind {
                for at in self.threads(index).into_iter().chain(self.tips(index)) {
                    if try_witness(&mut best, at) {
                        return best;
                    }
                }
            }
        }
        best
    }

    /// Whether no nearer witness is looked for.
    fn is_near_enough(&self, witness: [f64; 2]) -> bool {
        max_norm(witness) <= self.lo * 1.01 + 1e-12
    }

    /// Points of a face near its corners and along its sides, inside by a part of its width, the nearest first.
    fn threads(&self, index: usize) -> Vec<[f64; 2]> {
        let mut points = Vec::new();
        for k in 0..3 {
            for s in [0.0, 1e-6, 1e-4, 0.01, 0.04, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.96] {
                for inward in [1e-6, 1e-3, 0.03] {
                    let mut weights = [inward / 3.0; 3];
                    weights[k] += (1.0 - s) * (1.0 - inward);
                    weights[(k + 1) % 3] += s * (1.0 - inward);
                    points.push(self.near.faces[index].point(&self.near.ray, weights));
                }
            }
        }
        points.retain(|&at| max_norm(at) <= 1.0);
        points.sort_by(|a, b| max_norm(*a).total_cmp(&max_norm(*b)));
        points
    }

    /// Points of a face in and near its nearest corner, and between the points of its sides that the ray passes. These are
    /// known more exactly than any form.
    fn tips(&self, index: usize) -> Vec<[f64; 2]> {
        let mut points = self.near.displacements_inside_corners(index, 1.0);
        let nearest = points.iter().map(|&at| max_norm(at)).fold(1.0, f64::min);
        points.extend(self.near.displacements_inside_corners(index, (2.0 * nearest).min(1.0)));
        points.extend(self.near.displacements_between_sides(index));
        points.sort_by(|a, b| max_norm(*a).total_cmp(&max_norm(*b)));
        points
    }

    /// Tries points from the region where all forms hold, from its nearest point towards its middle, until
    /// `try_witness` accepts one. At one dy the forms are linear in dx, so that thin regions bent by a beam are met
    /// as well.
    fn towards(&self, forms: &[Form], mut try_witness: impl FnMut([f64; 2]) -> bool) -> bool {
        let Some(Region { near, middle, .. }) = Region::of(forms) else { return false };
        [0.0, 1e-9, 1e-6, 1e-3, 0.03, 0.3, 1.0].into_iter().any(|inward| {
            let at = [0, 1].map(|k: usize| near[k] + inward * (middle[k] - near[k]));
            let across = holds_between(forms, at[1]);
            let in_row = across.map(|[from, to]| {
                let nearest = if from > 0.0 { from } else { to.min(0.0) };
                [[nearest + 1e-3 * (0.5 * (from + to) - nearest), at[1]], [0.5 * (from + to), at[1]]]
            });
            std::iter::once(at).chain(in_row.into_iter().flatten()).any(&mut try_witness)
        })
    }
}

#[cfg(test)]
#[path = "../../tests/unit/face_margin.rs"]
mod tests;
