//! Diffraction pattern of a round aperture. (Born and Wolf, Principles of Optics, 8.5.2; the paper's reference 1)

use std::f64::consts::PI;

/// Argument v = pi r / (lambda N) of a point `radius` metres from the centre of the pattern.
fn argument(radius: f64, wavelength: f64, f_number: f64) -> f64 {
    PI * radius / (wavelength * f_number)
}

/// Irradiance at `radius` metres from the centre, relative to the centre: (2 J1(v) / v)^2.
pub fn airy_pattern(radius: f64, wavelength: f64, f_number: f64) -> f64 {
    let v = argument(radius, wavelength, f_number);
    // 2 J1(v) / v = 1 - v^2 / 8 + ...: 1 to the last bit.
    if v.abs() < 1e-8 {
        return 1.0;
    }
    let amplitude = 2.0 * libm::j1(v) / v;
    amplitude * amplitude
}

/// Fraction of the light within `radius` metres of the centre: 1 - J0(v)^2 - J1(v)^2.
///
/// ```
/// use raypencil_sensor::encircled_energy;
///
/// // The first dark ring of f/4 at 810 nm is at 1.22 * 810 nm * 4 and encloses 83.8 %. (Born and Wolf, table 8.2)
/// assert!((encircled_energy(1.22 * 810e-9 * 4.0, 810e-9, 4.0) - 0.838).abs() < 5e-4);
/// ```
pub fn encircled_energy(radius: f64, wavelength: f64, f_number: f64) -> f64 {
    let v = argument(radius, wavelength, f_number);
    let (j0, j1) = (libm::j0(v), libm::j1(v));
    1.0 - j0 * j0 - j1 * j1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_dark_ring_is_at_1_22_wavelengths_times_the_f_number() {
        // The first zero of J1 is 3.8317059702, that is 1.2196698913 pi.
        let (wavelength, f_number) = (810e-9, 4.0);
        let zero = 1.219_669_891_3 * wavelength * f_number;
        assert!(airy_pattern(zero, wavelength, f_number) < 1e-18);
        assert!(airy_pattern(0.97 * zero, wavelength, f_number) > 1e-4);
        assert!(airy_pattern(1.03 * zero, wavelength, f_number) > 1e-4);
        // The pattern decreases all the way to it.
        let mut last = 1.0;
        for step in 1..=100 {
            let here = airy_pattern(zero * f64::from(step) / 100.0, wavelength, f_number);
            assert!(here < last);
            last = here;
        }
        assert_eq!(airy_pattern(0.0, wavelength, f_number), 1.0);
    }

    #[test]
    fn rings_hold_what_the_textbook_says() {
        // Born and Wolf, table 8.2: 83.8, 91.0 and 93.8 % within the first three dark rings.
        for (zero, share) in [(1.220, 0.838), (2.233, 0.910), (3.238, 0.938)] {
            assert!((encircled_energy(zero, 1.0, 1.0) - share).abs() < 5e-4);
        }
        assert_eq!(encircled_energy(0.0, 1.0, 1.0), 0.0);
    }
}
