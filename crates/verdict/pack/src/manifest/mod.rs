//! `manifest.json` of a pack: kind, scene, sensors, and each file by size and digest. Schema:
//! `docs/formats/pack.schema.json`.
//!
//! ```text
//! document      the structure of the file
//! path          paths that stay inside the pack's folder
//! consistency   refuses a manifest that contradicts itself
//! write         writes a manifest, removes an earlier pack
//! read          reads a manifest, and verifies the files that it lists
//! scene         loads the scene of a verified pack
//! ```

mod consistency;
mod document;
mod path;
mod read;
mod scene;
mod write;

pub use document::{
    ChannelType, FileRole, FileType, MANIFEST_FORMAT, Manifest, ManifestChannel, ManifestClause,
    ManifestFile, ManifestScene, ManifestSensor, ManifestSharpness, PackKind,
};
pub(crate) use document::{MANIFEST_NAME, pack_fault};
