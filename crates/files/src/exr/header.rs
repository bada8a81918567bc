//! What the header of an OpenEXR file says as it stands there: the crate `exr` puts some of it right in silence.
//! (OpenEXR file layout, openexr.com)

use exr::block::chunk::{CompressedBlock, TileCoordinates};
use exr::meta::header::Header;
use std::collections::BTreeSet;
use std::io::Cursor;

use crate::error::Fault;

/// What an OpenEXR file starts with.
const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// The bit of deep data in the second byte of the version.
const DEEP: u8 = 1 << 3;

/// Refuses a file that calls itself deep, and a window that ends before it starts: the crate believes the part's type
/// alone, and swaps the ends. What else is wrong it says itself.
pub(super) fn check(file: &[u8]) -> Result<(), Fault> {
    if !file.starts_with(&MAGIC) {
        return Ok(());
    }
    if file.get(5).is_some_and(|flags| flags & DEEP != 0) {
        return Err(Fault::new("header", "the flag of deep data", "one sample a cell"));
    }
    let mut rest = file.get(8..).unwrap_or_default();
    while let Some((attribute, after)) = Attribute::first(rest) {
        if attribute.kind == b"box2i"
            && let Some(&[x0, y0, x1, y1]) = whole_numbers(attribute.value).first_chunk()
            && (x1 < x0 || y1 < y0)
        {
            let place = String::from_utf8_lossy(attribute.name).into_owned();
            return Err(Fault::new(
                place,
                format!("from ({x0}, {y0}) to ({x1}, {y1})"),
                "an end after its start",
            ));
        }
        rest = after;
    }
    Ok(())
}

/// An attribute as its bytes.
struct Attribute<'a> {
    name: &'a [u8],
    kind: &'a [u8],
    value: &'a [u8],
}

impl<'a> Attribute<'a> {
    /// The first attribute, and what follows it; `None` at the end of the header, or where it is cut off.
    fn first(bytes: &'a [u8]) -> Option<(Self, &'a [u8])> {
        let (name, rest) = text(bytes)?;
        let (kind, rest) = text(rest).filter(|_| !name.is_empty())?;
        let (length, rest) = rest.split_first_chunk()?;
        let (value, rest) = rest.split_at_checked(usize::try_from(i32::from_le_bytes(*length)).ok()?)?;
        Some((Self { name, kind, value }, rest))
    }
}

/// A text up to its null byte, and what follows it.
fn text(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let end = bytes.iter().position(|&byte| byte == 0)?;
    Some((&bytes[..end], &bytes[end + 1..]))
}

fn whole_numbers(bytes: &[u8]) -> Vec<i32> {
    bytes.chunks_exact(4).map(|word| i32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
}

/// Refuses blocks that do not make up the image, each part of it once: the crate counts them, but two of one place leave
/// another unset, which then reads as 0.
pub(super) fn blocks(file: &[u8], header: &Header) -> Result<(), Fault> {
    let invalid = |error: exr::error::Error| {
        Fault::new("pixels", error.to_string(), "an OpenEXR file that is complete")
    };
    let first_line = i64::from(header.own_attributes.layer_position.y());
    let lines = header.compression.scan_lines_per_block() as i64;
    let key = |at: TileCoordinates| [at.level_index.1, at.level_index.0, at.tile_index.1, at.tile_index.0];
    let mut missing: BTreeSet<_> =
        header.blocks_increasing_y_order().map(|tile| key(tile.location)).collect();
    // By the offset table, as the pixels are read.
    let blocks = exr::block::read(Cursor::new(file), false)
        .and_then(|reader| reader.filter_chunks(true, |_, _, _| true))
        .map_err(invalid)?;
    for (index, block) in blocks.enumerate() {
        let block = block.map_err(invalid)?.compressed_block;
        let at = header.get_block_data_indices(&block).map_err(invalid)?;
        // The crate rounds down to the first line of a block.
        let line = match &block {
            CompressedBlock::ScanLine(block) => i64::from(block.y_coordinate) - first_line,
            _ => 0,
        };
        if line % lines != 0 || !missing.remove(&key(at)) {
            let found = match &block {
                CompressedBlock::ScanLine(block) => format!("of line {}", block.y_coordinate),
                _ => format!(
                    "of tile {}, {}, level {}, {}",
                    at.tile_index.0, at.tile_index.1, at.level_index.0, at.level_index.1
                ),
            };
            return Err(Fault::new(format!("pixels, block {index}"), found, "each part of the image once"));
        }
    }
    Ok(())
}
