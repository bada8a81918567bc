//! Point clouds as other programs write them: PCD, PLY, and points as bytes.
//!
//! CHOICE: PCD has a small parser of its own. `pcd-rs` knows no compressed files, and its errors name no place.

mod columns;
mod lzf;
mod packed;
mod pcd;
mod printed;
mod read;

pub use columns::{Cloud, CloudColumn, CloudStorage};
pub(crate) use columns::{decimal, whole_decimal};
pub use lzf::compressed as lzf_compressed;
pub use packed::{PackedField, PackedKind, PackedPoints};
pub(crate) use printed::{Printed, with_decimals};
pub use read::{claimed_points, cloud_from_bytes, is_cloud_file, read_cloud};
