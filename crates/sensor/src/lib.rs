//! Steps 6 to 8 of the paper: from watts per pixel to digital numbers.
//!
//! ```text
//! 6  splat -> convolve (kernel, airy, disc) -> optics, dust      filter the image for aberrations and dust
//!    sunlight                                                    what the sun and the sky add
//! 7  random, poisson -> sensor                                   add the sensor's noise
//! 8  sensor -> difference                                        adjust the range, digitise
//! ```
//!
//! Everything is a pure function of its arguments. Random numbers are functions of seed, purpose, frame and pixel, and
//! every sum is in a fixed order, so that the bits do not depend on the number of threads. `docs/sensor.md` has the
//! equations.
//!
//! ```
//! use raypencil_scene::Image;
//! use raypencil_sensor::Sensor;
//!
//! let flux = Image::filled(64, 48, 2e-12);
//! let frame = Sensor::cmos().expose(&flux, None, 0);
//! assert!(frame.numbers.at(10, 10) > 0);
//! ```

mod airy;
mod check;
mod convolve;
mod disc;
mod dust;
mod image_sensor;
mod kernel;
mod noise_stream;
mod optics;
mod poisson;
mod presets;
mod splat;
mod sunlight;

pub use airy::{airy_pattern, encircled_energy};
pub use convolve::{ConvolvedImage, binned, convolve};
pub use dust::{Dust, DustedImage};
pub use image_sensor::{
    DarkCurrent, DigitalFrame, FramePair, PLANCK_CONSTANT, SPEED_OF_LIGHT, Sensor, difference, photon_energy,
};
pub use kernel::{Extent, Kernel, Psf};
pub use noise_stream::{NoiseSource, NoiseStream};
pub use optics::{FluxBudget, Optics, OpticsOutput};
pub use poisson::poisson;
pub use presets::{PRESETS, preset};
pub use splat::{PointSource, SplatImage, ThinLens, splat, splat_defocused};
pub use sunlight::{Ground, MARS_ORBIT, SOLAR_SPECTRUM_810, Sunlight};
