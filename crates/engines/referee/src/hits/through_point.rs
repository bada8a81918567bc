//! The displacement whose ray passes through a given point, correctly rounded; displacements just inside the corners of
//! a face, and between those points of its sides that the ray passes.
//!
//! The forms of a face are linear in f64. Near a corner that the ray all but meets, their error is as large as the
//! ray's distance from it; where the face is also thin, they cannot tell where it is. The corner itself is known
//! without rounding. With N the square of the pose's quaternion and (X, Y, Z) the point in the sensor's frame times
//! N,
//!
//! ```text
//! camera   dx = (f_c X - (i + 1/2 - c_x) p_x Z) / (p_x Z)        dy likewise
//! beam     dx = (columns g X - (2i + 1 - columns) w Z) / (2 w Z)
//!          dy = (2 rows Y - (2j + 1 - rows) N T) / (2 N T)
//! ```
//!
//! so even a displacement of 1e-12 cells is known to sixteen digits.

use std::cmp::Ordering;

use glam::DVec3;
use raypencil_scene::Mounted;

use crate::hits::face::Face;
use crate::numbers::number::{Dyadic, Interval, Number};
use crate::numbers::rounding::quotient;
use crate::numbers::vector::{ScaledRotation, Vector};
use crate::rays::displacement::max_norm;
use crate::rays::ray::{Aim, MountedSensor};
use crate::trees::bvh::InBox;

/// The ray of a cell, from which displacements are counted, in some arithmetic.
struct CellRay<'a, T> {
    sensor: &'a MountedSensor,
    aim: Aim,
    rotation: ScaledRotation<T>,
    position: Vector<T>,
}

impl<'a, T: Number> CellRay<'a, T> {
    fn of(sensor: &'a MountedSensor, aim: Aim) -> Self {
        Self { sensor, aim, rotation: sensor.rotation(), position: Vector::of(sensor.pose().position) }
    }

    /// The displacement of the ray through a point, across and down: each as what is divided and its divisor. The first
    /// divisor is 0 where the point lies in the plane through the sensor.
    fn fractions_through(&self, point: &Vector<T>) -> [[T; 2]; 2] {
        let Vector([x, y, z]) = self.rotation.apply_inverse(&point.sub(&self.position));
        let (of, aim) = (T::of, self.aim);
        match self.sensor {
            MountedSensor::Camera(Mounted { sensor, .. }, _) => {
                let along = |part: &T, index: u32, centre: f64, pitch: f64| {
                    let from_centre = T::of_integer(index).add(&of(0.5)).sub(&of(centre));
                    let wide = of(pitch).mul(&z);
                    let here = part.mul(&of(sensor.focal_length));
                    [here.sub(&from_centre.mul(&wide)), wide]
                };
                let ([cx, cy], [px, py]) = (sensor.principal_point, sensor.pixel_pitch);
                [along(&x, aim.i, cx, px), along(&y, aim.j, cy, py)]
            }
            MountedSensor::Beam(Mounted { sensor, .. }, _) => {
                let half_cells = |index: u32, count: u32| of(2.0 * f64::from(index) + 1.0 - f64::from(count));
                let (columns, rows) = (T::of_integer(sensor.columns), T::of_integer(sensor.rows));
                let wide = of(sensor.half_width).mul(&z);
                let across = columns.mul(&of(sensor.grid_distance)).mul(&x);
                let across = across.sub(&half_cells(aim.i, sensor.columns).mul(&wide));
                let high = of(sensor.thickness).mul(&self.rotation.norm_squared);
                let down = rows.doubled().mul(&y).sub(&half_cells(aim.j, sensor.rows).mul(&high));
                [[across, wide.doubled()], [down, high.doubled()]]
            }
        }
    }
}

impl CellRay<'_, Dyadic> {
    /// The displacement of the ray that passes through a point, cells, correctly rounded; infinite beyond the range of
    /// f64. `None` if the point lies in the plane through the sensor.
    fn displacement_through(&self, point: &Vector<Dyadic>) -> Option<[f64; 2]> {
        let [[across, wide], [down, high]] = self.fractions_through(point);
        (wide.sign() != Some(Ordering::Equal))
            .then(|| [quotient(&across, &wide).double, quotient(&down, &high).double])
    }
}

impl CellRay<'_, Interval> {
    /// Whether the displacement of the ray through a point is certainly more than `max_cells`. So are most, and intervals
    /// tell it at a small part of the cost.
    fn is_certainly_beyond(&self, point: &Vector<Interval>, max_cells: f64) -> bool {
        self.fractions_through(point).into_iter().any(|[part, divisor]| {
            let Interval { low, high } = part.over(divisor);
            low > max_cells || high < -max_cells
        })
    }
}

/// Displacements whose rays pass through points of a face near its corners: each corner within `max_cells` of the
/// cell's ray, and points farther and farther inside the face, about as far as `max_cells` allows.
///
/// The points are chosen on the face, not in the square of displacements: a beam bends straight lines, and a point on
/// the straight way to the middle of a thin face may lie beside it.
pub(crate) fn displacements_inside_corners(
    sensor: &MountedSensor,
    aim: Aim,
    face: &Face,
    max_cells: f64,
) -> Vec<[f64; 2]> {
    let fast = CellRay::<Interval>::of(sensor, aim);
    let is_near = |k: &usize| !fast.is_certainly_beyond(&face.corner(*k), max_cells);
    let near: Vec<usize> = (0..3).filter(is_near).collect();
    if near.is_empty() {
        return Vec::new();
    }
    let ray = CellRay::<Dyadic>::of(sensor, aim);
    let corners: [Vector<Dyadic>; 3] = std::array::from_fn(|k| face.corner(k));
    let mut inside = Vec::new();
    for k in near {
        let [a, b, c] = [0, 1, 2].map(|turn| &corners[(k + turn) % 3]);
        let both = b.sub(a).add(&c.sub(a));
        // Inside the face for shares of up to a half.
        let at = |share: f64| ray.displacement_through(&a.add(&both.scaled(&Dyadic::of(share))));
        let Some(corner) = ray.displacement_through(a).filter(|at| max_norm(*at) <= max_cells) else {
            continue;
        };
        let Some(quarter) = at(0.25) else {
            continue;
        };
        let length = max_norm([quarter[0] - corner[0], quarter[1] - corner[1]]);
        inside.push(corner);
        if length > 0.0 && length.is_finite() {
            let room = ((max_cells - max_norm(corner)) / length).min(1.0);
            let shares = [1e-9, 1e-6, 1e-3, 0.03, 0.3, 0.9];
            let within = |share: f64| at(0.25 * share * room).filter(|at| max_norm(*at) <= max_cells);
            inside.extend(shares.into_iter().filter_map(within));
        }
    }
    inside
}

/// Displacements of at most `max_cells` whose rays pass through points of a face between two of its sides, each side being
/// taken where the cell's ray passes it.
///
/// A needle across the ray and almost in a plane with it looks thinner than f64 can tell, and its corners are far away: the
/// forms do not find it, nor do its corners. These points lie on the face without rounding. Where along its side a point
/// lies is found in f64: that is wrong by a few roundings of the distance, across the ray, as a renderer is.
pub(crate) fn displacements_between_sides(
    sensor: &MountedSensor,
    aim: Aim,
    face: &Face,
    max_cells: f64,
) -> Vec<[f64; 2]> {
    let ray = sensor.ray::<Interval>(aim);
    let middle = |v: &Vector<Interval>| DVec3::from_array(std::array::from_fn(|k| v.0[k].middle()));
    let (start, along) = (middle(&ray.origin) / ray.origin_scale.middle(), middle(&ray.direction));
    let corners = face.corners();
    let passed: Vec<(usize, f64)> = (0..3)
        .filter_map(|k| {
            // Nearest to the ray is a + s e with ((a + s e - o) x q).(e x q) = 0.
            let (a, e) = (corners[k], corners[(k + 1) % 3] - corners[k]);
            let across = e.cross(along);
            let s = -(a - start).cross(along).dot(across) / across.length_squared();
            s.is_finite().then(|| (k, s.clamp(0.0, 1.0)))
        })
        .collect();
    let fast = CellRay::<Interval>::of(sensor, aim);
    let points = points_between::<Interval>(face, &passed);
    let mut is_near = points.iter().map(|point| !fast.is_certainly_beyond(point, max_cells));
    if !is_near.clone().any(|is_near| is_near) {
        return Vec::new();
    }
    let ray = CellRay::<Dyadic>::of(sensor, aim);
    let mut points = points_between::<Dyadic>(face, &passed);
    points.retain(|_| is_near.next().unwrap_or(true));
    let mut between: Vec<[f64; 2]> =
        points.iter().filter_map(|point| ray.displacement_through(point)).collect();
    between.retain(|at| max_norm(*at) <= max_cells);
    between
}

/// Points of a face on and between points of its sides. Each of those is a side and a share of the way along it.
fn points_between<T: Number>(face: &Face, on_sides: &[(usize, f64)]) -> Vec<Vector<T>> {
    let on_side = |&(k, share): &(usize, f64)| {
        let (from, to) = (face.corner::<T>(k), face.corner::<T>((k + 1) % 3));
        from.add(&to.sub(&from).scaled(&T::of(share)))
    };
    let on_sides: Vec<Vector<T>> = on_sides.iter().map(on_side).collect();
    let mut points = Vec::new();
    for (k, from) in on_sides.iter().enumerate() {
        for to in &on_sides[k + 1..] {
            let way = to.sub(from);
            points.extend([0.5, 0.25, 0.75].map(|share| from.add(&way.scaled(&T::of(share)))));
        }
    }
    points.extend(on_sides);
    points
}

#[cfg(test)]
#[path = "../../tests/unit/through_point.rs"]
mod tests;
