//! A raster of azimuth and elevation: a solid-state sensor.

use glam::DVec3;

use super::{Mounting, PatternRays, check_ranges, check_rays, direction, sincos_deg};
use crate::error::{check_count, check_range};
use crate::{CastRay, SceneError};

/// What has equal steps from one ray of a raster to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spacing {
    /// Azimuth and elevation.
    Angle,
    /// Their tangents: the raster is even on a plane across x, as in a camera.
    Tangent,
}

/// A raster about the x axis. Columns run from left to right, rows from top to bottom. The outer columns and rows are at
/// the ends of the field of view; a single one is in its middle.
///
/// ```
/// use raypencil_scene::pattern::{Grid, Spacing};
///
/// let grid = Grid {
///     columns: 3,
///     rows: 3,
///     width_deg: 90.0,
///     height_deg: 90.0,
///     spacing: Spacing::Tangent,
///     min_range_m: 0.0,
///     max_range_m: 10.0,
/// };
/// let pattern = grid.rays("rays")?;
/// assert_eq!(pattern.shape, [3, 3]);
/// // The upper left corner is at tangents of 1; the middle looks along x.
/// let [corner, middle] = [pattern.rays[0].direction, pattern.rays[4].direction];
/// assert!((corner - glam::DVec3::ONE.normalize()).length() < 1e-15);
/// assert_eq!(middle, glam::DVec3::X);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Number of columns.
    pub columns: u64,
    /// Number of rows.
    pub rows: u64,
    /// Full angle from the first column to the last, degrees.
    pub width_deg: f64,
    /// Full angle from the first row to the last, degrees.
    pub height_deg: f64,
    /// What has equal steps.
    pub spacing: Spacing,
    /// Shortest range, metres: a nearest hit before it is too near ([`CastRay::t_blind`]), and nothing is seen behind it.
    pub min_range_m: f64,
    /// Longest range, metres.
    pub max_range_m: f64,
}

impl Grid {
    /// Refuses a raster that no sensor has. `field` names it.
    ///
    /// # Errors
    /// Names the first part that is wrong, its value and what is expected.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        let name = |part: &str| format!("{field}.{part}");
        check_count(|| name("columns"), self.columns, 1, super::MAX_RAYS)?;
        check_count(|| name("rows"), self.rows, 1, super::MAX_RAYS)?;
        let widest = if self.spacing == Spacing::Tangent { [179.9; 2] } else { [360.0, 180.0] };
        check_range(|| name("width"), self.width_deg, 0.0, widest[0], "degrees")?;
        check_range(|| name("height"), self.height_deg, 0.0, widest[1], "degrees")?;
        check_ranges(field, self.min_range_m, self.max_range_m)?;
        check_rays(field, &[self.columns, self.rows])
    }

    /// The rays, of shape (rows, columns). They have no times. `field` names the raster in messages.
    ///
    /// # Errors
    /// As [`Grid::validate`].
    pub fn rays(&self, field: &str) -> Result<PatternRays, SceneError> {
        self.validate(field)?;
        let mut rays = Vec::with_capacity((self.columns * self.rows) as usize);
        // From +1 at the first to -1 at the last, and exactly opposite on both sides of the middle.
        let place = |index: u64, count: u64| match count {
            1 => 0.0,
            _ => (count as f64 - 1.0 - 2.0 * index as f64) / (count as f64 - 1.0),
        };
        let tangent = |degrees: f64| {
            let (sin, cos) = sincos_deg(degrees);
            sin / cos
        };
        let half = [0.5 * self.width_deg, 0.5 * self.height_deg];
        let tangents = half.map(tangent);
        for row in 0..self.rows {
            let up = place(row, self.rows);
            for column in 0..self.columns {
                let left = place(column, self.columns);
                let direction = match self.spacing {
                    Spacing::Angle => direction(half[0] * left, half[1] * up),
                    Spacing::Tangent => DVec3::new(1.0, tangents[0] * left, tangents[1] * up).normalize(),
                };
                let ray = CastRay::new(DVec3::ZERO, direction);
                rays.push(CastRay { t_max: self.max_range_m, t_blind: self.min_range_m, ..ray });
            }
        }
        let shape = vec![self.rows, self.columns];
        Ok(PatternRays {
            shape,
            rays,
            times: None,
            weights: None,
            returns: None,
            elevations_deg: None,
            mounting: Mounting::HERE,
        })
    }
}
