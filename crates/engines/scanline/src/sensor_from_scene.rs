//! The motion from the scene frame into a sensor's frame. (§4, step 2)

use glam::{DMat3, DVec3};
use raypencil_scene::Pose;

/// `R^T (p - position)`, with the rotation matrix R of the pose's quaternion.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SensorFromScene {
    /// Position of the sensor, scene frame, metres.
    position: DVec3,
    /// R: its columns are the sensor's axes in the scene frame.
    axes: DMat3,
}

impl SensorFromScene {
    /// The matrix of `(q p q*) / (q . q)`, term by term.
    pub(crate) fn from_pose(pose: &Pose) -> Self {
        let [x, y, z, w] = pose.rotation.to_array();
        let (xx, yy, zz, ww) = (x * x, y * y, z * z, w * w);
        let (xy, xz, yz) = (2.0 * x * y, 2.0 * x * z, 2.0 * y * z);
        let (wx, wy, wz) = (2.0 * w * x, 2.0 * w * y, 2.0 * w * z);
        let norm_squared = xx + yy + zz + ww;
        let axes = DMat3 {
            x_axis: DVec3::new(ww + xx - yy - zz, xy + wz, xz - wy) / norm_squared,
            y_axis: DVec3::new(xy - wz, ww - xx + yy - zz, yz + wx) / norm_squared,
            z_axis: DVec3::new(xz + wy, yz - wx, ww - xx - yy + zz) / norm_squared,
        };
        Self { position: pose.position, axes }
    }

    /// Position of the sensor, scene frame, metres.
    pub(crate) fn position(&self) -> DVec3 {
        self.position
    }

    /// Rotates a vector from the scene's axes to the sensor's axes.
    #[inline]
    pub(crate) fn in_sensor_axes(&self, v: DVec3) -> DVec3 {
        DVec3::new(self.axes.x_axis.dot(v), self.axes.y_axis.dot(v), self.axes.z_axis.dot(v))
    }

    /// Rotates a vector from the sensor's axes to the scene's axes.
    #[inline]
    fn in_scene_axes(&self, v: DVec3) -> DVec3 {
        self.axes.x_axis * v.x + self.axes.y_axis * v.y + self.axes.z_axis * v.z
    }

    /// The vector from the sensor's position to a scene point, along the scene's axes, metres.
    #[inline]
    pub(crate) fn offset_of(&self, point: DVec3) -> DVec3 {
        point - self.position
    }

    /// Moves a point from the sensor's frame into the scene.
    #[inline]
    pub(crate) fn scene_point(&self, p: DVec3) -> DVec3 {
        self.position + self.in_scene_axes(p)
    }

    /// Moves a point `p` from the frame of `other` into this one. The sum is formed with the vector between the two
    /// sensors: the scene's origin may be far from both.
    #[inline]
    pub(crate) fn point_of_sensor(&self, other: &Self, p: DVec3) -> DVec3 {
        self.in_sensor_axes((other.position - self.position) + other.in_scene_axes(p))
    }

    /// Rotates a vector `v` from the axes of `other` to the axes of this sensor.
    #[inline]
    pub(crate) fn vector_of_sensor(&self, other: &Self, v: DVec3) -> DVec3 {
        self.in_sensor_axes(other.in_scene_axes(v))
    }
}
