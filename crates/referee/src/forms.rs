//! The contract's conditions as functions of a small displacement of the ray, in f64 with proven errors.
//!
//! In the sensor's frame, z = 1 along its axis, a ray displaced by (dx, dy) cells starts at (0, dy h, 0) and
//! runs along q = (q_x + dx p_x, q_y + dy p_y, 1); in the camera h = 0, in a beam q_y = p_y = 0. For a vertex a,
//! V = M^T (a - start) with the pose's rotation M; for an edge E = M^T (b - a); n = E x E'. The contract's signs
//! (`face`) are then those of
//!
//! | condition | form, >= 0 where it holds |
//! | --- | --- |
//! | inside the edge | -q.(V x E) |
//! | the front is met | -n.q |
//! | at or beyond the SPP at z = f | f n.q - n.V |
//! | within the range | M (-n.q) + n.V L, with L the length of q |
//! | at or before the other face, primed | n'.V' n.q - n.V n'.q |
//!
//! each a positive multiple of the one there. All are bilinear in (dx, dy), but for the range, whose L is
//! bent a little.
//!
//! # The errors
//!
//! u = 2^-53. |x|_1 is the sum of the absolute values; it is at least the length of x and at least any part of
//! it. Terms of order u^2 are covered where a bound is rounded up. The limits on what a scene may hold (vertices
//! and positions within 1e7 m, pitches and distances from 1e-8 to 1e3) keep all products far from overflow,
//! and underflow far below the errors.
//!
//! M: its parts are quotients of sums of four products by q.q, each sum within 4 u q.q: off by at most 10 u.
//!
//! V: a - start, u of itself before it is turned; a sum of three products, 3 u. So it is off by at most
//! 10 u |d|_1 + (1 + 3) u |d| <= 14 u |d|_1 in each part; in a beam, the row's height adds 4 u of itself and the
//! subtraction u of the result: in all at most 20 u S, with S = |d|_1 + height + h. E likewise: 14 u e, with
//! e = |b - a|_1.
//!
//! q_x, q_y, p_x, p_y, h: at most 3 u of themselves. Q = |q_x| + |q_y| + 1 + p_x + p_y bounds |q| over the square.
//!
//! V x E: each part 2 (20 + 14) u S e from the factors, 4 u S e from its own three roundings: 72 u S e. The edge
//! form, of size Q S e: 72 u from V x E, 4 u from q, 3 u from the sum, and 16 u for evaluating it (below): less than
//! 128 u Q S e.
//!
//! n: 2 (14 + 14) u K + 4 u K with K = e e': 60 u K each part. n.q: 60 u K Q + 7 u K Q, with 16 u for evaluating it
//! less than 128 u K Q. n.V: 60 u K times |V|_1 <= 1.8 S, 20 u S times |n|_1 <= 1.8 K, and 3 u: less than 160 u K S.
//!
//! SPP: 67 u f K Q + 160 u K S + 2 u and 16 u of the sum: less than 256 u K (f Q + S). Range: 67 u M K Q +
//! 160 u K S Q, 12 u from |q| and its slopes, 16 u: less than 256 u K Q (M + S). Order: (67 + 160 + 3 + 16) u for each
//! of two products of sizes K K' S' Q and K K' S Q: less than 256 u K K' Q (S + S').
//!
//! "Evaluating": adding up the at most four terms of a form somewhere in the square, and moving its origin.

use glam::{DMat3, DVec3};
use raypencil_scene::Mounted;

use crate::face::Face;
use crate::number::Interval;
use crate::pencil::{Aim, Sensor};

/// 2^-53: the unit roundoff.
const U: f64 = 0.5 * f64::EPSILON;

/// `constant + x dx + y dy + xy dx dy`: anywhere in |dx|, |dy| <= 1 off by at most `error`, evaluation
/// included, and within |dx|, |dy| <= r by at most `bend` r^2 more.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Form {
    pub(crate) constant: f64,
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) xy: f64,
    pub(crate) error: f64,
    pub(crate) bend: f64,
}

impl Form {
    /// A form by its coefficients, each known up to an interval.
    pub(crate) fn of(coefficients: [Interval; 4]) -> Self {
        let middle = coefficients.map(|range| range.middle());
        let doubt = |k: usize| (coefficients[k].high - middle[k]).max(middle[k] - coefficients[k].low);
        let [constant, x, y, xy] = middle;
        let form = Self { constant, x, y, xy, error: 0.0, bend: 0.0 };
        let evaluated = 16.0 * U * form.scale() + f64::MIN_POSITIVE;
        let error = ((doubt(0) + doubt(1)) + (doubt(2) + doubt(3)) + evaluated) * (1.0 + 8.0 * f64::EPSILON);
        Self { error, ..form }
    }

    /// A radius of at most 1 within which g > 0 for certain; 0 if there is none.
    #[inline]
    pub(crate) fn holds_within(&self) -> f64 {
        self.radius(self.constant - self.error)
    }

    /// A radius of at most 1 within which g < 0 for certain; 0 if there is none.
    #[inline]
    pub(crate) fn fails_within(&self) -> f64 {
        self.radius(-self.constant - self.error)
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
        let a = self.x.abs() + self.y.abs();
        let b = self.xy.abs() + self.bend;
        if room > (a + b) * (1.0 + 8.0 * f64::EPSILON) {
            return 1.0;
        }
        let r = 2.0 * room / (a + (a * a + 4.0 * b * room).sqrt());
        // NaN (infinite coefficients) certifies nothing.
        if r > 0.0 { (r * (1.0 - 1.0 / (1u64 << 40) as f64)).min(1.0) } else { 0.0 }
    }

    /// The sum of the sizes of the coefficients: the scale of what evaluating it may round away.
    fn scale(&self) -> f64 {
        self.constant.abs() + self.x.abs() + self.y.abs() + self.xy.abs()
    }

    /// `self + weight other`: for a positive weight negative wherever both are.
    pub(crate) fn plus(&self, other: &Self, weight: f64) -> Self {
        let sum = Self {
            constant: self.constant + weight * other.constant,
            x: self.x + weight * other.x,
            y: self.y + weight * other.y,
            xy: self.xy + weight * other.xy,
            error: 0.0,
            bend: (self.bend + weight.abs() * other.bend) * (1.0 + 4.0 * f64::EPSILON),
        };
        // Two roundings of each coefficient, and the evaluation of the sum where slopes cancel.
        let rounded = 16.0 * U * (self.scale() + weight.abs() * other.scale());
        let error = (self.error + weight.abs() * other.error + rounded) * (1.0 + 4.0 * f64::EPSILON);
        Self { error, ..sum }
    }

    /// The same function of the displacement from `centre`, which lies in the square |dx|, |dy| <= 1, as does
    /// all that is asked about afterwards.
    pub(crate) fn about(&self, [cx, cy]: [f64; 2]) -> Self {
        if cx == 0.0 && cy == 0.0 {
            return *self;
        }
        Self {
            constant: self.constant + self.x * cx + self.y * cy + self.xy * cx * cy,
            x: self.x + self.xy * cy,
            y: self.y + self.xy * cx,
            xy: self.xy,
            error: (self.error + self.bend + 16.0 * U * self.scale()) * (1.0 + 4.0 * f64::EPSILON),
            bend: 0.0,
        }
    }

    /// The value at a displacement, to within `error` and the bend.
    #[inline]
    pub(crate) fn at(&self, [dx, dy]: [f64; 2]) -> f64 {
        self.constant + self.x * dx + self.y * dy + self.xy * dx * dy
    }

    /// Whether g > 0 at a displacement in the square, or g < 0; `None` if it is not certain.
    #[inline]
    pub(crate) fn is_positive_at(&self, at: [f64; 2]) -> Option<bool> {
        let value = self.at(at);
        // Sizes are at most 1: the bend's r^2 too.
        let doubt = self.error + self.bend;
        if value > doubt {
            Some(true)
        } else if value < -doubt {
            Some(false)
        } else {
            None
        }
    }

    /// -g.
    pub(crate) fn negated(&self) -> Self {
        Self { constant: -self.constant, x: -self.x, y: -self.y, xy: -self.xy, ..*self }
    }

    /// The same form for displacements in units of `unit` cells, at most 1.
    pub(crate) fn scaled(&self, unit: f64) -> Self {
        Self {
            x: self.x * unit,
            y: self.y * unit,
            xy: self.xy * unit * unit,
            bend: self.bend * unit * unit,
            ..*self
        }
    }
}

/// A square in which the forms certainly do not all hold, by one of them or by two combined: the largest that
/// can be shown, or one of at least `enough`. Of the first `apart` no two are combined.
pub(crate) fn certainly_fails(forms: &[Form], apart: usize, enough: f64) -> f64 {
    let mut best = forms.iter().map(Form::fails_within).fold(0.0, f64::max);
    for (k, a) in forms.iter().enumerate() {
        for b in &forms[(k + 1).max(apart.min(forms.len()))..] {
            if best >= enough {
                return best;
            }
            best = best.max(both_fail(a, b));
        }
    }
    best
}

/// A square in which two forms certainly do not both hold, by their combinations.
///
/// Where both hold, so does their sum with any positive weight; those that make the sum level in dx or in dy
/// are the best for a square.
fn both_fail(a: &Form, b: &Form) -> f64 {
    let mut best = 0.0;
    for (slope_a, slope_b) in [(a.x, b.x), (a.y, b.y)] {
        let weight = -slope_a / slope_b;
        if weight > 0.0 && weight.is_finite() {
            best = a.plus(b, weight).fails_within().max(best);
        }
    }
    best
}

/// A square in which the line of `edge` certainly does not meet where `other` holds: on the line the form is 0,
/// so it may be added with a weight of either sign.
pub(crate) fn line_leaves(edge: &Form, other: &Form) -> f64 {
    let mut best = 0.0;
    for (slope, slope_edge) in [(other.x, edge.x), (other.y, edge.y)] {
        let weight = -slope / slope_edge;
        if weight.is_finite() {
            best = other.plus(edge, weight).fails_within().max(best);
        }
    }
    best
}

/// A cell's ray and how displacement moves it, in the sensor's frame.
#[derive(Debug, Clone)]
pub(crate) struct MovingRay {
    position: DVec3,
    /// M, from the sensor's frame to the scene's.
    rotation: DMat3,
    /// Height of the ray's start on the focal axis, and its change by a cell.
    height: f64,
    height_step: f64,
    /// (q_x, q_y) and (p_x, p_y).
    q: [f64; 2],
    step: [f64; 2],
    /// z of the sensor plane.
    plane: f64,
    max_range: f64,
    /// Q.
    q_size: f64,
    /// |q| as a form without its bend, and the bend.
    length: [f64; 3],
    length_bend: f64,
}

impl MovingRay {
    /// The ray of an aim. The errors above are those of a cell's own ray, that is, of one not displaced.
    pub(crate) fn new(sensor: &Sensor, aim: Aim) -> Self {
        let pose = sensor.pose();
        let [x, y, z, w] = pose.rotation.to_array();
        let (xx, yy, zz, ww) = (x * x, y * y, z * z, w * w);
        let norm = xx + yy + zz + ww;
        let rows = [
            [ww + xx - yy - zz, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), ww - xx + yy - zz, 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), ww - xx - yy + zz],
        ];
        let rotation = DMat3::from_cols_array_2d(&rows.map(|row| row.map(|part| part / norm))).transpose();
        let (q, step, height, height_step, plane) = match sensor {
            Sensor::Camera(Mounted { sensor, .. }) => {
                let step = sensor.pixel_pitch.map(|pitch| pitch / sensor.focal_length);
                let along = |index: u32, by: f64, axis: usize| {
                    (f64::from(index) + 0.5 + by - sensor.principal_point[axis]) * step[axis]
                };
                ([along(aim.i, aim.dx, 0), along(aim.j, aim.dy, 1)], step, 0.0, 0.0, sensor.focal_length)
            }
            Sensor::Beam(Mounted { sensor, .. }) => {
                let half_cells =
                    |index: u32, by: f64, count: f64| 2.0 * f64::from(index) + 1.0 - count + 2.0 * by;
                let (columns, rows) = (f64::from(sensor.columns), f64::from(sensor.rows));
                let half_step = sensor.half_width / (columns * sensor.grid_distance);
                (
                    [half_cells(aim.i, aim.dx, columns) * half_step, 0.0],
                    [2.0 * half_step, 0.0],
                    sensor.thickness * half_cells(aim.j, aim.dy, rows) / (2.0 * rows),
                    sensor.thickness / rows,
                    sensor.grid_distance,
                )
            }
        };
        let (steps, q_size) = (step[0] + step[1], q[0].abs() + q[1].abs() + 1.0 + step[0] + step[1]);
        // |q| is convex: at least its tangent, and at most (p_x + p_y)^2 r^2 / (2 min |q|) more; |q| >= 1.
        let length = (q[0] * q[0] + q[1] * q[1] + 1.0).sqrt();
        let shortest = (length - steps).max(1.0);
        Self {
            position: pose.position,
            rotation,
            height,
            height_step,
            q,
            step,
            plane,
            max_range: sensor.max_range(),
            q_size: q_size * (1.0 + 8.0 * f64::EPSILON),
            length: [length, q[0] * step[0] / length, q[1] * step[1] / length],
            length_bend: steps * steps / (2.0 * shortest) * (1.0 + 32.0 * f64::EPSILON),
        }
    }

    /// Where the ray starts and its direction, not a unit: scene frame, to a few roundings.
    pub(crate) fn line(&self) -> (DVec3, DVec3) {
        let origin = self.position + self.rotation.y_axis * self.height;
        (origin, self.rotation * DVec3::new(self.q[0], self.q[1], 1.0))
    }

    /// How far the start may move, metres, and the direction, in units of a direction of this length, where
    /// the ray is displaced by at most `radius` cells.
    pub(crate) fn spread(&self, radius: f64) -> (f64, f64) {
        let moved = radius * (self.step[0] * self.step[0] + self.step[1] * self.step[1]).sqrt();
        // Two directions of lengths L and L' that differ by d have units that differ by at most
        // d / min(L, L'): cut to the shorter length they lie no farther apart. And every q is at least 1.
        (radius * self.height_step, moved / (self.length[0] - moved).max(1.0))
    }

    /// |q| at a displacement, to a few roundings.
    fn length_at(&self, [dx, dy]: [f64; 2]) -> f64 {
        let q = [self.q[0] + dx * self.step[0], self.q[1] + dy * self.step[1]];
        (q[0] * q[0] + q[1] * q[1] + 1.0).sqrt()
    }
}

/// Where a corner lies among the displaced rays: the displacement of the ray through it, per axis, and by
/// how much that may be off, infinitely where the corner is not certainly before the sensor.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Corner {
    pub(crate) at: [f64; 2],
    error: [f64; 2],
}

/// A square beside which all `corners` certainly lie on one of its four sides, about a centre. All rays that
/// meet the hull of the corners lie on that side too: the side is a plane through the rays' start, or, for
/// the rows of a beam, parallel to them.
pub(crate) fn beside<const N: usize>(corners: [&Corner; N], centre: [f64; 2]) -> f64 {
    let mut best = 0.0_f64;
    for axis in 0..2 {
        let (mut after, mut before) = (f64::INFINITY, f64::INFINITY);
        for corner in corners {
            let at = corner.at[axis] - centre[axis];
            after = after.min(at - corner.error[axis]);
            before = before.min(-at - corner.error[axis]);
        }
        best = best.max(after).max(before);
    }
    best.min(1.0)
}

/// Why a face is not met in the unit square of displacements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Away {
    /// No ray of the square meets its triangle between the SPP and the longest range.
    Beside,
    /// No ray of the square meets its front; its edges may lie anywhere.
    Back,
}

/// The conditions of one face.
#[derive(Debug, Clone)]
pub(crate) struct FaceForms<'a> {
    pub(crate) face: &'a Face,
    own: [Form; 6],
    pub(crate) corners: [Corner; 3],
    /// The corners before the sensor, and the edges, in its frame.
    places: [DVec3; 3],
    along: [DVec3; 3],
    /// n.V: constant and dy.
    height: [f64; 2],
    /// n.q: constant, dx, dy.
    approach: [f64; 3],
    /// K, S and Q of the errors.
    area_size: f64,
    distance: f64,
    q_size: f64,
    /// How far the lengths of the places may be off, metres.
    off: f64,
    /// A range in metres that no point met in the unit square exceeds.
    pub(crate) farthest: f64,
}

impl<'a> FaceForms<'a> {
    pub(crate) fn new(ray: &MovingRay, face: &'a Face) -> Self {
        Self::of_edges(ray, face, &Placed::of(ray, face))
    }

    /// The conditions of a face that may be met in the unit square.
    ///
    /// An edge's form is negative outside of a triangle that shows its front, and *inside* of one that shows
    /// its back: only with the front is it known where the triangle lies.
    pub(crate) fn in_square(ray: &MovingRay, face: &'a Face) -> Result<Self, Away> {
        let placed = Placed::of(ray, face);
        if placed.is_beside(ray) {
            return Err(Away::Beside);
        }
        let forms = Self::of_edges(ray, face, &placed);
        // Where the ray lies in the face's plane all forms vanish: ask how far away the triangle is.
        if forms.closest(ray) > ray.max_range {
            return Err(Away::Beside);
        }
        if forms.edges().iter().any(|edge| edge.fails_within() >= 1.0) {
            let shows_front = forms.own[3].holds_within() >= 1.0;
            return Err(if shows_front { Away::Beside } else { Away::Back });
        }
        Ok(forms)
    }

    fn of_edges(ray: &MovingRay, face: &'a Face, placed: &Placed) -> Self {
        let [a, b, c] = face.corners.map(|corner| glam::Vec3::from_array(corner).as_dvec3());
        // Differences of f32 numbers, u of themselves.
        let differences = [b - a, c - b, a - c];
        let along = differences.map(|d| ray.rotation.transpose() * d);
        let sizes = differences.map(|d| d.abs().element_sum());
        let edge = |k: usize| {
            let (v, e) = (placed.corners[k], along[k]);
            let moment = v.cross(e);
            let (q, step, h) = (ray.q, ray.step, ray.height_step);
            let size = placed.sizes[k] * sizes[k] * ray.q_size;
            Form {
                constant: -(q[0] * moment.x + q[1] * moment.y + moment.z),
                x: -(step[0] * moment.x),
                y: h * (q[0] * e.z - e.x) - step[1] * moment.y,
                xy: h * step[0] * e.z,
                error: 128.0 * U * size * (1.0 + 8.0 * f64::EPSILON),
                bend: 0.0,
            }
        };
        let normal = along[2].cross(along[0]);
        let v = placed.corners[0];
        let height = [normal.dot(v), -(normal.y * ray.height_step)];
        let approach = [
            normal.x * ray.q[0] + normal.y * ray.q[1] + normal.z,
            normal.x * ray.step[0],
            normal.y * ray.step[1],
        ];
        let area_size = sizes[2] * sizes[0] * (1.0 + 8.0 * f64::EPSILON);
        let distance = placed.sizes[0];
        let [h, hy] = height;
        let [p, px, py] = approach;
        let [l, lx, ly] = ray.length;
        let rounded = 256.0 * U * area_size * (1.0 + 8.0 * f64::EPSILON);
        let front =
            Form { constant: -p, x: -px, y: -py, xy: 0.0, error: 0.5 * rounded * ray.q_size, bend: 0.0 };
        let plane = Form {
            constant: ray.plane * p - h,
            x: ray.plane * px,
            y: ray.plane * py - hy,
            xy: 0.0,
            error: rounded * (ray.plane * ray.q_size + distance),
            bend: 0.0,
        };
        // The point met lies in the triangle, no farther from a displaced start than a corner is.
        let to_corners = placed.corners.map(DVec3::length).into_iter().fold(0.0, f64::max);
        let off = 128.0 * U * placed.sizes.into_iter().fold(0.0, f64::max);
        let range = range_form(ray, height, approach, area_size, distance, ray.max_range);
        let by_corners = (to_corners + ray.height_step + off) * (1.0 + 8.0 * f64::EPSILON);
        let slope = px.abs() + py.abs();
        let nearest_approach = (-p - slope) - 0.5 * rounded * ray.q_size;
        let longest = l + lx.abs() + ly.abs() + ray.length_bend;
        let on_plane = if nearest_approach > 0.0 {
            (h.abs() + hy.abs() + rounded * distance) * longest / nearest_approach
                * (1.0 + 64.0 * f64::EPSILON)
        } else {
            f64::INFINITY
        };
        Self {
            face,
            own: [edge(0), edge(1), edge(2), front, plane, range],
            corners: placed.corners_among(ray),
            places: placed.corners,
            along,
            height,
            approach,
            area_size,
            distance,
            q_size: ray.q_size,
            off,
            farthest: by_corners.min(on_plane).min(ray.max_range),
        }
    }

    /// The six conditions that concern this face alone: three edges, front, plane, range.
    pub(crate) fn own(&self) -> &[Form; 6] {
        &self.own
    }

    /// Inside the edges, each from the corner of its index.
    pub(crate) fn edges(&self) -> &[Form] {
        &self.own[..3]
    }

    /// Met within the range `limit`, metres, which is not beyond the sensor's own.
    pub(crate) fn within(&self, ray: &MovingRay, limit: f64) -> Form {
        range_form(ray, self.height, self.approach, self.area_size, self.distance, limit)
    }

    /// A range in metres than which no point of the triangle is met nearer, perhaps negative.
    pub(crate) fn closest(&self, ray: &MovingRay) -> f64 {
        // The part of the way to a point along any unit vector is no longer than the way.
        let along = DVec3::new(ray.q[0], ray.q[1], 1.0) / ray.length[0];
        let least = self.places.into_iter().map(|v| v.dot(along)).fold(f64::INFINITY, f64::min);
        least - ray.height_step - self.off - least.abs() * 64.0 * f64::EPSILON
    }

    /// This face is met at or before `other`, where both are met from the front.
    pub(crate) fn at_or_before(&self, other: &Self) -> Form {
        let ([g, gy], [f, fy]) = (self.height, other.height);
        let ([p, px, py], [q, qx, qy]) = (self.approach, other.approach);
        let size = self.area_size * other.area_size * self.q_size * (self.distance + other.distance);
        Form {
            constant: f * p - g * q,
            x: f * px - g * qx,
            y: f * py + fy * p - g * qy - gy * q,
            xy: fy * px - gy * qx,
            error: 256.0 * U * size * (1.0 + 8.0 * f64::EPSILON),
            bend: 0.0,
        }
    }

    /// The range at a displacement at which the face is met, and how far it may be off, relatively.
    pub(crate) fn range_at(&self, ray: &MovingRay, at: [f64; 2]) -> (f64, f64) {
        let height = self.height[0] + self.height[1] * at[1];
        let approach = self.approach[0] + self.approach[1] * at[0] + self.approach[2] * at[1];
        let rounded = 256.0 * U * self.area_size;
        let doubt = rounded * self.distance / height.abs() + rounded * self.q_size / approach.abs();
        (height / approach * ray.length_at(at), doubt)
    }

    /// The displacement of the ray through the point of edge `k` that lies `s` of the way along it.
    pub(crate) fn edge_point(&self, ray: &MovingRay, k: usize, s: f64) -> [f64; 2] {
        ray.through(self.places[k] + s * self.along[k])
    }

    /// The displacement of the ray through a point of the triangle, given by its corners' weights.
    pub(crate) fn point(&self, ray: &MovingRay, weights: [f64; 3]) -> [f64; 2] {
        let [a, b, c] = self.places;
        ray.through(a * weights[0] + b * weights[1] + c * weights[2])
    }

    /// The least and the greatest displacement, per axis, of rays that meet the triangle: they lie between those
    /// of its corners, as `beside` says.
    pub(crate) fn bounds(&self) -> [[f64; 2]; 2] {
        let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for corner in &self.corners {
            for axis in 0..2 {
                bounds[0][axis] = bounds[0][axis].min(corner.at[axis] - corner.error[axis]);
                bounds[1][axis] = bounds[1][axis].max(corner.at[axis] + corner.error[axis]);
            }
        }
        bounds
    }

    /// Whether all corners lie certainly before the sensor, so that `beside` knows of them.
    pub(crate) fn is_before(&self) -> bool {
        self.corners.iter().all(|corner| corner.error[0] < f64::INFINITY)
    }
}

/// M (-n.q) + n.V |q|, for a limit M.
fn range_form(
    ray: &MovingRay,
    [h, hy]: [f64; 2],
    [p, px, py]: [f64; 3],
    area_size: f64,
    distance: f64,
    limit: f64,
) -> Form {
    let [l, lx, ly] = ray.length;
    let rounded = 256.0 * U * area_size * (1.0 + 16.0 * f64::EPSILON);
    Form {
        constant: h * l - limit * p,
        x: h * lx - limit * px,
        y: h * ly + hy * l - limit * py,
        xy: hy * lx,
        error: rounded * ray.q_size * (limit + distance),
        bend: (h.abs() + hy.abs() + rounded * distance) * ray.length_bend * (1.0 + 4.0 * f64::EPSILON),
    }
}

impl MovingRay {
    /// The displacement of the ray through a point of the sensor's frame.
    fn through(&self, v: DVec3) -> [f64; 2] {
        let x = (v.x - self.q[0] * v.z) / (self.step[0] * v.z);
        let y = if self.height_step > 0.0 {
            v.y / self.height_step
        } else {
            (v.y - self.q[1] * v.z) / (self.step[1] * v.z)
        };
        [x, y]
    }
}

/// A face's corners in the sensor's frame, before its ray's start.
struct Placed {
    corners: [DVec3; 3],
    /// S of each.
    sizes: [f64; 3],
}

impl Placed {
    fn of(ray: &MovingRay, face: &Face) -> Self {
        let from = face.corners.map(|corner| glam::Vec3::from_array(corner).as_dvec3() - ray.position);
        Self {
            corners: from.map(|d| {
                let turned = ray.rotation.transpose() * d;
                DVec3::new(turned.x, turned.y - ray.height, turned.z)
            }),
            sizes: from.map(|d| d.abs().element_sum() + ray.height.abs() + ray.height_step),
        }
    }

    /// How far a part of V less z times q's, or that of a side of the square, may be off: 20 u S for the one,
    /// 20 u S and 4 u S for the other, times the slope, and 3 u S Q for the roundings. All slopes and 1 are within Q.
    fn off(&self, ray: &MovingRay, k: usize) -> f64 {
        32.0 * U * self.sizes[k] * ray.q_size * (1.0 + 8.0 * f64::EPSILON)
    }

    /// Whether all corners certainly lie on one side of the unit square, or before the SPP.
    fn is_beside(&self, ray: &MovingRay) -> bool {
        let all = |test: &dyn Fn(usize) -> bool| (0..3).all(test);
        let v = &self.corners;
        if all(&|k| v[k].z < ray.plane - 32.0 * U * (self.sizes[k] + ray.plane)) {
            return true;
        }
        let side = |part: usize, slope: f64, sign: f64| {
            all(&|k: usize| sign * (v[k][part] - slope * v[k].z) > self.off(ray, k))
        };
        let [x, y] = ray.q;
        let [px, py] = ray.step;
        if side(0, x + px, 1.0) || side(0, x - px, -1.0) {
            return true;
        }
        if ray.height_step > 0.0 {
            let over = |k: usize| ray.height_step + 32.0 * U * self.sizes[k];
            all(&|k| v[k].y > over(k)) || all(&|k| v[k].y < -over(k))
        } else {
            side(1, y + py, 1.0) || side(1, y - py, -1.0)
        }
    }

    /// Where the corners lie among the displaced rays.
    fn corners_among(&self, ray: &MovingRay) -> [Corner; 3] {
        [0, 1, 2].map(|k: usize| {
            let (v, size) = (self.corners[k], self.sizes[k]);
            let mut at = ray.through(v);
            // z is off by at most 20 u S. Where that is less than 2^-10 of it, the quotient's error is no more
            // than 1 + 2^-8 times the first-order one.
            let doubt = 32.0 * U * size / v.z;
            let known = v.z > 0.0 && doubt < 1.0 / 1024.0;
            if !known {
                // Nothing that could be added up to NaN.
                at[0] = 0.0;
                at[1] = if ray.height_step > 0.0 { at[1] } else { 0.0 };
            }
            let of_axis =
                |axis: usize| self.off(ray, k) / (ray.step[axis] * v.z) + at[axis].abs() * (doubt + 16.0 * U);
            let across = if known { of_axis(0) * (1.0 + 1.0 / 256.0) } else { f64::INFINITY };
            let down = if ray.height_step > 0.0 {
                32.0 * U * size / ray.height_step + at[1].abs() * 16.0 * U
            } else if known {
                of_axis(1) * (1.0 + 1.0 / 256.0)
            } else {
                f64::INFINITY
            };
            // Subtracting the centre, at most 1, rounds once more.
            let at_centre = |x: f64| x + 4.0 * U * (1.0 + x.abs());
            Corner { at, error: [at_centre(across), at_centre(down) + 4.0 * U * at[1].abs()] }
        })
    }
}

#[cfg(test)]
#[path = "../tests/unit/forms_by_hand.rs"]
mod by_hand;
#[cfg(test)]
#[path = "../tests/unit/forms.rs"]
mod tests;
