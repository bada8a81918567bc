//! The margin of the surface: the least displacement at which the nearest t jumps.
//!
//! The nearest t is the least of the t of all faces that the displaced ray meets. Each face's t is continuous where the
//! face is met, and least values of continuous functions are continuous. So a jump can only be where a face begins or
//! ends: on an edge of its flat triangle, or where an end of the ray cuts it off. There it is a jump unless
//!
//! * another face is met there before it, or
//! * faces that are met there at the same t cover all directions around the place.
//!
//! # Why it is enough to walk along the borders
//!
//! Let the faces that are met at a place at the nearest t leave a wedge of directions uncovered. A side of this wedge is
//! covered by such faces up to it, not beyond; close to the place, along this side, the nearest of these faces ends
//! there too, and nothing nearer is met, since near the place only faces are met that are met at the place. So no place
//! of a jump stands alone: it is the end of a part of a border with jumps all along. Hence what holds *just behind* a
//! place on a border is all that must be known, and there the directions to both sides of the border decide: the left
//! is covered by the face itself.
//!
//! # The search
//!
//! Borders are taken in the order of their least displacement, by a heap. Each is cut at the place nearest to the ray into
//! two pieces, and each piece is walked from there: where a face covers it just behind the near end, the piece begins
//! anew where that face ends, which is a root of a linear function and thus an exact quotient. The first piece that no
//! face covers is a jump, and no other can be nearer.

use std::cmp::{Ordering, Reverse};
use std::collections::{BinaryHeap, HashSet};
use std::rc::Rc;

use glam::DVec3;
use raypencil_scene::{FaceId, Side, Sides};

use super::super::triangle::Triangle;
use super::faces::in_units;
use super::flat::{FlatFace, corner_of};
use super::frame::{Frame, FrameNumbers, is_cut, least_size};
use super::hidden::{Hidden, WalkedFace};
use super::looks::take_note_of_a_look;
use super::nearby::Nearby;
use super::screen::Screen;
use super::segment::{Border, Cover, Piece, Place, Segment, corner_segment, cover, covered_up_to, met_at};
use super::view::View;
use super::{ExactCast, within};
use crate::margins::margin::Margin;
use crate::numbers::number::{Dyadic, Number};
use crate::trees::bvh::RayBundle;

/// What waits to be looked at, nearest first.
enum Task {
    /// A border, not yet cut into pieces, by the least displacement to its box.
    Border(FaceId, Side, Border),
    /// The same by the least displacement to the segment itself, with the places of its two pieces in the order of tasks.
    Segment(FaceId, Side, Border, usize),
    /// A corner of the flat face: all that an end of the ray leaves of it.
    Corner(FaceId, Side, usize),
    Piece(Box<Piece>),
}

/// Tasks by the bits of the size that each needs at least, then in the order in which they were found.
#[derive(Default)]
struct Tasks {
    order: BinaryHeap<Reverse<(u64, usize)>>,
    tasks: Vec<Option<Task>>,
}

impl Tasks {
    fn push(&mut self, size: f64, task: Task) {
        let place = self.reserve(1);
        self.push_at(place, size, task);
    }

    /// So many places in the order of tasks; gives the first.
    fn reserve(&mut self, count: usize) -> usize {
        let first = self.tasks.len();
        self.tasks.extend(std::iter::repeat_with(|| None).take(count));
        first
    }

    /// Puts a task on a place that is reserved.
    fn push_at(&mut self, place: usize, size: f64, task: Task) {
        self.order.push(Reverse((size.to_bits(), place)));
        self.tasks[place] = Some(task);
    }

    fn size(&self) -> f64 {
        self.order.peek().map_or(f64::INFINITY, |Reverse((bits, _))| f64::from_bits(*bits))
    }

    fn pop(&mut self) -> Option<Task> {
        let Reverse((_, index)) = self.order.pop()?;
        self.tasks[index].take()
    }
}

/// A relative distance within which other faces are looked up around a place: far above the rounding of the place.
const PLACE_SLACK: f64 = 1.0 / (1u64 << 40) as f64;

/// Most faces that wait for an exact look. Often none is needed, for another face certainly hides the piece.
const MAX_DOUBTFUL: usize = 16;

impl ExactCast<'_> {
    /// The margin of the surface of a ray that hits. No jump is nearer than `from`, the margin of the faces.
    ///
    /// The screen only finds sooner what is hidden: without one the margin is the same.
    pub(super) fn surface_margin(
        &self,
        frame: &Frame<'_>,
        from: f64,
        view: &View<'_>,
        screen: Option<&Screen<'_>>,
    ) -> Margin {
        let cap = self.tree.diagonal;
        let [first, last] = frame.ranges();
        let mut nearby = Nearby::new(self.places());
        let mut tasks = Tasks::default();
        // Directed edges by their ends, and corners as edges from a vertex to itself. What becomes of one depends on the ends alone and on
        // the faces around: of many faces that share it the first decides, which has the same size as the others and comes before them.
        let mut decided = HashSet::new();
        let bits = |face: FaceId, side: Side, k: usize| {
            self.mesh.corners(face)[corner_of(side, k)].to_array().map(f64::to_bits)
        };
        loop {
            let size = nearby.size().min(tasks.size());
            if size >= cap {
                return within([cap; 2], None, 0.0, cap);
            }
            if nearby.size() <= tasks.size() {
                let faces = nearby.open(frame, |node, span| {
                    let [near, far] = span[2];
                    if least_size(span) >= cap || near > last || far < first {
                        return false;
                    }
                    let is_cut = is_cut(span[2], [first, last]);
                    let shown = view.side_shown(node);
                    // Where all show one side there is no border; where all show backs that are not hit, nothing.
                    shown == 0 || (is_cut && (shown < 0 || view.sides() == Sides::Both))
                });
                for face in faces {
                    self.add_borders(frame, face, view, &mut tasks);
                }
                continue;
            }
            match tasks.pop() {
                None => {}
                Some(Task::Border(face, side, border)) => {
                    let place = tasks.reserve(2);
                    let least = match (screen, border) {
                        (Some(screen), Border::Edge(k)) => self.least_size_of_edge(screen, (face, side, k)),
                        _ => size,
                    };
                    tasks.push_at(place, least.max(size), Task::Segment(face, side, border, place));
                }
                Some(Task::Segment(face, side, Border::Edge(k), _))
                    if !decided.insert([k, k + 1].map(|k| bits(face, side, k))) => {}
                Some(Task::Segment(face, side, border, place)) => {
                    if let (Some(screen), Border::Edge(k)) = (screen, border)
                        && self.is_edge_hidden(screen, (face, side, k), view.sides())
                    {
                        continue;
                    }
                    let segment = Segment::of(&self.mesh.corners(face), side, border, frame.exact());
                    let segment = Rc::new(segment);
                    let pieces = segment.pieces(frame.exact()).into_iter().flatten();
                    for (k, [near, far]) in pieces.enumerate() {
                        let piece = Piece { face, side, border, segment: Rc::clone(&segment), near, far };
                        if !piece.is_empty() {
                            let size = in_units(segment.size(&piece.near), frame)[0].max(from);
                            tasks.push_at(place + k, size, Task::Piece(Box::new(piece)));
                        }
                    }
                }
                Some(Task::Corner(face, side, k)) if !decided.insert([bits(face, side, k); 2]) => {}
                Some(Task::Corner(face, side, k)) => {
                    let point = corner_segment(&self.flat(frame.exact(), face, side), k);
                    if self.stands_alone(frame, &point, view) {
                        let near = Place::start();
                        let far = Place::end();
                        let (border, segment) = (Border::Edge(k), Rc::new(point));
                        let piece = Piece { face, side, border, segment, near, far };
                        return self.jump(frame, &piece, view.sides(), cap);
                    }
                }
                Some(Task::Piece(mut piece)) => match self.next_uncovered(frame, &piece, view) {
                    None => return self.jump(frame, &piece, view.sides(), cap),
                    Some(near) => {
                        piece.near = near;
                        if !piece.is_empty() {
                            let size = in_units(piece.segment.size(&piece.near), frame)[0].max(from);
                            tasks.push(size, Task::Piece(piece));
                        }
                    }
                },
            }
        }
    }

    fn flat<T: Number>(&self, numbers: &FrameNumbers<T>, face: FaceId, side: Side) -> FlatFace<T> {
        FlatFace::new(numbers, &self.mesh.corners(face), side)
    }

    /// Adds the borders of a face at which the surface may end.
    fn add_borders(&self, frame: &Frame<'_>, face: &Triangle, view: &View<'_>, tasks: &mut Tasks) {
        let Some(side) = view.side_hit(face) else { return };
        let [first, last] = frame.ranges();
        let corner = |k: usize| face.corners[corner_of(side, k)];
        let span_of = |a: DVec3, b: DVec3| frame.span(a.min(b), a.max(b));
        let [a, b, c] = face.corners;
        let whole = frame.span(a.min(b).min(c), a.max(b).max(c));
        let is_cut = is_cut(whole[2], [first, last]);
        for k in 0..3 {
            // Both faces show the same side: they continue one another, unless the edge is where an end cuts them.
            if !is_cut && self.continued(face.id, side, k, view).is_some() {
                continue;
            }
            let span = span_of(corner(k), corner(k + 1));
            if span[2][0] <= last && span[2][1] >= first {
                tasks.push(least_size(&span), Task::Border(face.id, side, Border::Edge(k)));
            }
        }
        if !is_cut {
            return;
        }
        let numbers = frame.exact();
        let flat = self.flat(numbers, face.id, side);
        let ends = [Some((&numbers.from, true)), numbers.to.as_ref().map(|to| (to, false))];
        for (at, is_start) in ends.into_iter().flatten() {
            if let Some(k) = lone_corner(&flat, at, is_start) {
                let size = in_units(corner_segment(&flat, k).size(&Place::start()), frame)[0];
                tasks.push(size, Task::Corner(face.id, side, k));
            }
            if let Some(edges) = cut_edges(&flat, at, is_start) {
                let border = if is_start { Border::Start(edges) } else { Border::End(edges) };
                tasks.push(least_size(&whole), Task::Border(face.id, side, border));
            }
        }
    }

    /// The one other face that has the edge from corner k of a flat face, if it shows the ray the same side.
    fn continued(&self, face: FaceId, side: Side, k: usize, view: &View<'_>) -> Option<FaceId> {
        // Corner k of the flat face and the next are an edge of the mesh's face; from the second if it is turned round.
        let edge = match side {
            Side::Back => k,
            Side::Front => corner_of(side, k + 1),
        };
        let mate = self.seams().mate(face, edge)?;
        view.shows(mate, side).then_some(mate)
    }

    /// Where the piece begins that no face of those at its near end covers; `None` if none covers it there.
    fn next_uncovered(&self, frame: &Frame<'_>, piece: &Piece, view: &View<'_>) -> Option<Place> {
        let numbers = &frame.fast;
        let segment = piece.segment.as_ref();
        let fast = Segment::of(&self.mesh.corners(piece.face), piece.side, piece.border, numbers);
        let place = segment.point(&piece.near);
        let bundle = self.bundle_at(frame, place);
        let at = [place[0], place[1]].map(|part| part / numbers.scale.middle());
        let behind = |face, side, k| {
            let mate = self.continued(face, side, k, view)?;
            Some(WalkedFace { face: mate, flat: self.flat(numbers, mate, side) })
        };
        let walk = |face, side, flat| {
            piece
                .hidden_by_surface(WalkedFace { face, flat }, &fast, numbers, |face, k| behind(face, side, k))
        };
        let is_farther = |one: f64, other: f64| if piece.is_forward() { one > other } else { one < other };
        let end_of = |face, side, covers| {
            covered_up_to(piece, segment, &self.flat(frame.exact(), face, side), frame.exact(), covers)
        };
        // Up to where a face covers the piece, without rounding.
        let covered_by = |(face, side): (FaceId, Side)| {
            take_note_of_a_look();
            let exact = self.flat(frame.exact(), face, side);
            match cover(piece, segment, &exact, frame.exact())? {
                Cover::Before => Some(match walk(face, side, self.flat(numbers, face, side)) {
                    Hidden::Wholly => piece.far.clone(),
                    Hidden::UpToTheEndOf(end, _) => end_of(end, side, Cover::Before),
                }),
                Cover::GoesOn => Some(end_of(face, side, Cover::GoesOn)),
                Cover::None => None,
            }
        };
        // The farther from the near end the better: nearer to the far end.
        let order = piece.far.compare(&piece.near);
        let farthest = |until: Option<Place>, doubtful: &mut Vec<(FaceId, Side)>| {
            let ends = until.into_iter().chain(doubtful.drain(..).filter_map(covered_by));
            ends.reduce(|kept, end| if end.compare(&kept) == order { end } else { kept })
        };
        // The face up to whose end the piece is hidden, and where it is entered: the farther the better.
        let mut last: Option<(f64, FaceId, Side)> = None;
        // Faces of which intervals do not tell what they cover, and up to where those cover that were looked at exactly.
        let mut doubtful: Vec<(FaceId, Side)> = Vec::new();
        let mut until: Option<Place> = None;
        let mut is_hidden = false;
        self.places().visit(&bundle, |face| {
            take_note_of_a_look();
            if is_hidden || !frame.may_show(&face.corners, at, bundle.start_radius) {
                return bundle.max_range;
            }
            let Some(side) = view.side_hit(face) else { return bundle.max_range };
            let flat = FlatFace::new(numbers, &face.corners, side);
            match cover(piece, &fast, &flat, numbers) {
                Some(Cover::None) => {}
                Some(Cover::Before) => match walk(face.id, side, flat) {
                    Hidden::Wholly => is_hidden = true,
                    Hidden::UpToTheEndOf(end, entered) => {
                        if last.is_none_or(|(kept, ..)| is_farther(entered, kept)) {
                            last = Some((entered, end, side));
                        }
                    }
                },
                Some(Cover::GoesOn) | None => doubtful.push((face.id, side)),
            }
            // Where thousands lie on one another, one of the first mostly covers all of the piece.
            if doubtful.len() == MAX_DOUBTFUL {
                until = farthest(until.take(), &mut doubtful);
                is_hidden = until.as_ref().is_some_and(|until| until.compare(&piece.far) == Ordering::Equal);
            }
            if is_hidden { f64::NEG_INFINITY } else { bundle.max_range }
        });
        if is_hidden {
            return Some(piece.far.clone());
        }
        match last {
            Some((_, face, side)) => Some(end_of(face, side, Cover::Before)),
            None => farthest(until, &mut doubtful),
        }
    }

    /// Whether a corner, which is all that is left of its face, is a jump.
    fn stands_alone(&self, frame: &Frame<'_>, point: &Segment<Dyadic>, view: &View<'_>) -> bool {
        let numbers = frame.exact();
        let bundle = self.bundle_at(frame, point.point(&Place::start()));
        let mut stands_alone = true;
        self.places().visit(&bundle, |face| {
            take_note_of_a_look();
            if let Some(side) = view.side_hit(face) {
                let flat = self.flat(numbers, face.id, side);
                stands_alone &= match met_at(point, &flat, numbers) {
                    None | Some(Ordering::Greater) => true,
                    Some(Ordering::Less) => false,
                    Some(Ordering::Equal) => !is_more_than_a_corner(&flat, numbers),
                };
            }
            bundle.max_range
        });
        stands_alone
    }

    /// The displaced ray at a place of the frame, up to the place itself, for the hierarchy.
    fn bundle_at(&self, frame: &Frame<'_>, [a, b, t]: [f64; 3]) -> RayBundle {
        let [u, v] = frame.ray.across();
        let scale = frame.fast.scale.middle();
        let origin = frame.ray.origin + u * (a / scale) + v * (b / scale);
        let range = t / scale * frame.length();
        let size = origin.abs().max_element() + frame.ray.origin.abs().max_element() + range.abs();
        RayBundle {
            origin,
            max_range: range + PLACE_SLACK * size,
            start_radius: PLACE_SLACK * size,
            ..super::super::bundle(frame.ray)
        }
    }

    fn jump(&self, frame: &Frame<'_>, piece: &Piece, sides: Sides, cap: f64) -> Margin {
        let segment = &piece.segment;
        let bounds = in_units(segment.size(&piece.near), frame);
        let scale = frame.fast.scale.middle();
        let [a, b, _] = segment.point(&piece.near).map(|part| part / scale);
        // A little along the piece and to the right, where the ray has passed the border.
        let [to_a, to_b, _] = segment.point(&piece.far).map(|part| part / scale);
        let length = (to_a - a).abs().max((to_b - b).abs());
        let step = (bounds[1].max(self.smallest_size(frame)) * PLACE_SLACK).min(length);
        let along = if length > 0.0 { [(to_a - a) / length, (to_b - b) / length] } else { [0.0; 2] };
        let right = segment.right();
        let beside = |along_by: f64, right_by: f64| {
            [0, 1].map(|k: usize| [a, b][k] + (along[k] * along_by + right[k] * right_by) * step)
        };
        // It counts only if the border is there for rays of f64 numbers, too: the face is met to its left, and not to its right.
        let is_met = |by: [f64; 2]| self.first_moved(frame.ray, sides, by).contains(&piece.face);
        let beyond = |&(along_by, right_by): &(f64, f64)| {
            is_met(beside(along_by, -right_by)) && !is_met(beside(along_by, right_by))
        };
        let tried =
            [(1.0, 1.0 / 16.0), (1.0, 1.0), (1.0 / 16.0, 1.0 / 256.0), (16.0, 1.0), (0.5, 1.0 / 65536.0)];
        let witness =
            tried.iter().find(|by| beyond(by)).map(|&(along_by, right_by)| beside(along_by, right_by));
        // All that is tried is nearer to the place than a hundredth of its size, or than this.
        within(bounds, witness, self.smallest_size(frame), cap)
    }
}

/// The only corner of a face on the right side of `at`, if it is exactly there and the two others are beyond.
fn lone_corner(face: &FlatFace<Dyadic>, at: &Dyadic, keeps_later: bool) -> Option<usize> {
    let sign = |k: usize| face.corners[k % 3].0[2].sub(at).sign();
    let beyond = Some(if keeps_later { Ordering::Less } else { Ordering::Greater });
    (0..3).find(|&k| sign(k) == Some(Ordering::Equal) && sign(k + 1) == beyond && sign(k + 2) == beyond)
}

/// Whether the ends of the ray leave more of a face that is met than one corner.
fn is_more_than_a_corner(face: &FlatFace<Dyadic>, frame: &FrameNumbers<Dyadic>) -> bool {
    let at_start = lone_corner(face, &frame.from, true).is_some();
    !at_start && frame.to.as_ref().is_none_or(|to| lone_corner(face, to, false).is_none())
}

/// The edges, by their first corners, through which the part of a face on the right side of `at` is left and entered
/// again; `None` if the face is not cut.
fn cut_edges(face: &FlatFace<Dyadic>, at: &Dyadic, keeps_later: bool) -> Option<[usize; 2]> {
    let signs = face.corners.each_ref().map(|corner| {
        let sign = corner.0[2].sub(at).sign().unwrap_or(Ordering::Equal);
        if keeps_later { sign } else { sign.reverse() }
    });
    // A face beyond `at` that touches it is not cut. One that lies all on the right side is never left.
    if !signs.contains(&Ordering::Greater) {
        return None;
    }
    let is_kept = |k: usize| signs[k % 3] != Ordering::Less;
    let exit = (0..3).find(|&k| is_kept(k) && !is_kept(k + 1))?;
    let enter = (0..3).find(|&k| !is_kept(k) && is_kept(k + 1))?;
    Some([exit, enter])
}
