//! Which part of a beam's power each of its pencils carries, by column. (§5, equation (1))

use raypencil_scene::{Beam, Mounted, Profile};

use crate::tables::Axis;

/// The pencils' shares of one beam: they depend on the column alone.
#[derive(Debug)]
pub(crate) struct Shares {
    beam: Beam,
    /// P_k of the pencils in each column, watts.
    pub(crate) of_column: Vec<f64>,
}

impl Shares {
    pub(crate) fn of(beam: &Beam) -> Self {
        let x = Axis::of_grid(beam.columns, beam.half_width);
        let g = beam.grid_distance;
        // cos(alpha) = g / |q|, q = (x, 0, g).
        let cos_alpha = |x: f64| g / (x * x + g * g).sqrt();
        let rows = f64::from(beam.rows);
        let of_column = match beam.profile {
            // P_k = I_b A_bp cos(alpha) / A_b. The sum over the grid falls short of I_b.
            Profile::Paper => {
                let pencils = f64::from(beam.columns) * rows;
                x.centres().iter().map(|x| beam.power * cos_alpha(*x) / pencils).collect()
            }
            Profile::UniformAngle => {
                let weights = x.centres().iter().map(|x| cos_alpha(*x) * cos_alpha(*x)).collect();
                by_weight(beam.power, rows, weights)
            }
            Profile::Gaussian { half_width } => {
                let exponent = |x: &f64| {
                    let widths = libm::atan(x / g) / half_width;
                    2.0 * widths * widths
                };
                let exponents: Vec<f64> = x.centres().iter().map(exponent).collect();
                // CHOICE: weights relative to the brightest column's. That changes no share, and one remains where
                // the beam is so narrow that all exponentials vanish.
                let brightest = exponents.iter().copied().fold(f64::INFINITY, f64::min);
                let weights = exponents.iter().map(|of| libm::exp(brightest - of)).collect();
                by_weight(beam.power, rows, weights)
            }
        };
        Self { beam: *beam, of_column }
    }

    pub(crate) fn are_of(all: &[Self], beams: &[Mounted<Beam>]) -> bool {
        all.len() == beams.len() && all.iter().zip(beams).all(|(shares, beam)| shares.beam == beam.sensor)
    }
}

/// Shares that add up to the whole power over all pencils, hit or not.
fn by_weight(power: f64, rows: f64, weights: Vec<f64>) -> Vec<f64> {
    let sum = rows * weights.iter().sum::<f64>();
    weights.into_iter().map(|weight| power * weight / sum).collect()
}

#[cfg(test)]
#[path = "../tests/unit/shares.rs"]
mod tests;
