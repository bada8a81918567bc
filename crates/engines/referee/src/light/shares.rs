//! Shares of a beam's power: which part of it goes to each pencil.
//!
//! A pencil's share is its weight by the beam's profile, divided by the sum of all weights.

use std::sync::Arc;

use raypencil_scene::{Beam, Profile, Sampling};

use crate::numbers::arithmetic::{Arithmetic, WeightSum};
use crate::numbers::number::Number;
use crate::rays::displacement::Displacement;
use crate::rays::ray::Aim;

/// Exponents of a Gaussian below this need no common factor: exp(-2 100) is far from the smallest f64.
const MIN_FACTORED_EXPONENT: f64 = 100.0;

/// The shares of one beam's pencils.
#[derive(Debug)]
pub(crate) struct Shares {
    index: usize,
    beam: Beam,
    sampling: Sampling,
    weight_sum: Arc<WeightSum>,
    /// A lower bound, almost tight, of (alpha / w)^2 over all pencils of a Gaussian profile. All weights are divided
    /// by exp(-2 min_exponent), which changes no share: without it the weights of a narrow Gaussian underflow.
    min_exponent: f64,
}

impl Shares {
    /// The shares of beam number `index`; `weight_sum` caches the sum of its weights.
    pub(crate) fn new(index: usize, beam: Beam, sampling: Sampling, weight_sum: Arc<WeightSum>) -> Self {
        let mut shares = Self { index, beam, sampling, weight_sum, min_exponent: 0.0 };
        if let Profile::Gaussian { half_width } = beam.profile {
            shares.min_exponent = shares.least_exponent(half_width);
        }
        shares
    }

    /// The beam.
    pub(crate) fn beam(&self) -> &Beam {
        &self.beam
    }

    /// The displacement of a pencil's ray from the cell's centre, cells.
    pub(crate) fn offset(&self, i: u32, j: u32) -> Displacement {
        let [dx, dy] = self.sampling.offset(self.index, i, j);
        Displacement { dx, dy }
    }

    /// The aim of a pencil's ray.
    pub(crate) fn aim(&self, i: u32, j: u32) -> Aim {
        let Displacement { dx, dy } = self.offset(i, j);
        Aim { i, j, dx, dy }
    }

    /// x and z of a pencil's ray, in units of 1 / columns: (w (2i + 1 - columns + 2 dx), columns g).
    pub(crate) fn across_and_ahead<T: Number>(&self, i: u32, j: u32) -> [T; 2] {
        let Beam { columns, half_width, grid_distance, .. } = self.beam;
        let centre = T::of(2.0 * f64::from(i) + 1.0 - f64::from(columns));
        let half_cells = centre.add(&T::of(self.offset(i, j).dx).doubled());
        [T::of(half_width).mul(&half_cells), T::of_integer(columns).mul(&T::of(grid_distance))]
    }

    /// The weight of a pencil by the beam's profile, not yet normalised.
    fn weight<A: Arithmetic>(&self, a: &A, i: u32, j: u32) -> A::Real {
        let [x, z] = self.across_and_ahead::<A::Exact>(i, j);
        let squared = a.abs(&x.square().add(&z.square()));
        match self.beam.profile {
            Profile::Paper => {
                let pencils =
                    A::Exact::of_integer(self.beam.columns).mul(&A::Exact::of_integer(self.beam.rows));
                a.div(&a.abs(&z), &a.mul(&a.sqrt(&squared), &a.abs(&pencils)))
            }
            Profile::UniformAngle => a.div(&a.abs(&z.square()), &squared),
            Profile::Gaussian { half_width } => {
                let alpha = a.atan(&a.div(&a.abs(&x), &a.abs(&z)));
                let relative = a.div(&alpha, &a.exact(half_width));
                let beyond = a.distance(&a.mul(&relative, &relative), &a.exact(self.min_exponent));
                a.exp_minus(&a.mul(&a.exact(2.0), &beyond))
            }
        }
    }

    /// The share of a pencil in the beam's power.
    pub(crate) fn share<A: Arithmetic>(&self, a: &A, i: u32, j: u32) -> A::Real {
        let weight = self.weight(a, i, j);
        // The paper's own profile is defined with its normalisation.
        if self.beam.profile == Profile::Paper {
            return weight;
        }
        let weight_sum = a.weight_sum(&self.weight_sum, || {
            let Beam { columns, rows, .. } = self.beam;
            // Without jitter all rows have the same weights.
            let rows_alike = self.sampling == Sampling::Centres;
            let different = if rows_alike { 1 } else { rows };
            let pencils = (0..different).flat_map(|j| (0..columns).map(move |i| (i, j)));
            let sum = pencils.map(|(i, j)| self.weight(a, i, j)).reduce(|sum, weight| a.add(&sum, &weight));
            let sum = sum.unwrap_or_else(|| a.exact(0.0));
            if rows_alike { a.mul(&sum, &a.abs(&A::Exact::of_integer(rows))) } else { sum }
        });
        a.div(&weight, &weight_sum)
    }

    /// The least (alpha / w)^2 of all pencils, lowered by 1e-9 of itself, which is far more than its error in f64.
    /// 0 if it is below [`MIN_FACTORED_EXPONENT`].
    pub(crate) fn least_exponent(&self, half_width: f64) -> f64 {
        let Beam { columns, rows, half_width: w, grid_distance, .. } = self.beam;
        let different = if self.sampling == Sampling::Centres { 1 } else { rows };
        let pencils = (0..different).flat_map(|j| (0..columns).map(move |i| (i, j)));
        let half_cells = |(i, j)| 2.0 * f64::from(i) + 1.0 - f64::from(columns) + 2.0 * self.offset(i, j).dx;
        let nearest = pencils.map(|cell| half_cells(cell).abs()).fold(f64::INFINITY, f64::min);
        let relative = libm::atan(w * nearest / (f64::from(columns) * grid_distance)) / half_width;
        let exponent = relative * relative;
        if exponent < MIN_FACTORED_EXPONENT { 0.0 } else { exponent * (1.0 - 1e-9) }
    }
}
