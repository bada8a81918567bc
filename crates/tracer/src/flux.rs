//! The flux that one visible pencil delivers into its pixel. (Paper, §5, equation (1); contract: flux)

use std::f64::consts::{LN_2, PI};

use glam::DVec3;
use raypencil_scene::{Filter, FluxModel, Scene};

/// What is the same for all pencils of a beam.
#[derive(Debug)]
pub(crate) struct Light {
    model: FluxModel,
    /// sigma, 1/m.
    attenuation: f64,
    /// C_loss.
    transmission: f64,
    filter: Filter,
    /// Of the beam, metres.
    wavelength: f64,
    /// D, metres.
    aperture: f64,
    /// f_c, metres.
    focal_length: f64,
    /// A_cp, square metres.
    pixel_area: f64,
}

/// The way of a pencil's light, from the beam to the ground and on into the camera.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Path {
    /// P_k, watts.
    pub(crate) power: f64,
    /// R: from the beam to the point along the pencil, metres.
    pub(crate) range: f64,
    /// cos(psi).
    pub(crate) cos_incidence: f64,
    /// r_d.
    pub(crate) reflectivity: f64,
    /// cos(theta).
    pub(crate) cos_view: f64,
    /// r: *along the camera's normal axis*, metres.
    pub(crate) depth: f64,
    /// d: from the point to the projection centre, metres.
    pub(crate) distance: f64,
    /// The point in the camera frame, metres: the ray's own phi.
    pub(crate) point: DVec3,
    /// Through the middle of the receiving pixel, camera frame, metres: the pixel's phi.
    pub(crate) through_middle: DVec3,
}

impl Light {
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
    pub(crate) fn flux(&self, path: &Path) -> f64 {
        let Path { power, range, cos_incidence, reflectivity, cos_view, depth, distance, .. } = *path;
        let Self { attenuation: sigma, transmission, aperture, .. } = *self;
        match self.model {
            // P_k r_d C_loss F(phi) (D^2 / 4) cos(theta) cos^3(phi) / r^2 e^(-sigma (R + d)): a Lambertian
            // patch, r_d / pi per steradian, seen through the aperture (pi D^2 / 4) cos(phi) at d = r / cos(phi).
            // (Contract: `radiometric`)
            FluxModel::Radiometric => {
                let cos_phi = depth / distance;
                let solid_angle = aperture * aperture / 4.0 * (cos_phi * cos_phi * cos_phi) / (depth * depth);
                let lens = transmission * self.filter(path.point);
                let air = libm::exp(-sigma * (range + distance));
                power * reflectivity * cos_view * solid_angle * lens * air
            }
            // I_b r_d (pi / 4) (D / f_c)^2 C_loss F(phi) A_cp (A_bp cos(alpha) / A_b)
            // cos^4(phi) cos(theta) cos(psi) / (R r^2) e^(-sigma r) e^(-sigma R), phi of the pixel. (Equation (1))
            FluxModel::Eq1 => {
                let q = path.through_middle;
                let cos_phi_squared = q.z * q.z / q.length_squared();
                let stop = aperture / self.focal_length;
                let extended =
                    PI / 4.0 * (stop * stop) * self.pixel_area * (cos_phi_squared * cos_phi_squared);
                let lens = transmission * self.filter(q);
                let air = libm::exp(-sigma * depth) * libm::exp(-sigma * range);
                let spread = cos_view * cos_incidence / (range * (depth * depth));
                power * reflectivity * extended * lens * spread * air
            }
        }
    }

    /// F(phi) for a ray along `q` in the camera frame.
    fn filter(&self, q: DVec3) -> f64 {
        match self.filter {
            Filter::None => 1.0,
            Filter::Interference { centre, width, index } => {
                // sin^2(phi) <= 1 also as rounded: the divisor is the dividend and something more.
                let across = q.x * q.x + q.y * q.y;
                let sin_squared = across / (across + q.z * q.z);
                let moved = centre * (1.0 - sin_squared / (index * index)).sqrt();
                let off = (self.wavelength - moved) / width;
                libm::exp(-4.0 * LN_2 * (off * off))
            }
        }
    }
}
