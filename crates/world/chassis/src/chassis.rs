//! The dimensions of the vehicle.

/// Dimensions of a vehicle on four equal wheels.
///
/// The vehicle frame has x forward, y left, z up. Its origin lies in the plane of the wheels' lowest points, midway
/// between the axles and between the sides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chassis {
    /// Distance between the front and the rear axle, metres.
    pub wheelbase: f64,
    /// Distance between the middles of a left and a right wheel, metres.
    pub track: f64,
    /// Radius of every wheel, metres.
    pub wheel_radius: f64,
    /// Width of every wheel, metres.
    pub wheel_width: f64,
    /// Height of the body's underside above the plane of the wheels' lowest points, metres.
    pub clearance: f64,
}

/// Signs of the four wheels' x and y in the vehicle frame: front left, front right, rear left, rear right.
pub(crate) const WHEEL_SIGNS: [(f64, f64); 4] = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];

impl Default for Chassis {
    /// CHOICE: the paper prints no dimension. These are a rover of one to two metres, with its underside at the height
    /// of the hubs.
    fn default() -> Self {
        Self { wheelbase: 1.2, track: 1.0, wheel_radius: 0.35, wheel_width: 0.25, clearance: 0.35 }
    }
}
