//! Steps 7 and 8: electrons, noise and digital numbers, by the linear camera model of EMVA 1288, release 4.0.

use rayon::prelude::*;
use raypencil_scene::{Image, SceneError};

use crate::check::{assert_same_size, check_range};
use crate::{NoiseSource, NoiseStream, poisson};

/// h, J s: exact by the definition of the SI (CODATA).
pub const PLANCK_CONSTANT: f64 = 6.626_070_15e-34;
/// c, m/s: exact by the definition of the SI.
pub const SPEED_OF_LIGHT: f64 = 299_792_458.0;

/// Energy of a photon of this wavelength in metres, joules: h c / lambda.
pub fn photon_energy(wavelength: f64) -> f64 {
    PLANCK_CONSTANT * SPEED_OF_LIGHT / wavelength
}

/// Electrons that gather without light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DarkCurrent {
    /// Electrons per second and pixel, at the temperature `at`.
    pub rate: f64,
    /// The temperature of that rate, kelvin.
    pub at: f64,
    /// By how many kelvin it must get warmer for twice the rate.
    pub doubling: f64,
    /// The sensor's temperature, kelvin.
    pub temperature: f64,
}

impl DarkCurrent {
    /// There is none.
    pub const NONE: Self = Self { rate: 0.0, at: 293.15, doubling: 7.0, temperature: 293.15 };

    /// Electrons per second at the sensor's own temperature.
    pub fn electrons_per_second(&self) -> f64 {
        self.rate * libm::exp2((self.temperature - self.at) / self.doubling)
    }
}

/// An image sensor with its amplifier and A/D converter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// How long light is gathered, seconds.
    pub exposure: f64,
    /// Of the light, metres: all of it counts as the laser's.
    pub wavelength: f64,
    /// eta: electrons per photon that falls on the pixel's whole area.
    pub quantum_efficiency: f64,
    /// Whether electrons come by chance (Poisson's law) or exactly as many as expected.
    pub shot_noise: bool,
    /// mu_d: electrons that come without light.
    pub dark_current: DarkCurrent,
    /// sigma_d: standard deviation of what reading out adds, electrons.
    pub read_noise: f64,
    /// PRNU: standard deviation of the pixels' sensitivities, of their mean.
    pub prnu: f64,
    /// DSNU: standard deviation of the pixels' dark signals, electrons.
    pub dsnu: f64,
    /// Electrons that a pixel holds; may be infinite.
    pub full_well: f64,
    /// K: overall system gain, DN per electron.
    pub gain: f64,
    /// What the converter reads for no electrons, DN.
    pub bias: f64,
    /// Bits of the converter: it gives 0 to 2^bits - 1.
    pub bits: u32,
    /// Other seeds give another sensor of the same make, and other noise.
    pub seed: u64,
}

/// A frame, and how it came about.
#[derive(Debug, Clone, PartialEq)]
pub struct DigitalFrame {
    /// Electrons expected in each pixel, of light and in the dark.
    pub expected: Image<f64>,
    /// Electrons that it holds at the end of the exposure.
    pub electrons: Image<f64>,
    /// What the converter is given, DN, not yet rounded or clipped.
    pub signal: Image<f64>,
    /// What it gives: digital numbers.
    pub numbers: Image<u16>,
}

/// A frame with the laser on, one with it off, and what the first has more.
#[derive(Debug, Clone, PartialEq)]
pub struct FramePair {
    /// Laser on.
    pub lit: DigitalFrame,
    /// Laser off: background alone.
    pub unlit: DigitalFrame,
    /// Lit minus unlit, DN.
    pub difference: Image<i32>,
}

/// One pixel's part in each image of [`DigitalFrame`], before rounding.
struct Pixel {
    expected: f64,
    electrons: f64,
    signal: f64,
}

/// What falls on the pixel of an index, watts.
fn fluxes<'a>(optical: &'a Image<f64>, background: Option<&'a Image<f64>>) -> impl Fn(usize) -> f64 + Sync {
    if let Some(background) = background {
        assert_same_size(optical, background, "background");
    }
    let (optical, background) = (optical.cells(), background.map(Image::cells));
    move |index| optical[index] + background.map_or(0.0, |background| background[index])
}

impl Sensor {
    /// Takes frame number `frame`: `optical` is the flux of the laser on each pixel, watts, `background` that of all
    /// other light. The fixed patterns are the same in every frame.
    ///
    /// # Panics
    /// If the images differ in size, or a flux is negative or not finite.
    pub fn expose(&self, optical: &Image<f64>, background: Option<&Image<f64>>, frame: u64) -> DigitalFrame {
        let (width, height) = (optical.width(), optical.height());
        let flux = fluxes(optical, background);
        let dark = self.dark_electrons();
        let pixels = (0..optical.cells().len()).into_par_iter();
        let pixels: Vec<Pixel> = pixels.map(|index| self.pixel(flux(index), dark, frame, index)).collect();
        let image = |of: fn(&Pixel) -> f64| Image::from_cells(width, height, pixels.iter().map(of).collect());
        let numbers = pixels.iter().map(|pixel| self.digitised(pixel.signal)).collect();
        DigitalFrame {
            expected: image(|pixel| pixel.expected),
            electrons: image(|pixel| pixel.electrons),
            signal: image(|pixel| pixel.signal),
            numbers: Image::from_cells(width, height, numbers),
        }
    }

    /// [`DigitalFrame::numbers`] of [`Sensor::expose`] alone, without the images on the way to them; of any type that holds
    /// them all.
    ///
    /// # Panics
    /// As [`Sensor::expose`].
    pub fn numbers<T: Copy + From<u16> + Send + Sync>(
        &self,
        optical: &Image<f64>,
        background: Option<&Image<f64>>,
        frame: u64,
    ) -> Image<T> {
        let flux = fluxes(optical, background);
        let dark = self.dark_electrons();
        // Without chance all pixels in the dark are alike, and most pixels are in the dark.
        let in_the_dark = self.is_noiseless().then(|| self.digitised(self.pixel(0.0, dark, frame, 0).signal));
        let number = |index| match (flux(index), in_the_dark) {
            (0.0, Some(number)) => number.into(),
            (watts, _) => self.digitised(self.pixel(watts, dark, frame, index).signal).into(),
        };
        let numbers = (0..optical.cells().len()).into_par_iter().map(number).collect();
        Image::from_cells(optical.width(), optical.height(), numbers)
    }

    /// Whether what a pixel gives depends on its light alone.
    fn is_noiseless(&self) -> bool {
        !self.shot_noise && self.read_noise == 0.0 && self.prnu == 0.0 && self.dsnu == 0.0
    }

    /// mu_d of an exposure.
    fn dark_electrons(&self) -> f64 {
        self.dark_current.electrons_per_second() * self.exposure
    }

    fn pixel(&self, watts: f64, dark: f64, frame: u64, index: usize) -> Pixel {
        assert!(watts >= 0.0 && watts.is_finite(), "flux of pixel {index} is {watts} W");
        let pixel = index as u32;
        // mu_e + mu_d: the pixel's own sensitivity is in the first.
        let expected = self.photoelectrons(watts) * self.sensitivity(pixel) + dark;
        let electrons = self.collected(expected, frame, pixel);
        Pixel { expected, electrons, signal: self.signal(electrons, frame, pixel) }
    }

    /// Takes frame 2 `pair` with the laser on and frame 2 `pair` + 1 with it off, and subtracts.
    ///
    /// # Panics
    /// As [`Sensor::expose`].
    pub fn expose_pair(&self, optical: &Image<f64>, background: Option<&Image<f64>>, pair: u64) -> FramePair {
        let lit = self.expose(optical, background, 2 * pair);
        let off = Image::filled(optical.width(), optical.height(), 0.0);
        let unlit = self.expose(&off, background, 2 * pair + 1);
        let difference = difference(&lit.numbers, &unlit.numbers);
        FramePair { lit, unlit, difference }
    }

    /// [`FramePair::difference`] of [`Sensor::expose_pair`] alone, without the images on the way to it.
    ///
    /// # Panics
    /// As [`Sensor::expose`].
    pub fn lit_minus_unlit(
        &self,
        optical: &Image<f64>,
        background: Option<&Image<f64>>,
        pair: u64,
    ) -> Image<i32> {
        let off = Image::filled(optical.width(), optical.height(), 0.0);
        let lit = self.numbers(optical, background, 2 * pair);
        let unlit = self.numbers(&off, background, 2 * pair + 1);
        difference(&lit, &unlit)
    }

    /// mu_e = eta mu_p, mu_p = P t / (h c / lambda): electrons expected of a flux in watts.
    pub fn photoelectrons(&self, watts: f64) -> f64 {
        self.quantum_efficiency * (watts * self.exposure / photon_energy(self.wavelength))
    }

    /// How sensitive a pixel is, of the mean: 1 + PRNU g, not negative.
    pub fn sensitivity(&self, pixel: u32) -> f64 {
        if self.prnu == 0.0 {
            return 1.0;
        }
        (1.0 + self.prnu * NoiseStream::new(self.seed, NoiseSource::Prnu, 0, pixel).normal()).max(0.0)
    }

    /// The electrons in a pixel's well when so many are expected.
    fn collected(&self, expected: f64, frame: u64, pixel: u32) -> f64 {
        // What comes of light and what comes in the dark are both Poisson's, so their sum is, too.
        let electrons = if self.shot_noise {
            poisson(expected, &mut NoiseStream::new(self.seed, NoiseSource::Shot, frame, pixel))
        } else {
            expected
        };
        electrons.min(self.full_well)
    }

    /// What the converter is given: bias + K (electrons + DSNU + read noise).
    fn signal(&self, electrons: f64, frame: u64, pixel: u32) -> f64 {
        let mut offset = 0.0;
        if self.dsnu > 0.0 {
            offset += self.dsnu * NoiseStream::new(self.seed, NoiseSource::Dsnu, 0, pixel).normal();
        }
        if self.read_noise > 0.0 {
            offset += self.read_noise * NoiseStream::new(self.seed, NoiseSource::Read, frame, pixel).normal();
        }
        self.bias + self.gain * (electrons + offset)
    }

    /// The nearest whole number (halves upwards) that the converter can give.
    pub fn digitised(&self, signal: f64) -> u16 {
        signal.round().clamp(0.0, self.largest()) as u16
    }

    /// The largest number of the converter, 2^bits - 1.
    pub fn largest(&self) -> f64 {
        ((1_u32 << self.bits) - 1).into()
    }

    /// Refuses a sensor that nobody could build, naming the field.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(field, "exposure", self.exposure, 0.0, 1e5, "s")?;
        check_range(field, "wavelength", self.wavelength, 1e-8, 1e-3, "m")?;
        check_range(field, "quantum_efficiency", self.quantum_efficiency, 0.0, 1.0, "of 1")?;
        check_range(field, "dark_current.rate", self.dark_current.rate, 0.0, 1e9, "electrons/s")?;
        check_range(field, "dark_current.at", self.dark_current.at, 50.0, 500.0, "K")?;
        check_range(field, "dark_current.doubling", self.dark_current.doubling, 1.0, 100.0, "K")?;
        check_range(field, "dark_current.temperature", self.dark_current.temperature, 50.0, 500.0, "K")?;
        check_range(field, "read_noise", self.read_noise, 0.0, 1e6, "electrons")?;
        check_range(field, "prnu", self.prnu, 0.0, 1.0, "of 1")?;
        check_range(field, "dsnu", self.dsnu, 0.0, 1e6, "electrons")?;
        check_range(field, "full_well", self.full_well, 1.0, f64::INFINITY, "electrons")?;
        check_range(field, "gain", self.gain, 1e-9, 1e6, "DN per electron")?;
        check_range(field, "bits", f64::from(self.bits), 1.0, 16.0, "bits")?;
        check_range(field, "bias", self.bias, 0.0, self.largest(), "DN")
    }
}

/// The numbers of one frame minus those of another.
///
/// # Panics
/// If they differ in size.
pub fn difference(lit: &Image<u16>, unlit: &Image<u16>) -> Image<i32> {
    assert_same_size(lit, unlit, "the unlit frame");
    let cells = lit.cells().iter().zip(unlit.cells());
    let cells = cells.map(|(lit, unlit)| i32::from(*lit) - i32::from(*unlit)).collect();
    Image::from_cells(lit.width(), lit.height(), cells)
}
