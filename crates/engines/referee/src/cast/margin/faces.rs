//! The margin of the set of nearest faces.
//!
//! It changes when one of the nearest faces stops to be met, or when another is met at or before them. Within the radius
//! up to which the nearest faces meet their own conditions (the least of g / (|x| + |y|) over these), another face G
//! enters where its own conditions hold and its plane is met at or before that of a nearest face F. These are linear
//! conditions: `region` finds the least displacement at which all hold. Several nearest faces stay together only if
//! they lie in one plane; otherwise the least displacement is 0.

use std::cell::OnceCell;
use std::collections::BTreeSet;

use raypencil_scene::{FaceId, Side};

use super::super::triangle::Triangle;
use super::flat::{FlatFace, Linear, at_or_before};
use super::frame::{Frame, FrameNumbers};
use super::nearby::Nearby;
use super::region::{Bounded, LazyLinear, least_size};
use super::view::View;
use super::{ExactCast, within};
use crate::margins::margin::Margin;
use crate::numbers::number::{Dyadic, Interval, Number};

/// A face that the direction of the ray sees from one side.
#[derive(Clone, Copy)]
struct SeenFace<'t> {
    face: &'t Triangle,
    side: Side,
}

/// What may change the set first, with bounds of the size at which it does.
struct Event {
    size: [f64; 2],
    kind: EventKind,
}

enum EventKind {
    /// A condition of a nearest face begins to fail.
    Fails(Linear<f64>),
    /// All conditions of another face begin to hold.
    Enters(Vec<Linear<f64>>),
}

impl ExactCast<'_> {
    pub(super) fn face_margin(&self, frame: &Frame<'_>, nearest: &[Triangle], view: &View<'_>) -> Margin {
        let cap = self.tree.diagonal;
        let nearest: Vec<SeenFace<'_>> =
            nearest.iter().filter_map(|face| Some(SeenFace { face, side: view.side(face)? })).collect();
        let first = nearest.first().map(|first| InPlane::new(*first, frame));
        // Thousands of faces may lie in one place: they have the same conditions.
        let seams = self.seams();
        let distinct: Vec<&SeenFace<'_>> = nearest.iter().filter(|one| !seams.is_copy(one.face.id)).collect();
        let mut events = Vec::new();
        let mut lo = cap;
        for one in &distinct {
            for condition in OwnConditions::of(frame, one) {
                lo = lo.min(condition.size[0]);
                events.push(condition);
            }
        }
        if let [first, others @ ..] = &distinct[..]
            && others.iter().any(|other| !first.is_coplanar_with(other, frame.exact()))
        {
            lo = 0.0;
        }
        // No part of the nearest face within its own margin lies beyond its farthest corner.
        let farthest = nearest.first().map_or(frame.ranges()[1], |first| {
            let [a, b, c] = first.face.corners;
            frame.span(a.min(b).min(c), a.max(b).max(c))[2][1]
        });
        let first_range = frame.ranges()[0];
        let is_between = |range: &[f64; 2]| range[0] <= farthest && range[1] >= first_range;
        let own: BTreeSet<FaceId> = nearest.iter().map(|one| one.face.id).collect();
        let mut nearby = Nearby::new(self.places());
        while nearby.size() < lo {
            let faces =
                nearby.open(frame, |_, span| super::frame::least_size(span) < lo && is_between(&span[2]));
            for face in faces {
                if own.contains(&face.id) {
                    continue;
                }
                let Some(side) = view.side_hit(face) else { continue };
                let entering = Entering::new(InPlane::new(SeenFace { face, side }, frame), first.as_ref());
                // An edge shared with a nearest face gives the same size but for rounding: no new event, but the proven size may
                // be the smaller one.
                let enough = lo * (1.0 - 1.0 / (1u64 << 30) as f64);
                if let Some(size) = entering.size(lo) {
                    lo = lo.min(size[0]);
                    if size[0] < enough {
                        events.push(Event { size, kind: EventKind::Enters(entering.rounded()) });
                    }
                }
            }
        }
        if lo >= cap {
            return within([cap; 2], None, 0.0, cap);
        }
        events.retain(|event| event.size[0] <= 2.0 * lo.max(self.smallest_size(frame)));
        events.sort_by(|a, b| a.size[0].total_cmp(&b.size[0]));
        let hi = events.iter().map(|event| event.size[1]).fold(cap, f64::min);
        let hi = if lo == 0.0 { 0.0 } else { hi };
        let ids: Vec<_> = nearest.iter().map(|one| one.face.id).collect();
        let differs = |by: [f64; 2]| self.first_moved(frame.ray, view.sides(), by) != ids;
        let least = 2.0 * self.smallest_size(frame);
        within([lo, hi], self.face_witness(frame, &events, lo, cap, differs), least, cap)
    }

    /// A size of displacement below which f64 numbers can hardly tell one ray from another: 2^-52 of the largest
    /// coordinate.
    pub(super) fn smallest_size(&self, frame: &Frame<'_>) -> f64 {
        f64::EPSILON * self.tree.largest_coordinate.max(frame.ray.origin.abs().max_element())
    }

    /// A displaced ray with another answer, as near to `lo` as it can be found.
    fn face_witness(
        &self,
        frame: &Frame<'_>,
        events: &[Event],
        lo: f64,
        cap: f64,
        differs: impl Fn([f64; 2]) -> bool,
    ) -> Option<[f64; 2]> {
        let least = lo.max(self.smallest_size(frame));
        for further in [1e-12, 1e-9, 1e-6, 1e-4, 5e-3, 0.5, 0.9] {
            let size = (least * (1.0 + further)).min(cap);
            for event in events.iter().take(8) {
                let by = match &event.kind {
                    // The corner of the square at which the condition fails first.
                    EventKind::Fails(condition) => {
                        let away = |slope: f64| if slope > 0.0 { -size } else { size };
                        Some([away(condition.x), away(condition.y)])
                    }
                    EventKind::Enters(conditions) => middle_within(conditions, size),
                };
                if let Some(by) = by.filter(|by| differs(*by)) {
                    return Some(by);
                }
            }
        }
        // Faces at one point but in several planes: any side may tell them apart.
        let round = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0], [1.0, 1.0], [-1.0, -1.0]];
        round.into_iter().map(|by| by.map(|part| part * 1.5 * least)).find(|by| differs(*by))
    }
}

/// The middle of the region in which all conditions hold, in a square about 0: it only says where to look.
fn middle_within(conditions: &[Linear<f64>], size: f64) -> Option<[f64; 2]> {
    let mut corners = vec![[-size, -size], [size, -size], [size, size], [-size, size]];
    for condition in conditions {
        let at = |p: [f64; 2]| condition.c + condition.x * p[0] + condition.y * p[1];
        let mut kept = Vec::with_capacity(corners.len() + 1);
        for (k, &here) in corners.iter().enumerate() {
            let next = corners[(k + 1) % corners.len()];
            let (a, b) = (at(here), at(next));
            if a >= 0.0 {
                kept.push(here);
            }
            if (a >= 0.0) != (b >= 0.0) {
                let s = a / (a - b);
                kept.push([here[0] + s * (next[0] - here[0]), here[1] + s * (next[1] - here[1])]);
            }
        }
        corners = kept;
    }
    let count = corners.len() as f64;
    (!corners.is_empty())
        .then(|| [0, 1].map(|k: usize| corners.iter().map(|corner| corner[k]).sum::<f64>() / count))
}

/// A displacement in the middle of those up to `size` at which the ray's line meets a face whose `side` it sees; `None` if
/// none is found. It only says where to look.
pub(in super::super) fn onto_face(
    frame: &Frame<'_>,
    face: &Triangle,
    side: Side,
    size: f64,
) -> Option<[f64; 2]> {
    let flat = SeenFace { face, side }.flat(frame.exact());
    let edges: Vec<Linear<f64>> = (0..3).map(|k| rounded_exact(&flat.edge(k), frame)).collect();
    middle_within(&edges, size)
}

/// The conditions under which a face stays met, as events.
struct OwnConditions;

impl OwnConditions {
    fn of(frame: &Frame<'_>, one: &SeenFace<'_>) -> Vec<Event> {
        let fast = one.flat(&frame.fast).conditions(&frame.fast);
        let sized =
            |own: &Linear<Interval>| Interval::quotient_between(&own.c, &own.x.abs().add(&own.y.abs()));
        let is_known = |[low, high]: [f64; 2]| low > 0.0 && high <= low * (1.0 + 1.0 / (1u64 << 30) as f64);
        if fast.iter().map(sized).all(is_known) {
            let fails = |own: &Linear<Interval>| Event {
                size: in_units(sized(own), frame),
                kind: EventKind::Fails(rounded(own, frame)),
            };
            return fast.iter().map(fails).collect();
        }
        let exact = one.flat(frame.exact()).conditions(frame.exact());
        let fails = |own: &Linear<Dyadic>| {
            let slope = own.x.abs().add(&own.y.abs());
            // A face at right angles to the ray keeps its t everywhere.
            let size = match slope.sign() {
                Some(std::cmp::Ordering::Equal) => [f64::INFINITY; 2],
                _ => Dyadic::quotient_between(&own.c, &slope),
            };
            Event { size: in_units(size, frame), kind: EventKind::Fails(rounded_exact(own, frame)) }
        };
        exact.iter().map(fails).collect()
    }
}

/// A size in D times the mesh's unit, in the mesh's unit.
pub(super) fn in_units([low, high]: [f64; 2], frame: &Frame<'_>) -> [f64; 2] {
    let Interval { low: least, high: most } = frame.fast.scale;
    [(low / most * (1.0 - 2.0 * f64::EPSILON)).max(0.0), high / least * (1.0 + 2.0 * f64::EPSILON)]
}

/// A condition in f64, as a function of a and b themselves. It only says where to look.
fn rounded(linear: &Linear<Interval>, frame: &Frame<'_>) -> Linear<f64> {
    let scale = frame.fast.scale.middle();
    Linear { c: linear.c.middle(), x: linear.x.middle() * scale, y: linear.y.middle() * scale }
}

fn rounded_exact(linear: &Linear<Dyadic>, frame: &Frame<'_>) -> Linear<f64> {
    let one = Dyadic::of(1.0);
    // The largest is made 1 long, for polynomials of high degree leave f64.
    let largest = [&linear.c, &linear.x, &linear.y].map(Bounded::abs);
    let largest = largest.iter().fold(&one, |kept, part| {
        if part.sub(kept).sign() == Some(std::cmp::Ordering::Greater) { part } else { kept }
    });
    let part = |x: &Dyadic| crate::numbers::rounding::quotient(x, largest).double;
    let scale = frame.fast.scale.middle();
    Linear { c: part(&linear.c), x: part(&linear.x) * scale, y: part(&linear.y) * scale }
}

impl SeenFace<'_> {
    fn flat<T: Number>(&self, frame: &FrameNumbers<T>) -> FlatFace<T> {
        FlatFace::new(frame, &self.face.corners, self.side)
    }

    fn is_coplanar_with(&self, other: &Self, exact: &FrameNumbers<Dyadic>) -> bool {
        let order = self.flat(exact).at_or_before(&other.flat(exact));
        [&order.c, &order.x, &order.y].iter().all(|part| part.sign() == Some(std::cmp::Ordering::Equal))
    }
}

/// A face in the frame, with what is made of it more than once.
struct InPlane<'a> {
    frame: &'a Frame<'a>,
    seen: SeenFace<'a>,
    fast: FlatFace<Interval>,
    fast_height: Linear<Interval>,
    exact: OnceCell<(FlatFace<Dyadic>, Linear<Dyadic>)>,
}

impl<'a> InPlane<'a> {
    fn new(seen: SeenFace<'a>, frame: &'a Frame<'a>) -> Self {
        let fast = seen.flat(&frame.fast);
        Self { frame, seen, fast_height: fast.height(), fast, exact: OnceCell::new() }
    }

    fn exact(&self) -> &(FlatFace<Dyadic>, Linear<Dyadic>) {
        self.exact.get_or_init(|| {
            let flat = self.seen.flat(self.frame.exact());
            let height = flat.height();
            (flat, height)
        })
    }
}

/// The conditions under which a face is met at or before the nearest.
struct Entering<'a> {
    face: InPlane<'a>,
    nearest: Option<&'a InPlane<'a>>,
    conditions: Vec<LazyLinear>,
}

impl<'a> Entering<'a> {
    fn new(face: InPlane<'a>, nearest: Option<&'a InPlane<'a>>) -> Self {
        let mut fast = face.fast.conditions_with(&face.frame.fast, &face.fast_height);
        fast.extend(nearest.map(|nearest| {
            at_or_before([&face.fast_height, &nearest.fast_height], [&face.fast.area, &nearest.fast.area])
        }));
        let conditions = fast.into_iter().map(LazyLinear::new).collect();
        Self { face, nearest, conditions }
    }

    /// A condition without rounding.
    fn exact(&self, index: usize) -> Linear<Dyadic> {
        let (flat, height) = self.face.exact();
        let numbers = self.face.frame.exact();
        match (index, &numbers.to) {
            (0..=2, _) => flat.edge(index),
            (3, _) => flat.not_before_with(&numbers.from, height),
            (4, Some(to)) => flat.not_before_with(to, height).negated(),
            _ => {
                let (first, first_height) = self.nearest.unwrap_or(&self.face).exact();
                at_or_before([height, first_height], [&flat.area, &first.area])
            }
        }
    }

    /// Bounds of the size at which the face enters, if that is within `enough`.
    fn size(&self, enough: f64) -> Option<[f64; 2]> {
        let frame = self.face.frame;
        let is_enough = |size: f64| in_units([size; 2], frame)[0] >= enough;
        least_size(&self.conditions, |index| self.exact(index), is_enough).map(|size| in_units(size, frame))
    }

    /// All conditions in f64.
    fn rounded(&self) -> Vec<Linear<f64>> {
        let exact = |(index, condition): (usize, &LazyLinear)| {
            rounded_exact(condition.exact(|| self.exact(index)), self.face.frame)
        };
        self.conditions.iter().enumerate().map(exact).collect()
    }
}
