//! Energy of a photon, and the constants of nature in it.

/// Planck constant h, J s: exact by the definition of the SI. (CODATA)
pub const PLANCK_CONSTANT: f64 = 6.626_070_15e-34;
/// Speed of light c, m/s: exact by the definition of the SI.
pub const SPEED_OF_LIGHT: f64 = 299_792_458.0;

/// Energy of a photon of this wavelength (metres), joules: h c / lambda.
///
/// ```
/// use raypencil_sensor::photon_energy;
///
/// // 810 nm: 6.62607015e-34 * 299792458 / 810e-9 = 2.452402e-19 J.
/// assert!((photon_energy(810e-9) - 2.452_402e-19).abs() < 1e-25);
/// ```
pub fn photon_energy(wavelength: f64) -> f64 {
    PLANCK_CONSTANT * SPEED_OF_LIGHT / wavelength
}
