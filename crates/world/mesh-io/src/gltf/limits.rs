//! Limits of what is read and written. A small file can ask for any amount of memory or time.

/// Maximum size of a file: 1 GiB.
pub(super) const MAX_FILE_BYTES: u64 = 1 << 30;

/// Maximum size of all files with buffers beside a glTF file together, each counted once: 512 MiB. A file may have holes, so
/// that it takes no space on the disk and all of it in memory. A larger ground fits into a GLB.
pub const MAX_BUFFER_FILES_BYTES: u64 = 1 << 29;

/// Maximum number of faces, and of vertices, of all instances together. A small file can ask for any number of
/// instances of one mesh; 2^25 faces and vertices take about 1.5 GB.
pub(crate) const MAX_FACES_OR_VERTICES: u64 = 1 << 25;

/// Maximum number of primitives of all instances together, points and lines included: each takes time. CHOICE: four
/// million, since a mesh of rocks has one primitive for each rock.
pub(super) const MAX_PRIMITIVES: u64 = 1 << 22;

/// Maximum number of materials. One index is left for faces without a material.
pub(super) const MAX_MATERIALS: usize = u16::MAX as usize - 1;
