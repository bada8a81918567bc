//! Whether an approximation of the paper explains an answer that is not the contract's.
//!
//! A renderer that clips a beam's faces to the stripe, draws straight sides, and skips faces by the rules as
//! printed (§4, §5) loses some faces at some pencils and adds others. Its answer is *explained* if
//!
//! * the face that it names, where the ray does not meet it, is one that the approximations add here, and
//! * every face that the ray does meet, before that, is one that they lose here,
//!
//! each for a [`Reason`]. The image that an approximation gives a face is worked out from the paper, in
//! intervals that contain what any renderer computes that misplaces points by no more than its tolerance and
//! whose ray is displaced by no more than that: so a [`Truth`] that says no is a proof, and one that says
//! either lies within rounding of a side or a limit.

use std::fmt;

use raypencil_scene::{FaceId, Mounted, SensorId};

use crate::face::{ExactRay, Face};
use crate::number::{Interval, Number};
use crate::pencil::{Aim, Sensor};
use crate::ruling::Tolerance;
use crate::truth::Truth;
use crate::vector::{ScaledRotation, Vector};
use crate::verdict::{Referee, bundle};

/// Which of the paper's approximations an answer was made with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Approximations {
    /// A beam's faces are clipped to the stripe, their sides drawn straight. (§5, figures 8 and 9)
    pub beam_edges: bool,
    /// Faces are skipped by rules 1b, 3b and 3c as printed. (§4)
    pub skip_rules: bool,
}

/// Why a face is seen, or not seen, where the contract says otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reason {
    /// The pencil lies between a side of the face and the straight line drawn for it.
    StraightSide,
    /// Rule 1b: the middle of the sheet and the pencil's own row see different sides of the face.
    FacingOfMiddle,
    /// Rule 3b: all vertices of what clipping leaves are in the screen and beyond the maximum range.
    VerticesTooFar,
    /// Rule 3c: the straight lines between its vertices do not come into the screen, its true sides do.
    SidesApart,
}

impl Reason {
    /// Whether it belongs to [`Approximations::beam_edges`]; else to [`Approximations::skip_rules`].
    pub fn is_of_beam_edges(self) -> bool {
        self == Self::StraightSide
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::StraightSide => "the pencil lies between a true side and the straight line drawn for it",
            Self::FacingOfMiddle => {
                "rule 1b: the middle of the sheet and the pencil's row see different sides"
            }
            Self::VerticesTooFar => {
                "rule 3b: all vertices are in the screen and beyond the maximum range, the hit is not"
            }
            Self::SidesApart => {
                "rule 3c: the straight lines between the vertices do not meet the screen, the true sides do"
            }
        })
    }
}

/// A face that is seen or not seen against the contract, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Explained {
    /// Which face.
    pub face: FaceId,
    /// Whether the approximations add it; else they lose it.
    pub added: bool,
    /// All reasons that hold; at least one.
    pub reasons: Vec<Reason>,
}

impl Referee<'_> {
    /// Explains `answer`, a face or a miss, to the ray of cell (i, j) by approximations it was made with; `None`
    /// if they do not explain it.
    pub fn explain(
        &self,
        sensor: SensorId,
        i: u32,
        j: u32,
        answer: Option<FaceId>,
        with: Approximations,
        tolerance: Tolerance,
    ) -> Option<Vec<Explained>> {
        let sensor = Sensor::of(self.scene, sensor)?;
        let (width, height) = sensor.size();
        let mesh = self.scene.mesh();
        if i >= width || j >= height || answer.is_some_and(|id| id.0 as usize >= mesh.faces().len()) {
            return None;
        }
        let aim = Aim { i, j, dx: 0.0, dy: 0.0 };
        let (ray, max_range) = (ExactRay::new(&sensor, aim), sensor.max_range());
        let mut met: Vec<&Face> = Vec::new();
        self.tree.visit(&bundle(&sensor, aim, 0.0), |face| {
            if face.is_met_by(&ray, max_range) {
                met.push(face);
            }
            max_range
        });
        met.sort_by_key(|face| face.id);

        let pencil = Pencil::new(&sensor, aim, with, tolerance);
        let answer = answer.map(|id| Face::of(mesh, id));
        let mut explained = Vec::new();
        if let Some(face) = &answer
            && !met.iter().any(|kept| kept.id == face.id)
        {
            explained.push(Explained { face: face.id, added: true, reasons: pencil.adds(face) });
        }
        for face in met {
            let is_before = answer.as_ref().is_none_or(|answer| {
                answer.id != face.id && face.range(&ray) < answer.range(&ray) - tolerance.depth
            });
            if is_before {
                explained.push(Explained { face: face.id, added: false, reasons: pencil.loses(face) });
            }
        }
        let all = !explained.is_empty() && explained.iter().all(|one| !one.reasons.is_empty());
        all.then_some(explained)
    }
}

/// A cell's ray in the sensor's frame, with all rays and terrains within the tolerance.
pub(crate) struct Pencil<'a> {
    sensor: &'a Sensor,
    with: Approximations,
    position: f64,
    scene_from_sensor: ScaledRotation<Interval>,
    /// Where the ray starts.
    start: Vector<Interval>,
    /// q; its x and y are where the ray crosses the SPP, but for a beam, whose y is that of the start.
    q: Vector<Interval>,
    /// The point of the screen.
    at: Projected,
    /// Left, right, top and bottom of the screen.
    screen: [Interval; 4],
}

/// A point of the SPP, metres.
#[derive(Debug, Clone, Copy)]
struct Projected {
    x: Interval,
    y: Interval,
}

/// A triangle of what clipping leaves of a face: its vertices, sensor frame.
type Piece = [Vector<Interval>; 3];

impl<'a> Pencil<'a> {
    pub(crate) fn new(sensor: &'a Sensor, aim: Aim, with: Approximations, tolerance: Tolerance) -> Self {
        let of = Interval::of;
        let lateral = tolerance.lateral;
        // Half cells from the middle, or from the axis.
        let (x, y, screen) = match sensor {
            Sensor::Camera(Mounted { sensor, .. }) => {
                let metres = |cells: Interval, axis: usize| {
                    cells.sub(&of(sensor.principal_point[axis])).mul(&of(sensor.pixel_pitch[axis]))
                };
                let centre = |index: u32, axis| metres(of(f64::from(index) + 0.5).wider(lateral), axis);
                let border = |index: u32, axis| metres(Interval::of_integer(index), axis);
                let borders = [border(0, 0), border(sensor.width, 0), border(0, 1), border(sensor.height, 1)];
                (centre(aim.i, 0), centre(aim.j, 1), borders)
            }
            Sensor::Beam(Mounted { sensor, .. }) => {
                let centre = |index: u32, count: u32, half: Interval| {
                    let half_cells = of(2.0 * f64::from(index) + 1.0 - f64::from(count)).wider(2.0 * lateral);
                    half.mul(&half_cells).over(Interval::of_integer(count))
                };
                let (w, half) = (of(sensor.half_width), of(0.5 * sensor.thickness));
                let borders = [w.negated(), w, half.negated(), half];
                (centre(aim.i, sensor.columns, w), centre(aim.j, sensor.rows, half), borders)
            }
        };
        let (zero, spp) = (of(0.0), of(spp(sensor)));
        let (start, q) = match sensor {
            Sensor::Camera(_) => ([zero; 3], [x, y, spp]),
            Sensor::Beam(_) => ([zero, y, zero], [x, zero, spp]),
        };
        Self {
            sensor,
            with,
            position: tolerance.position,
            scene_from_sensor: ScaledRotation::of(sensor.pose().rotation),
            start: Vector(start),
            q: Vector(q),
            at: Projected { x, y },
            screen,
        }
    }

    /// The reasons for which the approximations make this ray meet a face that it does not meet.
    fn adds(&self, face: &Face) -> Vec<Reason> {
        let plane = self.plane(face);
        let mut reasons = Vec::new();
        if !(self.is_drawn(face) & plane.is_met_as_asked).may_be {
            return reasons;
        }
        if self.draws_straight_sides() && self.is_within_true_sides(face).may_not {
            reasons.push(Reason::StraightSide);
        }
        if self.asks_middle() && plane.row_sees_front.may_not {
            reasons.push(Reason::FacingOfMiddle);
        }
        reasons
    }

    /// The reasons for which the approximations lose a face that this ray meets.
    fn loses(&self, face: &Face) -> Vec<Reason> {
        let mut reasons = Vec::new();
        let pieces = self.pieces(face, self.draws_straight_sides());
        let within: Vec<Truth> = pieces.iter().map(|piece| self.is_within(piece)).collect();
        if self.draws_straight_sides() && Truth::any(within.iter().copied()).may_not {
            reasons.push(Reason::StraightSide);
        }
        if self.asks_middle() && self.plane(face).middle_sees_front.may_not {
            reasons.push(Reason::FacingOfMiddle);
        }
        if self.with.skip_rules && self.is_drawn(face).may_not {
            let pieces = || pieces.iter().zip(&within).filter(|(_, within)| within.may_be);
            if pieces().any(|(piece, _)| self.is_in_but_too_far(piece).may_be) {
                reasons.push(Reason::VerticesTooFar);
            }
            if pieces().any(|(piece, _)| self.is_apart(piece).may_be) {
                reasons.push(Reason::SidesApart);
            }
        }
        reasons
    }

    /// Whether sides are straight on the screen that in truth are not.
    fn draws_straight_sides(&self) -> bool {
        self.with.beam_edges && matches!(self.sensor, Sensor::Beam(_))
    }

    /// Whether the middle of the sheet decides which side of a face all rows see.
    fn asks_middle(&self) -> bool {
        self.with.skip_rules && matches!(self.sensor, Sensor::Beam(_))
    }

    /// Whether some piece of a face that the rules leave covers the cell's centre.
    fn is_drawn(&self, face: &Face) -> Truth {
        let pieces = self.pieces(face, self.draws_straight_sides());
        Truth::any(pieces.iter().map(|piece| {
            let skipped = if self.with.skip_rules {
                self.is_in_but_too_far(piece) | self.is_apart(piece)
            } else {
                Truth::NO
            };
            self.is_within(piece) & !skipped
        }))
    }

    /// Whether the ray passes between the sides of a face, from either side.
    fn is_within_true_sides(&self, face: &Face) -> Truth {
        let pieces = self.pieces(face, false);
        Truth::any(pieces.iter().map(|piece| self.is_within_planes(piece)))
    }

    /// A vertex in the sensor's frame, metres.
    pub(crate) fn seen(&self, corner: [f32; 3]) -> Vector<Interval> {
        let relative = Vector::of_f32(corner).sub(&Vector::of(self.sensor.pose().position));
        let Vector(turned) = self.scene_from_sensor.apply_inverse(&relative);
        Vector(turned.map(|part| part.over(self.scene_from_sensor.norm_squared).wider(self.position)))
    }

    /// What clipping leaves of a face, as a fan of triangles from its first vertex: the part with z >= g (figure
    /// 9), and of that, within the `stripe`, with |y| <= T/2, then |x| <= z w/g (figure 8).
    fn pieces(&self, face: &Face, stripe: bool) -> Vec<Piece> {
        let spp = Interval::of(spp(self.sensor));
        let mut polygon = face.corners.map(|corner| self.seen(corner)).to_vec();
        polygon = cut(&polygon, |p| p.0[2].sub(&spp));
        if let (true, Sensor::Beam(Mounted { sensor, .. })) = (stripe, self.sensor) {
            let half = Interval::of(0.5 * sensor.thickness);
            let (w, g) = (Interval::of(sensor.half_width), Interval::of(sensor.grid_distance));
            let aside = |p: &Vector<Interval>| (w.mul(&p.0[2]), g.mul(&p.0[0]));
            polygon = cut(&polygon, |p| p.0[1].add(&half));
            polygon = cut(&polygon, |p| half.sub(&p.0[1]));
            polygon = cut(&polygon, |p| {
                let (limit, x) = aside(p);
                limit.add(&x)
            });
            polygon = cut(&polygon, |p| {
                let (limit, x) = aside(p);
                limit.sub(&x)
            });
        }
        let Some((first, others)) = polygon.split_first() else { return Vec::new() };
        others.windows(2).map(|pair| [first.clone(), pair[0].clone(), pair[1].clone()]).collect()
    }

    /// The image of a point at or beyond the SPP.
    fn project(&self, p: &Vector<Interval>) -> Projected {
        let [x, y, z] = &p.0;
        let spp = Interval::of(spp(self.sensor));
        let across = |part: &Interval| spp.mul(part).over(*z);
        match self.sensor {
            Sensor::Camera(_) => Projected { x: across(x), y: across(y) },
            Sensor::Beam(_) => Projected { x: across(x), y: *y },
        }
    }

    /// Whether a piece covers the cell's centre, as its sides are drawn.
    fn is_within(&self, piece: &Piece) -> Truth {
        if self.draws_straight_sides() {
            is_within_lines(&self.at, &piece.each_ref().map(|point| self.project(point)))
        } else {
            self.is_within_planes(piece)
        }
    }

    /// Whether the ray passes between the planes through its start and the sides of a piece: all of
    /// q.(a' x (b - a)) have one sign, a' = a - start.
    fn is_within_planes(&self, piece: &Piece) -> Truth {
        let sides = [0, 1, 2].map(|k: usize| {
            let (a, b) = (&piece[k], &piece[(k + 1) % 3]);
            self.q.dot(&a.sub(&self.start).cross(&b.sub(a)))
        });
        Truth::all(sides.map(Truth::not_negative))
            | Truth::all(sides.map(|side| Truth::not_negative(side.negated())))
    }

    /// Rule 3b.
    fn is_in_but_too_far(&self, piece: &Piece) -> Truth {
        let max_range = Interval::of(self.sensor.max_range());
        Truth::all(piece.iter().map(|point| {
            let [x, y, z] = &point.0;
            let from_start = match self.sensor {
                Sensor::Camera(_) => x.square().add(&y.square()).add(&z.square()),
                // From (0, y, 0), where the ray starts.
                Sensor::Beam(_) => x.square().add(&z.square()),
            };
            self.holds(&self.project(point)) & Truth::positive(from_start.sub(&max_range.square()))
        }))
    }

    /// Rule 3c: no vertex or side in the screen, nor the screen's centre in the triangle.
    fn is_apart(&self, piece: &Piece) -> Truth {
        let corners = piece.each_ref().map(|point| self.project(point));
        let [left, right, top, bottom] = self.screen;
        let half = Interval::of(0.5);
        let centre = Projected { x: left.add(&right).mul(&half), y: top.add(&bottom).mul(&half) };
        !Truth::any(corners.iter().map(|corner| self.holds(corner)))
            & !Truth::any((0..3).map(|k| self.meets_side(&corners[k], &corners[(k + 1) % 3])))
            & !is_within_lines(&centre, &corners)
    }

    /// Whether the screen, closed, holds a point.
    fn holds(&self, p: &Projected) -> Truth {
        let [left, right, top, bottom] = self.screen;
        Truth::all(
            [p.x.sub(&left), right.sub(&p.x), p.y.sub(&top), bottom.sub(&p.y)].map(Truth::not_negative),
        )
    }

    /// Whether a straight side comes into the screen: nothing separates the two.
    fn meets_side(&self, from: &Projected, to: &Projected) -> Truth {
        let [left, right, top, bottom] = self.screen;
        let both = |a: Interval, b: Interval| Truth::positive(a) & Truth::positive(b);
        let beside = Truth::any([
            both(left.sub(&from.x), left.sub(&to.x)),
            both(from.x.sub(&right), to.x.sub(&right)),
            both(top.sub(&from.y), top.sub(&to.y)),
            both(from.y.sub(&bottom), to.y.sub(&bottom)),
        ]);
        let beyond = [(left, top), (right, top), (right, bottom), (left, bottom)]
            .map(|(x, y)| turn(from, to, &Projected { x, y }));
        let apart = Truth::all(beyond.map(Truth::positive))
            | Truth::all(beyond.map(|side| Truth::positive(side.negated())));
        !(beside | apart)
    }

    /// Whether the ray meets a face, from either side, at or beyond the SPP and nearer than `distance` metres.
    pub(crate) fn meets_nearer_than(&self, face: &Face, distance: Interval) -> Truth {
        let [a, b, c] = face.corners.map(|corner| self.seen(corner));
        let n = b.sub(&a).cross(&c.sub(&a));
        let (height, approach) = (n.dot(&a.sub(&self.start)), n.dot(&self.q));
        let length = square_root(self.q.length_squared());
        let is_met = |height: Interval, approach: Interval| {
            Truth::positive(height)
                & Truth::positive(approach)
                & Truth::not_negative(height.sub(&approach))
                & Truth::positive(distance.mul(&approach).sub(&height.mul(&length)))
        };
        self.is_within_true_sides(face)
            & (is_met(height, approach) | is_met(height.negated(), approach.negated()))
    }

    /// What the ray and the middle of the sheet see of a face's plane.
    fn plane(&self, face: &Face) -> PlaneSeen {
        let [a, b, c] = face.corners.map(|corner| self.seen(corner));
        let n = b.sub(&a).cross(&c.sub(&a));
        let (from_middle, from_start) = (n.dot(&a), n.dot(&a.sub(&self.start)));
        let approach = n.dot(&self.q);
        let length = square_root(self.q.length_squared());
        let max_range = Interval::of(self.sensor.max_range());
        // t = n.a' / n.q, at least 1, and R = t |q| within the range; both signs alike.
        let is_met = |height: Interval, approach: Interval| {
            Truth::positive(height)
                & Truth::positive(approach)
                & Truth::not_negative(height.sub(&approach))
                & Truth::not_negative(max_range.mul(&approach).sub(&height.mul(&length)))
        };
        let front = is_met(from_start.negated(), approach.negated());
        let middle_sees_front = Truth::positive(from_middle.negated());
        PlaneSeen {
            row_sees_front: Truth::positive(from_start.negated()),
            middle_sees_front,
            is_met_as_asked: if self.asks_middle() {
                middle_sees_front & (front | is_met(from_start, approach))
            } else {
                front
            },
        }
    }
}

/// What is seen of a face's plane.
struct PlaneSeen {
    /// From where the ray starts.
    row_sees_front: Truth,
    /// From (0, 0, 0).
    middle_sees_front: Truth,
    /// Whether the ray meets it within the range, from the side that the approximations ask for.
    is_met_as_asked: Truth,
}

/// Distance of the SPP, metres.
fn spp(sensor: &Sensor) -> f64 {
    match sensor {
        Sensor::Camera(Mounted { sensor, .. }) => sensor.focal_length,
        Sensor::Beam(Mounted { sensor, .. }) => sensor.grid_distance,
    }
}

/// The part of a convex polygon where `distance` is not negative. A corner that is within rounding of the cut is
/// taken as its middle says: either is within rounding of the other.
fn cut(
    polygon: &[Vector<Interval>],
    distance: impl Fn(&Vector<Interval>) -> Interval,
) -> Vec<Vector<Interval>> {
    let mut part = Vec::with_capacity(polygon.len() + 1);
    for (k, here) in polygon.iter().enumerate() {
        let there = &polygon[(k + 1) % polygon.len()];
        let (of_here, of_there) = (distance(here), distance(there));
        let (keeps_here, keeps_there) = (of_here.middle() >= 0.0, of_there.middle() >= 0.0);
        if keeps_here {
            part.push(here.clone());
        }
        if keeps_here != keeps_there {
            let (from, to) = if keeps_here { (of_here, of_there) } else { (of_there, of_here) };
            let (inner, outer) = if keeps_here { (here, there) } else { (there, here) };
            let s = share(from, to);
            part.push(
                inner.add(&Vector(std::array::from_fn(|axis| outer.0[axis].sub(&inner.0[axis]).mul(&s)))),
            );
        }
    }
    part
}

/// from / (from - to) for from >= 0 >= to: it grows with both.
fn share(from: Interval, to: Interval) -> Interval {
    let at = |from: f64, to: f64| {
        let (from, to) = (Interval::of(from.max(0.0)), Interval::of(to.min(0.0)));
        from.over(from.sub(&to))
    };
    let (low, high) = (at(from.low, to.low), at(from.high, to.high));
    let hull = low.hull(high);
    Interval::between(hull.low.max(0.0), hull.high.min(1.0))
}

/// Twice the signed area of a, b, c.
fn turn(a: &Projected, b: &Projected, c: &Projected) -> Interval {
    b.x.sub(&a.x).mul(&c.y.sub(&a.y)).sub(&b.y.sub(&a.y).mul(&c.x.sub(&a.x)))
}

/// Whether a point is in a closed triangle, whichever way round that runs.
fn is_within_lines(p: &Projected, corners: &[Projected; 3]) -> Truth {
    let turns = [0, 1, 2].map(|k: usize| turn(&corners[k], &corners[(k + 1) % 3], p));
    // What is known of the sides alone leaves a thin triangle open far beyond its ends.
    let not_beyond = |of: fn(&Projected) -> Interval| {
        let part = corners.each_ref().map(of);
        let low = part.iter().fold(f64::INFINITY, |low, part| low.min(part.low));
        let high = part.iter().fold(f64::NEG_INFINITY, |high, part| high.max(part.high));
        of(p).high >= low && of(p).low <= high
    };
    if !(not_beyond(|p| p.x) && not_beyond(|p| p.y)) {
        return Truth::NO;
    }
    Truth::all(turns.map(Truth::not_negative))
        | Truth::all(turns.map(|turn| Truth::not_negative(turn.negated())))
}

/// An interval around the square root.
fn square_root(x: Interval) -> Interval {
    // Correctly rounded, so half a unit in the last place.
    Interval::between(x.low.max(0.0).sqrt(), x.high.max(0.0).sqrt()).wider(0.0)
}
