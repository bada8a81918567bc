//! What a scene file says of the camera's optics and electronics: `[drive.optics]` and `[drive.electronics]`, in SI. What
//! it leaves out is the preset's.

use raypencil_sensor::{Dust, ImageLength, Kernel};

/// One blur of the optics.
#[derive(Debug, Clone, PartialEq)]
pub enum BlurSettings {
    /// Diffraction of the camera's own aperture at the beams' wavelength, up to so many dark rings.
    Airy {
        /// Dark rings.
        rings: u32,
    },
    /// A Gaussian of this standard deviation.
    Gaussian(ImageLength),
    /// Numbers from a file, on the cells of the fine image.
    Kernel(Kernel),
}

/// Optics as a scene file has them: only what was given, in range.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OpticsSettings {
    /// Cells to the side of a pixel.
    pub oversampling: Option<u32>,
    /// The depth at which the lens is sharp, metres.
    pub focus: Option<f64>,
    /// In place of the preset's.
    pub blurs: Option<Vec<BlurSettings>>,
    /// In place of the preset's.
    pub dust: Option<Dust>,
}

/// A sensor's numbers as a scene file has them: only what was given, in SI and in range.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ElectronicsSettings {
    /// Seconds.
    pub exposure: Option<f64>,
    /// Electrons per photon.
    pub quantum_efficiency: Option<f64>,
    /// Whether electrons come by chance.
    pub shot_noise: Option<bool>,
    /// Electrons per second, at `dark_at`.
    pub dark_rate: Option<f64>,
    /// Kelvin.
    pub dark_at: Option<f64>,
    /// Kelvin for twice the rate.
    pub dark_doubling: Option<f64>,
    /// Of the sensor, kelvin.
    pub temperature: Option<f64>,
    /// Electrons.
    pub read_noise: Option<f64>,
    /// Of the mean sensitivity.
    pub prnu: Option<f64>,
    /// Electrons.
    pub dsnu: Option<f64>,
    /// Electrons; may be infinite.
    pub full_well: Option<f64>,
    /// DN per electron.
    pub gain: Option<f64>,
    /// DN.
    pub bias: Option<f64>,
    /// Of the converter.
    pub bits: Option<u32>,
}
