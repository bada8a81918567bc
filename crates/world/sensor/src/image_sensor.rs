//! Steps 7 and 8 of the paper: electrons, noise and digital numbers, by the linear camera model of EMVA 1288,
//! release 4.0.

use rayon::prelude::*;
use raypencil_scene::{Image, SceneError, check_range};

use crate::same_size::assert_same_size;
use crate::{NoiseSource, NoiseStream, photon_energy, poisson};

/// Dark current: electrons that collect without light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DarkCurrent {
    /// Electrons per second and pixel at the temperature `reference_temperature`.
    pub rate: f64,
    /// Temperature at which `rate` holds, kelvin.
    pub reference_temperature: f64,
    /// Temperature increase that doubles the rate, kelvin.
    pub doubling_kelvins: f64,
    /// Temperature of the sensor, kelvin.
    pub temperature: f64,
}

impl DarkCurrent {
    /// No dark current.
    pub const NONE: Self =
        Self { rate: 0.0, reference_temperature: 293.15, doubling_kelvins: 7.0, temperature: 293.15 };

    /// Electrons per second and pixel at the sensor's own temperature.
    pub fn electrons_per_second(&self) -> f64 {
        self.rate * libm::exp2((self.temperature - self.reference_temperature) / self.doubling_kelvins)
    }
}

/// Image sensor with its amplifier and A/D converter.
///
/// Start from [`ImageSensor::ideal`], [`ImageSensor::ccd_1989`] or [`ImageSensor::cmos`] and change fields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImageSensor {
    /// Exposure time, seconds.
    pub exposure: f64,
    /// Wavelength, metres. All light counts as light of this wavelength.
    pub wavelength: f64,
    /// Quantum efficiency eta: electrons per photon on the pixel's whole area.
    pub quantum_efficiency: f64,
    /// Shot noise: whether the number of electrons follows Poisson's law, or equals its expectation.
    pub shot_noise: bool,
    /// Dark current, which gives mu_d.
    pub dark_current: DarkCurrent,
    /// Read noise sigma_d: standard deviation, electrons.
    pub read_noise: f64,
    /// PRNU: standard deviation of the pixels' sensitivities, relative to their mean.
    pub prnu: f64,
    /// DSNU: standard deviation of the pixels' dark signals, electrons.
    pub dsnu: f64,
    /// Full well: maximum electrons of a pixel; may be infinite.
    pub full_well: f64,
    /// Overall system gain K, DN per electron.
    pub gain: f64,
    /// Bias: output of the converter for no electrons, DN.
    pub bias: f64,
    /// Bits of the converter: it outputs 0 to 2^bits - 1.
    pub bits: u32,
    /// Seed: another seed gives another sensor of the same make, and other noise.
    pub seed: u64,
}

/// Frame, with the images it was made from.
#[derive(Debug, Clone, PartialEq)]
pub struct DigitalImage {
    /// Expected electrons in each pixel, from light and dark current.
    pub expected: Image<f64>,
    /// Electrons at the end of the exposure.
    pub electrons: Image<f64>,
    /// Input of the converter, DN, before rounding and clipping.
    pub signal: Image<f64>,
    /// Output of the converter: digital numbers.
    pub numbers: Image<u16>,
}

/// Frames with the laser on and off, and their difference.
#[derive(Debug, Clone, PartialEq)]
pub struct ImagePair {
    /// Frame with the laser on.
    pub lit: DigitalImage,
    /// Frame with the laser off: background alone.
    pub unlit: DigitalImage,
    /// Lit minus unlit, DN.
    pub difference: Image<i32>,
}

/// One pixel of each image of [`DigitalImage`], before rounding.
pub(crate) struct Pixel {
    expected: f64,
    electrons: f64,
    pub(crate) signal: f64,
}

/// Flux on the pixel of an index, watts.
pub(crate) fn fluxes<'a>(
    optical: &'a Image<f64>,
    background: Option<&'a Image<f64>>,
) -> impl Fn(usize) -> f64 + Sync {
    if let Some(background) = background {
        assert_same_size(optical, background, "background");
    }
    let (optical, background) = (optical.cells(), background.map(Image::cells));
    move |index| optical[index] + background.map_or(0.0, |background| background[index])
}

impl ImageSensor {
    /// Exposes frame number `frame`. `optical` is the flux of the laser on each pixel, watts; `background` that
    /// of all other light. The fixed patterns are the same in every frame.
    ///
    /// # Panics
    /// If the images differ in size, or a flux is negative or not finite.
    ///
    /// # Example
    ///
    /// ```
    /// use raypencil_scene::Image;
    /// use raypencil_sensor::ImageSensor;
    ///
    /// // 8 bits, and 1 DN per electron: the converter clips at 255.
    /// let sensor = ImageSensor { gain: 1.0, bits: 8, ..ImageSensor::ideal() };
    /// let one_electron = 1.0 / sensor.photoelectrons(1.0);
    /// let flux = Image::from_cells(3, 1, vec![0.0, 200.0 * one_electron, 300.0 * one_electron]);
    /// assert_eq!(sensor.expose(&flux, None, 0).numbers.cells(), &[0, 200, 255]);
    /// ```
    pub fn expose(&self, optical: &Image<f64>, background: Option<&Image<f64>>, frame: u64) -> DigitalImage {
        let (width, height) = (optical.width(), optical.height());
        let flux = fluxes(optical, background);
        let dark = self.dark_electrons();
        let pixels = (0..optical.cells().len()).into_par_iter();
        let pixels: Vec<Pixel> =
            pixels.map(|index| self.pixel(flux(index), dark, frame, index, None)).collect();
        let image = |of: fn(&Pixel) -> f64| Image::from_cells(width, height, pixels.iter().map(of).collect());
        let numbers = pixels.iter().map(|pixel| self.digitised(pixel.signal)).collect();
        DigitalImage {
            expected: image(|pixel| pixel.expected),
            electrons: image(|pixel| pixel.electrons),
            signal: image(|pixel| pixel.signal),
            numbers: Image::from_cells(width, height, numbers),
        }
    }

    /// DSNU of a pixel, electrons.
    pub(crate) fn dark_signal(&self, pixel: u32) -> f64 {
        if self.dsnu > 0.0 {
            self.dsnu * NoiseStream::new(self.seed, NoiseSource::Dsnu, 0, pixel).normal()
        } else {
            0.0
        }
    }

    /// Whether the output of a pixel depends on its flux alone.
    pub(crate) fn is_noiseless(&self) -> bool {
        !self.shot_noise && self.read_noise == 0.0 && self.prnu == 0.0 && self.dsnu == 0.0
    }

    /// Dark electrons mu_d of an exposure.
    pub(crate) fn dark_electrons(&self) -> f64 {
        self.dark_current.electrons_per_second() * self.exposure
    }

    /// `dark_signal`: its DSNU, electrons, if it is known.
    pub(crate) fn pixel(
        &self,
        watts: f64,
        dark: f64,
        frame: u64,
        index: usize,
        dark_signal: Option<f64>,
    ) -> Pixel {
        assert!(watts >= 0.0 && watts.is_finite(), "flux of pixel {index} is {watts} W");
        let pixel = index as u32;
        // mu_e + mu_d: the first includes the pixel's own sensitivity.
        // No light: no sensitivity, which is finite, makes more than 0 of it.
        let photoelectrons =
            if watts == 0.0 { 0.0 } else { self.photoelectrons(watts) * self.sensitivity(pixel) };
        let expected = photoelectrons + dark;
        let electrons = self.collected(expected, frame, pixel);
        let dark_signal = dark_signal.unwrap_or_else(|| self.dark_signal(pixel));
        Pixel { expected, electrons, signal: self.signal(electrons, frame, pixel, dark_signal) }
    }

    /// Exposes frame 2 `pair` with the laser on and frame 2 `pair` + 1 with it off, and subtracts them.
    ///
    /// # Panics
    /// As [`ImageSensor::expose`].
    ///
    /// # Example
    ///
    /// ```
    /// use raypencil_scene::Image;
    /// use raypencil_sensor::ImageSensor;
    ///
    /// // Without noise the background cancels: the difference is the laser's part.
    /// let sensor = ImageSensor { gain: 1.0, bias: 7.0, ..ImageSensor::ideal() };
    /// let one_electron = 1.0 / sensor.photoelectrons(1.0);
    /// let laser = Image::filled(4, 4, 100.0 * one_electron);
    /// let sun = Image::filled(4, 4, 30.0 * one_electron);
    /// let pair = sensor.expose_pair(&laser, Some(&sun), 0);
    /// assert_eq!(pair.lit.numbers.at(1, 2), 7 + 130);
    /// assert_eq!(pair.difference.at(1, 2), 100);
    /// ```
    pub fn expose_pair(&self, optical: &Image<f64>, background: Option<&Image<f64>>, pair: u64) -> ImagePair {
        let lit = self.expose(optical, background, 2 * pair);
        let off = Image::filled(optical.width(), optical.height(), 0.0);
        let unlit = self.expose(&off, background, 2 * pair + 1);
        let difference = difference(&lit.numbers, &unlit.numbers);
        ImagePair { lit, unlit, difference }
    }

    /// Expected electrons mu_e of a flux in watts: mu_e = eta mu_p, mu_p = P t / (h c / lambda).
    pub fn photoelectrons(&self, watts: f64) -> f64 {
        self.quantum_efficiency * (watts * self.exposure / photon_energy(self.wavelength))
    }

    /// Sensitivity of a pixel relative to the mean: 1 + PRNU g with a normal g, at least 0.
    pub fn sensitivity(&self, pixel: u32) -> f64 {
        if self.prnu == 0.0 {
            return 1.0;
        }
        (1.0 + self.prnu * NoiseStream::new(self.seed, NoiseSource::Prnu, 0, pixel).normal()).max(0.0)
    }

    /// Electrons in a pixel's well, given their expectation.
    fn collected(&self, expected: f64, frame: u64, pixel: u32) -> f64 {
        // Photoelectrons and dark electrons are both Poisson-distributed, so their sum is, too.
        let electrons = if self.shot_noise {
            poisson(expected, &mut NoiseStream::new(self.seed, NoiseSource::Shot, frame, pixel))
        } else {
            expected
        };
        electrons.min(self.full_well)
    }

    /// Input of the converter, DN: bias + K (electrons + DSNU + read noise).
    fn signal(&self, electrons: f64, frame: u64, pixel: u32, dark_signal: f64) -> f64 {
        let mut offset = dark_signal;
        if self.read_noise > 0.0 {
            offset += self.read_noise * NoiseStream::new(self.seed, NoiseSource::Read, frame, pixel).normal();
        }
        self.bias + self.gain * (electrons + offset)
    }

    /// Output of the converter: the nearest whole number (halves upwards), clipped to its range.
    pub fn digitised(&self, signal: f64) -> u16 {
        signal.round().clamp(0.0, self.max_number()) as u16
    }

    /// Largest output of the converter, 2^bits - 1.
    pub fn max_number(&self) -> f64 {
        ((1_u32 << self.bits) - 1).into()
    }

    /// Checks that all values are in their ranges.
    ///
    /// # Errors
    /// Names the first invalid field, as a part of `field`.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(|| format!("{field}.exposure"), self.exposure, 0.0, 1e5, "s")?;
        check_range(|| format!("{field}.wavelength"), self.wavelength, 1e-8, 1e-3, "m")?;
        check_range(|| format!("{field}.quantum_efficiency"), self.quantum_efficiency, 0.0, 1.0, "")?;
        check_range(
            || format!("{field}.dark_current.rate"),
            self.dark_current.rate,
            0.0,
            1e9,
            "electrons/s",
        )?;
        check_range(
            || format!("{field}.dark_current.reference_temperature"),
            self.dark_current.reference_temperature,
            50.0,
            500.0,
            "K",
        )?;
        check_range(
            || format!("{field}.dark_current.doubling"),
            self.dark_current.doubling_kelvins,
            1.0,
            100.0,
            "K",
        )?;
        check_range(
            || format!("{field}.dark_current.temperature"),
            self.dark_current.temperature,
            50.0,
            500.0,
            "K",
        )?;
        check_range(|| format!("{field}.read_noise"), self.read_noise, 0.0, 1e6, "electrons")?;
        check_range(|| format!("{field}.prnu"), self.prnu, 0.0, 1.0, "")?;
        check_range(|| format!("{field}.dsnu"), self.dsnu, 0.0, 1e6, "electrons")?;
        check_range(|| format!("{field}.full_well"), self.full_well, 1.0, f64::INFINITY, "electrons")?;
        check_range(|| format!("{field}.gain"), self.gain, 1e-9, 1e6, "DN per electron")?;
        check_range(|| format!("{field}.bits"), f64::from(self.bits), 1.0, 16.0, "bits")?;
        check_range(|| format!("{field}.bias"), self.bias, 0.0, self.max_number(), "DN")
    }
}

/// Numbers of the lit frame minus those of the unlit frame, DN.
///
/// # Panics
/// If the frames differ in size.
pub fn difference(lit: &Image<u16>, unlit: &Image<u16>) -> Image<i32> {
    assert_same_size(lit, unlit, "the unlit frame");
    let cells = lit.cells().iter().zip(unlit.cells());
    let cells = cells.map(|(lit, unlit)| i32::from(*lit) - i32::from(*unlit)).collect();
    Image::from_cells(lit.width(), lit.height(), cells)
}
