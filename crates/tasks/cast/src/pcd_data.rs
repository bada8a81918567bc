//! How the points of a PCD file are stored behind its header.

use std::io::{Result, Write};

use raypencil_mesh_io::lzf_compressed;

/// How the points of a PCD file are stored.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum PcdData {
    /// Point by point.
    #[default]
    Binary,
    /// Field by field, compressed by LZF.
    BinaryCompressed,
}

impl PcdData {
    /// The word of the header.
    pub fn word(self) -> &'static str {
        match self {
            Self::Binary => "binary",
            Self::BinaryCompressed => "binary_compressed",
        }
    }

    /// Most bytes that points may take.
    pub(crate) fn most(self) -> u64 {
        match self {
            Self::Binary => u64::MAX,
            Self::BinaryCompressed => u32::MAX.into(),
        }
    }

    /// Writes what `points` writes point by point; `sizes` are those of a point's fields, bytes.
    pub(crate) fn write(
        self,
        file: &mut dyn Write,
        sizes: &[usize],
        points: impl FnOnce(&mut dyn Write) -> Result<()>,
    ) -> Result<()> {
        let mut rows = Vec::new();
        match self {
            Self::Binary => return points(file),
            Self::BinaryCompressed => points(&mut rows)?,
        }
        let packed = lzf_compressed(&by_fields(&rows, sizes));
        let length = |bytes: &[u8]| (bytes.len() as u32).to_le_bytes();
        file.write_all(&length(&packed))?;
        file.write_all(&length(&rows))?;
        file.write_all(&packed)
    }
}

/// The first fields of all points, then the second ones, and so on.
fn by_fields(rows: &[u8], sizes: &[usize]) -> Vec<u8> {
    let size: usize = sizes.iter().sum();
    let mut columns = Vec::with_capacity(rows.len());
    let mut from = 0;
    for of_field in sizes {
        for row in rows.chunks_exact(size) {
            columns.extend_from_slice(&row[from..from + of_field]);
        }
        from += of_field;
    }
    columns
}
