//! Radiance along single rays, without chance, against the closed form
//!
//! ```text
//! L = r_d E / pi,    E = (I_b / T) p(x) (g / cos^2(alpha)) (1 / R) cos(psi) exp(-sigma R)
//! ```
//!
//! with x = g tan(alpha) the place on the grid, T the sheet's thickness and p(x) the part of the power per metre of x. For
//! the paper's profile p = cos(alpha) / 2w, and E is the (I_b / A_b)(R_g / R) cos(psi) of docs/theory/radiometry.md. The others are
//! here divided by their integral over the fan, not by the sum over the pencils, for this light knows of no pencils.

use glam::DVec3;

use crate::candidate::RadianceMap;
use raypencil_judge::GroundTruth;
use raypencil_scene::Place;
use raypencil_scene::{Beam, Profile, Scene, SensorId};

/// How far radiance that was computed in single precision may be off, relative. Tuned: some 80 roundings.
const LARGEST_OFF: f64 = 5e-6;

/// Points nearer than this to the border of the sheet, as a part of their coordinates, may be taken for lit or dark in
/// single precision: 16 roundings.
const BORDER: f64 = 16.0 / (1 << 24) as f64;

/// How the radiance along a sensor's rays fares.
#[derive(Debug, Clone, PartialEq)]
pub struct RadianceComparison {
    /// Whose rays.
    pub sensor: SensorId,
    /// Which beam's light.
    pub beam: usize,
    /// Rays that end on ground lit by that beam, on both sides: their radiance is compared.
    pub lit: u64,
    /// Rays that end outside the sheet, or nowhere, and have no radiance, as is right.
    pub dark: u64,
    /// Rays that end within the sheet and have no radiance: in a shadow, or wrong; nothing here tells.
    pub shadowed: u64,
    /// Rays too near the sheet's border to be sure.
    pub doubtful: u64,
    /// The largest relative error of the lit ones, and where.
    pub worst: Option<(f64, Place)>,
    /// Rays that are off by more than 5e-6 of the radiance, or have radiance where there is no light.
    pub wrong: u64,
}

/// Compares a map of radiance with the closed form at the exact points that the rays hit.
pub fn compare_radiance(truth: &GroundTruth<'_>, map: &RadianceMap) -> RadianceComparison {
    let scene = truth.scene();
    let light = Light::of(scene, map.beam);
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
                // Nothing is hit: a camera sees black, and of a pencil there is nothing to say.
                let is_dark = said == 0.0 || (said.is_nan() && map.sensor != SensorId::Camera);
                if is_dark {
                    found.dark += 1
                } else {
                    found.wrong += 1
                }
                continue;
            };
            // Of a pencil that the camera does not see, its ray shows something else.
            if map.sensor != SensorId::Camera && !truth.visibility(place).0 {
                found.doubtful += 1;
                continue;
            }
            match light.radiance(hit.point, hit.normal, reflectivity(scene, hit.face.0)) {
                Lit::Unsure => found.doubtful += 1,
                Lit::Dark if said == 0.0 => found.dark += 1,
                Lit::Dark => found.wrong += 1,
                Lit::By(_) if said == 0.0 && map.sensor == SensorId::Camera => found.shadowed += 1,
                Lit::By(exact) => {
                    let off = (said / exact - 1.0).abs();
                    found.lit += 1;
                    found.wrong += u64::from(off.is_nan() || off > LARGEST_OFF);
                    if found.worst.is_none_or(|(worst, _)| off > worst || off.is_nan()) {
                        found.worst = Some((off, place));
                    }
                }
            }
        }
    }
    found
}

fn reflectivity(scene: &Scene, face: u32) -> f64 {
    let mesh = scene.mesh();
    mesh.materials()[mesh.face_materials()[face as usize] as usize].reflectivity
}

/// What light falls on a point.
enum Lit {
    /// None: it is outside the sheet, or its back is lit.
    Dark,
    /// Too near a border to tell in single precision.
    Unsure,
    /// So much radiance, if nothing stands in between, W m^-2 sr^-1.
    By(f64),
}

/// A beam's light as a function of the point.
struct Light<'a> {
    scene: &'a Scene,
    beam: &'a raypencil_scene::Mounted<Beam>,
    /// The integral of the profile's weight over x, or 2w for the paper's.
    integral: f64,
}

impl<'a> Light<'a> {
    fn of(scene: &'a Scene, beam: usize) -> Self {
        let beam = &scene.beams()[beam];
        Self { scene, beam, integral: integral(&beam.sensor) }
    }

    fn radiance(&self, point: DVec3, normal: DVec3, reflectivity: f64) -> Lit {
        let pose = self.beam.scene_from_sensor;
        let Beam { thickness, grid_distance: g, half_width, max_range, power, .. } = self.beam.sensor;
        let turned = pose.inverse();
        let DVec3 { x, y, z } = turned.rotate(point - pose.position);
        let range = libm::hypot(x, z);
        // How far inside the sheet it is, by its thickness, its fan and its ends, metres.
        let inside =
            [0.5 * thickness - y.abs(), (half_width * z - x.abs() * g) / g, z - g, max_range - range];
        let inside = inside.into_iter().fold(f64::INFINITY, f64::min);
        if inside.abs() <= BORDER * (1.0 + point.length()) {
            return Lit::Unsure;
        }
        let cos_incidence = -pose.rotate(DVec3::new(x, 0.0, z)).dot(normal) / range;
        if inside < 0.0 || cos_incidence <= 0.0 {
            return Lit::Dark;
        }
        let alpha = libm::atan(x / z);
        let cos = z / range;
        let density = weight(&self.beam.sensor, alpha) / self.integral;
        let attenuation = self.scene.atmosphere().attenuation;
        let irradiance = power / thickness * density * g / (cos * cos) / range
            * cos_incidence
            * libm::exp(-attenuation * range);
        Lit::By(reflectivity * irradiance / std::f64::consts::PI)
    }
}

/// The weight of a pencil of a beam's grid by its angle.
fn weight(beam: &Beam, alpha: f64) -> f64 {
    let cos = libm::cos(alpha);
    match beam.profile {
        Profile::Paper => cos,
        Profile::UniformAngle => cos * cos,
        Profile::Gaussian { half_width } => libm::exp(-2.0 * (alpha / half_width) * (alpha / half_width)),
    }
}

/// What the weight is divided by: for the paper's profile the grid's width, as printed, for the others the integral
/// of the weight over it. (Simpson's rule over `PARTS` parts: of fans up to 170 degrees and Gaussians of a tenth of
/// the fan off by less than 1e-9.)
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
    fn integrals_are_those_by_hand() {
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
