//! What surfaces and air leave of the light of an echo.

use crate::SceneError;
use crate::error::check_range;

/// Greatest extinction, 1/m: of a micrometre's way.
const MAX_EXTINCTION_PER_M: f64 = 1e6;

/// The light that comes back from a small spot on a diffuse surface, beside its angle and its range: r e^(-2 sigma R).
///
/// The air takes the share 1 - e^(-sigma R) on the way there, and the same on the way back. (Law of Beer and Lambert; R. H. Rasshofer, M. Spies and
/// H. Spies, "Influences of weather phenomena on automotive laser radar systems", Advances in Radio Science 9, 2011)
///
/// ```
/// use raypencil_scene::pattern::EchoLight;
///
/// // One surface, no air.
/// assert_eq!(EchoLight::default(), EchoLight { reflectivity: 1.0, extinction_per_m: 0.0 });
/// let error = EchoLight { extinction_per_m: -0.1, ..EchoLight::default() }.validate("rays 0").unwrap_err();
/// assert_eq!(error.to_string(), "rays 0.extinction is -0.1: expected 0 to 1000000 1/m");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EchoLight {
    /// Share of the light that surfaces return, of all of them the same.
    pub reflectivity: f64,
    /// Extinction coefficient sigma of the air, 1/m.
    pub extinction_per_m: f64,
}

impl Default for EchoLight {
    fn default() -> Self {
        Self { reflectivity: 1.0, extinction_per_m: 0.0 }
    }
}

impl EchoLight {
    /// What is left of the light of a spot at this range.
    ///
    /// ```
    /// use raypencil_scene::pattern::EchoLight;
    ///
    /// let fog = EchoLight { reflectivity: 0.5, extinction_per_m: 0.01 };
    /// assert!((fog.left(50.0) - 0.5 * (-1.0_f64).exp()).abs() < 1e-16);
    /// assert_eq!(EchoLight::default().left(50.0), 1.0);
    /// ```
    pub fn left(&self, range_m: f64) -> f64 {
        self.reflectivity * libm::exp(-2.0 * self.extinction_per_m * range_m)
    }

    /// Refuses what no surface and no air have. `field` names their owner.
    ///
    /// # Errors
    /// Names the part that is wrong, its value and what is expected.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(|| format!("{field}.reflectivity"), self.reflectivity, 0.0, 1.0, "")?;
        let extinction = self.extinction_per_m;
        check_range(|| format!("{field}.extinction"), extinction, 0.0, MAX_EXTINCTION_PER_M, "1/m")
    }
}
