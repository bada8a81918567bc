//! How a beam's power spreads over its pencils: P_k. (Paper, equation (1), A_bp cos(alpha) / A_b; contract: flux)

use rayon::prelude::*;
use raypencil_scene::Profile;

use crate::rays::Grid;

/// The power of each pencil of a beam.
#[derive(Debug)]
pub(crate) struct Shares {
    grid: Grid,
    /// Watts of a pencil of weight 1.
    per_weight: f64,
    /// alpha^2 of the pencil nearest to the normal axis, rad^2; for the Gaussian profile.
    least: f64,
}

impl Shares {
    pub(crate) fn new(grid: Grid) -> Self {
        let (columns, rows) = (grid.beam.columns, grid.beam.rows);
        let mut shares = Self { grid, per_weight: 1.0, least: 0.0 };
        let sum = match grid.beam.profile {
            // A_bp / A_b is the same for all of them.
            Profile::Paper => f64::from(columns) * f64::from(rows),
            Profile::UniformAngle => shares.sum_of_weights(),
            Profile::Gaussian { .. } => {
                // The pencil nearest to the axis gets the weight 1, the others theirs in proportion: a beam
                // much narrower than a pencil would else have the weight 0 in all of them.
                let least_of_row =
                    |j| (0..columns).map(|i| shares.alpha_squared(i, j)).fold(f64::MAX, f64::min);
                shares.least = (0..rows).into_par_iter().map(least_of_row).reduce(|| f64::MAX, f64::min);
                shares.sum_of_weights()
            }
        };
        shares.per_weight = grid.beam.power / sum;
        shares
    }

    /// P_k of pencil (i, j), watts.
    pub(crate) fn of(&self, i: u32, j: u32) -> f64 {
        self.weight(i, j) * self.per_weight
    }

    /// Over all pencils, hit or not: rows on any thread, added in their order.
    fn sum_of_weights(&self) -> f64 {
        let of_row = |j| (0..self.grid.beam.columns).map(|i| self.weight(i, j)).sum();
        let rows: Vec<f64> = (0..self.grid.beam.rows).into_par_iter().map(of_row).collect();
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
                libm::exp(-2.0 * ((self.alpha_squared(i, j) - self.least) / (half_width * half_width)))
            }
        }
    }

    fn alpha_squared(&self, i: u32, j: u32) -> f64 {
        let (x, _) = self.grid.crossing(i, j);
        let alpha = libm::atan(x / self.grid.beam.grid_distance);
        alpha * alpha
    }
}

#[cfg(test)]
#[path = "../tests/unit/shares.rs"]
mod tests;
