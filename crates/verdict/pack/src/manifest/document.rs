//! The structure of `manifest.json`.

use std::path::Path;

use raypencil_files::{Fault, FileError};
use raypencil_scene::FluxModel;
use serde::{Deserialize, Serialize};

use crate::sharpness::Sharpness;

/// Number of the format that this version writes and reads. It grows when a key changes its meaning or goes away.
pub const MANIFEST_FORMAT: u32 = 1;

/// The manifest's file name.
pub(crate) const MANIFEST_NAME: &str = "manifest.json";

/// Content of `manifest.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Manifest {
    /// Number of the format: [`MANIFEST_FORMAT`].
    pub format: u32,
    /// Whether the pack holds the answers.
    pub kind: PackKind,
    /// Version of raypencil that wrote the pack.
    pub raypencil_version: String,
    /// Version of the pack itself, if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub version: Option<String>,
    /// Licence of the pack itself as an SPDX expression, if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub licence: Option<String>,
    /// The scene.
    pub scene: ManifestScene,
    /// The scene's flux model.
    #[serde(with = "FluxModelKey")]
    pub flux_model: FluxModel,
    /// Seed of the scene of a blind pack; `None` for the other kind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blind_seed: Option<u64>,
    /// The camera, then the beams by their index.
    pub sensors: Vec<ManifestSensor>,
    /// How many rays decide each clause of the contract; empty if they were not counted.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub clauses: Vec<ManifestClause>,
    /// How large a tolerance of each clause is noticed; empty if it was not measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sharpness: Vec<ManifestSharpness>,
    /// Every file except the manifest.
    pub files: Vec<ManifestFile>,
}

/// Whether a pack holds the answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PackKind {
    /// Scene, terrain, rays and answers.
    Answers,
    /// Scene, terrain and rays. The answers are computed from the seed when a candidate is checked.
    Blind,
    /// Scene, terrain and rays of any scene. The answers are computed from the scene.
    Questions,
}

/// [`FluxModel`] as the manifest's words: `scene` knows no serde.
#[derive(Serialize, Deserialize)]
#[serde(remote = "FluxModel", rename_all = "lowercase")]
enum FluxModelKey {
    Radiometric,
    Eq1,
}

/// A scene by name and digest.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestScene {
    /// Name, for people.
    pub name: String,
    /// [`raypencil_scene_io::scene_sha256`] of the resolved scene, 64 hexadecimal digits.
    pub sha256: String,
}

/// A sensor and the size of its maps.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestSensor {
    /// `camera`, `beam-0`, `beam-1`, ...
    pub name: String,
    /// Number of columns.
    pub columns: u32,
    /// Number of rows.
    pub rows: u32,
}

/// A clause of the contract, and the rays that test it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestClause {
    /// The clause's key, such as `fronts-only`.
    pub clause: String,
    /// On how many rays a renderer that breaks the clause is wrong.
    pub rays: u64,
}

/// A way to keep a clause with a tolerance, and the smallest tolerance that the pack notices.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestSharpness {
    /// Key of the way, such as `shadow-starts-away`.
    pub slack: String,
    /// Unit of the sizes.
    pub unit: String,
    /// The smallest size that is noticed of a candidate that computes in double precision; `None`: none is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub f64: Option<f64>,
    /// The same for single precision.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub f32: Option<f64>,
}

impl ManifestSharpness {
    /// The entry of a slack.
    pub(crate) fn new(double: &Sharpness, single: &Sharpness) -> Self {
        Self {
            slack: double.slack.key().into(),
            unit: double.slack.unit().words().into(),
            f64: double.noticed,
            f32: single.noticed,
        }
    }
}

/// Purpose of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FileRole {
    /// The resolved scene.
    Scene,
    /// The scene's ground.
    Terrain,
    /// The rays of a sensor, for programs that read no scene.
    Rays,
    /// Correctly rounded answers.
    Answers,
    /// The list of a set's own pack: rays of no sensor, with their answers.
    #[serde(rename = "raySet")]
    RaySet,
}

/// Type of a file's cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FileType {
    /// NPY in double precision.
    Float64,
    /// NPY or PFM in single precision.
    Float32,
    /// NPY with 32-bit unsigned integers.
    Uint32,
    /// NPY with bytes.
    Uint8,
    /// OpenEXR: each channel has its own type.
    Exr,
}

/// Type of a channel's cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ChannelType {
    /// Double precision.
    Float64,
    /// Single precision.
    Float32,
    /// 32-bit unsigned integers.
    Uint32,
    /// Bytes.
    Uint8,
}

/// A file of a pack.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestFile {
    /// Path from the pack's folder, with `/` on every system.
    pub path: String,
    /// Purpose.
    pub role: FileRole,
    /// Size, bytes.
    pub bytes: u64,
    /// SHA-256, 64 hexadecimal digits in lower case.
    pub sha256: String,
    /// Type of the cells, if the file is an array or a map.
    #[serde(rename = "type", default, skip_serializing_if = "Option::is_none")]
    pub kind: Option<FileType>,
    /// Rows, columns, and components if an array has several. `None` exactly if `kind` is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<Vec<u32>>,
    /// The channels in their order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub channels: Vec<ManifestChannel>,
}

/// A channel of a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestChannel {
    /// Name as in `docs/formats/files.md`, such as `range.T`.
    pub name: String,
    /// Unit: `m`, `W`, `1`, ...; `index` for integers that count.
    pub unit: String,
    /// Type of the cells.
    #[serde(rename = "type")]
    pub kind: ChannelType,
}

pub(crate) fn pack_fault(path: &Path, fault: Fault) -> FileError {
    FileError::Pack(fault.in_file(path))
}
