//! Step 4: the flux that each pencil delivers to its pixel, by equation (1) or by the radiometric model, and the
//! tables it takes. (§5)

use std::f64::consts::{FRAC_PI_4, LN_2};

use rayon::prelude::*;
use raypencil_scene::{Beam, Camera, Filter, FluxModel, Mounted, Pixel, Scene};

use crate::points::StripePoint;
use crate::tables::CameraTables;

/// What equation (1) needs of each pixel: "tables of F(phi) are computed for each camera pixel before simulation
/// starts. The cosines [...] are also pre-computed". (§5)
#[derive(Debug)]
pub(crate) struct PixelTables {
    camera: Camera,
    /// cos^4(phi) of every pixel's centre, row by row.
    cos_4_phi: Vec<f64>,
    /// F(phi) of every pixel's centre by wavelength; without a filter none is needed.
    filters: Vec<(f64, Vec<f64>)>,
}

impl PixelTables {
    pub(crate) fn of(camera: &Camera, tables: &CameraTables, beams: &[Mounted<Beam>]) -> Self {
        // cos(phi) = f_c / |q|.
        let cos_4_phi = |q_length: &f64| {
            let cosine = camera.focal_length / q_length;
            (cosine * cosine) * (cosine * cosine)
        };
        let cos_4_phi = tables.q_length.par_iter().map(cos_4_phi).collect();
        let mut filters: Vec<(f64, Vec<f64>)> = Vec::new();
        for wavelength in wavelengths(camera, beams) {
            if filters.iter().all(|(known, _)| *known != wavelength) {
                filters.push((wavelength, f_phi(camera, tables, wavelength)));
            }
        }
        Self { camera: *camera, cos_4_phi, filters }
    }

    pub(crate) fn are_of(&self, camera: &Camera, beams: &[Mounted<Beam>]) -> bool {
        self.camera == *camera
            && wavelengths(camera, beams).all(|wavelength| self.f_phi(wavelength).is_some())
    }

    fn f_phi(&self, wavelength: f64) -> Option<&[f64]> {
        self.filters.iter().find(|(known, _)| *known == wavelength).map(|(_, table)| &table[..])
    }
}

/// F(phi) of every pixel's centre, row by row.
fn f_phi(camera: &Camera, tables: &CameraTables, wavelength: f64) -> Vec<f64> {
    let mut of_pixels = vec![0.0; tables.q_length.len()];
    let width = camera.width as usize;
    of_pixels.par_chunks_mut(width).enumerate().for_each(|(j, row)| {
        let y = tables.y.centre(j as u32);
        let q_lengths = &tables.q_length[j * width..][..width];
        for ((f_phi, x), q_length) in row.iter_mut().zip(tables.x.centres()).zip(q_lengths) {
            let sin_squared = (x * x + y * y) / (q_length * q_length);
            *f_phi = pass(camera.lens.filter, wavelength, sin_squared);
        }
    });
    of_pixels
}

/// The wavelengths that a filter is asked about.
fn wavelengths(camera: &Camera, beams: &[Mounted<Beam>]) -> impl Iterator<Item = f64> {
    let filters = camera.lens.filter != Filter::None;
    beams.iter().filter(move |_| filters).map(|beam| beam.sensor.wavelength)
}

/// F(phi): how much of the light a filter lets through.
fn pass(filter: Filter, wavelength: f64, sin_squared: f64) -> f64 {
    match filter {
        Filter::None => 1.0,
        Filter::Interference { centre, width, index } => {
            // Rounding may take a sine of grazing light a little beyond 1.
            let seen_centre = centre * (1.0 - sin_squared / (index * index)).max(0.0).sqrt();
            let off = (wavelength - seen_centre) / width;
            libm::exp(-4.0 * LN_2 * (off * off))
        }
    }
}

/// The flux of one beam's pencils.
#[derive(Debug)]
pub(crate) struct Flux<'a> {
    camera: &'a Camera,
    wavelength: f64,
    /// sigma, 1/m.
    attenuation: f64,
    model: Model<'a>,
}

#[derive(Debug)]
enum Model<'a> {
    Radiometric,
    Eq1 { tables: &'a PixelTables, f_phi: Option<&'a [f64]> },
}

impl<'a> Flux<'a> {
    /// `tables` are wanted by equation (1).
    pub(crate) fn new(scene: &'a Scene, beam: &Beam, tables: Option<&'a PixelTables>) -> Self {
        let model = match (scene.flux_model(), tables) {
            (FluxModel::Eq1, Some(tables)) => Model::Eq1 { tables, f_phi: tables.f_phi(beam.wavelength) },
            _ => Model::Radiometric,
        };
        Self {
            camera: &scene.camera().sensor,
            wavelength: beam.wavelength,
            attenuation: scene.atmosphere().attenuation,
            model,
        }
    }

    /// I_k of a visible point in a pixel: `share` is P_k, watts, `reflectivity` r_d.
    pub(crate) fn of(&self, share: f64, reflectivity: f64, point: &StripePoint, pixel: Pixel) -> f64 {
        let camera = self.camera;
        let (c_loss, f_c, aperture) = (camera.lens.transmission, camera.focal_length, camera.aperture);
        let (big_r, r) = (point.range, point.depth);
        match &self.model {
            // What P_k watts really deliver: a Lambertian patch, r_d/pi per steradian, seen through the aperture
            // (pi D^2/4) cos(phi) at the distance d = r / cos(phi). phi is the ray's own.
            Model::Radiometric => {
                let f_phi = pass(camera.lens.filter, self.wavelength, point.sin_squared);
                let cos_3_phi = point.cos_off_axis * point.cos_off_axis * point.cos_off_axis;
                share
                    * reflectivity
                    * c_loss
                    * f_phi
                    * (0.25 * aperture * aperture)
                    * point.cos_view
                    * cos_3_phi
                    / (r * r)
                    * self.transmission(big_r + point.distance)
            }
            // Equation (1) as printed, W/m; phi is that of the pixel's centre, from the tables.
            Model::Eq1 { tables, f_phi } => {
                // CHOICE: the laser behind the face (a back that rule 1b as printed has let be hit) delivers
                // nothing: power is not negative.
                if !(point.cos_incidence > 0.0) {
                    return 0.0;
                }
                let of_pixel = pixel.j as usize * camera.width as usize + pixel.i as usize;
                let f_phi = f_phi.map_or(1.0, |table| table[of_pixel]);
                let cos_4_phi = tables.cos_4_phi[of_pixel];
                let d_over_f = aperture / f_c;
                let a_cp = camera.pixel_pitch[0] * camera.pixel_pitch[1];
                share
                    * reflectivity
                    * FRAC_PI_4
                    * (d_over_f * d_over_f)
                    * c_loss
                    * f_phi
                    * a_cp
                    * cos_4_phi
                    * point.cos_view
                    * point.cos_incidence
                    / (big_r * (r * r))
                    * self.transmission(r)
                    * self.transmission(big_r)
            }
        }
    }

    /// e^(-sigma length).
    ///
    /// DIFFERENCE: the paper pre-computes "attenuation factors" too. A table of them over R and r would have to be
    /// interpolated; only visible points ask.
    fn transmission(&self, length: f64) -> f64 {
        libm::exp(-self.attenuation * length)
    }
}
