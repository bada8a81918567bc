//! `[drive.optics]` and `[drive.electronics]`: changes of the sensor preset.

use serde::Deserialize;
use std::ops::RangeInclusive;
use toml::Spanned;

use raypencil_sensor::{Dust, ImageLength, ImageSensor, Psf};

use crate::digest::NamedDigest;
use crate::drive::setup::DriveSetup;
use crate::parse::key::Key;
use crate::parse::source::Source;
use crate::scene_error::SceneIoError;

/// Maximum number of blurs, applied one after another.
const MAX_BLURS: usize = 16;

/// Standard deviation of a blur, pixels. A wider one is no blur of a camera.
const BLUR_PX: RangeInclusive<f64> = 0.0..=100.0;

/// Standard deviation of a blur, micrometres.
const BLUR_UM: RangeInclusive<f64> = 0.0..=1e4;

const SHARE: RangeInclusive<f64> = 0.0..=1.0;

/// 0 degrees Celsius, kelvin.
const ICE_POINT_K: f64 = 273.15;

/// Temperature, degrees Celsius: 50 to 500 K.
const CELSIUS: RangeInclusive<f64> = -223.15..=226.85;

/// Dust on the lens before the keys of `dust`: it takes away no light.
const CLEAN: Dust =
    Dust { transmission: 1.0, halo_share: 0.0, halo_sigma: ImageLength::Pixels(DEFAULT_HALO_PX) };

/// Standard deviation of the halo of dust, pixels.
const DEFAULT_HALO_PX: f64 = 20.0;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct OpticsKeys {
    oversampling: Key<i64>,
    focus_m: Key<f64>,
    blurs: Key<Vec<Spanned<BlurKeys>>>,
    dust: Key<DustKeys>,
    speckle_contrast: Key<f64>,
}

/// One of `blurs`: exactly one of these keys.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BlurKeys {
    airy_rings: Key<i64>,
    gaussian_px: Key<f64>,
    gaussian_um: Key<f64>,
    kernel: Key<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DustKeys {
    transmission: Key<f64>,
    halo_share: Key<f64>,
    halo_px: Key<f64>,
}

#[derive(Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ElectronicsKeys {
    exposure_ms: Key<f64>,
    quantum_efficiency: Key<f64>,
    shot_noise: Option<bool>,
    dark_e_per_s: Key<f64>,
    dark_at_c: Key<f64>,
    dark_doubling_k: Key<f64>,
    temperature_c: Key<f64>,
    read_noise_e: Key<f64>,
    prnu: Key<f64>,
    dsnu_e: Key<f64>,
    full_well_e: Key<f64>,
    gain_dn_per_e: Key<f64>,
    bias_dn: Key<f64>,
    bits: Key<i64>,
}

impl ElectronicsKeys {
    /// Whether no key is given.
    pub(super) fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

impl Source<'_> {
    /// Changes the optics of a drive. The result is the digests of the kernels' files, in their order.
    pub(super) fn optics(
        &self,
        keys: &OpticsKeys,
        drive: &mut DriveSetup,
    ) -> Result<Vec<NamedDigest>, SceneIoError> {
        let mut kernel_digests = Vec::new();
        let name = "drive.optics.oversampling";
        self.integer(&keys.oversampling, name, &mut drive.optics.oversampling, 1..=64, "")?;
        let focus = self.optional(&keys.focus_m, "drive.optics.focus_m", 1e-3..=f64::INFINITY, "metres")?;
        drive.optics.focus = focus.or(drive.optics.focus);
        if let Some(list) = &keys.blurs {
            let count = list.get_ref().len();
            if count > MAX_BLURS {
                let message = format!("`drive.optics.blurs` has {count} blurs; expected up to {MAX_BLURS}");
                return Err(self.error(list.span(), message));
            }
            let mut blurs = Vec::new();
            for (index, keys) in list.get_ref().iter().enumerate() {
                blurs.push(self.blur(
                    keys,
                    &format!("drive.optics.blurs[{index}]"),
                    drive,
                    &mut kernel_digests,
                )?);
            }
            drive.optics.blurs = blurs;
        }
        if let Some(dust) = &keys.dust {
            drive.optics.dust = Some(self.dust(dust.get_ref())?);
        }
        let name = "drive.optics.speckle_contrast";
        if let Some(contrast) = self.optional(&keys.speckle_contrast, name, SHARE, "of 1")? {
            drive.optics.speckle = drive.speckle(contrast);
        }
        Ok(kernel_digests)
    }

    fn blur(
        &self,
        keys: &Spanned<BlurKeys>,
        name: &str,
        drive: &DriveSetup,
        kernel_digests: &mut Vec<NamedDigest>,
    ) -> Result<Psf, SceneIoError> {
        let BlurKeys { airy_rings, gaussian_px, gaussian_um, kernel } = keys.get_ref();
        match (airy_rings, gaussian_px, gaussian_um, kernel) {
            (Some(_), None, None, None) => {
                let mut rings = 0;
                self.integer(airy_rings, &format!("{name}.airy_rings"), &mut rings, 1..=100, "")?;
                Ok(drive.airy(rings))
            }
            (None, Some(_), None, None) => {
                let mut sigma = 0.0;
                self.number(gaussian_px, &format!("{name}.gaussian_px"), &mut sigma, BLUR_PX, "pixels")?;
                Ok(Psf::Gaussian { sigma: ImageLength::Pixels(sigma) })
            }
            (None, None, Some(_), None) => {
                let mut sigma = 0.0;
                let name = format!("{name}.gaussian_um");
                self.converted(gaussian_um, &name, &mut sigma, BLUR_UM, "micrometres", |um| 1e-6 * um)?;
                Ok(Psf::Gaussian { sigma: ImageLength::Metres(sigma) })
            }
            (None, None, None, Some(file)) => {
                let (kernel, digest) = self.kernel(file, &format!("{name}.kernel"))?;
                kernel_digests.push(digest);
                Ok(Psf::Sampled(kernel))
            }
            _ => {
                let message = format!(
                    "`{name}`: expected exactly one of `airy_rings`, `gaussian_px`, `gaussian_um`, `kernel`"
                );
                Err(self.error(keys.span(), message))
            }
        }
    }

    fn dust(&self, keys: &DustKeys) -> Result<Dust, SceneIoError> {
        let mut dust = CLEAN;
        let name = "drive.optics.dust.transmission";
        self.number(&keys.transmission, name, &mut dust.transmission, SHARE, "of 1")?;
        let name = "drive.optics.dust.halo_share";
        self.number(&keys.halo_share, name, &mut dust.halo_share, SHARE, "of 1")?;
        let mut halo = DEFAULT_HALO_PX;
        self.number(&keys.halo_px, "drive.optics.dust.halo_px", &mut halo, BLUR_PX, "pixels")?;
        Ok(Dust { halo_sigma: ImageLength::Pixels(halo), ..dust })
    }

    /// Changes the image sensor of a drive.
    pub(super) fn electronics(
        &self,
        keys: &ElectronicsKeys,
        sensor: &mut ImageSensor,
    ) -> Result<(), SceneIoError> {
        let same = |value| value;
        let milli: fn(f64) -> f64 = |value| 1e-3 * value;
        let kelvin: fn(f64) -> f64 = |celsius| celsius + ICE_POINT_K;
        self.integer(&keys.bits, "drive.electronics.bits", &mut sensor.bits, 1..=16, "")?;
        sensor.shot_noise = keys.shot_noise.unwrap_or(sensor.shot_noise);
        let dark = &mut sensor.dark_current;
        let (dark_at, to_infinity) = (&mut dark.reference_temperature, 1.0..=f64::INFINITY);
        let numbers = [
            ("exposure_ms", &keys.exposure_ms, &mut sensor.exposure, milli, 1e-6..=1e8, "milliseconds"),
            (
                "quantum_efficiency",
                &keys.quantum_efficiency,
                &mut sensor.quantum_efficiency,
                same,
                SHARE,
                "of 1",
            ),
            ("dark_e_per_s", &keys.dark_e_per_s, &mut dark.rate, same, 0.0..=1e9, "electrons per second"),
            ("dark_at_c", &keys.dark_at_c, dark_at, kelvin, CELSIUS, "degrees Celsius"),
            (
                "dark_doubling_k",
                &keys.dark_doubling_k,
                &mut dark.doubling_kelvins,
                same,
                1.0..=100.0,
                "kelvin",
            ),
            ("temperature_c", &keys.temperature_c, &mut dark.temperature, kelvin, CELSIUS, "degrees Celsius"),
            ("read_noise_e", &keys.read_noise_e, &mut sensor.read_noise, same, 0.0..=1e6, "electrons"),
            ("prnu", &keys.prnu, &mut sensor.prnu, same, SHARE, "of 1"),
            ("dsnu_e", &keys.dsnu_e, &mut sensor.dsnu, same, 0.0..=1e6, "electrons"),
            ("full_well_e", &keys.full_well_e, &mut sensor.full_well, same, to_infinity, "electrons"),
            ("gain_dn_per_e", &keys.gain_dn_per_e, &mut sensor.gain, same, 1e-9..=1e6, "DN per electron"),
            ("bias_dn", &keys.bias_dn, &mut sensor.bias, same, 0.0..=65535.0, "DN"),
        ];
        for (name, key, slot, si, range, unit) in numbers {
            self.converted(key, &format!("drive.electronics.{name}"), slot, range, unit, si)?;
        }
        Ok(())
    }
}
