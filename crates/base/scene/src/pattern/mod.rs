//! Patterns of range sensors (LiDAR) as rays: spinning heads, rasters, beams with a footprint, fixed and moving mounts.
//! Definitions alone; which ray meets what is not asked here.
//!
//! The *pattern frame* is that of REP-103: x forward, y left, z up. Azimuth is the angle from x to the left
//! (counter-clockwise seen from above), elevation the angle up from the horizontal plane. Directions are unit vectors up
//! to rounding, so that a ray's t is its range in metres.
//!
//! Angles are in degrees, as data sheets give them. Sines and cosines are those of `libm`, of an angle that was first
//! reduced by whole quarter turns without rounding: the bits are the same everywhere, and those of 90 degrees are exact.

mod cone;
mod echo;
mod grid;
mod poses;
mod presets;
mod returns;
mod spinning;

use glam::DVec3;

pub use cone::Cone;
pub use echo::EchoLight;
pub use grid::{Grid, Spacing};
pub use poses::{Mounting, TimedPose, TimedPoses};
pub use presets::{GRID_PRESETS, SPINNING_PRESETS};
pub use returns::{Keep, Returns};
pub use spinning::{Channel, Spinning};

use crate::error::{check_count, check_range};
use crate::{CastRay, SceneError};

/// Greatest number of rays of all sets of a file together.
pub const MAX_RAYS: u64 = 100_000_000;

/// Longest range that is not infinite, metres.
const MAX_RANGE_M: f64 = 1e9;

/// Rays of a pattern.
#[derive(Debug, Clone, PartialEq)]
pub struct PatternRays {
    /// Dimensions; their product is the number of rays.
    pub shape: Vec<u64>,
    /// The rays, the last dimension running fastest.
    pub rays: Vec<CastRay>,
    /// Time at which each ray is fired, seconds; `None` if the pattern has no times.
    pub times: Option<Vec<f64>>,
    /// Shares of a beam's power, one for each entry of the last dimension; `None` if rays are whole beams.
    pub weights: Option<Vec<f64>>,
    /// Which returns of a beam are told, if rays are parts of beams; `None`: rays stand for themselves.
    pub returns: Option<Returns>,
    /// Elevations of the channels of a spinning head, one for each entry of the second dimension, degrees.
    pub elevations_deg: Option<Vec<f64>>,
    /// Where the pattern's own frame stands in that of the rays.
    pub mounting: Mounting,
}

impl PatternRays {
    /// The same rays, fired from `start_s` seconds on. Rays without times are all fired then.
    #[must_use]
    pub fn starting_at(mut self, start_s: f64) -> Self {
        match &mut self.times {
            Some(times) => times.iter_mut().for_each(|time| *time += start_s),
            None => self.times = Some(vec![start_s; self.rays.len()]),
        }
        self
    }
}

/// Refuses more rays than [`MAX_RAYS`]. Nothing was allocated yet: the number is the product of `counts`.
pub(crate) fn check_rays(field: &str, counts: &[u64]) -> Result<(), SceneError> {
    let product = counts.iter().fold(1_u64, |product, &count| product.saturating_mul(count));
    check_count(|| format!("{field}: number of rays"), product, 0, MAX_RAYS)
}

/// Sine and cosine of an angle in degrees. The angle is reduced by quarter turns exactly.
pub(crate) fn sincos_deg(degrees: f64) -> (f64, f64) {
    let turn = degrees % 360.0;
    let quarter = (turn / 90.0).round();
    let (sin, cos) = libm::sincos((turn - 90.0 * quarter).to_radians());
    match (quarter as i64).rem_euclid(4) {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// The unit vector at this azimuth (from x to the left) and elevation (up), degrees.
pub(crate) fn direction(azimuth_deg: f64, elevation_deg: f64) -> DVec3 {
    let (sin, cos) = sincos_deg(azimuth_deg);
    let (up, level) = sincos_deg(elevation_deg);
    DVec3::new(level * cos, level * sin, up)
}

/// Refuses ranges that no ray can have. The longest may be infinite.
pub(crate) fn check_ranges(field: &str, min_m: f64, max_m: f64) -> Result<(), SceneError> {
    check_range(|| format!("{field}.min_range"), min_m, 0.0, MAX_RANGE_M, "m")?;
    let end = if max_m == f64::INFINITY { MAX_RANGE_M } else { max_m };
    check_range(|| format!("{field}.max_range"), end, min_m, MAX_RANGE_M, "m")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        for (degrees, expected) in
            [(0.0, (0.0, 1.0)), (90.0, (1.0, 0.0)), (180.0, (0.0, -1.0)), (270.0, (-1.0, 0.0))]
        {
            assert_eq!(sincos_deg(degrees), expected);
            let (sin, cos) = expected;
            assert_eq!(sincos_deg(-degrees), (-sin, cos));
            assert_eq!(sincos_deg(degrees + 720.0), expected);
        }
        let (sin, cos) = sincos_deg(30.0);
        assert!((sin - 0.5).abs() < 1e-16 && (cos - 0.75_f64.sqrt()).abs() < 2e-16);
        let (sin, cos) = sincos_deg(150.0);
        assert!((sin - 0.5).abs() < 2e-16 && (cos + 0.75_f64.sqrt()).abs() < 2e-16);
    }
}
