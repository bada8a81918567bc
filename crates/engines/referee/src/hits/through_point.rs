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
use crate::numbers::vector::Vector;
use crate::rays::displacement::max_norm;
use crate::rays::ray::{Aim, MountedSensor};
use crate::trees::bvh::InBox;

impl MountedSensor {
    /// The displacement of cell (i, j)'s ray that passes through a point, cells, correctly rounded; infinite beyond
    /// the range of f64. `None` if the point lies in the plane through the sensor.
    fn displacement_through(&self, aim: Aim, point: &Vector<Dyadic>) -> Option<[f64; 2]> {
        let pose = self.pose();
        let rotation = self.rotation::<Dyadic>();
        let Vector([x, y, z]) = rotation.apply_inverse(&point.sub(&Vector::of(pose.position)));
        if z.sign() == Some(Ordering::Equal) {
            return None;
        }
        let of = Dyadic::of;
        Some(match self {
            Self::Camera(Mounted { sensor, .. }, _) => {
                let along = |part: &Dyadic, index: u32, centre: f64, pitch: f64| {
                    let from_centre = Dyadic::of_integer(index).add(&of(0.5)).sub(&of(centre));
                    let wide = of(pitch).mul(&z);
                    let here = part.mul(&of(sensor.focal_length));
                    quotient(&here.sub(&from_centre.mul(&wide)), &wide).double
                };
                let ([cx, cy], [px, py]) = (sensor.principal_point, sensor.pixel_pitch);
                [along(&x, aim.i, cx, px), along(&y, aim.j, cy, py)]
            }
            Self::Beam(Mounted { sensor, .. }, _) => {
                let half_cells = |index: u32, count: u32| of(2.0 * f64::from(index) + 1.0 - f64::from(count));
                let (columns, rows) = (Dyadic::of_integer(sensor.columns), Dyadic::of_integer(sensor.rows));
                let wide = of(sensor.half_width).mul(&z);
                let across = columns.mul(&of(sensor.grid_distance)).mul(&x);
                let across = across.sub(&half_cells(aim.i, sensor.columns).mul(&wide));
                let high = of(sensor.thickness).mul(&rotation.norm_squared);
                let down = rows.doubled().mul(&y).sub(&half_cells(aim.j, sensor.rows).mul(&high));
                [quotient(&across, &wide.doubled()).double, quotient(&down, &high.doubled()).double]
            }
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
    let corners: [Vector<Dyadic>; 3] = std::array::from_fn(|k| face.corner(k));
    let mut inside = Vec::new();
    for k in 0..3 {
        let [a, b, c] = [0, 1, 2].map(|turn| &corners[(k + turn) % 3]);
        let both = b.sub(a).add(&c.sub(a));
        // Inside the face for shares of up to a half.
        let within = |share: f64| {
            sensor
                .displacement_through(aim, &a.add(&both.scaled(&Dyadic::of(share))))
                .filter(|at| max_norm(*at) <= max_cells)
        };
        let Some(corner) = sensor.displacement_through(aim, a).filter(|at| max_norm(*at) <= max_cells) else {
            continue;
        };
        let Some(quarter) = sensor.displacement_through(aim, &a.add(&both.scaled(&Dyadic::of(0.25)))) else {
            continue;
        };
        let length = max_norm([quarter[0] - corner[0], quarter[1] - corner[1]]);
        inside.push(corner);
        if length > 0.0 && length.is_finite() {
            let room = ((max_cells - max_norm(corner)) / length).min(1.0);
            let shares = [1e-9, 1e-6, 1e-3, 0.03, 0.3, 0.9];
            inside.extend(shares.into_iter().filter_map(|share| within(0.25 * share * room)));
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
    let passed: Vec<Vector<Dyadic>> = (0..3)
        .filter_map(|k| {
            // Nearest to the ray is a + s e with ((a + s e - o) x q).(e x q) = 0.
            let (a, e) = (corners[k], corners[(k + 1) % 3] - corners[k]);
            let across = e.cross(along);
            let s = -(a - start).cross(along).dot(across) / across.length_squared();
            let s = s.is_finite().then(|| Dyadic::of(s.clamp(0.0, 1.0)))?;
            let (from, to) = (face.corner::<Dyadic>(k), face.corner::<Dyadic>((k + 1) % 3));
            Some(from.add(&to.sub(&from).scaled(&s)))
        })
        .collect();
    let mut points = Vec::new();
    for (k, from) in passed.iter().enumerate() {
        for to in &passed[k + 1..] {
            let way = to.sub(from);
            points.extend([0.5, 0.25, 0.75].map(|share| from.add(&way.scaled(&Dyadic::of(share)))));
        }
    }
    points.extend(passed);
    let mut between: Vec<[f64; 2]> =
        points.iter().filter_map(|point| sensor.displacement_through(aim, point)).collect();
    between.retain(|at| max_norm(*at) <= max_cells);
    between
}

#[cfg(test)]
#[path = "../../tests/unit/through_point.rs"]
mod tests;
