//! Limits that a reader holds a file's claims against before it asks for memory.

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
    /// 2^26 cells, as many as a sensor may have; 4 GiB; any size.
    fn default() -> Self {
        Self { cells: 1 << 26, bytes: 1 << 32, size: None }
    }
}

impl Limits {
    /// The default limits for a file of exactly this size.
    pub fn of_size(width: u32, height: u32) -> Self {
        Self { size: Some((width, height)), ..Self::default() }
    }
}
