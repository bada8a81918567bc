//! `manifest.json` of a pack: what it is, and each of its files by size and digest. Schema: `docs/formats/pack.schema.json`.

pub(crate) mod scene;
pub(crate) mod verify;

use serde::{Deserialize, Serialize};
use std::path::Path;

use raypencil_files::file_sha256_hex;
use raypencil_files::{Fault, FileError, write_atomically};

/// The format of the manifests that this version writes and reads.
pub const MANIFEST_FORMAT: u32 = 1;

/// The manifest's name in its folder.
pub(crate) const FILE_NAME: &str = "manifest.json";

/// What a pack is and what belongs to it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Manifest {
    /// [`MANIFEST_FORMAT`]; it grows when a key changes its meaning or goes away.
    pub format: u32,
    /// Whether the answers are in it.
    pub kind: PackKind,
    /// The version of raypencil that wrote the pack.
    pub raypencil_version: String,
    /// The scene that it asks about.
    pub scene: ManifestScene,
    /// The equation of flux.
    pub flux_model: FluxWord,
    /// Of a blind pack, what the answers can be made from again; there exactly when the kind is blind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blind_seed: Option<u64>,
    /// The sensors: the camera, then the beams by their index.
    pub sensors: Vec<ManifestSensor>,
    /// Every file but the manifest itself.
    pub files: Vec<ManifestFile>,
}

/// Whether the answers are in a pack.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PackKind {
    /// They are.
    Answers,
    /// Only the questions are: scene, terrain and rays.
    Blind,
}

/// The words for the equations of flux.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FluxWord {
    /// What a pencil's watts really deliver, W.
    Radiometric,
    /// Equation (1) of the paper as printed, W/m.
    Eq1,
}

/// The scene of a pack.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestScene {
    /// For people.
    pub name: String,
    /// [`raypencil_scene_io::scene_sha256`] of the resolved scene: 64 hexadecimal digits.
    pub sha256: String,
}

/// A sensor and the size of its maps.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestSensor {
    /// `camera`, `beam-0`, `beam-1`, ...
    pub name: String,
    /// Columns of its maps.
    pub columns: u32,
    /// Rows of its maps.
    pub rows: u32,
}

/// What a file is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FileRole {
    /// The resolved scene.
    Scene,
    /// Its ground.
    Terrain,
    /// The rays, for programs that read no scene.
    Rays,
    /// Correctly rounded answers.
    Answers,
}

/// What the cells of a file are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FileType {
    /// NPY of double precision.
    Float64,
    /// NPY or PFM of single precision.
    Float32,
    /// NPY of 32-bit unsigned integers.
    Uint32,
    /// NPY of bytes.
    Uint8,
    /// OpenEXR, whose channels have types of their own.
    Exr,
}

/// What the cells of a channel are.
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
    /// Its path from the pack's folder, with `/`, on any system.
    pub path: String,
    /// What it is for.
    pub role: FileRole,
    /// Its size, bytes.
    pub bytes: u64,
    /// Its SHA-256: 64 hexadecimal digits.
    pub sha256: String,
    /// What its cells are, if it is an array or a map.
    #[serde(rename = "type", default, skip_serializing_if = "Option::is_none")]
    pub kind: Option<FileType>,
    /// Rows, columns and, of an array with several, components; there exactly when the type is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<Vec<u32>>,
    /// Its channels in their order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub channels: Vec<ManifestChannel>,
}

/// A channel of a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestChannel {
    /// As in `docs/formats/files.md`: `range.T`.
    pub name: String,
    /// `m`, `W`, `1`, ...; `index` of what counts.
    pub unit: String,
    /// What its cells are.
    #[serde(rename = "type")]
    pub kind: ChannelType,
}

impl ManifestFile {
    /// The entry of a file that is there: `path` from `folder`, with its size and digest, and neither type
    /// nor channels yet.
    ///
    /// # Errors
    /// A path that leaves the folder; what the file system says.
    pub fn of(folder: &Path, path: impl Into<String>, role: FileRole) -> Result<Self, FileError> {
        let path = path.into();
        let file = verify::inside(folder, &path).map_err(|fault| unfit(&folder.join(FILE_NAME), fault))?;
        let (bytes, sha256) = file_sha256_hex(&file).map_err(|error| FileError::io(&file, "read", error))?;
        Ok(Self { path, role, bytes, sha256, kind: None, shape: None, channels: Vec::new() })
    }
}

impl Manifest {
    /// Writes `manifest.json` into `folder`. The same manifest gives the same bytes.
    ///
    /// # Errors
    /// A manifest that [`Manifest::read_verified`] would refuse by its own words (the files are not looked
    /// at); what the file system says.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<(), FileError> {
        let path = folder.as_ref().join(FILE_NAME);
        self.check().map_err(|fault| unfit(&path, fault))?;
        let mut text = serde_json::to_vec_pretty(self).expect("JSON of numbers and texts");
        text.push(b'\n');
        write_atomically(&path, |file| file.write_all(&text))
    }

    /// Removes the files of a pack that was written to `folder` before, if one was, its manifest first: what a manifest
    /// that can be read lists, and nothing that leads out of the folder.
    ///
    /// # Errors
    /// What the file system says.
    pub fn remove_pack(folder: impl AsRef<Path>) -> Result<(), FileError> {
        let folder = folder.as_ref();
        let path = folder.join(FILE_NAME);
        let earlier = std::fs::read(&path).ok().and_then(|text| serde_json::from_slice::<Self>(&text).ok());
        let remove = |path: &Path| match std::fs::remove_file(path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                Err(FileError::io(path, "remove", error))
            }
            _ => Ok(()),
        };
        remove(&path)?;
        for file in earlier.iter().flat_map(|manifest| &manifest.files) {
            // What is not there any more leads nowhere.
            if let Ok(file) = verify::inside(folder, &file.path) {
                remove(&file)?;
            }
        }
        Ok(())
    }

    /// Reads the manifest of the pack in `folder`, and every file that it lists: each must be there with the
    /// size and the digest that it was written with. Files that it does not list are left alone.
    ///
    /// # Errors
    /// Names the manifest and the entry, or the file, what was found and what was expected.
    pub fn read_verified(folder: impl AsRef<Path>) -> Result<Self, FileError> {
        let folder = folder.as_ref();
        let manifest = verify::read(folder)?;
        for file in &manifest.files {
            verify::file(folder, file)?;
        }
        Ok(manifest)
    }
}

pub(crate) fn unfit(path: &Path, fault: Fault) -> FileError {
    FileError::Pack(fault.in_file(path))
}
