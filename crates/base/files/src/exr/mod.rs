//! OpenEXR: named channels and text attributes, the maps of one sensor, and the light that comes back to the camera.
//! The names and units of channels are in `docs/formats/files.md`.

mod header;
mod map;
mod read;
mod returns;
mod sensor_map;
mod write;

pub(crate) use map::convert;
pub use map::{ExrMap, Raster};
pub use read::{ExrPart, exr_from_bytes, exr_parts_from_bytes, read_exr, read_exr_parts};
pub use sensor_map::Attributes;
pub use write::write_exr;
