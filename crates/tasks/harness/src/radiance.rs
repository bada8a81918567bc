//! A candidate's radiance along single rays, which is not random, against the closed form
//!
//! ```text
//! L = r_d E / pi,    E = (I_b / T) p(x) (g / cos^2(alpha)) (1 / R) cos(psi) exp(-sigma R)
//! ```
//!
//! with x = g tan(alpha) the position on the grid, T the sheet's thickness and p(x) the share of the power per metre of
//! x. For the paper's profile p = cos(alpha) / 2w, and E is the (I_b / A_b)(R_g / R) cos(psi) of
//! docs/theory/radiometry.md. The other profiles are divided by their integral over the fan, not by their sum over the
//! pencils: this light is not divided into pencils.

use glam::DVec3;
use raypencil_judge::GroundTruth;
use raypencil_scene::{Beam, Mounted, Place, Profile, Scene, SensorId};

use crate::candidate::RadianceMap;

/// Maximum relative error of radiance computed in single precision. Tuned: some 80 roundings.
const MAX_RELATIVE_ERROR: f64 = 5e-6;

/// Relative half-width of the sheet's border, 16 roundings in single precision. A point nearer to the border may be lit
/// or dark.
const BORDER_HALF_WIDTH: f64 = 16.0 / (1 << 24) as f64;

/// The comparison of a radiance map with the closed form; the counts are numbers of rays.
#[derive(Debug, Clone, PartialEq)]
pub struct RadianceComparison {
    /// The sensor whose rays these are.
    pub sensor: SensorId,
    /// Index of the beam whose light it is.
    pub beam: usize,
    /// Rays that hit terrain lit by that beam and have radiance: they are compared.
    pub lit: u64,
    /// Rays that hit unlit terrain, or nothing, and have no radiance, which is right.
    pub dark: u64,
    /// Rays that hit within the sheet and have no radiance: in a shadow or wrong, which this comparison cannot tell.
    pub shadowed: u64,
    /// Rays that are not compared: too near the sheet's border, or to a point that the camera does not see.
    pub doubtful: u64,
    /// The largest relative error of the lit rays, and its ray.
    pub worst: Option<(f64, Place)>,
    /// Rays with a relative error above 5e-6, or with radiance where there is no light.
    pub wrong: u64,
}

/// Compares a radiance map with the closed form at the exact hit points.
pub fn compare_radiance(truth: &GroundTruth<'_>, map: &RadianceMap) -> RadianceComparison {
    let scene = truth.scene();
    let light = BeamLight::of(scene, map.beam);
    let mut found = RadianceComparison {
        sensor: map.sensor,
        beam: map.beam,
        lit: 0,
        dark: 0,
        shadowed: 0,
        doubtful: 0,
        worst: None,
        wrong: 0,
    };
    for j in 0..map.image.height() {
        for i in 0..map.image.width() {
            let place = Place { sensor: map.sensor, i, j };
            let said = map.image.at(i, j);
            let Some(hit) = truth.hit(place) else {
                // Nothing is hit: a camera's ray is black, a pencil's radiance may also be NaN.
                let is_dark = said == 0.0 || (said.is_nan() && map.sensor != SensorId::Camera);
                if is_dark {
                    found.dark += 1
                } else {
                    found.wrong += 1
                }
                continue;
            };
            // The camera does not see this pencil's hit: its ray there meets another point.
            if map.sensor != SensorId::Camera && !truth.visibility(place).0 {
                found.doubtful += 1;
                continue;
            }
            match light.at(hit.point, hit.normal, reflectivity(scene, hit.face.0)) {
                Lighting::Unsure => found.doubtful += 1,
                Lighting::Dark if said == 0.0 => found.dark += 1,
                Lighting::Dark => found.wrong += 1,
                Lighting::Radiance(_) if said == 0.0 && map.sensor == SensorId::Camera => found.shadowed += 1,
                Lighting::Radiance(exact) => {
                    let off = (said / exact - 1.0).abs();
                    found.lit += 1;
                    found.wrong += u64::from(off.is_nan() || off > MAX_RELATIVE_ERROR);
                    if found.worst.is_none_or(|(worst, _)| off > worst || off.is_nan()) {
                        found.worst = Some((off, place));
                    }
                }
            }
        }
    }
    found
}

/// Reflectivity of a face's material.
fn reflectivity(scene: &Scene, face: u32) -> f64 {
    let mesh = scene.mesh();
    mesh.materials()[mesh.face_materials()[face as usize] as usize].reflectivity
}

/// How a beam lights a point.
enum Lighting {
    /// No light: the point is outside the sheet, or the face shows its back.
    Dark,
    /// Too near the sheet's border to tell in single precision.
    Unsure,
    /// The radiance if nothing stands in between, W m^-2 sr^-1.
    Radiance(f64),
}

/// A beam's light as a function of the point.
struct BeamLight<'a> {
    scene: &'a Scene,
    beam: &'a Mounted<Beam>,
    /// Integral of the profile's weight over x, metres; 2w for the paper's profile.
    integral: f64,
}

impl<'a> BeamLight<'a> {
    fn of(scene: &'a Scene, beam: usize) -> Self {
        let beam = &scene.beams()[beam];
        Self { scene, beam, integral: integral(&beam.sensor) }
    }

    fn at(&self, point: DVec3, normal: DVec3, reflectivity: f64) -> Lighting {
        let pose = self.beam.scene_from_sensor;
        let Beam { thickness, grid_distance: g, half_width, max_range, power, .. } = self.beam.sensor;
        let turned = pose.inverse();
        let DVec3 { x, y, z } = turned.rotate(point - pose.position);
        let range = libm::hypot(x, z);
        // Distances inside the sheet's thickness, its fan and its two ends, metres.
        let inside =
            [0.5 * thickness - y.abs(), (half_width * z - x.abs() * g) / g, z - g, max_range - range];
        let inside = inside.into_iter().fold(f64::INFINITY, f64::min);
        if inside.abs() <= BORDER_HALF_WIDTH * (1.0 + point.length()) {
            return Lighting::Unsure;
        }
        let cos_incidence = -pose.rotate(DVec3::new(x, 0.0, z)).dot(normal) / range;
        if inside < 0.0 || cos_incidence <= 0.0 {
            return Lighting::Dark;
        }
        let alpha = libm::atan(x / z);
        let cos = z / range;
        let density = weight(&self.beam.sensor, alpha) / self.integral;
        let attenuation = self.scene.atmosphere().attenuation;
        let irradiance = power / thickness * density * g / (cos * cos) / range
            * cos_incidence
            * libm::exp(-attenuation * range);
        Lighting::Radiance(reflectivity * irradiance / std::f64::consts::PI)
    }
}

/// Weight of a beam's profile at an angle to its axis, radians.
fn weight(beam: &Beam, alpha: f64) -> f64 {
    let cos = libm::cos(alpha);
    match beam.profile {
        Profile::Paper => cos,
        Profile::UniformAngle => cos * cos,
        Profile::Gaussian { half_width } => libm::exp(-2.0 * (alpha / half_width) * (alpha / half_width)),
    }
}

/// Divisor of the weight: the grid's width for the paper's profile, as printed; the integral of the weight over that
/// width for the others, metres. (Simpson's rule over `PARTS` parts. Its error is below 1e-9 for fans up to 170 degrees
/// and Gaussians of a tenth of the fan.)
fn integral(beam: &Beam) -> f64 {
    const PARTS: u32 = 20_000;
    let (g, w) = (beam.grid_distance, beam.half_width);
    if beam.profile == Profile::Paper {
        return 2.0 * w;
    }
    let step = 2.0 * w / f64::from(PARTS);
    let at = |part: u32| weight(beam, libm::atan((f64::from(part) * step - w) / g));
    let inner: f64 = (1..PARTS).map(|part| if part % 2 == 1 { 4.0 * at(part) } else { 2.0 * at(part) }).sum();
    (at(0) + inner + at(PARTS)) * step / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn beam(profile: Profile) -> Beam {
        Beam {
            columns: 8,
            rows: 2,
            thickness: 0.004,
            grid_distance: 0.1,
            half_width: 0.1,
            max_range: 20.0,
            power: 2.0,
            wavelength: 810e-9,
            profile,
        }
    }

    #[test]
    fn integrals_match_those_by_hand() {
        // g = w = 0.1: 45 degrees to either side. cos^2(alpha) dx = g dalpha: 0.1 pi / 2.
        assert_eq!(integral(&beam(Profile::Paper)), 0.2);
        let uniform = integral(&beam(Profile::UniformAngle));
        assert!((uniform - 0.05 * std::f64::consts::PI).abs() < 1e-12, "{uniform}");
        // A Gaussian so wide that it is flat: the grid's width.
        let flat = integral(&beam(Profile::Gaussian { half_width: 1e3 }));
        assert!((flat - 0.2).abs() < 1e-6, "{flat}");
        // So narrow that tan(alpha) = alpha + alpha^3 / 3 tells: g (h sqrt(pi/2)) (1 + h^2 / 4 + ...), h = 0.01; with
        // the mean of alpha^2 being h^2 / 4, that of sec^2 is 1 + h^2 / 4.
        let h = 0.01;
        let narrow = integral(&beam(Profile::Gaussian { half_width: h }));
        let by_hand = 0.1 * h * (0.5 * std::f64::consts::PI).sqrt() * (1.0 + h * h / 4.0);
        assert!((narrow / by_hand - 1.0).abs() < 1e-8, "{narrow} {by_hand}");
    }
}
