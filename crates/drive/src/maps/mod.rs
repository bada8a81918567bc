//! What a drive leaves behind, in the formats of those who use it. `docs/guide/drive.md` has the conventions.

pub(crate) mod camera_info;
pub(crate) mod occupancy;
pub(crate) mod ply;
pub(crate) mod vectors;
pub(crate) mod yaml;
