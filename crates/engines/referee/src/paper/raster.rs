//! The image that the paper's approximations give a face, in intervals.
//!
//! The intervals contain the result of any renderer that misplaces points by at most its tolerance and whose ray is
//! displaced by at most that. So a [`Kleene`] value that is false is a proof, and an unknown one lies within rounding
//! of a side or a limit.

use raypencil_scene::Mounted;

use crate::hits::face::Face;
use crate::hits::ruling::Tolerance;
use crate::numbers::kleene::Kleene;
use crate::numbers::number::{Interval, Number};
use crate::numbers::vector::{ScaledRotation, Vector};
use crate::paper::approximations::{Approximations, Reason};
use crate::rays::ray::{Aim, MountedSensor};

/// A cell's ray in the sensor's frame, in intervals that contain all rays and terrains within the tolerance.
pub(crate) struct PaperRay<'a> {
    sensor: &'a MountedSensor,
    with: Approximations,
    position: f64,
    scene_from_sensor: ScaledRotation<Interval>,
    /// The ray's start.
    start: Vector<Interval>,
    /// q. Its x and y are where the ray crosses the SPP; in a beam, y is that of the start.
    q: Vector<Interval>,
    /// The cell's centre on the screen.
    at: Projected,
    /// Left, right, top and bottom border of the screen.
    screen: [Interval; 4],
}

/// A point of the SPP, metres.
#[derive(Debug, Clone, Copy)]
struct Projected {
    x: Interval,
    y: Interval,
}

/// A triangle of a clipped face: its vertices, sensor frame.
type Piece = [Vector<Interval>; 3];

impl<'a> PaperRay<'a> {
    pub(crate) fn new(
        sensor: &'a MountedSensor,
        aim: Aim,
        with: Approximations,
        tolerance: Tolerance,
    ) -> Self {
        let of = Interval::of;
        let lateral = tolerance.lateral;
        // The cell's centre and the borders of the screen, on the SPP in metres.
        let (x, y, screen) = match sensor {
            MountedSensor::Camera(Mounted { sensor, .. }, _) => {
                let metres = |cells: Interval, axis: usize| {
                    cells.sub(&of(sensor.principal_point[axis])).mul(&of(sensor.pixel_pitch[axis]))
                };
                let centre = |index: u32, axis| metres(of(f64::from(index) + 0.5).wider(lateral), axis);
                let border = |index: u32, axis| metres(Interval::of_integer(index), axis);
                let borders = [border(0, 0), border(sensor.width, 0), border(0, 1), border(sensor.height, 1)];
                (centre(aim.i, 0), centre(aim.j, 1), borders)
            }
            MountedSensor::Beam(Mounted { sensor, .. }, _) => {
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
            MountedSensor::Camera(..) => ([zero; 3], [x, y, spp]),
            MountedSensor::Beam(..) => ([zero, y, zero], [x, zero, spp]),
        };
        Self {
            sensor,
            with,
            position: tolerance.position,
            scene_from_sensor: sensor.rotation(),
            start: Vector(start),
            q: Vector(q),
            at: Projected { x, y },
            screen,
        }
    }

    /// The reasons for which the approximations make this ray meet a face that it does not meet.
    pub(crate) fn adds(&self, face: &Face) -> Vec<Reason> {
        let plane = self.plane(face);
        let mut reasons = Vec::new();
        if !(self.is_drawn(face) & plane.is_met_as_asked).may_hold {
            return reasons;
        }
        if self.draws_straight_sides() && self.is_within_true_sides(face).may_fail {
            reasons.push(Reason::StraightSide);
        }
        if self.asks_middle() && plane.row_sees_front.may_fail {
            reasons.push(Reason::FacingOfMiddle);
        }
        reasons
    }

    /// The reasons for which the approximations lose a face that this ray meets.
    pub(crate) fn loses(&self, face: &Face) -> Vec<Reason> {
        let mut reasons = Vec::new();
        let pieces = self.pieces(face, self.draws_straight_sides());
        let within: Vec<Kleene> = pieces.iter().map(|piece| self.is_within(piece)).collect();
        if self.draws_straight_sides() && Kleene::any(within.iter().copied()).may_fail {
            reasons.push(Reason::StraightSide);
        }
        if self.asks_middle() && self.plane(face).middle_sees_front.may_fail {
            reasons.push(Reason::FacingOfMiddle);
        }
        if self.with.skip_rules && self.is_drawn(face).may_fail {
            let pieces = || pieces.iter().zip(&within).filter(|(_, within)| within.may_hold);
            if pieces().any(|(piece, _)| self.is_in_but_too_far(piece).may_hold) {
                reasons.push(Reason::VerticesTooFar);
            }
            if pieces().any(|(piece, _)| self.is_off_screen(piece).may_hold) {
                reasons.push(Reason::SidesApart);
            }
        }
        reasons
    }

    /// Whether sides are drawn straight that are curved in truth.
    fn draws_straight_sides(&self) -> bool {
        self.with.beam_edges && matches!(self.sensor, MountedSensor::Beam(..))
    }

    /// Whether the middle of the sheet decides which side of a face all rows see.
    fn asks_middle(&self) -> bool {
        self.with.skip_rules && matches!(self.sensor, MountedSensor::Beam(..))
    }

    /// Whether a piece of the face that the rules do not skip covers the cell's centre.
    fn is_drawn(&self, face: &Face) -> Kleene {
        let pieces = self.pieces(face, self.draws_straight_sides());
        Kleene::any(pieces.iter().map(|piece| {
            let skipped = if self.with.skip_rules {
                self.is_in_but_too_far(piece) | self.is_off_screen(piece)
            } else {
                Kleene::FALSE
            };
            self.is_within(piece) & !skipped
        }))
    }

    /// Whether the ray passes between the sides of a face, from either side.
    fn is_within_true_sides(&self, face: &Face) -> Kleene {
        let pieces = self.pieces(face, false);
        Kleene::any(pieces.iter().map(|piece| self.is_within_planes(piece)))
    }

    /// A vertex in the sensor's frame, metres.
    pub(crate) fn in_sensor_frame(&self, corner: [f32; 3]) -> Vector<Interval> {
        let relative = Vector::of_f32(corner).sub(&Vector::of(self.sensor.pose().position));
        let Vector(turned) = self.scene_from_sensor.apply_inverse(&relative);
        Vector(turned.map(|part| part.over(self.scene_from_sensor.norm_squared).wider(self.position)))
    }

    /// The clipped face as a fan of triangles from its first vertex: the part with z >= g (figure 9); with `stripe`,
    /// also |y| <= T/2 and then |x| <= z w/g (figure 8).
    fn pieces(&self, face: &Face, stripe: bool) -> Vec<Piece> {
        let spp = Interval::of(spp(self.sensor));
        let mut polygon = face.corners.map(|corner| self.in_sensor_frame(corner)).to_vec();
        polygon = clip(&polygon, |p| p.0[2].sub(&spp));
        if let (true, MountedSensor::Beam(Mounted { sensor, .. }, _)) = (stripe, self.sensor) {
            let half = Interval::of(0.5 * sensor.thickness);
            let (w, g) = (Interval::of(sensor.half_width), Interval::of(sensor.grid_distance));
            let aside = |p: &Vector<Interval>| (w.mul(&p.0[2]), g.mul(&p.0[0]));
            polygon = clip(&polygon, |p| p.0[1].add(&half));
            polygon = clip(&polygon, |p| half.sub(&p.0[1]));
            polygon = clip(&polygon, |p| {
                let (limit, x) = aside(p);
                limit.add(&x)
            });
            polygon = clip(&polygon, |p| {
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
            MountedSensor::Camera(..) => Projected { x: across(x), y: across(y) },
            MountedSensor::Beam(..) => Projected { x: across(x), y: *y },
        }
    }

    /// Whether a piece, as its sides are drawn, covers the cell's centre.
    fn is_within(&self, piece: &Piece) -> Kleene {
        if self.draws_straight_sides() {
            is_within_lines(&self.at, &piece.each_ref().map(|point| self.project(point)))
        } else {
            self.is_within_planes(piece)
        }
    }

    /// Whether the ray passes between the planes through its start and the sides of a piece: all q.(a' x (b - a))
    /// have one sign, a' = a - start.
    fn is_within_planes(&self, piece: &Piece) -> Kleene {
        let sides = [0, 1, 2].map(|k: usize| {
            let (a, b) = (&piece[k], &piece[(k + 1) % 3]);
            self.q.dot(&a.sub(&self.start).cross(&b.sub(a)))
        });
        Kleene::all(sides.map(Kleene::not_negative))
            | Kleene::all(sides.map(|side| Kleene::not_negative(side.negated())))
    }

    /// Rule 3b: all vertices are in the screen and beyond the maximum range.
    fn is_in_but_too_far(&self, piece: &Piece) -> Kleene {
        let max_range = Interval::of(self.sensor.max_range());
        Kleene::all(piece.iter().map(|point| {
            let [x, y, z] = &point.0;
            let from_start = match self.sensor {
                MountedSensor::Camera(..) => x.square().add(&y.square()).add(&z.square()),
                // From (0, y, 0), where the ray starts.
                MountedSensor::Beam(..) => x.square().add(&z.square()),
            };
            self.holds(&self.project(point)) & Kleene::positive(from_start.sub(&max_range.square()))
        }))
    }

    /// Rule 3c: no vertex or side is in the screen, nor the screen's centre in the triangle.
    fn is_off_screen(&self, piece: &Piece) -> Kleene {
        let corners = piece.each_ref().map(|point| self.project(point));
        let [left, right, top, bottom] = self.screen;
        let half = Interval::of(0.5);
        let centre = Projected { x: left.add(&right).mul(&half), y: top.add(&bottom).mul(&half) };
        !Kleene::any(corners.iter().map(|corner| self.holds(corner)))
            & !Kleene::any((0..3).map(|k| self.meets_side(&corners[k], &corners[(k + 1) % 3])))
            & !is_within_lines(&centre, &corners)
    }

    /// Whether the screen, closed, contains a point.
    fn holds(&self, p: &Projected) -> Kleene {
        let [left, right, top, bottom] = self.screen;
        Kleene::all(
            [p.x.sub(&left), right.sub(&p.x), p.y.sub(&top), bottom.sub(&p.y)].map(Kleene::not_negative),
        )
    }

    /// Whether a straight side meets the screen: no line separates the two.
    fn meets_side(&self, from: &Projected, to: &Projected) -> Kleene {
        let [left, right, top, bottom] = self.screen;
        let both = |a: Interval, b: Interval| Kleene::positive(a) & Kleene::positive(b);
        let beside = Kleene::any([
            both(left.sub(&from.x), left.sub(&to.x)),
            both(from.x.sub(&right), to.x.sub(&right)),
            both(top.sub(&from.y), top.sub(&to.y)),
            both(from.y.sub(&bottom), to.y.sub(&bottom)),
        ]);
        let beyond = [(left, top), (right, top), (right, bottom), (left, bottom)]
            .map(|(x, y)| signed_double_area(from, to, &Projected { x, y }));
        let apart = Kleene::all(beyond.map(Kleene::positive))
            | Kleene::all(beyond.map(|side| Kleene::positive(side.negated())));
        !(beside | apart)
    }

    /// Whether the ray meets a face, from either side, at or beyond the SPP and nearer than `distance` metres.
    pub(crate) fn meets_nearer_than(&self, face: &Face, distance: Interval) -> Kleene {
        let [a, b, c] = face.corners.map(|corner| self.in_sensor_frame(corner));
        let n = b.sub(&a).cross(&c.sub(&a));
        let (height, approach) = (n.dot(&a.sub(&self.start)), n.dot(&self.q));
        let length = square_root(self.q.length_squared());
        let is_met = |height: Interval, approach: Interval| {
            Kleene::positive(height)
                & Kleene::positive(approach)
                & Kleene::not_negative(height.sub(&approach))
                & Kleene::positive(distance.mul(&approach).sub(&height.mul(&length)))
        };
        self.is_within_true_sides(face)
            & (is_met(height, approach) | is_met(height.negated(), approach.negated()))
    }

    /// The sides of a face's plane on which the ray and the middle of the sheet lie.
    fn plane(&self, face: &Face) -> PlaneSides {
        let [a, b, c] = face.corners.map(|corner| self.in_sensor_frame(corner));
        let n = b.sub(&a).cross(&c.sub(&a));
        let (from_middle, from_start) = (n.dot(&a), n.dot(&a.sub(&self.start)));
        let approach = n.dot(&self.q);
        let length = square_root(self.q.length_squared());
        let max_range = Interval::of(self.sensor.max_range());
        // t = n.a' / n.q is at least 1, and R = t |q| is within the range; both products have the same sign.
        let is_met = |height: Interval, approach: Interval| {
            Kleene::positive(height)
                & Kleene::positive(approach)
                & Kleene::not_negative(height.sub(&approach))
                & Kleene::not_negative(max_range.mul(&approach).sub(&height.mul(&length)))
        };
        let front = is_met(from_start.negated(), approach.negated());
        let middle_sees_front = Kleene::positive(from_middle.negated());
        PlaneSides {
            row_sees_front: Kleene::positive(from_start.negated()),
            middle_sees_front,
            is_met_as_asked: if self.asks_middle() {
                middle_sees_front & (front | is_met(from_start, approach))
            } else {
                front
            },
        }
    }
}

/// The sides of a face's plane that are seen.
struct PlaneSides {
    /// Whether the ray's start lies before the plane.
    row_sees_front: Kleene,
    /// Whether (0, 0, 0) lies before the plane.
    middle_sees_front: Kleene,
    /// Whether the ray meets the plane within the range, from the side that the approximations accept.
    is_met_as_asked: Kleene,
}

/// Distance of the SPP, metres.
fn spp(sensor: &MountedSensor) -> f64 {
    match sensor {
        MountedSensor::Camera(Mounted { sensor, .. }, _) => sensor.focal_length,
        MountedSensor::Beam(Mounted { sensor, .. }, _) => sensor.grid_distance,
    }
}

/// The part of a convex polygon where `distance` is not negative. A corner within rounding of the limit is classified
/// by its middle: both choices are within rounding of each other.
fn clip(
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
            let s = crossing_fraction(from, to);
            part.push(
                inner.add(&Vector(std::array::from_fn(|axis| outer.0[axis].sub(&inner.0[axis]).mul(&s)))),
            );
        }
    }
    part
}

/// from / (from - to) for from >= 0 >= to; it increases with both.
fn crossing_fraction(from: Interval, to: Interval) -> Interval {
    let at = |from: f64, to: f64| {
        let (from, to) = (Interval::of(from.max(0.0)), Interval::of(to.min(0.0)));
        from.over(from.sub(&to))
    };
    let (low, high) = (at(from.low, to.low), at(from.high, to.high));
    let hull = low.hull(high);
    Interval::between(hull.low.max(0.0), hull.high.min(1.0))
}

/// Twice the signed area of a, b, c.
fn signed_double_area(a: &Projected, b: &Projected, c: &Projected) -> Interval {
    b.x.sub(&a.x).mul(&c.y.sub(&a.y)).sub(&b.y.sub(&a.y).mul(&c.x.sub(&a.x)))
}

/// Whether a point is in a closed triangle of either orientation.
fn is_within_lines(p: &Projected, corners: &[Projected; 3]) -> Kleene {
    let turns = [0, 1, 2].map(|k: usize| signed_double_area(&corners[k], &corners[(k + 1) % 3], p));
    // The sides alone leave a thin triangle undecided far beyond its ends: test the bounding box too.
    let not_beyond = |of: fn(&Projected) -> Interval| {
        let part = corners.each_ref().map(of);
        let low = part.iter().fold(f64::INFINITY, |low, part| low.min(part.low));
        let high = part.iter().fold(f64::NEG_INFINITY, |high, part| high.max(part.high));
        of(p).high >= low && of(p).low <= high
    };
    if !(not_beyond(|p| p.x) && not_beyond(|p| p.y)) {
        return Kleene::FALSE;
    }
    Kleene::all(turns.map(Kleene::not_negative))
        | Kleene::all(turns.map(|turn| Kleene::not_negative(turn.negated())))
}

/// An interval that contains the square root.
fn square_root(x: Interval) -> Interval {
    // The roots are correctly rounded: an error of half a unit in the last place.
    Interval::between(x.low.max(0.0).sqrt(), x.high.max(0.0).sqrt()).wider(0.0)
}

#[cfg(test)]
#[path = "../../tests/unit/raster.rs"]
mod tests;
