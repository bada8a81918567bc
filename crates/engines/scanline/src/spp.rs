//! Points of the scene, and points and lines on the sensor projection plane (SPP). (§4, figure 4)

use glam::DVec3;

/// A point on the SPP, metres: x to the right, y down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SppPoint {
    pub(crate) x: f64,
    pub(crate) y: f64,
}

/// The projection of a straight line in space onto the SPP: a straight line for the camera, a curve for a beam. (Or
/// the straight line that the paper draws for a beam: `stripe::Chord`.)
pub(crate) trait ProjectedLine: Copy {
    /// The x at which the line crosses the row at `y`, metres. Any number, even NaN, where the line runs along the
    /// row.
    fn x_at(&self, y: f64) -> f64;
}

/// A vertex in f64, exactly.
#[inline]
pub(crate) fn widen([x, y, z]: [f32; 3]) -> DVec3 {
    DVec3::new(f64::from(x), f64::from(y), f64::from(z))
}
