//! Rigid poses: a position and a quaternion, whose rotation is a rational function of stored numbers.

use std::ops::Mul;

use glam::{DQuat, DVec3};

use crate::SceneError;

/// Where a frame `b` stands in a frame `a`; named `a_from_b`, so that `p_a = a_from_b * p_b`.
///
/// The quaternion need not be a unit: the rotation it stands for is *exactly* `(q p q*) / (q . q)`,
/// a rational function of the four stored numbers. A resolved scene stores poses rounded once, and those
/// seven numbers are the truth that every renderer approximates.
///
/// ```
/// use glam::DVec3;
/// use raypencil_scene::Pose;
///
/// // A sensor 1.5 m above the vehicle's origin that looks forward: 2 m ahead of it is (2, 0, 1.5) on the vehicle.
/// let vehicle_from_sensor =
///     Pose { position: DVec3::new(0.0, 0.0, 1.5), ..Pose::VEHICLE_FROM_FORWARD_SENSOR };
/// let p_sensor = DVec3::new(0.0, 0.0, 2.0);
/// assert_eq!(vehicle_from_sensor * p_sensor, DVec3::new(2.0, 0.0, 1.5));
/// // The inverse undoes it.
/// assert_eq!(vehicle_from_sensor.inverse() * DVec3::new(2.0, 0.0, 1.5), p_sensor);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Origin of frame `b` in frame `a`, metres.
    pub position: DVec3,
    /// Rotation from `b` to `a`; any non-zero quaternion.
    pub rotation: DQuat,
}

impl Pose {
    /// Both frames are the same.
    pub const IDENTITY: Self = Self { position: DVec3::ZERO, rotation: DQuat::IDENTITY };

    /// The pose of a sensor (z forward, x right, y down) that looks along the x axis of a vehicle
    /// (x forward, y left, z up): the fixed change of axes of REP-103.
    pub const VEHICLE_FROM_FORWARD_SENSOR: Self =
        Self { position: DVec3::ZERO, rotation: DQuat::from_xyzw(-0.5, 0.5, -0.5, 0.5) };

    /// A pure translation, metres.
    pub fn from_position(position: DVec3) -> Self {
        Self { position, rotation: DQuat::IDENTITY }
    }

    /// A turn by `angle` radians about the unit vector `axis`, right-handed.
    pub fn from_axis_angle(axis: DVec3, angle: f64) -> Self {
        let (sin, cos) = libm::sincos(0.5 * angle);
        let v = axis * sin;
        Self { position: DVec3::ZERO, rotation: DQuat::from_xyzw(v.x, v.y, v.z, cos) }
    }

    /// Turns the vector `v` from frame `b` into frame `a`.
    ///
    /// With q = (u, w): `v + 2 (w (u x v) + u x (u x v)) / (w^2 + u . u)`.
    pub fn rotate(&self, v: DVec3) -> DVec3 {
        let q = self.rotation;
        let u = DVec3::new(q.x, q.y, q.z);
        let norm_squared = q.w * q.w + u.dot(u);
        let uv = u.cross(v);
        v + (uv * q.w + u.cross(uv)) * (2.0 / norm_squared)
    }

    /// The pose of frame `a` in frame `b`.
    pub fn inverse(&self) -> Self {
        let q = self.rotation;
        let rotation = DQuat::from_xyzw(-q.x, -q.y, -q.z, q.w);
        let turned = Self { position: DVec3::ZERO, rotation }.rotate(self.position);
        Self { position: -turned, rotation }
    }

    /// Refuses numbers that are no pose: a coordinate that is not finite or beyond 1e7 m, a quaternion whose
    /// length is not between 1e-3 and 1e3.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        const MAX_COORDINATE_M: f64 = 1e7;
        let p = self.position;
        if !p.is_finite() || p.abs().max_element() > MAX_COORDINATE_M {
            return Err(SceneError::new(
                format!("{field}.position"),
                format!("({}, {}, {})", p.x, p.y, p.z),
                "three numbers within 1e7 m of the scene origin",
            ));
        }
        let q = self.rotation;
        let norm_squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
        if !(1e-6..=1e6).contains(&norm_squared) {
            return Err(SceneError::new(
                format!("{field}.rotation"),
                format!("({}, {}, {}, {})", q.x, q.y, q.z, q.w),
                "a quaternion (x, y, z, w) of length 1e-3 to 1e3",
            ));
        }
        Ok(())
    }
}

impl Mul<DVec3> for Pose {
    type Output = DVec3;

    /// `p_a = a_from_b * p_b`.
    #[allow(clippy::suspicious_arithmetic_impl, reason = "a rigid motion is a turn and then a sum")]
    fn mul(self, point: DVec3) -> DVec3 {
        self.position + self.rotate(point)
    }
}

impl Mul for Pose {
    type Output = Self;

    /// `a_from_c = a_from_b * b_from_c`.
    fn mul(self, b_from_c: Self) -> Self {
        Self { position: self * b_from_c.position, rotation: self.rotation * b_from_c.rotation }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sensor_axes_follow_rep_103() {
        // A camera looking forward: its z is the vehicle's x, its x (right) the vehicle's -y, its y (down) -z.
        let pose = Pose::VEHICLE_FROM_FORWARD_SENSOR;
        assert_eq!(pose.rotate(DVec3::Z), DVec3::X);
        assert_eq!(pose.rotate(DVec3::X), -DVec3::Y);
        assert_eq!(pose.rotate(DVec3::Y), -DVec3::Z);
    }

    #[test]
    fn pitching_down_turns_forward_towards_the_ground() {
        // A right-handed turn by +30 degrees about y (left) takes (1, 0, 0) to (cos 30, 0, -sin 30).
        let pose = Pose::from_axis_angle(DVec3::Y, std::f64::consts::FRAC_PI_6);
        let forward = pose.rotate(DVec3::X);
        assert!((forward - DVec3::new(0.75_f64.sqrt(), 0.0, -0.5)).length() < 1e-15);
    }

    #[test]
    fn a_quaternion_of_any_length_is_the_same_rotation() {
        let unit = Pose::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 1.1);
        let q = unit.rotation;
        let scaled = Pose { rotation: DQuat::from_xyzw(3.0 * q.x, 3.0 * q.y, 3.0 * q.z, 3.0 * q.w), ..unit };
        let v = DVec3::new(1.0, -2.0, 3.0);
        assert!((unit.rotate(v) - scaled.rotate(v)).length() < 4e-15);
    }

    #[test]
    fn composition_and_inverse_agree_with_application() {
        let a = Pose { position: DVec3::new(1.0, 2.0, 3.0), ..Pose::from_axis_angle(DVec3::Z, 0.7) };
        let b = Pose { position: DVec3::new(-4.0, 0.5, 2.0), ..Pose::from_axis_angle(DVec3::X, -0.4) };
        let p = DVec3::new(0.3, -0.2, 5.0);
        assert!(((a * b) * p - a * (b * p)).length() < 1e-14);
        assert!((a.inverse() * (a * p) - p).length() < 1e-14);
    }

    #[test]
    fn a_pose_that_is_none_is_named() {
        let nan = Pose::from_position(DVec3::new(0.0, f64::NAN, 0.0));
        let message = nan.validate("camera").unwrap_err().to_string();
        assert!(message.contains("camera.position") && message.contains("1e7 m"), "{message}");
        let zero = Pose { rotation: DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), ..Pose::IDENTITY };
        assert!(zero.validate("beam 0").unwrap_err().to_string().contains("beam 0.rotation"));
    }
}
