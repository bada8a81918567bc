//! The flux that one visible pencil delivers into its pixel. (Paper, §5, equation (1); contract: flux)

use std::f64::consts::{LN_2, PI};

use glam::DVec3;
use raypencil_scene::{Filter, FluxModel, Scene};

/// The flux model with those of its terms that all pencils of a beam share.
#[derive(Debug)]
pub(crate) struct FluxEquation {
    model: FluxModel,
    /// sigma, 1/m.
    attenuation: f64,
    /// C_loss.
    transmission: f64,
    filter: Filter,
    /// The beam's wavelength, metres.
    wavelength: f64,
    /// D, metres.
    aperture: f64,
    /// f_c, metres.
    focal_length: f64,
    /// A_cp, square metres.
    pixel_area: f64,
}

/// The terms of one pencil's light path: from the beam to the ground, and on into the camera.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LightPath {
    /// P_k, watts.
    pub(crate) power: f64,
    /// R: distance from the beam to the point along the pencil, metres.
    pub(crate) range: f64,
    /// cos(psi).
    pub(crate) cos_psi: f64,
    /// r_d.
    pub(crate) reflectivity: f64,
    /// cos(theta).
    pub(crate) cos_theta: f64,
    /// r: distance *along the camera's normal axis*, metres.
    pub(crate) depth: f64,
    /// d: distance from the point to the projection centre, metres.
    pub(crate) distance: f64,
    /// The point in the camera frame, metres. Its angle to the axis is the ray's own phi.
    pub(crate) point: DVec3,
    /// The vector through the centre of the receiving pixel, camera frame, metres. Its angle is the pixel's phi.
    pub(crate) pixel_ray: DVec3,
}

impl FluxEquation {
    pub(crate) fn new(scene: &Scene, wavelength: f64) -> Self {
        let camera = scene.camera().sensor;
        Self {
            model: scene.flux_model(),
            attenuation: scene.atmosphere().attenuation,
            transmission: camera.lens.transmission,
            filter: camera.lens.filter,
            wavelength,
            aperture: camera.aperture,
            focal_length: camera.focal_length,
            pixel_area: camera.pixel_pitch[0] * camera.pixel_pitch[1],
        }
    }

    /// I_k, watts (`eq1`: W/m).
    pub(crate) fn flux(&self, path: &LightPath) -> f64 {
        let LightPath { power, range, cos_psi, reflectivity, cos_theta, depth, distance, .. } = *path;
        let Self { attenuation: sigma, transmission, aperture, .. } = *self;
        match self.model {
            // I_k = P_k r_d C_loss F(phi) (D^2 / 4) cos(theta) cos^3(phi) / r^2 e^(-sigma (R + d)): a Lambertian
            // patch, r_d / pi per steradian, seen through the aperture (pi D^2 / 4) cos(phi) at d = r / cos(phi).
            // (Contract: `radiometric`)
            FluxModel::Radiometric => {
                let cos_phi = depth / distance;
                let solid_angle = aperture * aperture / 4.0 * (cos_phi * cos_phi * cos_phi) / (depth * depth);
                let lens = transmission * self.filter(path.point);
                let air = libm::exp(-sigma * (range + distance));
                power * reflectivity * cos_theta * solid_angle * lens * air
            }
            // I_k = I_b r_d (pi / 4) (D / f_c)^2 C_loss F(phi) A_cp (A_bp cos(alpha) / A_b)
            // cos^4(phi) cos(theta) cos(psi) / (R r^2) e^(-sigma r) e^(-sigma R), with the pixel's phi.
            // (Equation (1))
            FluxModel::Eq1 => {
                let q = path.pixel_ray;
                let cos_phi_squared = q.z * q.z / q.length_squared();
                let d_over_f = aperture / self.focal_length;
                let extended =
                    PI / 4.0 * (d_over_f * d_over_f) * self.pixel_area * (cos_phi_squared * cos_phi_squared);
                let lens = transmission * self.filter(q);
                let air = libm::exp(-sigma * depth) * libm::exp(-sigma * range);
                let spread = cos_theta * cos_psi / (range * (depth * depth));
                power * reflectivity * extended * lens * spread * air
            }
        }
    }

    /// F(phi) for a ray along `q` in the camera frame.
    fn filter(&self, q: DVec3) -> f64 {
        match self.filter {
            Filter::None => 1.0,
            Filter::Interference { centre, width, index } => {
                // sin^2(phi) <= 1 also as rounded: the divisor is the dividend plus a square.
                let across = q.x * q.x + q.y * q.y;
                let sin_squared = across / (across + q.z * q.z);
                let shifted_centre = centre * (1.0 - sin_squared / (index * index)).sqrt();
                let widths = (self.wavelength - shifted_centre) / width;
                libm::exp(-4.0 * LN_2 * (widths * widths))
            }
        }
    }
}
