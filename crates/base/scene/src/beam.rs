//! A laser sheet and its grid of ray pencils. (Paper, §5, figures 6 and 7)

use glam::DVec3;

use crate::SceneError;
use crate::error::check_range;
use crate::image::check_cells;

/// A flat laser beam spread by a cylindrical lens, cut into `columns x rows` ray pencils by an imaginary
/// grid on the plane z = `grid_distance` (the SPP).
///
/// The central ray of pencil (i, j) starts *on the focal axis* at `(0, y_j, 0)` and runs along
/// `(x_i, 0, g)`: the sheet keeps its thickness. Row 0 is on top, so the lower edge plane is y = +T/2.
///
/// ```
/// use glam::DVec3;
/// use raypencil_scene::rig;
///
/// // 4 columns of 1/16 m and 2 rows of 4 mm on a grid plane at 0.1 m.
/// let beam = rig::beam(4, 2, [0.0625, 0.004], 0.1);
/// // Column 3: its centre is 1.5 cells to the right of the middle. Row 0 starts half a row above it.
/// assert_eq!(beam.direction(3), DVec3::new(0.09375, 0.0, 0.1));
/// assert_eq!(beam.origin(0), DVec3::new(0.0, -0.002, 0.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beam {
    /// Pencils across the fan.
    pub columns: u32,
    /// Pencils across the sheet's thickness.
    pub rows: u32,
    /// Thickness T of the sheet along the focal axis, metres.
    pub thickness: f64,
    /// Distance g of the grid plane from the focal axis, metres.
    pub grid_distance: f64,
    /// Half the width of the grid, w = fl(g tan(fan / 2)), rounded once and stored, metres.
    pub half_width: f64,
    /// Longest range along the ray, metres.
    pub max_range: f64,
    /// Power I_b of the whole beam, watts.
    pub power: f64,
    /// Wavelength, metres.
    pub wavelength: f64,
    /// Distribution of the power over the fan.
    pub profile: Profile,
}

/// Distribution of a beam's power over the angle alpha from its normal axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Profile {
    /// The paper's share, A_bp cos(alpha) / A_b. Its sum falls short of the whole power.
    Paper,
    /// Equal power per radian: weight cos^2(alpha), divided by the discrete sum.
    UniformAngle,
    /// Weight exp(-2 (alpha / w)^2), divided by the discrete sum.
    Gaussian {
        /// The angle w at which the weight has fallen to exp(-2), radians.
        half_width: f64,
    },
}

impl Beam {
    /// Half the width of a grid at distance `grid_distance` (metres) under a full fan angle `fan` (radians).
    pub fn half_width_of(grid_distance: f64, fan: f64) -> f64 {
        grid_distance * libm::tan(0.5 * fan)
    }

    /// Origin of the central rays of row `j` in the beam frame: `y_j = T (2j + 1 - rows) / (2 rows)` on
    /// the focal axis.
    pub fn origin(&self, j: u32) -> DVec3 {
        let rows = f64::from(self.rows);
        DVec3::new(0.0, self.thickness * (2.0 * f64::from(j) + 1.0 - rows) / (2.0 * rows), 0.0)
    }

    /// Direction of the central rays of column `i` in the beam frame, not a unit: `(x_i, 0, g)` with
    /// `x_i = w (2i + 1 - columns) / columns`. At t = 1 the ray crosses the grid plane.
    pub fn direction(&self, i: u32) -> DVec3 {
        let columns = f64::from(self.columns);
        DVec3::new(self.half_width * (2.0 * f64::from(i) + 1.0 - columns) / columns, 0.0, self.grid_distance)
    }

    /// Refuses a beam that no renderer could work with, naming the field.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        let name = |part: &str| format!("{field}.{part}");
        check_cells(field, "columns", self.columns, "rows", self.rows)?;
        check_range(|| name("thickness"), self.thickness, 1e-6, 1e2, "m")?;
        check_range(|| name("grid_distance"), self.grid_distance, 1e-4, 1e2, "m")?;
        // Between a thread of light and a fan of 179.9 degrees.
        let (narrow, wide) = (1e-6 * self.grid_distance, 1.146e3 * self.grid_distance);
        check_range(|| name("half_width"), self.half_width, narrow, wide, "m")?;
        check_range(|| name("max_range"), self.max_range, 1e-3, 1e7, "m")?;
        check_range(|| name("power"), self.power, 0.0, 1e6, "W")?;
        check_range(|| name("wavelength"), self.wavelength, 1e-8, 1e-3, "m")?;
        if let Profile::Gaussian { half_width } = self.profile {
            check_range(|| name("profile.half_width"), half_width, 1e-6, 1e3, "rad")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pencils_are_cell_centres_of_the_grid() {
        // 4 columns over a half width of 1/8 m: centres at -3/32, -1/32, 1/32, 3/32 m; 2 rows over a
        // thickness of 8 mm: 2 mm above and below the middle, row 0 on top (y is down).
        let beam = Beam {
            columns: 4,
            rows: 2,
            thickness: 0.008,
            grid_distance: 0.1,
            half_width: 0.125,
            max_range: 20.0,
            power: 1.0,
            wavelength: 810e-9,
            profile: Profile::Paper,
        };
        let x: Vec<f64> = (0..4).map(|i| beam.direction(i).x).collect();
        assert_eq!(x, [-0.09375, -0.03125, 0.03125, 0.09375]);
        assert_eq!(beam.origin(0).y, -0.002);
        assert_eq!(beam.origin(1).y, 0.002);
        assert_eq!(beam.direction(0).z, 0.1);
    }

    #[test]
    fn a_right_angled_fan_is_as_wide_as_it_is_deep() {
        let w = Beam::half_width_of(0.1, std::f64::consts::FRAC_PI_2);
        assert!((w - 0.1).abs() < 1e-16);
    }
}
