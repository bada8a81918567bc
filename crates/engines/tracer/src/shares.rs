//! The power P_k of each pencil of a beam. (Paper, equation (1), A_bp cos(alpha) / A_b; contract: flux)

use rayon::prelude::*;
use raypencil_scene::Profile;

use crate::rays::PencilGrid;

/// The shares of a beam's power that its pencils carry.
#[derive(Debug)]
pub(crate) struct PowerShares {
    grid: PencilGrid,
    /// Power of a pencil of weight 1, watts.
    watts_per_weight: f64,
    /// alpha^2 of the pencil nearest to the normal axis, rad^2. Used by the Gaussian profile.
    min_alpha_squared: f64,
}

impl PowerShares {
    pub(crate) fn new(grid: PencilGrid) -> Self {
        let (columns, rows) = (grid.beam.columns, grid.beam.rows);
        let mut shares = Self { grid, watts_per_weight: 1.0, min_alpha_squared: 0.0 };
        let divisor = match grid.beam.profile {
            // A_bp / A_b is the same for all pencils.
            Profile::Paper => f64::from(columns) * f64::from(rows),
            Profile::UniformAngle => shares.sum_of_weights(),
            Profile::Gaussian { .. } => {
                // The pencil nearest to the axis gets the weight 1, the others theirs in proportion. Otherwise a
                // beam much narrower than a pencil would have the weight 0 in all of them.
                let min_of_row =
                    |j| (0..columns).map(|i| shares.alpha_squared(i, j)).fold(f64::MAX, f64::min);
                shares.min_alpha_squared =
                    (0..rows).into_par_iter().map(min_of_row).reduce(|| f64::MAX, f64::min);
                shares.sum_of_weights()
            }
        };
        shares.watts_per_weight = grid.beam.power / divisor;
        shares
    }

    /// P_k of pencil (i, j), watts.
    pub(crate) fn power(&self, i: u32, j: u32) -> f64 {
        self.weight(i, j) * self.watts_per_weight
    }

    /// The sum over all pencils, hit or not. Rows are summed on any thread and added in their order.
    fn sum_of_weights(&self) -> f64 {
        let sum_of_row = |j| (0..self.grid.beam.columns).map(|i| self.weight(i, j)).sum();
        let rows: Vec<f64> = (0..self.grid.beam.rows).into_par_iter().map(sum_of_row).collect();
        rows.iter().sum()
    }

    fn weight(&self, i: u32, j: u32) -> f64 {
        // cos^2(alpha) = g^2 / |q|^2, q = (x, 0, g).
        let g = self.grid.beam.grid_distance;
        let cos_squared = || {
            let (x, _) = self.grid.crossing(i, j);
            g * g / (x * x + g * g)
        };
        match self.grid.beam.profile {
            Profile::Paper => cos_squared().sqrt(),
            Profile::UniformAngle => cos_squared(),
            Profile::Gaussian { half_width } => {
                let above_min = self.alpha_squared(i, j) - self.min_alpha_squared;
                libm::exp(-2.0 * (above_min / (half_width * half_width)))
            }
        }
    }

    /// alpha^2 of pencil (i, j), rad^2.
    fn alpha_squared(&self, i: u32, j: u32) -> f64 {
        let (x, _) = self.grid.crossing(i, j);
        let alpha = libm::atan(x / self.grid.beam.grid_distance);
        alpha * alpha
    }
}

#[cfg(test)]
#[path = "../tests/unit/shares.rs"]
mod tests;
