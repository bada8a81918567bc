//! Optics and sensors by name. Each figure has its source or is marked CHOICE; `docs/theory/sensor.md` lists them in a
//! table.

use crate::{DarkCurrent, Dust, ImageLength, ImageSensor, Optics, Psf};

/// Names that [`preset`] accepts.
pub const PRESET_NAMES: &[&str] = &["ideal", "ccd_1989", "cmos"];

/// Optics and sensor by name; `None` for an unknown name.
///
/// ```
/// use raypencil_sensor::{PRESET_NAMES, preset};
///
/// assert_eq!(PRESET_NAMES, ["ideal", "ccd_1989", "cmos"]);
/// // The camera of 1989 has 8 bits: its largest number is 2^8 - 1.
/// let (optics, sensor) = preset("ccd_1989").expect("a preset name");
/// assert_eq!(sensor.max_number(), 255.0);
/// // Its lens is dusty: a tenth of the light is lost.
/// assert_eq!(optics.dust.expect("dust").transmission, 0.9);
/// ```
pub fn preset(name: &str) -> Option<(Optics, ImageSensor)> {
    match name {
        "ideal" => Some((Optics::PERFECT, ImageSensor::ideal())),
        "ccd_1989" => Some((Optics::dusty(), ImageSensor::ccd_1989())),
        "cmos" => Some((Optics::diffraction_limited(), ImageSensor::cmos())),
        _ => None,
    }
}

/// Wavelength of the default beams, metres. CHOICE.
const BEAM_WAVELENGTH_M: f64 = 810e-9;

impl ImageSensor {
    /// Sensor without noise: 16 bits, one electron per photon, an infinite full well.
    pub const fn ideal() -> Self {
        Self {
            // CHOICE: a stripe of the default rig, some 1.2e-11 W per pixel, gives 24,000 DN.
            exposure: 2e-3,
            gain: 0.25,
            wavelength: BEAM_WAVELENGTH_M,
            quantum_efficiency: 1.0,
            shot_noise: false,
            dark_current: DarkCurrent::NONE,
            read_noise: 0.0,
            prnu: 0.0,
            dsnu: 0.0,
            full_well: f64::INFINITY,
            bias: 0.0,
            bits: 16,
            seed: 0,
        }
    }

    /// CCD camera of the paper's time, after the solid-state imager of Galileo, launched in 1989 (a virtual-phase
    /// CCD of 800 x 800 pixels by Texas Instruments).
    pub const fn ccd_1989() -> Self {
        Self {
            // CHOICE: stripes of the default rig fill a third of the well, and ten frames a second (paper, §7)
            // leave time for it.
            exposure: 2e-3,
            wavelength: BEAM_WAVELENGTH_M,
            // CHOICE: front-lit silicon of that time has 0.3 to 0.4 at 810 nm.
            quantum_efficiency: 0.35,
            shot_noise: true,
            dark_current: DarkCurrent {
                // Limit for the frame-transfer CCDs of the Mars Exploration Rovers (12 um pixels) at 0 C.
                rate: 1200.0,
                reference_temperature: 273.15,
                // CCD makers give a factor of 2 for 5 to 7 K.
                doubling_kelvins: 6.0,
                // CHOICE: a warm afternoon on Mars.
                temperature: 273.15,
            },
            // CHOICE: 30 to 40 for that imager. The limit for those rovers, fifteen years later, was 50.
            read_noise: 35.0,
            // CHOICE.
            prnu: 0.02,
            // CHOICE.
            dsnu: 20.0,
            // Galileo's gain state "100K", full scale 100,000 electrons in 8 bits.
            full_well: 1e5,
            // (255 - 2) DN for a full well.
            gain: 253.0 / 1e5,
            // CHOICE.
            bias: 2.0,
            // "The images are linearly digitized 8-bits deep." (Belton et al. 1992)
            bits: 8,
            seed: 0,
        }
    }

    /// Camera of today with a global shutter, of the class of Sony's IMX250.
    pub const fn cmos() -> Self {
        Self {
            // CHOICE: stripes of the default rig fill two fifths of the well.
            exposure: 0.4e-3,
            wavelength: BEAM_WAVELENGTH_M,
            // CHOICE: makers' curves for this sensor fall from 0.6 to 0.7 in the green to 0.2 to 0.25 at 810 nm.
            quantum_efficiency: 0.22,
            shot_noise: true,
            dark_current: DarkCurrent {
                // CHOICE: a few electrons per second; in a millisecond they hardly matter.
                rate: 5.0,
                reference_temperature: 298.15,
                doubling_kelvins: 7.0,
                temperature: 298.15,
            },
            // CHOICE: EMVA 1288 figures for the sensor are about 2.4. (The manual below: 75.46 dB, that is 1.8.)
            read_noise: 2.4,
            // CHOICE: 0.5 to 1 % is common.
            prnu: 0.006,
            // CHOICE.
            dsnu: 0.6,
            // Teledyne Dalsa, manual of the Genie Nano series, model M2450 (IMX250): full well 10.7 ke, 12 bits.
            full_well: 10_700.0,
            // (4095 - 60) DN for a full well.
            gain: 4035.0 / 10_700.0,
            // CHOICE: far above the dark noise.
            bias: 60.0,
            bits: 12,
            seed: 0,
        }
    }
}

impl Optics {
    /// Diffraction of the default camera (f/4) at 810 nm, and half a micrometre of Gaussian blur. CHOICE: the
    /// latter.
    pub fn diffraction_limited() -> Self {
        Self {
            oversampling: 4,
            focus: None,
            blurs: vec![
                Psf::Airy { wavelength: BEAM_WAVELENGTH_M, f_number: 4.0, rings: 8 },
                Psf::Gaussian { sigma: ImageLength::Metres(0.5e-6) },
            ],
            dust: None,
            speckle: None,
        }
    }

    /// Lens after some time on Mars. CHOICE, all of it: a spot of a third of a pixel, in focus at 4 m; a tenth of
    /// the light is lost to dust, and 3 % of the rest goes into a halo.
    pub fn dusty() -> Self {
        Self {
            oversampling: 4,
            focus: Some(4.0),
            blurs: vec![
                Psf::Airy { wavelength: BEAM_WAVELENGTH_M, f_number: 4.0, rings: 8 },
                Psf::Gaussian { sigma: ImageLength::Pixels(1.0 / 3.0) },
            ],
            dust: Some(Dust { transmission: 0.9, halo_share: 0.03, halo_sigma: ImageLength::Pixels(20.0) }),
            speckle: None,
        }
    }
}
