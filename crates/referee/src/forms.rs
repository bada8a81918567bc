//! The contract's conditions as functions of a small displacement of the ray.
//!
//! Displaced by (dx, dy) cells, D = D0 + dx D_x + dy D_y and O = O0 + dy O_y; in the camera O_y = 0, in a beam
//! D_y = 0. Every condition of `face` is then bilinear in (dx, dy), but for the range, whose |D| is bent a
//! little. A [`Form`] is such a function g, its coefficients intervals, and the condition is g >= 0.

use glam::DVec3;
use raypencil_scene::Mounted;

use crate::face::Face;
use crate::number::{Interval, Number};
use crate::pencil::{Aim, Sensor};
use crate::vector::{ScaledRotation, Vector};

/// `constant + x dx + y dy + xy dx dy`, and within |dx|, |dy| <= r off by at most `bend` r^2.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Form {
    pub(crate) constant: Interval,
    pub(crate) x: Interval,
    pub(crate) y: Interval,
    pub(crate) xy: Interval,
    pub(crate) bend: f64,
}

const ZERO: Interval = Interval { low: 0.0, high: 0.0 };

impl Form {
    /// A radius of at most 1 within which g > 0 for certain; 0 if there is none.
    #[inline]
    pub(crate) fn holds_within(&self) -> f64 {
        self.radius(self.constant.low)
    }

    /// A radius of at most 1 within which g < 0 for certain; 0 if there is none.
    #[inline]
    pub(crate) fn fails_within(&self) -> f64 {
        self.radius(-self.constant.high)
    }

    /// Up to which r `room - r (|x| + |y|) - r^2 (|xy| + bend)` stays positive.
    ///
    /// The positive root of b r^2 + a r = c is 2 c / (a + sqrt(a^2 + 4 b c)); a dozen roundings up to that are
    /// far less than the 2^-40 of itself by which the result is made smaller.
    #[inline]
    fn radius(&self, room: f64) -> f64 {
        if !(room > 0.0) {
            return 0.0;
        }
        let a = self.x.magnitude() + self.y.magnitude();
        let b = self.xy.magnitude() + self.bend;
        let r = 2.0 * room / (a + (a * a + 4.0 * b * room).sqrt());
        // NaN (infinite coefficients) certifies nothing.
        if r > 0.0 { (r * (1.0 - 1.0 / (1u64 << 40) as f64)).min(1.0) } else { 0.0 }
    }

    /// `self + weight other`, for a positive weight: negative wherever both are.
    pub(crate) fn plus(&self, other: &Self, weight: f64) -> Self {
        let w = Interval::of(weight);
        let sum = |a: &Interval, b: &Interval| a.add(&b.mul(&w));
        Self {
            constant: sum(&self.constant, &other.constant),
            x: sum(&self.x, &other.x),
            y: sum(&self.y, &other.y),
            xy: sum(&self.xy, &other.xy),
            bend: (self.bend + weight * other.bend) * (1.0 + 4.0 * f64::EPSILON),
        }
    }

    /// The value at a displacement, roughly.
    pub(crate) fn at(&self, [dx, dy]: [f64; 2]) -> f64 {
        self.constant.middle() + self.x.middle() * dx + self.y.middle() * dy + self.xy.middle() * dx * dy
    }
}

/// A square in which the forms certainly do not all hold, by one of them or by two combined: the largest that
/// can be shown, or one of at least `enough`.
pub(crate) fn certainly_fails(forms: &[Form], enough: f64) -> f64 {
    let mut best = forms.iter().map(Form::fails_within).fold(0.0, f64::max);
    for (k, a) in forms.iter().enumerate() {
        for b in &forms[k + 1..] {
            if best >= enough {
                return best;
            }
            // Where both hold, so does their sum with any positive weight; those that make the sum level in
            // dx or in dy are the best for a square.
            for (slope_a, slope_b) in [(a.x, b.x), (a.y, b.y)] {
                let weight = -slope_a.middle() / slope_b.middle();
                if weight > 0.0 && weight.is_finite() {
                    best = best.max(a.plus(b, weight).fails_within());
                }
            }
        }
    }
    best
}

/// A cell's ray and how displacement moves it.
pub(crate) struct MovingRay {
    origin: Vector<Interval>,
    origin_y: Vector<Interval>,
    origin_scale: Interval,
    direction: Vector<Interval>,
    direction_x: Vector<Interval>,
    direction_y: Vector<Interval>,
    direction_scale: Interval,
    max_range: f64,
    /// |D| as a form without its bend, and the bend.
    length: [Interval; 3],
    length_bend: f64,
}

impl MovingRay {
    pub(crate) fn new(sensor: &Sensor, aim: Aim) -> Self {
        let ray = sensor.ray::<Interval>(aim);
        let rotation = ScaledRotation::<Interval>::of(sensor.pose().rotation);
        let turned = |v: DVec3| rotation.apply(&Vector::of(v));
        let nothing = || Vector([ZERO; 3]);
        let (direction_x, direction_y, origin_y) = match sensor {
            Sensor::Camera(Mounted { sensor, .. }) => (
                turned(DVec3::X * sensor.pixel_pitch[0]),
                turned(DVec3::Y * sensor.pixel_pitch[1]),
                nothing(),
            ),
            Sensor::Beam(Mounted { sensor, .. }) => (
                turned(DVec3::X * (2.0 * sensor.half_width)),
                nothing(),
                turned(DVec3::Y * (2.0 * sensor.thickness)),
            ),
        };
        // |D| is convex: at least its tangent, and at most (|D_x| + |D_y|)^2 r^2 / (2 min |D|) more.
        let length = square_root(ray.direction.length_squared());
        let slope = |along: &Vector<Interval>| quotient(ray.direction.dot(along), length);
        let steps =
            square_root(direction_x.length_squared()).high + square_root(direction_y.length_squared()).high;
        let shortest = length.low - steps;
        let length_bend = if shortest > 0.0 {
            steps * steps / (2.0 * shortest) * (1.0 + 16.0 * f64::EPSILON)
        } else {
            f64::INFINITY
        };
        Self {
            length: [length, slope(&direction_x), slope(&direction_y)],
            length_bend,
            origin: ray.origin,
            origin_y,
            origin_scale: ray.origin_scale,
            direction: ray.direction,
            direction_x,
            direction_y,
            direction_scale: ray.direction_scale,
            max_range: sensor.max_range(),
        }
    }
}

/// The conditions of one face, computed as they are asked for.
pub(crate) struct FaceForms<'a> {
    ray: &'a MovingRay,
    pub(crate) face: &'a Face,
    /// n.a': constant and dy.
    height: [Interval; 2],
    /// n.D: constant, dx, dy.
    approach: [Interval; 3],
}

impl<'a> FaceForms<'a> {
    pub(crate) fn new(ray: &'a MovingRay, face: &'a Face) -> Self {
        let a = Vector::<Interval>::of_f32(face.corners[0]);
        let (b, c) = (Vector::of_f32(face.corners[1]), Vector::of_f32(face.corners[2]));
        let normal = b.sub(&a).cross(&c.sub(&a));
        let relative = a.scaled(&ray.origin_scale).sub(&ray.origin);
        let height = [normal.dot(&relative), ZERO.sub(&normal.dot(&ray.origin_y))];
        let approach =
            [normal.dot(&ray.direction), normal.dot(&ray.direction_x), normal.dot(&ray.direction_y)];
        Self { ray, face, height, approach }
    }

    /// Inside the edge from corner `k`: -D.(a' x (b - a)) >= 0.
    pub(crate) fn edge(&self, k: usize) -> Form {
        edge(self.ray, self.face, k)
    }

    /// The front is met: -n.D >= 0.
    pub(crate) fn front(&self) -> Form {
        let [constant, x, y] = self.approach.map(|part| ZERO.sub(&part));
        Form { constant, x, y, xy: ZERO, bend: 0.0 }
    }

    /// At or beyond the SPP: s n.D - sigma n.a' >= 0.
    pub(crate) fn plane(&self) -> Form {
        let (s, sigma) = (&self.ray.origin_scale, &self.ray.direction_scale);
        let [p, px, py] = self.approach.each_ref().map(|part| part.mul(s));
        let [h, hy] = self.height.each_ref().map(|part| part.mul(sigma));
        Form { constant: p.sub(&h), x: px, y: py.sub(&hy), xy: ZERO, bend: 0.0 }
    }

    /// Within the range: M s (-n.D) - (-n.a') |D| >= 0.
    pub(crate) fn range(&self) -> Form {
        let limit = Interval::of(self.ray.max_range).mul(&self.ray.origin_scale);
        let [p, px, py] = self.approach.each_ref().map(|part| part.mul(&limit));
        let [h, hy] = &self.height;
        let [l, lx, ly] = &self.ray.length;
        Form {
            constant: h.mul(l).sub(&p),
            x: h.mul(lx).sub(&px),
            y: h.mul(ly).add(&hy.mul(l)).sub(&py),
            xy: hy.mul(lx),
            bend: (h.magnitude() + hy.magnitude()) * self.ray.length_bend * (1.0 + 4.0 * f64::EPSILON),
        }
    }

    /// This face is met at or before `other`, where both are met from the front:
    /// n'.a'' n.D - n.a' n'.D >= 0, primes for the other.
    pub(crate) fn at_or_before(&self, other: &Self) -> Form {
        let ([g, gy], [f, fy]) = (&self.height, &other.height);
        let ([p, px, py], [q, qx, qy]) = (&self.approach, &other.approach);
        Form {
            constant: f.mul(p).sub(&g.mul(q)),
            x: f.mul(px).sub(&g.mul(qx)),
            y: f.mul(py).add(&fy.mul(p)).sub(&g.mul(qy)).sub(&gy.mul(q)),
            xy: fy.mul(px).sub(&gy.mul(qx)),
            bend: 0.0,
        }
    }

    /// The six conditions that concern this face alone.
    pub(crate) fn own(&self) -> [Form; 6] {
        [self.edge(0), self.edge(1), self.edge(2), self.front(), self.plane(), self.range()]
    }

    /// A range in metres that this face's plane certainly does not exceed within the radius `r`.
    pub(crate) fn farthest_range(&self, r: f64) -> f64 {
        let [h, hy] = self.height.map(|part| part.magnitude());
        let [p, px, py] = &self.approach;
        let scale = (-p.high - r * (px.magnitude() + py.magnitude())) * self.ray.origin_scale.low;
        let [l, lx, ly] = self.ray.length.map(|part| part.magnitude());
        let length = l + r * (lx + ly) + r * r * self.ray.length_bend;
        let range = (h + r * hy) * length / scale * (1.0 + 32.0 * f64::EPSILON);
        if scale > 0.0 && range < self.ray.max_range { range } else { self.ray.max_range }
    }
}

/// The form of one edge, which needs nothing else of its face.
pub(crate) fn edge(ray: &MovingRay, face: &Face, k: usize) -> Form {
    let a = Vector::<Interval>::of_f32(face.corners[k]);
    let along = Vector::of_f32(face.corners[(k + 1) % 3]).sub(&a);
    let moment = a.scaled(&ray.origin_scale).sub(&ray.origin).cross(&along);
    let moment_y = ray.origin_y.cross(&along);
    let minus = |value: Interval| ZERO.sub(&value);
    Form {
        constant: minus(ray.direction.dot(&moment)),
        x: minus(ray.direction_x.dot(&moment)),
        y: ray.direction.dot(&moment_y).sub(&ray.direction_y.dot(&moment)),
        xy: ray.direction_x.dot(&moment_y),
        bend: 0.0,
    }
}

/// An interval around the square root of a number that is not negative.
fn square_root(value: Interval) -> Interval {
    let (low, high) = (value.low.max(0.0).sqrt(), value.high.max(0.0).sqrt());
    // Correctly rounded: half a unit in the last place each.
    Interval { low: (low * (1.0 - f64::EPSILON)).max(0.0), high: high * (1.0 + 2.0 * f64::EPSILON) }
}

/// An interval around a quotient by a positive number.
fn quotient(dividend: Interval, divisor: Interval) -> Interval {
    let [a, b, c, d] = [
        dividend.low / divisor.low,
        dividend.low / divisor.high,
        dividend.high / divisor.low,
        dividend.high / divisor.high,
    ];
    let (low, high) = (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)));
    let wider = |x: f64| x.abs() * f64::EPSILON + f64::MIN_POSITIVE;
    Interval { low: low - wider(low), high: high + wider(high) }
}
