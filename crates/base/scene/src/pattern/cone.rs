//! The footprint of a beam: several rays in place of one.

use super::{PatternRays, check_rays};
use crate::error::{check_count, check_range};
use crate::{CastRay, SceneError};

/// A cone of rays about each ray of a pattern: the ray itself, then ring j of n with 6 j rays at the angle
/// (j / n) (divergence / 2), in all 1 + 3 n (n + 1). The outermost ring is the edge of the cone.
///
/// The divergence is the full angle between the directions at which a Gaussian beam has fallen to 1/e^2 of its middle.
/// A ray has the share of this beam's power that falls into its part of the cone. Ring j has the annulus between the
/// angles half-way to its neighbours, the outermost ring up to the edge: with r in units of the half angle, the annulus
/// from r to s has the share (exp(-2 r^2) - exp(-2 s^2)) / (1 - exp(-2)). Light outside of the cone does not count, and all
/// shares together are 1.
///
/// ```
/// use raypencil_scene::pattern::Cone;
///
/// let cone = Cone { divergence_rad: 3e-3, rings: 2 };
/// let weights = cone.weights();
/// assert_eq!(weights.len(), 1 + 6 + 12);
/// assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// Full angle of the cone, radians.
    pub divergence_rad: f64,
    /// Number of rings about the middle.
    pub rings: u64,
}

impl Cone {
    /// Number of rays in place of one.
    pub fn count(&self) -> u64 {
        let rings = self.rings;
        rings.saturating_add(1).saturating_mul(rings).saturating_mul(3).saturating_add(1)
    }

    /// Refuses a cone without an angle or with too many rings. `field` names it.
    ///
    /// # Errors
    /// Names the part that is wrong, its value and what is expected.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(|| format!("{field}.divergence"), self.divergence_rad, 1e-9, 1.0, "rad")?;
        check_count(|| format!("{field}.rings"), self.rings, 1, 64)
    }

    /// The rays of the cone, ring by ring: number of the ring and its number of rays.
    fn ring_sizes(&self) -> impl Iterator<Item = (u64, u64)> + use<> {
        (0..=self.rings).map(|ring| (ring, if ring == 0 { 1 } else { 6 * ring }))
    }

    /// The shares of the beam's power, in the order of the rays.
    pub fn weights(&self) -> Vec<f64> {
        let rings = self.rings as f64;
        let outside = |r: f64| libm::exp(-2.0 * r * r);
        let mut weights = Vec::new();
        for (ring, count) in self.ring_sizes() {
            let inner = if ring == 0 { 0.0 } else { (ring as f64 - 0.5) / rings };
            let outer = if ring == self.rings { 1.0 } else { (ring as f64 + 0.5) / rings };
            let share = (outside(inner) - outside(outer)) / (1.0 - outside(1.0));
            weights.extend((0..count).map(|_| share / count as f64));
        }
        weights
    }

    /// The pattern with a cone in place of each ray: one more dimension, the last. Directions keep their lengths. The
    /// first ray of a ring lies along [`CastRay::across`]'s u from the middle. `field` names the cone in messages.
    ///
    /// # Errors
    /// As [`Cone::validate`], and if there would be more rays than [`MAX_RAYS`](super::MAX_RAYS).
    pub fn spread(&self, pattern: &PatternRays, field: &str) -> Result<PatternRays, SceneError> {
        self.validate(field)?;
        check_rays(field, &[pattern.rays.len() as u64, self.count()])?;
        let count = self.count() as usize;
        // Sine and cosine of the angle from the middle, and of the angle about it.
        let places: Vec<[f64; 4]> = self
            .ring_sizes()
            .flat_map(|(ring, of_ring)| {
                let angle = 0.5 * self.divergence_rad * (ring as f64 / self.rings as f64);
                let (sin, cos) = libm::sincos(angle);
                (0..of_ring).map(move |index| {
                    let (around_sin, around_cos) = super::sincos_deg(360.0 * index as f64 / of_ring as f64);
                    [sin, cos, around_sin, around_cos]
                })
            })
            .collect();
        let mut rays = Vec::with_capacity(pattern.rays.len() * count);
        for ray in &pattern.rays {
            let [u, v] = ray.across();
            // The squares of very short directions would be 0.
            let largest = ray.direction.abs().max_element();
            let length = largest * (ray.direction / largest).length();
            for &[sin, cos, around_sin, around_cos] in &places {
                // The middle is the ray itself, bit for bit.
                let direction = match sin {
                    0.0 => ray.direction,
                    _ => ray.direction * cos + (u * around_cos + v * around_sin) * (sin * length),
                };
                rays.push(CastRay { direction, ..*ray });
            }
        }
        let repeated = |times: &Vec<f64>| times.iter().flat_map(|&time| vec![time; count]).collect();
        Ok(PatternRays {
            shape: pattern.shape.iter().copied().chain([count as u64]).collect(),
            rays,
            times: pattern.times.as_ref().map(repeated),
            weights: Some(self.weights()),
            returns: None,
            elevations_deg: pattern.elevations_deg.clone(),
            mounting: pattern.mounting.clone(),
        })
    }
}
