//! Image sensor chain, steps 6 to 8 of the paper: from watts per pixel to digital numbers.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! ```text
//! 6  splat (disc) -> psf -> kernel (airy) -> convolve -> optics, dust   filter the image for aberrations and dust
//!    speckle                                                            the grain of laser light
//!    sunlight                                                           the background light of sun and sky
//! 7  noise_stream, poisson -> image_sensor (photon)                     add the sensor's noise
//! 8  image_sensor                                                       adjust the range, digitise, subtract frames
//!    image_sensor, dark_pixels -> numbers                               the same, the numbers alone
//!    presets                                                            optics and sensors by name, with sources
//! ```
//!
//! Sources: the linear camera model of EMVA 1288, release 4.0; Goodman, Introduction to Fourier Optics. The equations
//! are in `docs/theory/sensor.md`.
//!
//! Every function is pure. Random numbers depend on (seed, noise source, frame, pixel) alone, and every sum has a fixed
//! order: the bits do not depend on the number of threads.
//!
//! ```
//! use raypencil_scene::Image;
//! use raypencil_sensor::ImageSensor;
//!
//! // No noise and one electron per photon: 0.25 DN per electron, rounded.
//! let sensor = ImageSensor::ideal();
//! let flux = Image::filled(64, 48, 2e-12);
//! let frame = sensor.expose(&flux, None, 0);
//! let expected = (0.25 * sensor.photoelectrons(2e-12)).round();
//! assert_eq!(f64::from(frame.numbers.at(10, 10)), expected);
//! ```

mod airy;
mod convolve;
mod dark_pixels;
mod disc;
mod dust;
mod image_sensor;
mod kernel;
mod noise_stream;
mod numbers;
mod optics;
mod photon;
mod poisson;
mod presets;
mod psf;
mod same_size;
mod speckle;
mod splat;
mod sunlight;

pub use airy::{airy_pattern, encircled_energy};
pub use convolve::{ConvolvedImage, binned, convolve};
pub use dust::{Dust, DustedImage};
pub use image_sensor::{DarkCurrent, DigitalImage, ImagePair, ImageSensor, difference};
pub use kernel::Kernel;
pub use noise_stream::{NoiseSource, NoiseStream};
pub use numbers::FixedPattern;
pub use optics::{FluxBudget, Optics, OpticsOutput};
pub use photon::{PLANCK_CONSTANT, SPEED_OF_LIGHT, photon_energy};
pub use poisson::poisson;
pub use presets::{PRESET_NAMES, preset};
pub use psf::{ImageLength, Psf};
pub use speckle::{Speckle, SpecklePattern};
pub use splat::{PointSource, SplatImage, ThinLens, splat, splat_defocused};
pub use sunlight::{MARS_SEMI_MAJOR_AXIS_AU, SOLAR_IRRADIANCE_810_NM, Sunlight, VisibleSurface};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_sensor;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
