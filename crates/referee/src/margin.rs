//! How far a verdict is from changing: the margin `face`, as an interval with a witness.
//!
//! Displacements are measured by the larger of |dx| and |dy|, in cells. The margin is the least displacement
//! that changes the set of nearest faces; it is given as [lo, hi]: within lo no displaced ray changes the
//! set (proven), at hi one does (the witness is judged exactly). Both are capped at 1.
//!
//! # The proof of lo
//!
//! A square |dx|, |dy| <= r changes nothing if over all of it the nearest face F meets its own conditions and
//! every other face G breaks one: an edge, front, plane or range of its own, or to be met at or before F.
//! Each condition is a form g (see `forms`), so a radius up to which it holds, or fails, is the root of a
//! quadratic. Where a corner of G points at the ray no single condition fails for long, though two do
//! together: if g1 >= 0 and g2 >= 0 then g1 + w g2 >= 0 for any w > 0, and the weights that make the combined
//! slope in x or in y vanish are the best there are for a square. (The separating line of a convex polygon
//! and a square runs along a side of one of them.)

use raypencil_scene::SensorId;

use crate::face::Face;
use crate::forms::{FaceForms, Form, MovingRay, certainly_fails, edge};
use crate::pencil::{Aim, Sensor};
use crate::region::{Region, holds_between, size};
use crate::verdict::{Displacement, Referee, bundle};

/// The least displacement that changes a verdict, in cells, somewhere in `lo..=hi`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margin {
    /// No displaced ray within this changes the verdict.
    pub lo: f64,
    /// The witness's displacement; 1 if there is none because the margin is capped.
    pub hi: f64,
    /// A displaced ray whose verdict is another.
    pub witness: Option<Displacement>,
}

impl Margin {
    /// A verdict that does not change within a cell.
    pub(crate) const CAPPED: Self = Self { lo: 1.0, hi: 1.0, witness: None };
}

impl Referee<'_> {
    /// The margin of the set of nearest faces of cell (i, j), or `None` if there is no such cell.
    pub fn face_margin(&self, sensor: SensorId, i: u32, j: u32) -> Option<Margin> {
        let sensor = Sensor::of(self.scene, sensor)?;
        let (width, height) = sensor.size();
        if i >= width || j >= height {
            return None;
        }
        let aim = Aim { i, j, dx: 0.0, dy: 0.0 };
        Some(Search { referee: self, sensor: &sensor, aim, nearest: self.nearest(&sensor, aim) }.margin())
    }
}

/// The search for one margin.
struct Search<'a> {
    referee: &'a Referee<'a>,
    sensor: &'a Sensor,
    aim: Aim,
    nearest: Vec<&'a Face>,
}

/// What may end the verdict first: a condition of a nearest face that comes to fail, or another face whose
/// conditions come to hold together.
struct Event {
    radius: f64,
    forms: Vec<Form>,
    /// Whether it is the failing of the (only) form; else it is the holding of all.
    fails: bool,
}

impl Search<'_> {
    fn margin(&self) -> Margin {
        let ray = MovingRay::new(self.sensor, self.aim);
        let nearest: Vec<FaceForms<'_>> =
            self.nearest.iter().map(|face| FaceForms::new(&ray, face)).collect();
        let mut events = Vec::new();
        let mut lo = 1.0_f64;

        // The nearest faces must stay what they are.
        for forms in &nearest {
            for form in forms.own() {
                let radius = form.holds_within();
                lo = lo.min(radius);
                events.push(Event { radius, forms: vec![form], fails: true });
            }
        }
        // Several at one point stay together only if they lie in one plane.
        if let [first, others @ ..] = self.nearest.as_slice()
            && others.iter().any(|other| !first.is_coplanar_with(other))
        {
            lo = 0.0;
        }

        // Every other face that could come to be met must stay out of it.
        let reach =
            nearest.iter().map(|forms| forms.farthest_range(lo)).fold(self.sensor.max_range(), f64::min);
        let mut around = bundle(self.sensor, self.aim, 1.0);
        around.reach = reach * (1.0 + f64::EPSILON);
        self.referee.tree.visit(&around, |face, _| {
            if !self.nearest.iter().any(|kept| kept.id == face.id) {
                self.keep_out(&ray, nearest.first(), face, &mut lo, &mut events);
            }
            around.reach
        });

        if lo >= 1.0 {
            return Margin::CAPPED;
        }
        events.sort_by(|a, b| a.radius.total_cmp(&b.radius));
        match self.witness(&events, lo) {
            Some(witness) => Margin { lo, hi: witness.size().min(1.0), witness: Some(witness) },
            None => Margin { lo, hi: 1.0, witness: None },
        }
    }

    /// Lowers `lo` to a radius within which `face` is certainly not among the nearest.
    fn keep_out(
        &self,
        ray: &MovingRay,
        nearest: Option<&FaceForms<'_>>,
        face: &Face,
        lo: &mut f64,
        events: &mut Vec<Event>,
    ) {
        // Most faces of the neighbourhood are cleared by one of their edges.
        let edges = [0, 1, 2].map(|k| edge(ray, face, k));
        if edges.iter().any(|form| form.fails_within() >= *lo) {
            return;
        }
        let own = FaceForms::new(ray, face);
        let mut forms = edges.to_vec();
        forms.extend([own.front(), own.plane(), own.range()]);
        forms.extend(nearest.map(|nearest| own.at_or_before(nearest)));
        let out = certainly_fails(&forms, *lo);
        if out < *lo {
            *lo = out;
            events.push(Event { radius: out, forms, fails: false });
        }
    }

    /// A displaced ray whose verdict differs, as near as it can be found.
    fn witness(&self, events: &[Event], lo: f64) -> Option<Displacement> {
        let before: Vec<_> = self.nearest.iter().map(|face| face.id).collect();
        let differs = |at: [f64; 2]| {
            let aim = Aim { dx: at[0], dy: at[1], ..self.aim };
            let after = self.referee.nearest(self.sensor, aim);
            !after.iter().map(|face| face.id).eq(before.iter().copied())
        };
        let mut best: Option<[f64; 2]> = None;
        // Keeps a nearer witness; says whether it is near enough to stop.
        let offer = |best: &mut Option<[f64; 2]>, at: [f64; 2]| {
            let nearer = best.is_none_or(|best| size(at) < size(best));
            if nearer && size(at) <= 1.0 && differs(at) {
                *best = Some(at);
            }
            best.is_some_and(|best| size(best) <= lo * 1.01 + 1e-12)
        };
        for event in events {
            if event.fails {
                // The corner of the square at which the form vanishes first.
                let form = &event.forms[0];
                let away = |slope: f64| if slope > 0.0 { -1.0 } else { 1.0 };
                let corner = [away(form.x.middle()), away(form.y.middle())];
                for further in [1e-9, 1e-6, 1e-3, 0.1, 0.7] {
                    let r = event.radius * (1.0 + further) + 1e-13 * (1.0 + further * 1e6);
                    if offer(&mut best, [corner[0] * r, corner[1] * r]) {
                        return best.map(|[dx, dy]| Displacement { dx, dy });
                    }
                }
            } else if let Some(Region { near, middle, .. }) = Region::of(&event.forms) {
                // From the nearest point of the region where all hold towards its middle. At one dy the forms
                // are linear in dx, so that thin regions, which a beam bends, are met as well.
                for inward in [0.0, 1e-9, 1e-6, 1e-3, 0.03, 0.3, 1.0] {
                    let at = [0, 1].map(|k: usize| near[k] + inward * (middle[k] - near[k]));
                    let across = holds_between(&event.forms, at[1]);
                    let in_row = across.map(|[from, to]| {
                        let nearest = if from > 0.0 { from } else { to.min(0.0) };
                        [[nearest + 1e-3 * (0.5 * (from + to) - nearest), at[1]], [0.5 * (from + to), at[1]]]
                    });
                    for at in std::iter::once(at).chain(in_row.into_iter().flatten()) {
                        if offer(&mut best, at) {
                            return best.map(|[dx, dy]| Displacement { dx, dy });
                        }
                    }
                }
            }
            if best.is_some_and(|best| size(best) <= 1.9 * event.radius) {
                break;
            }
        }
        best.map(|[dx, dy]| Displacement { dx, dy })
    }
}
