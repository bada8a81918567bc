//! Step 4: the flux that each pencil delivers into its pixel, by equation (1) or by the radiometric model, and the
//! tables for it. (§3, step 4; §5)

use std::f64::consts::{FRAC_PI_4, LN_2};

use rayon::prelude::*;
use raypencil_scene::{Beam, Camera, Filter, FluxModel, Mounted, Pixel, Scene};

use crate::points::StripePoint;
use crate::tables::CameraTables;

/// The terms of equation (1) that depend on the pixel: "tables of F(phi) are computed for each camera pixel before
/// simulation starts. The cosines [...] are also pre-computed". (§5)
#[derive(Debug)]
pub(crate) struct PixelTables {
    camera: Camera,
    /// cos^4(phi) of every pixel's centre, row by row.
    cos_4_phi: Vec<f64>,
    /// F(phi) of every pixel's centre, row by row, for each wavelength in metres. Empty without a filter.
    filters: Vec<(f64, Vec<f64>)>,
}

impl PixelTables {
    pub(crate) fn new(camera: &Camera, tables: &CameraTables, beams: &[Mounted<Beam>]) -> Self {
        // cos(phi) = f_c / |q|.
        let cos_4_phi = |q_length: &f64| {
            let cosine = camera.focal_length / q_length;
            (cosine * cosine) * (cosine * cosine)
        };
        let cos_4_phi = tables.q_length.par_iter().map(cos_4_phi).collect();
        let mut filters: Vec<(f64, Vec<f64>)> = Vec::new();
        for wavelength in filtered_wavelengths(camera, beams) {
            if filters.iter().all(|(known, _)| *known != wavelength) {
                filters.push((wavelength, f_phi_table(camera, tables, wavelength)));
            }
        }
        Self { camera: *camera, cos_4_phi, filters }
    }

    /// Whether these tables serve `camera` and `beams`.
    pub(crate) fn fit(&self, camera: &Camera, beams: &[Mounted<Beam>]) -> bool {
        self.camera == *camera
            && filtered_wavelengths(camera, beams).all(|wavelength| self.f_phi(wavelength).is_some())
    }

    fn f_phi(&self, wavelength: f64) -> Option<&[f64]> {
        self.filters.iter().find(|(known, _)| *known == wavelength).map(|(_, table)| &table[..])
    }
}

/// F(phi) of every pixel's centre, row by row.
fn f_phi_table(camera: &Camera, tables: &CameraTables, wavelength: f64) -> Vec<f64> {
    let mut table = vec![0.0; tables.q_length.len()];
    let width = camera.width as usize;
    table.par_chunks_mut(width).enumerate().for_each(|(j, row)| {
        let y = tables.y.centre(j as u32);
        let q_lengths = &tables.q_length[j * width..][..width];
        for ((f_phi, x), q_length) in row.iter_mut().zip(tables.x.centres()).zip(q_lengths) {
            let sin_squared = (x * x + y * y) / (q_length * q_length);
            *f_phi = filter_transmittance(camera.lens.filter, wavelength, sin_squared);
        }
    });
    table
}

/// The wavelengths for which F(phi) is needed, metres: those of all beams if the lens has a filter, else none.
fn filtered_wavelengths(camera: &Camera, beams: &[Mounted<Beam>]) -> impl Iterator<Item = f64> {
    let has_filter = camera.lens.filter != Filter::None;
    beams.iter().filter(move |_| has_filter).map(|beam| beam.sensor.wavelength)
}

/// F(phi): the fraction of the light that a filter transmits, by sin^2(phi).
fn filter_transmittance(filter: Filter, wavelength: f64, sin_squared: f64) -> f64 {
    match filter {
        Filter::None => 1.0,
        Filter::Interference { centre, width, index } => {
            // Rounding may take the sine of grazing light a little beyond 1.
            let shifted_centre = centre * (1.0 - sin_squared / (index * index)).max(0.0).sqrt();
            let widths = (wavelength - shifted_centre) / width;
            libm::exp(-4.0 * LN_2 * (widths * widths))
        }
    }
}

/// The flux of one beam's pencils.
#[derive(Debug)]
pub(crate) struct BeamFlux<'a> {
    camera: &'a Camera,
    wavelength: f64,
    /// sigma, 1/m.
    attenuation: f64,
    equation: Equation<'a>,
}

#[derive(Debug)]
enum Equation<'a> {
    Radiometric,
    Eq1 { tables: &'a PixelTables, f_phi: Option<&'a [f64]> },
}

impl<'a> BeamFlux<'a> {
    /// Equation (1) needs `tables`.
    pub(crate) fn new(scene: &'a Scene, beam: &Beam, tables: Option<&'a PixelTables>) -> Self {
        let equation = match (scene.flux_model(), tables) {
            (FluxModel::Eq1, Some(tables)) => Equation::Eq1 { tables, f_phi: tables.f_phi(beam.wavelength) },
            _ => Equation::Radiometric,
        };
        Self {
            camera: &scene.camera().sensor,
            wavelength: beam.wavelength,
            attenuation: scene.atmosphere().attenuation,
            equation,
        }
    }

    /// I_k of a visible point, into its pixel, watts (`eq1`: W/m). `power` is P_k, watts; `reflectivity` is r_d.
    pub(crate) fn flux(&self, power: f64, reflectivity: f64, point: &StripePoint, pixel: Pixel) -> f64 {
        let camera = self.camera;
        let (c_loss, f_c, aperture) = (camera.lens.transmission, camera.focal_length, camera.aperture);
        let (big_r, r) = (point.range, point.depth);
        match &self.equation {
            // What P_k watts deliver: a Lambertian patch, r_d/pi per steradian, seen through the aperture
            // (pi D^2/4) cos(phi) at the distance d = r / cos(phi). phi is the ray's own.
            Equation::Radiometric => {
                let f_phi = filter_transmittance(camera.lens.filter, self.wavelength, point.sin_squared_phi);
                let cos_3_phi = point.cos_phi * point.cos_phi * point.cos_phi;
                power
                    * reflectivity
                    * c_loss
                    * f_phi
                    * (0.25 * aperture * aperture)
                    * point.cos_theta
                    * cos_3_phi
                    / (r * r)
                    * self.air_transmittance(big_r + point.distance)
            }
            // Equation (1) as printed, W/m. phi is that of the pixel's centre, from the tables.
            Equation::Eq1 { tables, f_phi } => {
                // CHOICE: a laser behind the face (possible where rule 1b as printed adds a hit on a back) delivers
                // nothing, since power is not negative.
                if !(point.cos_psi > 0.0) {
                    return 0.0;
                }
                let index = pixel.j as usize * camera.width as usize + pixel.i as usize;
                let f_phi = f_phi.map_or(1.0, |table| table[index]);
                let cos_4_phi = tables.cos_4_phi[index];
                let d_over_f = aperture / f_c;
                let a_cp = camera.pixel_pitch[0] * camera.pixel_pitch[1];
                power
                    * reflectivity
                    * FRAC_PI_4
                    * (d_over_f * d_over_f)
                    * c_loss
                    * f_phi
                    * a_cp
                    * cos_4_phi
                    * point.cos_theta
                    * point.cos_psi
                    / (big_r * (r * r))
                    * self.air_transmittance(r)
                    * self.air_transmittance(big_r)
            }
        }
    }

    /// e^(-sigma length), `length` in metres.
    ///
    /// DIFFERENCE: the paper pre-computes "attenuation factors" too. A table of them over R and r would have to be
    /// interpolated; here they are computed, for visible points only.
    fn air_transmittance(&self, length: f64) -> f64 {
        libm::exp(-self.attenuation * length)
    }
}
