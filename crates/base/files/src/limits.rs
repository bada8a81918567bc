//! Limits that a reader holds a file's claims against before it asks for memory.

use std::sync::atomic::{AtomicU64, Ordering};

/// Maximum number of attributes of an OpenEXR file, in all its parts. Parts have a few dozen.
pub const MAX_EXR_ATTRIBUTES: usize = 1024;

/// Maximum number of parts of an OpenEXR file.
pub const MAX_EXR_PARTS: usize = 64;

/// Maximum number of channels of an OpenEXR file, in all its parts.
pub const MAX_EXR_CHANNELS: usize = 1024;

/// Maximum size of the header of an OpenEXR file, bytes: 16 MiB. Some programs store lists of names there.
pub const MAX_EXR_HEADER_BYTES: usize = 1 << 24;

/// Maximum size of all channels of any compressed file, as the doubles that a reader makes of them, bytes: 512 MiB. It holds
/// 64 channels of 1024 x 1024 cells. A larger file may have [`MAX_EXPANSION`] times its own length.
pub const MAX_INFLATED_BYTES: u64 = 1 << 29;

/// Maximum size of all channels of a compressed file beyond [`MAX_INFLATED_BYTES`], as doubles, in file lengths. Zeros can be
/// compressed to a thousandth; maps of a ground are compressed to a half or a quarter.
pub const MAX_EXPANSION: u64 = 64;

/// Memory that this process may take, bytes; 0: nobody has said.
static MEMORY: AtomicU64 = AtomicU64::new(0);

/// Says how much memory this process may take for what files claim, bytes. Readers ask before they allocate.
pub fn limit_memory(bytes: u64) {
    MEMORY.store(bytes.max(1), Ordering::Relaxed);
}

/// A part of the memory that this process may take, bytes; all that there can be if nobody has said.
pub fn part_of_memory(divisor: u64) -> u64 {
    match MEMORY.load(Ordering::Relaxed) {
        0 => u64::MAX,
        bytes => bytes / divisor,
    }
}

/// Memory of a recording by the bytes that its channels have in files: they become doubles, two recordings are compared, and
/// each takes as much again. Tuned.
const MEMORY_OF_A_BYTE: u64 = 6;

/// How much a file may ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Maximum cells of a channel.
    pub cells: u64,
    /// Maximum bytes of all channels together, uncompressed.
    pub bytes: u64,
    /// Expected size, columns and rows; `None` accepts any.
    pub size: Option<(u32, u32)>,
}

impl Default for Limits {
    /// 2^26 cells, as many as a sensor may have; 4 GiB, or less where the memory is less; any size.
    fn default() -> Self {
        let bytes = part_of_memory(MEMORY_OF_A_BYTE).min(1 << 32);
        Self { cells: 1 << 26, bytes, size: None }
    }
}

impl Limits {
    /// The default limits for a file of exactly this size.
    pub fn of_size(width: u32, height: u32) -> Self {
        Self { size: Some((width, height)), ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_the_memory_is_so_much_of_it() {
        // Far more than any other test of this process asks for.
        limit_memory(1 << 62);
        assert_eq!([1, 4, 6].map(part_of_memory), [1 << 62, 1 << 60, (1 << 62) / 6]);
    }
}
