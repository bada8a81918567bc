//! The contract's conditions on one face, as forms in a small displacement of the ray: in f64 with proven errors.
//!
//! In the sensor's frame, z = 1 along its axis, a ray displaced by (dx, dy) cells starts at (0, dy h, 0) and runs
//! along q = (q_x + dx p_x, q_y + dy p_y, 1). In the camera h = 0; in a beam q_y = p_y = 0. For a vertex a, V = M^T
//! (a - start) with the pose's rotation M; for an edge, E = M^T (b - a); n = E x E'. The contract's signs (`face`)
//! are then those of
//!
//! | condition | form, >= 0 where it holds |
//! | --- | --- |
//! | inside the edge | -q.(V x E) |
//! | the front is met | -n.q |
//! | at or beyond the SPP at z = f | f n.q - n.V |
//! | within the range | M (-n.q) + n.V L, with L the length of q |
//! | at or before the other face, primed | n'.V' n.q - n.V n'.q |
//!
//! each a positive multiple of the polynomial there. All are bilinear in (dx, dy), except the range: its L is convex.
//!
//! # The errors
//!
//! u = 2^-53. |x|_1 is the sum of the absolute values; it is at least the length of x and at least any part of it.
//! Terms of order u^2 are covered where a bound is rounded up. The limits of a scene (vertices and positions within
//! 1e7 m, pitches and distances from 1e-8 to 1e3) keep all products far from overflow, and underflow far below the
//! errors.
//!
//! M: its parts are quotients of sums of four products by q.q, each sum within 4 u q.q. Error at most 10 u.
//!
//! V: a - start has an error of u of itself before the rotation, and a sum of three products adds 3 u. So each part
//! has an error of at most 10 u |d|_1 + (1 + 3) u |d| <= 14 u |d|_1. In a beam, the row's height adds 4 u of itself
//! and the subtraction u of the result: in all at most 20 u S, with S = |d|_1 + height + h. Likewise E: 14 u e, with
//! e = |b - a|_1.
//!
//! q_x, q_y, p_x, p_y, h: at most 3 u of themselves. Q = |q_x| + |q_y| + 1 + p_x + p_y bounds |q| over the square.
//!
//! V x E: each part has 2 (20 + 14) u S e from the factors and 4 u S e from its own three roundings: 72 u S e. The
//! edge form, of size Q S e, has 72 u from V x E, 4 u from q, 3 u from the sum, and 16 u from its evaluation (below):
//! less than 128 u Q S e.
//!
//! n: 2 (14 + 14) u K + 4 u K with K = e e': 60 u K each part. n.q: 60 u K Q + 7 u K Q, with 16 u for its evaluation
//! less than 128 u K Q. n.V: 60 u K times |V|_1 <= 1.8 S, 20 u S times |n|_1 <= 1.8 K, and 3 u: less than 160 u K S.
//!
//! SPP: 67 u f K Q + 160 u K S + 2 u and 16 u of the sum: less than 256 u K (f Q + S). Range: 67 u M K Q + 160 u K S
//! Q, 12 u from |q| and its slopes, 16 u: less than 256 u K Q (M + S). Order: (67 + 160 + 3 + 16) u for each of two
//! products of sizes K K' S' Q and K K' S Q: less than 256 u K K' Q (S + S').
//!
//! "Evaluation" is the sum of the at most four terms of a form somewhere in the square, and the move of its origin.

use glam::DVec3;

use crate::hits::face::Face;
use crate::rays::form::{Form, UNIT_ROUNDOFF as U};
use crate::rays::moving_ray::MovingRay;

/// A corner among the displaced rays: the displacement of the ray through it, per axis, and its error. The error is
/// infinite where the corner is not certainly before the sensor.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Corner {
    pub(crate) at: [f64; 2],
    error: [f64; 2],
}

/// A radius about a centre: all `corners` certainly lie beyond one side of this square. So do all rays that meet the
/// hull of the corners: the side is a plane through the rays' start or, for the rows of a beam, parallel to them.
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

/// The reason why a face is not met in the unit square of displacements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Exclusion {
    /// No ray of the square meets the triangle between the SPP and the maximum range.
    Beside,
    /// No ray of the square meets the front; the edges may lie anywhere.
    Back,
}

/// The conditions of one face as forms.
#[derive(Debug, Clone)]
pub(crate) struct FaceForms<'a> {
    pub(crate) face: &'a Face,
    own: [Form; 6],
    pub(crate) corners: [Corner; 3],
    /// V of each corner: relative to the ray's start, sensor frame, metres.
    vertices: [DVec3; 3],
    /// E of each edge.
    edge_vectors: [DVec3; 3],
    /// n.V: constant and dy.
    height: [f64; 2],
    /// n.q: constant, dx, dy.
    approach: [f64; 3],
    /// K of the errors.
    area_size: f64,
    /// S of the errors.
    distance: f64,
    /// Q of the errors.
    q_size: f64,
    /// Error of the lengths of V, metres.
    off: f64,
    /// An upper bound of the range of all points met in the unit square, metres.
    pub(crate) farthest: f64,
}

impl<'a> FaceForms<'a> {
    /// The conditions of any face.
    pub(crate) fn new(ray: &MovingRay, face: &'a Face) -> Self {
        Self::of_edges(ray, face, &FaceInSensorFrame::of(ray, face))
    }

    /// The conditions of a face that may be met in the unit square.
    ///
    /// An edge's form is negative outside of a triangle that shows its front, and *inside* of one that shows its
    /// back: the edges tell where the triangle lies only if the front shows.
    pub(crate) fn in_square(ray: &MovingRay, face: &'a Face) -> Result<Self, Exclusion> {
        let placed = FaceInSensorFrame::of(ray, face);
        if placed.is_beside(ray) {
            return Err(Exclusion::Beside);
        }
        let forms = Self::of_edges(ray, face, &placed);
        // Where the ray lies in the face's plane all forms vanish: only the distance of the triangle decides.
        if forms.closest(ray) > ray.max_range {
            return Err(Exclusion::Beside);
        }
        if forms.edges().iter().any(|edge| edge.fails_within() >= 1.0) {
            let shows_front = forms.own[3].holds_within() >= 1.0;
            return Err(if shows_front { Exclusion::Beside } else { Exclusion::Back });
        }
        Ok(forms)
    }

    fn of_edges(ray: &MovingRay, face: &'a Face, placed: &FaceInSensorFrame) -> Self {
        let [a, b, c] = face.corners.map(|corner| glam::Vec3::from_array(corner).as_dvec3());
        // Differences of f32 numbers: error u of themselves.
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
        // The point met lies in the triangle: no farther from a displaced start than a corner is.
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
            vertices: placed.corners,
            edge_vectors: along,
            height,
            approach,
            area_size,
            distance,
            q_size: ray.q_size,
            off,
            farthest: by_corners.min(on_plane).min(ray.max_range),
        }
    }

    /// The six conditions of this face alone: three edges, front, plane, range.
    pub(crate) fn conditions(&self) -> &[Form; 6] {
        &self.own
    }

    /// The edge conditions, each of the edge from the corner of its index.
    pub(crate) fn edges(&self) -> &[Form] {
        &self.own[..3]
    }

    /// The condition to be met within the range `limit`, metres; it is not beyond the sensor's own.
    pub(crate) fn within(&self, ray: &MovingRay, limit: f64) -> Form {
        range_form(ray, self.height, self.approach, self.area_size, self.distance, limit)
    }

    /// A lower bound of the range of all points of the triangle, metres; it may be negative.
    pub(crate) fn closest(&self, ray: &MovingRay) -> f64 {
        // The component of a vector along any unit vector is at most its length.
        let along = DVec3::new(ray.q[0], ray.q[1], 1.0) / ray.length[0];
        let least = self.vertices.into_iter().map(|v| v.dot(along)).fold(f64::INFINITY, f64::min);
        least - ray.height_step - self.off - least.abs() * 64.0 * f64::EPSILON
    }

    /// The condition to be met at or before `other`, where both are met from the front.
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

    /// The range at a displacement at which the face is met, metres, and its relative error.
    pub(crate) fn range_at(&self, ray: &MovingRay, at: [f64; 2]) -> (f64, f64) {
        let height = self.height[0] + self.height[1] * at[1];
        let approach = self.approach[0] + self.approach[1] * at[0] + self.approach[2] * at[1];
        let rounded = 256.0 * U * self.area_size;
        let doubt = rounded * self.distance / height.abs() + rounded * self.q_size / approach.abs();
        (height / approach * ray.length_at(at), doubt)
    }

    /// The displacement of the ray through the point at the fraction `s` of edge `k`.
    pub(crate) fn edge_point(&self, ray: &MovingRay, k: usize, s: f64) -> [f64; 2] {
        ray.through(self.vertices[k] + s * self.edge_vectors[k])
    }

    /// The displacement of the ray through a point of the triangle, given by the weights of its corners.
    pub(crate) fn point(&self, ray: &MovingRay, weights: [f64; 3]) -> [f64; 2] {
        let [a, b, c] = self.vertices;
        ray.through(a * weights[0] + b * weights[1] + c * weights[2])
    }

    /// The least and the greatest displacement, per axis, of rays that meet the triangle: they lie between those of
    /// its corners, as in [`beside`].
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

    /// Whether all corners lie certainly before the sensor. Only then does [`beside`] know of them.
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

/// A face's corners in the sensor's frame, relative to the ray's start.
struct FaceInSensorFrame {
    corners: [DVec3; 3],
    /// S of each corner.
    sizes: [f64; 3],
}

impl FaceInSensorFrame {
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

    /// The error of a part of V minus z times that of q, or of a side of the square: 20 u S for V, 20 u S and 4 u S
    /// for z, times the slope, and 3 u S Q for the roundings. All slopes and 1 are within Q.
    fn off(&self, ray: &MovingRay, k: usize) -> f64 {
        32.0 * U * self.sizes[k] * ray.q_size * (1.0 + 8.0 * f64::EPSILON)
    }

    /// Whether all corners certainly lie beyond one side of the unit square, or before the SPP.
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

    /// The corners among the displaced rays.
    fn corners_among(&self, ray: &MovingRay) -> [Corner; 3] {
        [0, 1, 2].map(|k: usize| {
            let (v, size) = (self.corners[k], self.sizes[k]);
            let mut at = ray.through(v);
            // z has an error of at most 20 u S. Where that is less than 2^-10 of z, the quotient's error is at most 1
            // + 2^-8 times the first-order one.
            let doubt = 32.0 * U * size / v.z;
            let known = v.z > 0.0 && doubt < 1.0 / 1024.0;
            if !known {
                // No number that could sum to NaN.
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
            // The subtraction of the centre, at most 1, rounds once more.
            let at_centre = |x: f64| x + 4.0 * U * (1.0 + x.abs());
            Corner { at, error: [at_centre(across), at_centre(down) + 4.0 * U * at[1].abs()] }
        })
    }
}

#[cfg(test)]
#[path = "../../tests/unit/face_forms_by_hand.rs"]
mod by_hand;
#[cfg(test)]
#[path = "../../tests/unit/face_forms.rs"]
mod tests;
