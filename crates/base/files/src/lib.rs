//! Files of numbers, and how they are written: NPY, PFM and OpenEXR (NPZ, Zarr, PNG and TIFF are read), recordings of
//! channels, SHA-256, output folders.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! A file is either written whole or not at all, and the same values give the same bytes on every machine. A reader
//! checks every size that a header claims against the length of the file and against [`Limits`] before it asks for
//! memory. An error names the file, the place in it, what was found and what was expected.
//!
//! ```text
//! error                          FileError: the file, the place in it, what was found and what was expected
//! limits, bytes                  how much a file may ask for, and reading one up to a limit
//! quoted                         words for a shell
//! sha256                         digests
//! program                        digests of programs
//! watch, disk                    operations that change a disk, each of which a test can let fail
//! made_list, journal -> running  what runs have made in a folder, what this process has, and who writes there
//!         -> placing             a complete file comes to its place
//! atomic, folder                 writing a file whole, output folders
//! folder_lock                    one run in a folder, or several that share it
//! output_folder                  one run at a time in a folder, and nothing of an earlier one left in it
//! harmless                       texts of untrusted files, for terminals and Markdown
//! growing_file                   a file or table that grows for a while and is seen only when it is complete
//! values -> shape                cells as a file stores them, and the size that a header claims
//! npy, pfm                       arrays of NumPy and portable float maps
//! npz, zarr                      archives and stores of arrays: read (named_array writes them)
//! png, tiff                      depth images and other pictures, as numbers
//! rays                           rays of no sensor, from NPY and CSV
//! exr: map -> read, write        named channels and text attributes of an OpenEXR file
//!      -> sensor_map, returns    the maps of one sensor, and the light that comes back to the camera, as channels
//! channels: channel -> find,     recordings of any program: the channels of a file or folder by their keys
//!           found -> declared,   what somebody declares of them: which channel is which map, the unit of whole numbers
//!           merge -> read
//! ```
//!
//! The formats are described in `docs/formats/files.md`. Sources: NumPy Enhancement Proposal 1 (NPY), the OpenEXR file
//! layout (openexr.com), the PFM format of Paul Debevec's HDR Shop, FIPS 180-4 (SHA-256).
//!
//! ```
//! use raypencil_files::{Limits, Values, read_npy, write_npy};
//! use raypencil_scene::Image;
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("range.npy");
//! let ranges = Image::from_cells(2, 1, vec![2.5, 1.0 / 3.0]);
//! write_npy(&path, &[&ranges])?;
//!
//! // NPY stores f64 as it is: every bit comes back.
//! let array = read_npy(&path, &Limits::default())?;
//! assert_eq!(array.planes, [Values::Reals(ranges)]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod atomic;
pub mod bytes;
mod channels;
mod comment_heading;
mod disk;
mod error;
mod exr;
mod folder;
mod folder_lock;
mod growing_file;
mod harmless;
mod journal;
mod limits;
mod made_list;
mod named_array;
mod npy;
mod npz;
mod output_folder;
mod pfm;
mod placing;
mod png;
mod program;
mod quoted;
mod rays;
mod running;
mod sha256;
mod shape;
mod tiff;
mod values;
mod watch;
mod zarr;

pub use atomic::{ask_place, write_atomically};
pub use channels::{
    Channel, Channels, Declared, DeclaredChannel, Used, add_ray_sets, has_maps, has_ray_sets, is_ray_set,
    read_channels, read_channels_as, read_listed_channels,
};
pub use comment_heading::heading_in_comment;
pub use disk::{TemporaryFolder, create_dir_all, remove_dir, remove_file};
pub use error::{Fault, FileError, Problem, readable, shortened};
pub use exr::{
    Attributes, ExrMap, ExrPart, Raster, exr_from_bytes, exr_parts_from_bytes, read_exr, read_exr_parts,
    write_exr,
};
pub use folder::{FolderError, begin_output_folder, create_folder, write_texts};
pub use growing_file::{GrowingFile, NpyRows};
pub use harmless::{harmless, harmless_line, harmless_source, markdown_text};
pub use journal::Journal;
pub use limits::{
    Limits, MAX_EXPANSION, MAX_EXR_ATTRIBUTES, MAX_EXR_CHANNELS, MAX_EXR_HEADER_BYTES, MAX_EXR_PARTS,
    MAX_INFLATED_BYTES, limit_memory, part_of_memory,
};
pub use made_list::subject_of;
pub use named_array::{ArrayData, NamedArray, write_npz, write_zarr};
pub use npy::{
    ArrayNumber, Numbers, npy_from_bytes, npy_numbers_from_bytes, read_npy, read_npy_numbers, write_npy,
    write_npy_numbers,
};
pub use npz::{npz_from_bytes, read_npz};
pub use output_folder::{MIN_ABANDONED_AGE, OutputFolder, SharedFolder, begin_files, remove_abandoned};
pub use pfm::{pfm_from_bytes, read_pfm, write_pfm};
pub use placing::{claim, put_in_place};
pub use png::{png_from_bytes, read_picture_png};
pub use program::{command_files, program_sha256};
pub use quoted::quoted;
pub use rays::{RayArray, ray_rows, rays_from_bytes, read_rays};
pub use sha256::{Sha256Digest, combined_sha256_hex, file_sha256, file_sha256_hex, hex_digits, sha256};
pub use tiff::{read_picture_tiff, tiff_from_bytes};
pub use values::{Array, Step, Storage, Values};
pub use watch::{Operation, Watch, Watcher, watch};
pub use zarr::{ZarrArray, read_zarr};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_files;
#[cfg(test)]
#[path = "../tests/unit/folder_faults.rs"]
mod folder_faults;
#[cfg(test)]
#[path = "../tests/unit/folder_orders.rs"]
mod folder_orders;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
