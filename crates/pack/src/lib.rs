//! Reference packs: written, and a candidate held to one.

mod arrays;
mod blind;
mod check;
mod check_report;
mod manifest;
mod margins;
mod provenance;
mod write;

pub use blind::{blind_scene, blind_subject};
pub use check::{CheckError, Checked, check_pack};
pub use check_report::{check_json, check_screen, write_check};
pub use manifest::{
    ChannelType, FileRole, FileType, FluxWord, MANIFEST_FORMAT, Manifest, ManifestChannel, ManifestFile,
    ManifestScene, ManifestSensor, PackKind,
};
pub use provenance::{Arithmetic, Provenance, ProvenanceError, Total, note, precision_of};
pub use write::{PackError, write_pack};
