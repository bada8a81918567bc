//! The keys of a scene TOML, as they stand in the file: nothing is checked here but names and types.
//!
//! Structs of options, never tagged enums: those lose the place of an error, and with it the caret.

use serde::Deserialize;
use serde::de::{Deserializer, Error, SeqAccess, Visitor};
use toml::Spanned;

use crate::drive::keys::DriveKeys;

/// A value that remembers its place in the file, if the key is given.
pub(crate) type Key<T> = Option<Spanned<T>>;

/// What the file is, read before all else.
#[derive(Deserialize)]
pub(crate) struct HeadKeys {
    pub version: Key<toml::Value>,
    pub kind: Key<toml::Value>,
}

/// The whole file.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SceneKeys {
    #[allow(dead_code, reason = "checked by HeadKeys; named here so that it is known")]
    pub version: Key<i64>,
    #[serde(default)]
    pub vehicle: VehicleKeys,
    #[serde(default)]
    pub camera: CameraKeys,
    pub beam: Option<Vec<BeamKeys>>,
    pub terrain: Key<TerrainKeys>,
    #[serde(default)]
    pub atmosphere: AtmosphereKeys,
    #[serde(default)]
    pub flux: FluxKeys,
    pub drive: Option<DriveKeys>,
}

/// `[vehicle]`
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct VehicleKeys {
    pub position_m: Key<Vec<f64>>,
    pub heading_deg: Key<f64>,
    pub pitch_down_deg: Key<f64>,
    pub roll_right_deg: Key<f64>,
}

/// `[camera]`
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CameraKeys {
    pub position_m: Key<Vec<f64>>,
    pub pitch_down_deg: Key<f64>,
    pub yaw_left_deg: Key<f64>,
    pub roll_right_deg: Key<f64>,
    pub width_px: Key<i64>,
    pub height_px: Key<i64>,
    pub pixel_pitch_um: Key<OneOrPair>,
    pub focal_length_mm: Key<f64>,
    pub principal_point_px: Key<Vec<f64>>,
    pub aperture_mm: Key<f64>,
    pub transmission: Key<f64>,
    pub filter: Key<FilterKeys>,
    pub max_range_m: Key<f64>,
}

/// `camera.filter`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FilterKeys {
    pub centre_nm: Spanned<f64>,
    pub width_nm: Spanned<f64>,
    pub index: Key<f64>,
}

/// `[[beam]]`
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BeamKeys {
    pub position_m: Key<Vec<f64>>,
    pub pitch_down_deg: Key<f64>,
    pub yaw_left_deg: Key<f64>,
    pub roll_right_deg: Key<f64>,
    pub fan_deg: Key<f64>,
    pub thickness_mm: Key<f64>,
    pub grid_distance_mm: Key<f64>,
    pub columns: Key<i64>,
    pub rows: Key<i64>,
    pub power_w: Key<f64>,
    pub wavelength_nm: Key<f64>,
    pub profile: Key<String>,
    pub gaussian_half_width_deg: Key<f64>,
    pub max_range_m: Key<f64>,
}

/// `[terrain]`
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TerrainKeys {
    pub builtin: Key<String>,
    pub file: Key<String>,
    pub dem: Key<String>,
    pub dem_window_m: Key<Vec<f64>>,
    pub dem_max_error_m: Key<f64>,
    pub generate: Key<GenerateKeys>,
    pub reflectivity: Key<f64>,
}

/// `generate = { ... }`
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GenerateKeys {
    pub kind: Key<String>,
    pub preset: Key<String>,
    pub seed: Key<i64>,
    pub faces: Key<i64>,
    pub extent_m: Key<f64>,
    pub offset_m: Key<Vec<f64>>,
    pub post_spacing_m: Key<f64>,
    pub coarse: Key<String>,
    pub hurst: Key<f64>,
    pub roughness_m: Key<f64>,
    pub octave_gains: Key<Vec<f64>>,
    pub rock_coverage: Key<f64>,
    pub rock_smallest_m: Key<f64>,
    pub rock_largest_m: Key<f64>,
    pub crater_density: Key<f64>,
    pub crater_smallest_m: Key<f64>,
    pub crater_largest_m: Key<f64>,
    pub crevasses: Key<i64>,
    pub crevasse_width_m: Key<f64>,
    pub crevasse_depth_m: Key<f64>,
    pub crevasse_overhang_m: Key<f64>,
}

/// `[atmosphere]`
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AtmosphereKeys {
    pub attenuation_per_m: Key<f64>,
}

/// `[flux]`
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FluxKeys {
    pub model: Key<String>,
}

/// A number, or one for each of x and y.
#[derive(Clone, Copy)]
pub(crate) struct OneOrPair(pub [f64; 2]);

impl<'de> Deserialize<'de> for OneOrPair {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Numbers;
        impl<'de> Visitor<'de> for Numbers {
            type Value = OneOrPair;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a number, or two as [x, y]")
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<OneOrPair, E> {
                Ok(OneOrPair([value; 2]))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<OneOrPair, E> {
                Ok(OneOrPair([value as f64; 2]))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<OneOrPair, A::Error> {
                let mut values = [0.0; 2];
                for (index, value) in values.iter_mut().enumerate() {
                    *value = list.next_element()?.ok_or_else(|| Error::invalid_length(index, &self))?;
                }
                match list.next_element::<f64>()? {
                    None => Ok(OneOrPair(values)),
                    Some(_) => Err(Error::invalid_length(3, &self)),
                }
            }
        }
        deserializer.deserialize_any(Numbers)
    }
}
