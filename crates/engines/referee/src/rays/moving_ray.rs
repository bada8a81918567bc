//! A cell's ray and its change with the displacement, in the sensor's frame and in f64.

use glam::{DMat3, DVec3};
use raypencil_scene::Mounted;

use crate::rays::ray::{Aim, MountedSensor};

/// A cell's ray and its change with the displacement, in the sensor's frame.
#[derive(Debug, Clone)]
pub(crate) struct MovingRay {
    /// Position of the sensor, scene frame, metres.
    pub(crate) position: DVec3,
    /// M: the rotation from the sensor's frame to the scene's.
    pub(crate) rotation: DMat3,
    /// Height of the ray's start on the focal axis, metres.
    pub(crate) height: f64,
    /// Change of that height by a cell, metres; 0 in a camera.
    pub(crate) height_step: f64,
    /// (q_x, q_y).
    pub(crate) q: [f64; 2],
    /// (p_x, p_y): the change of q by a cell.
    pub(crate) step: [f64; 2],
    /// z of the SPP, metres.
    pub(crate) plane: f64,
    /// Maximum range of the sensor, metres.
    pub(crate) max_range: f64,
    /// Q: a bound of |q| over the unit square.
    pub(crate) q_size: f64,
    /// |q| as a form without its bend: constant, dx, dy.
    pub(crate) length: [f64; 3],
    /// The bend of |q|.
    pub(crate) length_bend: f64,
}

impl MovingRay {
    /// The ray of an aim.
    pub(crate) fn new(sensor: &MountedSensor, aim: Aim) -> Self {
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
            MountedSensor::Camera(Mounted { sensor, .. }, _) => {
                let step = sensor.pixel_pitch.map(|pitch| pitch / sensor.focal_length);
                let along = |index: u32, by: f64, axis: usize| {
                    (f64::from(index) + 0.5 + by - sensor.principal_point[axis]) * step[axis]
                };
                ([along(aim.i, aim.dx, 0), along(aim.j, aim.dy, 1)], step, 0.0, 0.0, sensor.focal_length)
            }
            MountedSensor::Beam(Mounted { sensor, .. }, _) => {
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

    /// The ray's start and its direction, not a unit vector: scene frame, to a few roundings.
    pub(crate) fn line(&self) -> (DVec3, DVec3) {
        let origin = self.position + self.rotation.y_axis * self.height;
        (origin, self.rotation * DVec3::new(self.q[0], self.q[1], 1.0))
    }

    /// Bounds over displacements of at most `radius` cells: the distance of the start from this ray's, metres, and
    /// that of the unit direction.
    pub(crate) fn spread(&self, radius: f64) -> (f64, f64) {
        let moved = radius * (self.step[0] * self.step[0] + self.step[1] * self.step[1]).sqrt();
        // Two directions of lengths L and L' that differ by d have unit vectors that differ by at most d / min(L,
        // L'): cut to the shorter length they are no farther apart. Every q has length at least 1.
        (radius * self.height_step, moved / (self.length[0] - moved).max(1.0))
    }

    /// |q| at a displacement, to a few roundings.
    pub(crate) fn length_at(&self, [dx, dy]: [f64; 2]) -> f64 {
        let q = [self.q[0] + dx * self.step[0], self.q[1] + dy * self.step[1]];
        (q[0] * q[0] + q[1] * q[1] + 1.0).sqrt()
    }

    /// The displacement of the ray through a point of the sensor's frame.
    pub(crate) fn through(&self, v: DVec3) -> [f64; 2] {
        let x = (v.x - self.q[0] * v.z) / (self.step[0] * v.z);
        let y = if self.height_step > 0.0 {
            v.y / self.height_step
        } else {
            (v.y - self.q[1] * v.z) / (self.step[1] * v.z)
        };
        [x, y]
    }
}
