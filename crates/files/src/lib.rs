//! Files of numbers: NPY, PFM, OpenEXR, recordings of channels, digests, and folders that are written whole.

mod array;
mod atomic;
pub mod bytes;
mod channels;
mod error;
mod exr;
mod folder;
mod limits;
mod npy;
mod pfm;
mod sha;

pub use array::{Array, ArrayNumber, Storage, Values};
pub use atomic::write_atomically;
pub use channels::{Channel, Channels, read_channels, read_listed};
pub use error::{Fault, FileError, Problem, shortened};

pub use exr::read::{exr_from_bytes, read_exr};
pub use exr::write::write_exr;
pub use exr::{Attributes, ExrMap, Raster, read_exr_map, write_exr_map};
pub use folder::{FolderError, begin, create};
pub use limits::Limits;
pub use npy::write::write_npy;
pub use npy::{npy_from_bytes, read_npy};
pub use pfm::{pfm_from_bytes, read_pfm, write_pfm};
pub use sha::{Sha, combine, hex, of_file, sha, sha_of_file};
