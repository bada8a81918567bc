//! The sun-lit ground behind the stripes: why there is a filter before the lens.

use std::f64::consts::{LN_2, PI};

use glam::DVec3;
use rayon::prelude::*;
use raypencil_scene::{Camera, Filter, Image, Maybe, SceneError};

use crate::check::{assert_same_size, check_range};

/// Spectral irradiance of the sun at 1 AU near 810 nm, W/m^2 per metre of wavelength: 1.110 W/m^2/nm, the mean of the
/// ten rows 801 to 819 nm of ASTM E490-00a (1142, 1129, 1115, 1120, 1095, 1114, 1115, 1107, 1104 and
/// 1063 W/m^2/um). ASTM G173-03 has 1.110 at 810 nm for the top of the atmosphere.
pub const SOLAR_SPECTRUM_810: f64 = 1.110e9;
/// Semi-major axis of Mars' orbit, astronomical units (J2000). Sunlight falls with its square, 2.3216.
pub const MARS_ORBIT: f64 = 1.523_679;

/// The sun and the sky, as the ground has them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sunlight {
    /// Height of the sun above the horizontal, radians.
    pub elevation: f64,
    /// Where the sun is, to the left of the global x axis, as a heading is; radians.
    pub azimuth: f64,
    /// Spectral irradiance of the sun itself on a plane that faces it, W/m^2 per metre of wavelength, at `reference`.
    pub direct: f64,
    /// That of the sky, on any face. CHOICE: it is the same from everywhere above, and faces are not shaded from it.
    pub sky: f64,
    /// The wavelength of these two, metres.
    pub reference: f64,
    /// By how much of itself the spectrum rises per metre of wavelength near there; negative beyond 500 nm.
    pub slope: f64,
    /// Width of the band that the sensor sees where there is no filter, metres.
    pub open_band: f64,
}

/// What the camera sees of the ground, pixel by pixel; maps of its central rays.
#[derive(Debug, Clone, Copy)]
pub struct Ground<'a> {
    /// Normal of the face hit, a unit in the scene frame; none where there is no hit.
    pub normal: &'a Image<Maybe<DVec3>>,
    /// Distance of the hit along the ray, metres.
    pub range: &'a Image<Maybe<f64>>,
    /// r_d of the face hit.
    pub reflectivity: &'a Image<f64>,
    /// Whether nothing stands between the hit and the sun.
    pub sunlit: &'a Image<bool>,
}

impl Sunlight {
    /// Light on Mars at its mean distance from the sun, through dust of an optical depth: 0.5 is a clear day, 1 a hazy
    /// one.
    ///
    /// The sun is dimmed by exp(-tau / sin(elevation)). CHOICE: 0.7 of what the dust takes comes down as sky light;
    /// the table of Appelbaum and Flood (1990) gives 0.75, 0.75, 0.66 and 0.71 for (tau, zenith angle) =
    /// (0.3, 40), (0.5, 0), (0.5, 60) and (1, 0 degrees), over the whole spectrum. In a dust storm it gives too much:
    /// with tau = 2 and the sun at 60 degrees a fifth.
    pub fn mars(elevation: f64, azimuth: f64, optical_depth: f64) -> Self {
        let above = SOLAR_SPECTRUM_810 / (MARS_ORBIT * MARS_ORBIT);
        let height = libm::sin(elevation).max(0.0);
        let left = if height > 0.0 { libm::exp(-optical_depth / height) } else { 0.0 };
        Self {
            elevation,
            azimuth,
            direct: above * left,
            sky: 0.7 * above * height * (1.0 - left),
            reference: 810e-9,
            // From 1144 W/m^2/um about 795 nm to 1075 about 825 nm in E490; a black body of 5772 K has -0.00219 / nm.
            slope: -0.0021e9,
            // CHOICE: silicon's, from 400 to 1000 nm, all at the efficiency of the laser's wavelength.
            open_band: 600e-9,
        }
    }

    /// Direction towards the sun in the scene frame, a unit: (cos el cos az, cos el sin az, sin el).
    pub fn direction(&self) -> DVec3 {
        let (sin_el, cos_el) = libm::sincos(self.elevation);
        let (sin_az, cos_az) = libm::sincos(self.azimuth);
        DVec3::new(cos_el * cos_az, cos_el * sin_az, sin_el)
    }

    /// What a filter leaves of a spectral irradiance of 1 at `reference`, metres, for light at an angle phi to the
    /// camera's normal axis: the effective width of its pass band, times the slope of the spectrum.
    ///
    /// The band of an interference filter is a Gaussian about centre(phi) = centre sqrt(1 - (sin(phi) / index)^2) of
    /// a full width `width` at half its height, whose integral over the wavelength is width sqrt(pi / (4 ln 2)) =
    /// 1.064 width at any angle; a spectrum that is a straight line has its mean at centre(phi).
    pub fn pass_band(&self, filter: Filter, sin_squared_phi: f64) -> f64 {
        match filter {
            Filter::None => self.open_band,
            Filter::Interference { centre, width, index } => {
                let moved = centre * (1.0 - sin_squared_phi / (index * index)).sqrt();
                let line = 1.0 + self.slope * (moved - self.reference);
                width * (PI / (4.0 * LN_2)).sqrt() * line.max(0.0)
            }
        }
    }

    /// The flux that sun and sky put into each pixel of the camera, watts:
    ///
    /// (pi / 4) L (D / f_c)^2 cos^4(phi) A_cp C_loss e^(-sigma d),  L = r_d / pi (E_sun max(0, n.s) + E_sky),
    ///
    /// phi of the pixel's centre, E within the pass band at phi, E_sun 0 in shadow. `attenuation` is sigma, 1/m. A
    /// pixel without a hit sees the sky, L = E_sky / pi.
    ///
    /// # Panics
    /// If the maps are not of the camera's size.
    pub fn flux(&self, camera: &Camera, attenuation: f64, ground: &Ground<'_>) -> Image<f64> {
        let mut out = Image::filled(camera.width, camera.height, 0.0);
        assert_same_size(&out, ground.normal, "normals");
        assert_same_size(&out, ground.range, "ranges");
        assert_same_size(&out, ground.reflectivity, "reflectivities");
        assert_same_size(&out, ground.sunlit, "shadows");
        let sun = self.direction();
        let stop = camera.aperture / camera.focal_length;
        let area = camera.pixel_pitch[0] * camera.pixel_pitch[1];
        let factor = PI / 4.0 * (stop * stop) * area * camera.lens.transmission;
        out.cells_mut().par_chunks_mut(camera.width.max(1) as usize).enumerate().for_each(|(j, row)| {
            for (i, flux) in row.iter_mut().enumerate() {
                let (i, j) = (i as u32, j as u32);
                let q = camera.direction(i, j);
                let across = q.x * q.x + q.y * q.y;
                let length_squared = across + q.z * q.z;
                let cos_squared = q.z * q.z / length_squared;
                let band = self.pass_band(camera.lens.filter, across / length_squared);
                let radiance = match (ground.normal.at(i, j).get(), ground.range.at(i, j).get()) {
                    (Some(normal), Some(range)) => {
                        let facing = normal.dot(sun).max(0.0);
                        let direct = if ground.sunlit.at(i, j) { self.direct * facing } else { 0.0 };
                        let air = libm::exp(-attenuation * range);
                        ground.reflectivity.at(i, j) / PI * (direct + self.sky) * air
                    }
                    _ => self.sky / PI,
                };
                *flux = factor * (cos_squared * cos_squared) * (radiance * band);
            }
        });
        out
    }

    /// Refuses light that nobody has, naming the field.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(field, "elevation", self.elevation, -PI / 2.0, PI / 2.0, "rad")?;
        check_range(field, "azimuth", self.azimuth, -2.0 * PI, 2.0 * PI, "rad")?;
        check_range(field, "direct", self.direct, 0.0, 1e12, "W/m^3")?;
        check_range(field, "sky", self.sky, 0.0, 1e12, "W/m^3")?;
        check_range(field, "reference", self.reference, 1e-8, 1e-3, "m")?;
        check_range(field, "slope", self.slope, -1e9, 1e9, "1/m")?;
        check_range(field, "open_band", self.open_band, 0.0, 1e-5, "m")
    }
}
