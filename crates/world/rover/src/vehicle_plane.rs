//! The plane of the wheels' lowest points, as the measured attitude gives it.

use glam::{DVec2, DVec3};
use raypencil_scene::Pose;

/// Slope of the plane of a vehicle's wheels: rise over distance along global x and y.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct WheelPlane {
    slope: DVec2,
}

impl WheelPlane {
    /// Plane of a vehicle with this pose, `global_from_vehicle`.
    pub fn of(pose: &Pose) -> Self {
        let up = pose.rotate(DVec3::Z);
        // A vehicle on its side has no such plane.
        Self { slope: if up.z > 0.1 { -up.truncate() / up.z } else { DVec2::ZERO } }
    }

    /// Rise of the plane over a horizontal `displacement`, metres.
    pub fn rise(&self, displacement: DVec2) -> f64 {
        self.slope.dot(displacement)
    }
}
