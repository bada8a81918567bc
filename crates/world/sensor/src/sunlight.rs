//! Sunlight: the lit ground behind the stripes, and the reason for a filter in front of the lens.

use std::f64::consts::{LN_2, PI};

use glam::DVec3;
use rayon::prelude::*;
use raypencil_scene::{Camera, Filter, Image, Maybe, SceneError, check_range};

use crate::same_size::assert_same_size;

/// Spectral irradiance of the sun at 1 AU near 810 nm, W/m^2 per metre of wavelength: 1.110 W/m^2/nm, the mean of the
/// ten rows 801 to 819 nm of ASTM E490-00a (1142, 1129, 1115, 1120, 1095, 1114, 1115, 1107, 1104 and
/// 1063 W/m^2/um). ASTM G173-03 has 1.110 at 810 nm for the top of the atmosphere.
pub const SOLAR_IRRADIANCE_810_NM: f64 = 1.110e9;
/// Semi-major axis of Mars' orbit, astronomical units (J2000). Sunlight decreases with its square, 2.3216.
pub const MARS_SEMI_MAJOR_AXIS_AU: f64 = 1.523_679;

/// Light of the sun and the sky on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sunlight {
    /// Elevation of the sun above the horizontal, radians.
    pub elevation: f64,
    /// Azimuth of the sun, radians, counted to the left from the global x axis like a heading.
    pub azimuth: f64,
    /// Spectral irradiance of the sun alone on a plane that faces it, W/m^2 per metre of wavelength, at
    /// `reference`.
    pub direct: f64,
    /// Spectral irradiance of the sky on any face, in the same unit. CHOICE: it is the same from all directions
    /// above, and no face is shaded from it.
    pub sky: f64,
    /// Wavelength of these two, metres.
    pub reference: f64,
    /// Relative increase of the spectrum per metre of wavelength near `reference`; negative beyond 500 nm.
    pub slope: f64,
    /// Width of the sensor's own band without a filter, metres.
    pub open_band: f64,
}

/// Surface that the camera sees, pixel by pixel: maps of its central rays.
#[derive(Debug, Clone, Copy)]
pub struct VisibleSurface<'a> {
    /// Unit normal of the face hit, scene frame; none where there is no hit.
    pub normal: &'a Image<Maybe<DVec3>>,
    /// Distance of the hit along the ray, metres.
    pub range: &'a Image<Maybe<f64>>,
    /// Reflectivity r_d of the face hit.
    pub reflectivity: &'a Image<f64>,
    /// Whether nothing stands between the hit and the sun.
    pub sunlit: &'a Image<bool>,
}

impl Sunlight {
    /// Light on Mars at its mean distance from the sun, through dust of an optical depth tau: 0.5 is a clear day,
    /// 1 a hazy one. Angles are in radians.
    ///
    /// The sun is dimmed by exp(-tau / sin(elevation)). CHOICE: 0.7 of the light that the dust removes arrives as
    /// sky light. The table of Appelbaum and Flood (1990) gives 0.75, 0.75, 0.66 and 0.71 for (tau, zenith angle)
    /// = (0.3, 40), (0.5, 0), (0.5, 60) and (1, 0 degrees), over the whole spectrum. In a dust storm it is too
    /// much: a fifth for tau = 2 and the sun at 60 degrees.
    ///
    /// ```
    /// use raypencil_sensor::{MARS_SEMI_MAJOR_AXIS_AU, SOLAR_IRRADIANCE_810_NM, Sunlight};
    ///
    /// // Without dust the sun at the zenith is the solar spectrum over the squared distance, 1.110 / 2.3216 W/m^2/nm.
    /// let sun = Sunlight::mars(std::f64::consts::FRAC_PI_2, 0.0, 0.0);
    /// let above = SOLAR_IRRADIANCE_810_NM / (MARS_SEMI_MAJOR_AXIS_AU * MARS_SEMI_MAJOR_AXIS_AU);
    /// assert_eq!(sun.direct, above);
    /// assert_eq!(sun.sky, 0.0);
    /// // With tau = 0.5 the sun keeps exp(-0.5) = 0.6065, and the sky gets 0.7 of the rest.
    /// let dusty = Sunlight::mars(std::f64::consts::FRAC_PI_2, 0.0, 0.5);
    /// assert!((dusty.direct / sun.direct - 0.6065).abs() < 1e-4);
    /// assert!((dusty.sky / sun.direct - 0.7 * 0.3935).abs() < 1e-4);
    /// ```
    pub fn mars(elevation: f64, azimuth: f64, optical_depth: f64) -> Self {
        let above = SOLAR_IRRADIANCE_810_NM / (MARS_SEMI_MAJOR_AXIS_AU * MARS_SEMI_MAJOR_AXIS_AU);
        let height = libm::sin(elevation).max(0.0);
        let left = if height > 0.0 { libm::exp(-optical_depth / height) } else { 0.0 };
        Self {
            elevation,
            azimuth,
            direct: above * left,
            sky: 0.7 * above * height * (1.0 - left),
            reference: 810e-9,
            // From 1144 W/m^2/um around 795 nm to 1075 around 825 nm in E490; a black body of 5772 K has -0.00219
            // / nm.
            slope: -0.0021e9,
            // CHOICE: silicon's band, from 400 to 1000 nm, all at the efficiency of the laser's wavelength.
            open_band: 600e-9,
        }
    }

    /// Unit direction towards the sun, scene frame: (cos el cos az, cos el sin az, sin el).
    pub fn direction(&self) -> DVec3 {
        let (sin_el, cos_el) = libm::sincos(self.elevation);
        let (sin_az, cos_az) = libm::sincos(self.azimuth);
        DVec3::new(cos_el * cos_az, cos_el * sin_az, sin_el)
    }

    /// Effective width of a filter's pass band, metres, times the spectrum relative to `reference`, for light at
    /// an angle phi to the camera's normal axis.
    ///
    /// The band of an interference filter is a Gaussian about centre(phi) = centre sqrt(1 - (sin(phi) /
    /// index)^2), of full width `width` at half maximum. Its integral over the wavelength is width sqrt(pi / (4
    /// ln 2)) = 1.064 width at any angle. A spectrum that is a straight line has its mean at centre(phi).
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

    /// Flux of sun and sky on each pixel of the camera, watts:
    ///
    /// (pi / 4) L (D / f_c)^2 cos^4(phi) A_cp C_loss e^(-sigma d),  L = r_d / pi (E_sun max(0, n.s) + E_sky),
    ///
    /// with phi of the pixel's centre, E within the pass band at phi, and E_sun = 0 in shadow. `attenuation` is
    /// sigma, 1/m. A pixel without a hit sees the sky, L = E_sky / pi.
    ///
    /// # Panics
    /// If the maps do not have the camera's size.
    pub fn flux(&self, camera: &Camera, attenuation: f64, ground: &VisibleSurface<'_>) -> Image<f64> {
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

    /// Checks that all values are in their ranges.
    ///
    /// # Errors
    /// Names the first invalid field, as a part of `field`.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(|| format!("{field}.elevation"), self.elevation, -PI / 2.0, PI / 2.0, "rad")?;
        check_range(|| format!("{field}.azimuth"), self.azimuth, -2.0 * PI, 2.0 * PI, "rad")?;
        check_range(|| format!("{field}.direct"), self.direct, 0.0, 1e12, "W/m^3")?;
        check_range(|| format!("{field}.sky"), self.sky, 0.0, 1e12, "W/m^3")?;
        check_range(|| format!("{field}.reference"), self.reference, 1e-8, 1e-3, "m")?;
        check_range(|| format!("{field}.slope"), self.slope, -1e9, 1e9, "1/m")?;
        check_range(|| format!("{field}.open_band"), self.open_band, 0.0, 1e-5, "m")
    }
}
