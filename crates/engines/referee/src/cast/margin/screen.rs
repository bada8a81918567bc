//! Whether a surface hides an edge wholly, in plain f64: most edges that are looked at are hidden so.
//!
//! Some face is met before the middle of the edge. From there the surface is followed to both ends of the edge, over the edges
//! that two faces continue, as in `hidden`. Each step is certain, or the answer is "not certain", and exact arithmetic goes on from the
//! beginning. An edge that is hidden has no jump, so to leave it out changes no margin.
//!
//! # Bounds
//!
//! All is in the rounded frame: a, b and the range r of a vertex, each off by at most E = [`slack`](Frame::slack), some twenty times what
//! their roundings come to. With u = 2^-53 and S the largest coordinate, E is 3 2^-44 S, and no difference exceeds 7 S.
//!
//! ```text
//! turn of p, q, c: (q - p) x (c - p)      both differences off by 2 E, and s the sum of their four parts:
//!                                         2 E s + 8 E E, and roundings of 4 u 7 S s                  at most  3 E (s + 3 E)
//! a part w = x / (x + y), x and y off     (x' y - x y') / ((x + y) (x' + y')), as x, y >= 0          at most  max / (x' + y')
//!   by at most `max`
//! r of a face at a place, by weights w_k  sum of (w'_k / W' - w_k / W) r_k; these parts sum up to 0
//!   with bounds B_k, W their sum          and are at most B_k / W' + (w_k / W) (sum B) / W'          at most  2 (sum B) / W' (max r - min r)
//! ```
//!
//! An E less than [`LEAST_SLACK`] is not used, so that no square of it underflows.

use glam::DVec3;
use raypencil_scene::{CastRay, FaceId, Side, Sides};

use super::super::wide_tree::Next;
use super::ExactCast;
use super::flat::corner_of;
use super::frame::Frame;
use super::looks::take_note_of_a_look;

/// Below it squares come near to the end of f64.
const LEAST_SLACK: f64 = 1e-140;

/// The roundings of a few operations, as a part of what they give.
const ROUNDINGS: f64 = 8.0 * f64::EPSILON;

/// Most faces of which it is asked whether they hide an edge. They come roughly from near to far, so one of the first hides it if any does;
/// of thousands of layers each edge would else be asked for all of them.
const MAX_ASKED: usize = 64;

/// A number and how far it may be off.
#[derive(Debug, Clone, Copy)]
struct Bounded {
    value: f64,
    bound: f64,
}

impl Bounded {
    fn is_positive(self) -> bool {
        self.value > self.bound
    }

    fn is_negative(self) -> bool {
        self.value < -self.bound
    }

    fn times(self, sign: f64) -> Self {
        Self { value: sign * self.value, ..self }
    }

    /// x / (x + y), for numbers that are not negative.
    fn part_of_sum(self, other: Self) -> Self {
        let sum = self.value + other.value;
        Self { value: self.value / sum, bound: self.bound.max(other.bound) / sum + ROUNDINGS }
    }
}

/// A face that shows the ray a certain side, as (a, b, r) of its corners.
#[derive(Clone, Copy)]
struct ShownFace {
    id: FaceId,
    corners: [DVec3; 3],
    /// 1 if the corners go counter-clockwise, for a back; else -1.
    turn: f64,
}

/// The way along an edge from its middle to one end.
#[derive(Clone, Copy)]
struct Way {
    from: DVec3,
    to: DVec3,
}

/// A frame with all that is certain in it.
pub(super) struct Screen<'f> {
    frame: &'f Frame<'f>,
    /// E.
    slack: f64,
    /// A range after which nothing is met before the start of the ray.
    start: f64,
}

impl<'f> Screen<'f> {
    /// `largest` is the largest coordinate of the mesh. `None` where nothing would be certain.
    pub(super) fn new(frame: &'f Frame<'f>, largest: f64) -> Option<Self> {
        let slack = frame.slack(largest);
        let start = frame.range_after_start() + 2.0 * slack;
        (slack >= LEAST_SLACK).then_some(Self { frame, slack, start })
    }

    /// (q - p) x (c - p) of the pictures: positive if these turn left.
    #[inline]
    fn turn(&self, p: DVec3, q: DVec3, c: DVec3) -> Bounded {
        let (along, aside) = (q - p, c - p);
        let sum = along.x.abs() + along.y.abs() + aside.x.abs() + aside.y.abs();
        Bounded {
            value: along.x * aside.y - along.y * aside.x,
            bound: 3.0 * self.slack * (sum + 3.0 * self.slack),
        }
    }

    /// A displacement below which the ray comes to no place of the segment between two vertices in the frame: that to its line.
    fn least_size_of_segment(&self, [p, q]: [DVec3; 2]) -> f64 {
        let Bounded { value, bound } = self.turn(DVec3::ZERO, p, q);
        let along = (q.x - p.x).abs() + (q.y - p.y).abs() + 5.0 * self.slack;
        ((value.abs() - bound) / along * (1.0 - ROUNDINGS)).max(0.0)
    }

    /// The face in the frame, if it certainly shows a side that counts, and all of it is after the start of the ray.
    #[inline]
    fn shown(&self, id: FaceId, corners: [DVec3; 3], sides: Sides) -> Option<ShownFace> {
        let corners = corners.map(|corner| self.frame.shown(corner));
        let [a, b, c] = corners;
        let turn = self.turn(a, b, c);
        let (side, sign) = if turn.is_positive() {
            (Side::Back, 1.0)
        } else if turn.is_negative() {
            (Side::Front, -1.0)
        } else {
            return None;
        };
        let is_after_start = a.z.min(b.z).min(c.z) > self.start;
        (is_after_start && sides.include(side)).then_some(ShownFace { id, corners, turn: sign })
    }

    /// Twice the area between the edge from corner `k` of a face and a place: positive inside.
    #[inline]
    fn inside(&self, face: &ShownFace, k: usize, place: DVec3) -> Bounded {
        self.turn(face.corners[k], face.corners[(k + 1) % 3], place).times(face.turn)
    }

    /// Whether the face is certainly met before a place that its picture contains.
    fn is_before(&self, face: &ShownFace, place: DVec3) -> bool {
        let [a, b, c] = face.corners;
        let (near, far) = (a.z.min(b.z).min(c.z), a.z.max(b.z).max(c.z));
        if far < place.z - 4.0 * self.slack {
            return true;
        }
        if near > place.z {
            return false;
        }
        let weights = [1, 2, 0].map(|k| self.inside(face, k, place));
        let [of_a, of_b, of_c] = weights;
        let sum = of_a.value + of_b.value + of_c.value;
        let off = of_a.bound + of_b.bound + of_c.bound;
        if !(sum > 2.0 * off) {
            return false;
        }
        // From the nearest corner, so that roundings are small.
        let weighted = of_a.value * (a.z - near) + of_b.value * (b.z - near) + of_c.value * (c.z - near);
        let error = (2.0 * off / sum + ROUNDINGS) * (far - near) + 4.0 * self.slack;
        near + weighted / sum < place.z - error
    }

    /// Whether the place is certainly inside a face that is met before it.
    fn is_hidden_by(&self, face: &ShownFace, place: DVec3) -> bool {
        (0..3).all(|k| self.inside(face, k, place).is_positive()) && self.is_before(face, place)
    }

    /// Whether the edge from corner `k` of a face, where the way leaves it, is certainly met before the way there. `beside`
    /// says how far both its ends are from the way.
    fn is_before_at(&self, face: &ShownFace, k: usize, way: Way, beside: [Bounded; 2]) -> bool {
        let [i, j] = [face.corners[k].z, face.corners[(k + 1) % 3].z];
        if i.max(j) < way.from.z.min(way.to.z) - 4.0 * self.slack {
            return true;
        }
        let [of_i, of_j] = beside.map(|beside| Bounded { value: beside.value.abs(), ..beside });
        let (of_from, of_to) = (self.inside(face, k, way.from), self.inside(face, k, way.to).times(-1.0));
        if !of_from.is_positive() {
            return false;
        }
        let (on_edge, on_way) = (of_i.part_of_sum(of_j), of_from.part_of_sum(of_to));
        let r_of_edge = i + (j - i) * on_edge.value;
        let r_of_way = way.from.z + (way.to.z - way.from.z) * on_way.value;
        let error = (j - i).abs() * on_edge.bound + (way.to.z - way.from.z).abs() * on_way.bound;
        r_of_edge + error + 4.0 * self.slack < r_of_way
    }
}

impl ExactCast<'_> {
    /// A displacement below which the ray comes to no place of the edge from corner `k` of a flat face.
    pub(super) fn least_size_of_edge(
        &self,
        screen: &Screen<'_>,
        (face, side, k): (FaceId, Side, usize),
    ) -> f64 {
        let corners = self.mesh.corners(face);
        let ends = [k, k + 1].map(|k| screen.frame.shown(corners[corner_of(side, k)]));
        screen.least_size_of_segment(ends)
    }

    /// Whether other faces certainly hide all of the edge from corner `k` of a flat face.
    pub(super) fn is_edge_hidden(
        &self,
        screen: &Screen<'_>,
        (face, side, k): (FaceId, Side, usize),
        sides: Sides,
    ) -> bool {
        let corners = self.mesh.corners(face);
        let [p, q] = [corners[corner_of(side, k)], corners[corner_of(side, k + 1)]];
        let [from, to] = [p, q].map(|end| screen.frame.shown(end));
        let middle = 0.5 * from + 0.5 * to;
        let (ray, point) = (screen.frame.ray, 0.5 * p + 0.5 * q);
        let t = middle.z / screen.frame.length_of_direction();
        if !(t > ray.t_min) {
            return false;
        }
        // It only proposes, so it need not be the ray through the middle to the last digit.
        let through = CastRay { origin: point - ray.direction * t, t_max: t, ..*ray };
        let (mut is_hidden, mut asked) = (false, 0);
        self.walk_places(&through, |candidate| {
            take_note_of_a_look();
            asked += 1;
            let shown = screen.shown(candidate.id, candidate.corners, sides);
            let first = shown.filter(|first| screen.is_hidden_by(first, middle));
            is_hidden = first.is_some_and(|first| {
                [from, to]
                    .into_iter()
                    .all(|end| self.hides_way(screen, first, Way { from: middle, to: end }, sides))
            });
            if is_hidden || asked == MAX_ASKED { Next::Stop } else { Next::On }
        });
        is_hidden
    }

    /// Whether the surface that goes on from a face, which hides the beginning of a way, certainly hides all of it.
    fn hides_way(&self, screen: &Screen<'_>, first: ShownFace, way: Way, sides: Sides) -> bool {
        let mut here = first;
        loop {
            let beside = here.corners.map(|corner| screen.turn(way.from, way.to, corner).times(here.turn));
            // Inside is on the left of an edge of a back, and the way leaves from its left to its right.
            let exit = (0..3).find(|&k| beside[k].is_negative() && beside[(k + 1) % 3].is_positive());
            let Some(k) = exit else { return false };
            let end = screen.inside(&here, k, way.to);
            if end.is_positive() {
                return screen.is_before(&here, way.to);
            }
            let beside = [beside[k], beside[(k + 1) % 3]];
            if !end.is_negative() || !screen.is_before_at(&here, k, way, beside) {
                return false;
            }
            let Some(mate) = self.seams().mate(here.id, k) else { return false };
            match screen.shown(mate, self.mesh.corners(mate), sides) {
                Some(next) if next.turn == here.turn => here = next,
                _ => return false,
            }
        }
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/screen.rs"]
mod tests;
