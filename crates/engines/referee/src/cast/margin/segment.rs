//! The border of a face in the frame of a ray, as segments, and the part of one that is still to be looked at.
//!
//! A segment runs between two points of the frame, the face on its left. Places on it are fractions s of the way. Any
//! linear function of the displacement is linear in s, so it is known by its values at both ends, and the places where
//! it vanishes are quotients of exact numbers.
//!
//! What holds *just behind* a place, in the direction of the walk, is told by the sign of the value there, and where
//! that is 0 by the sign of its change.

use std::cmp::Ordering;
use std::rc::Rc;

use glam::DVec3;
use raypencil_scene::{FaceId, Side};

use super::flat::{FlatFace, Linear, corner_of};
use super::frame::{FrameNumbers, Point};
use super::region::Bounded;
use crate::numbers::number::{Dyadic, Interval, Number};
use crate::numbers::rounding::quotient;

/// Which part of a face's border.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Border {
    /// The edge from a corner of the flat face.
    Edge(usize),
    /// Where the face is cut off by the start of the ray: on from the edge of the first corner to that of the second.
    Start([usize; 2]),
    /// Where it is cut off by the end.
    End([usize; 2]),
}

/// Two points with a common divisor w: D a w, D b w, D t w.
#[derive(Debug, Clone)]
pub(super) struct Segment<T> {
    pub(super) ends: [[T; 3]; 2],
    pub(super) divisor: T,
    /// The vertices of the mesh at both ends, if it is an edge.
    vertices: Option<[DVec3; 2]>,
}

impl<T: Number> Segment<T> {
    /// A border of the face with these corners, whose `side` the ray sees.
    pub(super) fn of(corners: &[DVec3; 3], side: Side, border: Border, frame: &FrameNumbers<T>) -> Self {
        let cut_at = |[exit, enter]: [usize; 2], at: &T| {
            let face = FlatFace::new(frame, corners, side);
            let (from, to) = (crossing(&face, exit, at), crossing(&face, enter, at));
            let divisor = from.1.mul(&to.1);
            let ends = [from.0.map(|part| part.mul(&to.1)), to.0.map(|part| part.mul(&from.1))];
            Self { ends, divisor, vertices: None }
        };
        match (border, &frame.to) {
            (Border::Edge(k), _) => Self::of_edge(corners, side, k, frame),
            (Border::Start(edges), _) => cut_at(edges, &frame.from),
            // Only a ray with an end cuts faces off there.
            (Border::End(edges), to) => cut_at(edges, to.as_ref().unwrap_or(&frame.from)),
        }
    }

    /// An edge of a face whose `side` the ray sees, from corner k of the flat face.
    pub(super) fn of_edge(corners: &[DVec3; 3], side: Side, k: usize, frame: &FrameNumbers<T>) -> Self {
        let vertices = [k, k + 1].map(|k| corners[corner_of(side, k)]);
        let ends = vertices.map(|vertex| frame.point(vertex).0);
        Self { ends, divisor: T::of(1.0), vertices: Some(vertices) }
    }

    /// The values of a linear function at both ends, times the divisor.
    pub(super) fn values(&self, linear: &Linear<T>) -> [T; 2] {
        self.ends
            .each_ref()
            .map(|[a, b, _]| linear.c.mul(&self.divisor).add(&linear.x.mul(a)).add(&linear.y.mul(b)))
    }

    /// The values of a face's edge from corner k. At a vertex that both have it is 0, which no interval could tell.
    pub(super) fn edge_values(&self, face: &FlatFace<T>, k: usize) -> [T; 2] {
        let mut values = self.values(&face.edge(k));
        for (end, vertex) in self.vertices.iter().flatten().enumerate() {
            if face.vertices[k] == *vertex || face.vertices[(k + 1) % 3] == *vertex {
                values[end] = T::of(0.0);
            }
        }
        values
    }

    /// t of a face's plane less t of the segment, times positive numbers. At a common vertex it is 0.
    pub(super) fn behind(&self, face: &FlatFace<T>) -> [T; 2] {
        let [from, to] = self.values(&face.height());
        let mut values =
            [from.sub(&self.ends[0][2].mul(&face.area)), to.sub(&self.ends[1][2].mul(&face.area))];
        for (end, vertex) in self.vertices.iter().flatten().enumerate() {
            if face.vertices.contains(vertex) {
                values[end] = T::of(0.0);
            }
        }
        values
    }

    /// How far a point is to the left of the segment's line, times positive numbers: 0 on the line.
    pub(super) fn to_the_left(&self, Point([a, b, _]): &Point<T>) -> T {
        let [[from_a, from_b, _], [to_a, to_b, _]] = &self.ends;
        let (past_a, past_b) = (a.mul(&self.divisor).sub(from_a), b.mul(&self.divisor).sub(from_b));
        to_a.sub(from_a).mul(&past_b).sub(&to_b.sub(from_b).mul(&past_a))
    }

    /// How a linear function changes to the right of the segment, away from its face.
    fn to_the_right(&self, linear: &Linear<T>) -> T {
        let [from, to] = &self.ends;
        linear.x.mul(&to[1].sub(&from[1])).sub(&linear.y.mul(&to[0].sub(&from[0])))
    }
}

/// The point of the edge from corner k at D t = `at`, and its divisor; the edge's ends must be on different sides.
fn crossing<T: Number>(face: &FlatFace<T>, k: usize, at: &T) -> ([T; 3], T) {
    let (Point(p), Point(q)) = (&face.corners[k % 3], &face.corners[(k + 1) % 3]);
    // (q - at) p - (p - at) q over q - p, with a positive divisor for both directions.
    let (of_p, of_q) = (q[2].sub(at), at.sub(&p[2]));
    let divisor = q[2].sub(&p[2]);
    let point = std::array::from_fn(|axis| of_p.mul(&p[axis]).add(&of_q.mul(&q[axis])));
    if divisor.sign() == Some(Ordering::Less) {
        let minus = T::of(-1.0);
        return (point.map(|part: T| part.mul(&minus)), divisor.mul(&minus));
    }
    (point, divisor)
}

/// A place on a segment: numerator / divisor of the way, the divisor positive.
#[derive(Debug, Clone)]
pub(super) struct Place {
    numerator: Dyadic,
    divisor: Dyadic,
    rounded: Interval,
}

impl Place {
    pub(super) fn start() -> Self {
        let rounded = Interval::of(0.0);
        Self { numerator: Dyadic::of(0.0), divisor: Dyadic::of(1.0), rounded }
    }

    pub(super) fn end() -> Self {
        let rounded = Interval::of(1.0);
        Self { numerator: Dyadic::of(1.0), divisor: Dyadic::of(1.0), rounded }
    }

    /// The place in f64.
    pub(super) fn middle(&self) -> f64 {
        self.rounded.middle()
    }

    fn of(numerator: Dyadic, divisor: Dyadic) -> Self {
        let nearest = quotient(&numerator, &divisor).double;
        let rounded = Interval::between(nearest.next_down(), nearest.next_up());
        Self { numerator, divisor, rounded }
    }

    /// Where a function with these values at both ends vanishes; they must differ.
    fn root([from, to]: &[Dyadic; 2]) -> Self {
        let change = from.sub(to);
        if change.sign() == Some(Ordering::Less) {
            let minus = Dyadic::of(-1.0);
            return Self::of(from.mul(&minus), change.mul(&minus));
        }
        Self::of(from.clone(), change)
    }

    pub(super) fn compare(&self, other: &Self) -> Ordering {
        if self.rounded.high < other.rounded.low {
            return Ordering::Less;
        }
        if self.rounded.low > other.rounded.high {
            return Ordering::Greater;
        }
        let difference = self.numerator.mul(&other.divisor).sub(&other.numerator.mul(&self.divisor));
        difference.sign().unwrap_or(Ordering::Equal)
    }
}

/// A number that can be evaluated at a place.
pub(super) trait AtPlace: Number {
    /// A positive multiple of the value at a place, from the values at both ends.
    fn at(place: &Place, values: &[Self; 2]) -> Self;
}

impl AtPlace for Interval {
    fn at(place: &Place, [from, to]: &[Self; 2]) -> Self {
        // Exactly at an end, where a value may be exactly 0.
        match (place.rounded.low, place.rounded.high) {
            (0.0, 0.0) => *from,
            (1.0, 1.0) => *to,
            _ => from.add(&to.sub(from).mul(&place.rounded)),
        }
    }
}

impl AtPlace for Dyadic {
    fn at(place: &Place, [from, to]: &[Self; 2]) -> Self {
        from.mul(&place.divisor.sub(&place.numerator)).add(&to.mul(&place.numerator))
    }
}

/// A part of a segment that is still to be looked at, open at both ends, walked from `near` to `far`. Its distance from
/// the ray does not fall on the way.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    pub(super) face: FaceId,
    pub(super) side: Side,
    pub(super) border: Border,
    pub(super) segment: Rc<Segment<Dyadic>>,
    pub(super) near: Place,
    pub(super) far: Place,
}

impl Piece {
    /// Whether the walk goes from the segment's start to its end.
    pub(super) fn is_forward(&self) -> bool {
        self.near.compare(&self.far) == Ordering::Less
    }

    pub(super) fn is_empty(&self) -> bool {
        self.near.compare(&self.far) == Ordering::Equal
    }
}

/// What a face does to a piece just behind its near end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cover {
    /// The face is not there, or does not matter.
    None,
    /// It is met before the piece.
    Before,
    /// It goes on to the right of the piece, with the same t along it.
    GoesOn,
}

/// What a face does to a piece just behind its near end; `None` if that is not certain in these numbers.
pub(super) fn cover<T: AtPlace>(
    piece: &Piece,
    segment: &Segment<T>,
    face: &FlatFace<T>,
    frame: &FrameNumbers<T>,
) -> Option<Cover> {
    let is_forward = piece.is_forward();
    let mut is_certain = true;
    // The sign just behind the near end; Equal if the function vanishes along all of the segment.
    let sign = |values: &[T; 2]| {
        let here = T::at(&piece.near, values).sign();
        match here {
            Some(Ordering::Equal) => {
                let change = values[1].sub(&values[0]).sign();
                if is_forward { change } else { change.map(Ordering::reverse) }
            }
            sign => sign,
        }
    };
    let mut ends_here: Vec<Linear<T>> = Vec::new();
    for k in 0..3 {
        match sign(&segment.edge_values(face, k)) {
            Some(Ordering::Less) => return Some(Cover::None),
            Some(Ordering::Greater) => {}
            Some(Ordering::Equal) => ends_here.push(face.edge(k)),
            None => is_certain = false,
        }
    }
    let ends = std::iter::once_with(|| face.not_before(&frame.from));
    for condition in ends.chain(frame.to.iter().map(|to| face.not_after(to))) {
        match sign(&segment.values(&condition)) {
            Some(Ordering::Less) => return Some(Cover::None),
            Some(Ordering::Greater) => {}
            Some(Ordering::Equal) => ends_here.push(condition),
            None => is_certain = false,
        }
    }
    match sign(&segment.behind(face)) {
        Some(Ordering::Greater) => Some(Cover::None),
        Some(Ordering::Less) => is_certain.then_some(Cover::Before),
        None => None,
        Some(Ordering::Equal) => {
            if !is_certain {
                return None;
            }
            for condition in &ends_here {
                // A condition that vanishes along the segment and falls to the right ends the face there. One that does not
                // change is 0 everywhere, as for a face that lies in an end of the ray: it holds on both sides.
                if segment.to_the_right(condition).sign()? == Ordering::Less {
                    return Some(Cover::None);
                }
            }
            Some(Cover::GoesOn)
        }
    }
}

/// A corner of a flat face as a segment without length.
pub(super) fn corner_segment<T: Number>(face: &FlatFace<T>, k: usize) -> Segment<T> {
    let corner = face.corners[k % 3].0.clone();
    Segment { ends: [corner.clone(), corner], divisor: T::of(1.0), vertices: None }
}

/// When a face is met at a corner of another, against that corner's t: `None` if it is not met there.
pub(super) fn met_at(
    corner: &Segment<Dyadic>,
    face: &FlatFace<Dyadic>,
    frame: &FrameNumbers<Dyadic>,
) -> Option<Ordering> {
    let is_met = |condition: &Linear<Dyadic>| corner.values(condition)[0].sign() != Some(Ordering::Less);
    let is_met = face.conditions(frame).iter().all(is_met);
    is_met.then(|| corner.behind(face)[0].sign().unwrap_or(Ordering::Equal))
}

/// The place up to which a face that covers a piece just behind its near end covers it.
pub(super) fn covered_up_to(
    piece: &Piece,
    segment: &Segment<Dyadic>,
    face: &FlatFace<Dyadic>,
    frame: &FrameNumbers<Dyadic>,
    cover: Cover,
) -> Place {
    let is_forward = piece.is_forward();
    let mut until = piece.far.clone();
    let mut limit = |values: [Dyadic; 2]| {
        // The function is positive just behind the near end; where it falls on the way, it has a root.
        let change = values[1].sub(&values[0]).sign();
        let falls = if is_forward { Ordering::Less } else { Ordering::Greater };
        if change == Some(falls) {
            let root = Place::root(&values);
            let is_sooner =
                root.compare(&until) == if is_forward { Ordering::Less } else { Ordering::Greater };
            if is_sooner {
                until = root;
            }
        }
    };
    for k in 0..3 {
        limit(segment.edge_values(face, k));
    }
    for condition in face.conditions(frame).iter().skip(3) {
        limit(segment.values(condition));
    }
    if cover == Cover::Before {
        limit(segment.behind(face).map(|value| Dyadic::of(0.0).sub(&value)));
    }
    until
}

impl Segment<Dyadic> {
    /// The pieces of the segment in which the ray's ends lie beyond it: each begins at the place nearest to the ray.
    pub(super) fn pieces(&self, frame: &FrameNumbers<Dyadic>) -> Option<[[Place; 2]; 2]> {
        let (mut first, mut last) = (Place::start(), Place::end());
        let [from, to] = &self.ends;
        let from_start = |end: &[Dyadic; 3]| end[2].sub(&frame.from.mul(&self.divisor));
        let mut windows = vec![[from_start(from), from_start(to)]];
        if let Some(end) = &frame.to {
            let to_end = |point: &[Dyadic; 3]| end.mul(&self.divisor).sub(&point[2]);
            windows.push([to_end(from), to_end(to)]);
        }
        for values in &windows {
            let signs = values.each_ref().map(|value| value.sign().unwrap_or(Ordering::Equal));
            match signs {
                [Ordering::Less, Ordering::Less | Ordering::Equal] | [Ordering::Equal, Ordering::Less] => {
                    return None;
                }
                [Ordering::Less, Ordering::Greater] => {
                    let root = Place::root(values);
                    if root.compare(&first) == Ordering::Greater {
                        first = root;
                    }
                }
                [Ordering::Greater, Ordering::Less] => {
                    let root = Place::root(values);
                    if root.compare(&last) == Ordering::Less {
                        last = root;
                    }
                }
                _ => {}
            }
        }
        if first.compare(&last) != Ordering::Less {
            return None;
        }
        // The larger of |a| and |b| is convex: its least value is at an end, or where a, b, a - b or a + b vanishes.
        let [a, b] = [0, 1].map(|axis: usize| [from[axis].clone(), to[axis].clone()]);
        let combine = |with: fn(&Dyadic, &Dyadic) -> Dyadic| [with(&a[0], &b[0]), with(&a[1], &b[1])];
        let mut nearest = (first.clone(), self.size(&first));
        let places = [a.clone(), b.clone(), combine(Dyadic::sub), combine(Dyadic::add)];
        let places = places.iter().filter(|values| values[0].sub(&values[1]).sign() != Some(Ordering::Equal));
        let places = places.map(Place::root).filter(|place| {
            place.compare(&first) == Ordering::Greater && place.compare(&last) == Ordering::Less
        });
        for place in places.chain([last.clone()]) {
            let size = self.size(&place);
            if size[0] < nearest.1[0] {
                nearest = (place, size);
            }
        }
        Some([[nearest.0.clone(), first], [nearest.0, last]])
    }

    /// Bounds of the larger of D |a| and D |b| at a place.
    pub(super) fn size(&self, place: &Place) -> [f64; 2] {
        let [from, to] = &self.ends;
        let part = |axis: usize| Dyadic::at(place, &[from[axis].clone(), to[axis].clone()]).abs();
        let (a, b) = (part(0), part(1));
        let larger = if a.sub(&b).sign() == Some(Ordering::Greater) { a } else { b };
        Dyadic::quotient_between(&larger, &self.divisor.mul(&place.divisor))
    }

    /// D a, D b and D t at a place, rounded.
    pub(super) fn point(&self, place: &Place) -> [f64; 3] {
        let [from, to] = &self.ends;
        let divisor = self.divisor.mul(&place.divisor);
        [0, 1, 2].map(|axis: usize| {
            quotient(&Dyadic::at(place, &[from[axis].clone(), to[axis].clone()]), &divisor).double
        })
    }

    /// A vector to the right of the segment, with the larger part 1.
    pub(super) fn right(&self) -> [f64; 2] {
        let [from, to] = &self.ends;
        let (right, down) = (to[1].sub(&from[1]), from[0].sub(&to[0]));
        let (a, b) = (right.abs(), down.abs());
        let larger = if a.sub(&b).sign() == Some(Ordering::Greater) { a } else { b };
        if larger.sign() == Some(Ordering::Equal) {
            return [1.0, 0.0];
        }
        [quotient(&right, &larger).double, quotient(&down, &larger).double]
    }
}
