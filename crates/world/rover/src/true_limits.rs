//! What the vehicle can truly do, apart from what the rover believes of it.

use glam::DVec3;
use raypencil_scene::{SceneError, check_range};

use crate::traversability::SlopeLimits;
use crate::vehicle::Vehicle;

/// Limits of the vehicle itself, to which the rover's obstacle maps are held. The rover does not know them: its own are
/// [`TraversabilityRules`](crate::TraversabilityRules) and [`Vehicle`]. What is `None` here is as the rover has it, or no limit.
///
/// By default the vehicle can do what its rover believes: slopes and clearance are the rover's own, wheels climb any step, and
/// the vehicle never tips over. The paper names slopes and the belly alone (§7), without a number.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TrueLimits {
    /// Maximum slope across the vehicle at its front axle, rise over distance. `None`: the rover's own, as with the next two.
    pub front: Option<f64>,
    /// The same at its rear axle.
    pub rear: Option<f64>,
    /// Maximum slope along the vehicle, from axle to axle.
    pub length: Option<f64>,
    /// Height of the underside above the plane of the wheels' lowest points, metres. `None`: [`Vehicle::clearance`].
    pub clearance: Option<f64>,
    /// Maximum height of a step that a wheel climbs, metres. `None`: any.
    pub step: Option<f64>,
    /// Centre of mass in the vehicle frame, metres, for tip-over. `None`: the vehicle never tips over.
    pub centre_of_mass: Option<DVec3>,
}

impl TrueLimits {
    /// The slopes in force, front, rear and length, where those of the rover are `own`.
    ///
    /// ```
    /// use raypencil_rover::{SlopeLimits, TrueLimits};
    ///
    /// let own = SlopeLimits { front: 0.35, rear: 0.35, length: 0.29, closer: 0.58 };
    /// let limits = TrueLimits { length: Some(0.4), ..TrueLimits::default() };
    /// assert_eq!(limits.slopes(&own), [0.35, 0.35, 0.4]);
    /// ```
    pub fn slopes(&self, own: &SlopeLimits) -> [f64; 3] {
        [(self.front, own.front), (self.rear, own.rear), (self.length, own.length)]
            .map(|(limit, own)| limit.unwrap_or(own))
    }

    /// Checks every field for a vehicle. The error names the first one that is out of range.
    ///
    /// # Errors
    /// As a part of `field`.
    pub fn validate(&self, field: &str, vehicle: &Vehicle) -> Result<(), SceneError> {
        for (name, limit, range, unit) in [
            ("front", self.front, 0.0..=1e3, "(rise over distance)"),
            ("rear", self.rear, 0.0..=1e3, "(rise over distance)"),
            ("length", self.length, 0.0..=1e3, "(rise over distance)"),
            ("clearance", self.clearance, 1e-2..=1e2, "m"),
            ("step", self.step, 1e-3..=1e2, "m"),
        ] {
            if let Some(limit) = limit {
                check_range(|| format!("{field}.{name}"), limit, *range.start(), *range.end(), unit)?;
            }
        }
        let Some(mass) = self.centre_of_mass else { return Ok(()) };
        let (half_length, half_width) = (0.5 * vehicle.wheelbase, 0.5 * vehicle.track);
        for (axis, place, most, unit) in [
            ("x", mass.x, half_length, "m (between the axles: else it tips over on level ground)"),
            ("y", mass.y, half_width, "m (between the wheels: else it tips over on level ground)"),
            ("z", mass.z, 1e2, "m"),
        ] {
            check_range(|| format!("{field}.centre_of_mass.{axis}"), place, -most, most, unit)?;
        }
        Ok(())
    }
}
