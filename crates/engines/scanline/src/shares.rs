//! The power P_k of each pencil of a beam, by column. (§5, equation (1), A_bp cos(alpha) / A_b)

use raypencil_scene::{Beam, Mounted, Profile};

use crate::tables::Axis;

/// The power of one beam's pencils. It depends on the column alone.
#[derive(Debug)]
pub(crate) struct ColumnShares {
    beam: Beam,
    /// P_k of a pencil in each column, watts.
    pub(crate) watts: Vec<f64>,
}

impl ColumnShares {
    pub(crate) fn new(beam: &Beam) -> Self {
        let x = Axis::grid_columns(beam.columns, beam.half_width);
        let g = beam.grid_distance;
        // cos(alpha) = g / |q|, q = (x, 0, g).
        let cos_alpha = |x: f64| g / (x * x + g * g).sqrt();
        let rows = f64::from(beam.rows);
        let watts = match beam.profile {
            // P_k = I_b A_bp cos(alpha) / A_b. The sum over the grid falls short of I_b.
            Profile::Paper => {
                let pencils = f64::from(beam.columns) * rows;
                x.centres().iter().map(|x| beam.power * cos_alpha(*x) / pencils).collect()
            }
            Profile::UniformAngle => {
                let weights = x.centres().iter().map(|x| cos_alpha(*x) * cos_alpha(*x)).collect();
                watts_by_weight(beam.power, rows, weights)
            }
            Profile::Gaussian { half_width } => {
                let exponent = |x: &f64| {
                    let widths = libm::atan(x / g) / half_width;
                    2.0 * widths * widths
                };
                let exponents: Vec<f64> = x.centres().iter().map(exponent).collect();
                // CHOICE: weights relative to the brightest column's. This changes no share, and keeps one where the
                // beam is so narrow that all exponentials are 0 in f64.
                let brightest = exponents.iter().copied().fold(f64::INFINITY, f64::min);
                let weights = exponents.iter().map(|exponent| libm::exp(brightest - exponent)).collect();
                watts_by_weight(beam.power, rows, weights)
            }
        };
        Self { beam: *beam, watts }
    }

    /// Whether `all` are the shares of `beams`, in order.
    pub(crate) fn fit(all: &[Self], beams: &[Mounted<Beam>]) -> bool {
        all.len() == beams.len() && all.iter().zip(beams).all(|(shares, beam)| shares.beam == beam.sensor)
    }
}

/// Powers in proportion to the columns' weights. Their sum over all pencils, hit or not, is the beam's `power`.
fn watts_by_weight(power: f64, rows: f64, weights: Vec<f64>) -> Vec<f64> {
    let sum = rows * weights.iter().sum::<f64>();
    weights.into_iter().map(|weight| power * weight / sum).collect()
}

#[cfg(test)]
#[path = "../tests/unit/shares.rs"]
mod tests;
