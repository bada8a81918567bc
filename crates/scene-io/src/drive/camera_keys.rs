//! `[drive.optics]` and `[drive.electronics]`: what of the camera is not as the preset has it.

use serde::Deserialize;
use std::ops::{Range, RangeInclusive};
use std::path::PathBuf;
use toml::Spanned;

use crate::drive::camera_settings::{BlurSettings, ElectronicsSettings, OpticsSettings};
use crate::keys::Key;
use crate::parse::Source;
use crate::scene_error::SceneIoError;
use raypencil_sensor::{Dust, ImageLength};

/// Blurs, one after another.
const MOST_BLURS: usize = 16;

/// A blur wider than this is no blur of a camera.
const BLUR_PX: RangeInclusive<f64> = 0.0..=100.0;

const BLUR_UM: RangeInclusive<f64> = 0.0..=1e4;

const SHARE: RangeInclusive<f64> = 0.0..=1.0;

/// 0 degrees Celsius, kelvin.
const ICE_POINT: f64 = 273.15;

const CELSIUS: RangeInclusive<f64> = -223.15..=226.85;

/// `[drive.optics]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct OpticsKeys {
    oversampling: Key<i64>,
    focus_m: Key<f64>,
    blurs: Key<Vec<Spanned<BlurKeys>>>,
    dust: Key<DustKeys>,
}

/// One of `blurs`: exactly one of its keys.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BlurKeys {
    airy_rings: Key<i64>,
    gaussian_px: Key<f64>,
    gaussian_um: Key<f64>,
    kernel: Key<String>,
}

/// `dust = { ... }`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DustKeys {
    transmission: Key<f64>,
    halo_share: Key<f64>,
    halo_px: Key<f64>,
}

/// `[drive.electronics]`
#[derive(Deserialize)]
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

/// A kernel that is in a file of its own, and which of the blurs it is.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct KernelPart {
    pub blur: usize,
    pub file: PathBuf,
    pub span: Range<usize>,
}

impl Source<'_> {
    /// The optics, but for kernels in files, whose places among the blurs are still empty.
    pub(super) fn optics(&self, keys: OpticsKeys) -> Result<(OpticsSettings, Vec<KernelPart>), SceneIoError> {
        let mut optics = OpticsSettings {
            oversampling: self.drive_count(keys.oversampling, "optics.oversampling", 1..=64)?,
            focus: self.drive_number(keys.focus_m, "optics.focus_m", 1e-3..=f64::INFINITY, "metres")?,
            ..OpticsSettings::default()
        };
        let mut files = Vec::new();
        if let Some(list) = keys.blurs {
            let count = list.get_ref().len();
            if count > MOST_BLURS {
                let message = format!("`drive.optics.blurs` has {count} blurs; expected up to {MOST_BLURS}");
                return Err(self.error(list.span(), message));
            }
            let mut blurs = Vec::new();
            for (blur, keys) in list.into_inner().into_iter().enumerate() {
                let span = keys.span();
                let BlurKeys { airy_rings, gaussian_px, gaussian_um, kernel } = keys.into_inner();
                let name = |key: &str| format!("optics.blurs[{blur}].{key}");
                match (airy_rings, gaussian_px, gaussian_um, kernel) {
                    (rings @ Some(_), None, None, None) => {
                        let rings = self.drive_count(rings, &name("airy_rings"), 1..=100)?;
                        blurs.extend(rings.map(|rings| BlurSettings::Airy { rings }));
                    }
                    (None, sigma @ Some(_), None, None) => {
                        let sigma = self.drive_number(sigma, &name("gaussian_px"), BLUR_PX, "pixels")?;
                        blurs.extend(sigma.map(|sigma| BlurSettings::Gaussian(ImageLength::Pixels(sigma))));
                    }
                    (None, None, sigma @ Some(_), None) => {
                        let sigma = self.drive_number(sigma, &name("gaussian_um"), BLUR_UM, "micrometres")?;
                        blurs.extend(
                            sigma.map(|sigma| BlurSettings::Gaussian(ImageLength::Metres(1e-6 * sigma))),
                        );
                    }
                    (None, None, None, Some(file)) => {
                        files.push(KernelPart { blur, span: file.span(), file: file.into_inner().into() });
                    }
                    _ => {
                        let message = format!(
                            "`drive.{}`: expected exactly one of `airy_rings`, `gaussian_px`, `gaussian_um`, `kernel`",
                            name("").trim_end_matches('.')
                        );
                        return Err(self.error(span, message));
                    }
                }
            }
            optics.blurs = Some(blurs);
        }
        if let Some(dust) = keys.dust {
            let DustKeys { transmission, halo_share, halo_px } = dust.into_inner();
            let number = |key, name: &str, usual, range, unit: &str| {
                let value = self.drive_number(key, &format!("optics.dust.{name}"), range, unit)?;
                Ok::<_, SceneIoError>(value.unwrap_or(usual))
            };
            optics.dust = Some(Dust {
                transmission: number(transmission, "transmission", 1.0, SHARE, "of 1")?,
                halo_share: number(halo_share, "halo_share", 0.0, SHARE, "of 1")?,
                halo_sigma: ImageLength::Pixels(number(halo_px, "halo_px", 20.0, BLUR_PX, "pixels")?),
            });
        }
        Ok((optics, files))
    }

    /// The electronics.
    pub(super) fn electronics(&self, keys: ElectronicsKeys) -> Result<ElectronicsSettings, SceneIoError> {
        let number = |key, name: &str, range, unit: &str| {
            self.drive_number(key, &format!("electronics.{name}"), range, unit)
        };
        let kelvin = |celsius: Option<f64>| celsius.map(|celsius| celsius + ICE_POINT);
        let bits = self.drive_count(keys.bits, "electronics.bits", 1..=16)?;
        Ok(ElectronicsSettings {
            exposure: number(keys.exposure_ms, "exposure_ms", 1e-6..=1e8, "milliseconds")?
                .map(|ms| 1e-3 * ms),
            quantum_efficiency: number(keys.quantum_efficiency, "quantum_efficiency", SHARE, "of 1")?,
            shot_noise: keys.shot_noise,
            dark_rate: number(keys.dark_e_per_s, "dark_e_per_s", 0.0..=1e9, "electrons per second")?,
            dark_at: kelvin(number(keys.dark_at_c, "dark_at_c", CELSIUS, "degrees Celsius")?),
            dark_doubling: number(keys.dark_doubling_k, "dark_doubling_k", 1.0..=100.0, "kelvin")?,
            temperature: kelvin(number(keys.temperature_c, "temperature_c", CELSIUS, "degrees Celsius")?),
            read_noise: number(keys.read_noise_e, "read_noise_e", 0.0..=1e6, "electrons")?,
            prnu: number(keys.prnu, "prnu", SHARE, "of 1")?,
            dsnu: number(keys.dsnu_e, "dsnu_e", 0.0..=1e6, "electrons")?,
            full_well: number(keys.full_well_e, "full_well_e", 1.0..=f64::INFINITY, "electrons")?,
            gain: number(keys.gain_dn_per_e, "gain_dn_per_e", 1e-9..=1e6, "DN per electron")?,
            bias: number(keys.bias_dn, "bias_dn", 0.0..=65535.0, "DN")?,
            bits,
        })
    }
}
