//! Checks of an OpenEXR file before it is decoded: faults that the crate `exr` corrects or overlooks in silence.
//! (OpenEXR file layout, openexr.com)

use std::collections::BTreeSet;
use std::io::Cursor;

use exr::block::chunk::{CompressedBlock, TileCoordinates};
use exr::meta::header::Header;

use crate::error::Fault;
use crate::limits::{MAX_EXR_ATTRIBUTES, MAX_EXR_CHANNELS, MAX_EXR_HEADER_BYTES, MAX_EXR_PARTS};

/// First bytes of every OpenEXR file.
const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Bit of deep data in the second byte of the version.
const DEEP_DATA_FLAG: u8 = 1 << 3;

/// Bit of several parts in the second byte of the version.
const SEVERAL_PARTS_FLAG: u8 = 1 << 4;

/// Refuses a file with the flag of deep data, a window that ends before it starts, an attribute that is there twice, and headers that take much memory: too
/// many bytes, attributes, channels or parts.
///
/// The crate looks only at the type of the part for deep data, swaps the ends of such a window, and reads all parts and all
/// attributes, each of which takes over a kilobyte, and takes one of two attributes of one name. It reports all other faults of the
/// header itself. Nothing but a list of names is allocated here, after their number is known to be small.
pub(super) fn check_attributes(file: &[u8]) -> Result<(), Fault> {
    if !file.starts_with(&MAGIC) {
        return Ok(());
    }
    let flags = file.get(5).copied().unwrap_or_default();
    if flags & DEEP_DATA_FLAG != 0 {
        return Err(Fault::new("header", "the flag of deep data", "one sample a cell"));
    }
    let has_parts = flags & SEVERAL_PARTS_FLAG != 0;
    let start = file.get(8..).unwrap_or_default();
    let mut rest = start;
    let (mut attributes, mut channels) = (0, 0);
    for parts in 1.. {
        let mut names = BTreeSet::new();
        while let Some((attribute, after)) = Attribute::first(rest) {
            attributes += 1;
            let bytes = start.len() - after.len();
            for (found, limit, what) in
                [(attributes, MAX_EXR_ATTRIBUTES, "attributes"), (bytes, MAX_EXR_HEADER_BYTES, "bytes")]
            {
                if found > limit {
                    let found = format!("{found} {what} or more");
                    return Err(Fault::new("header", found, format!("at most {limit}")));
                }
            }
            check_attribute(&attribute, &mut channels)?;
            // Of two that differ, some programs take the first and others the last.
            if !names.insert(attribute.name) {
                let name = String::from_utf8_lossy(attribute.name).into_owned();
                return Err(Fault::new("header", format!("attribute {name:?} twice"), "each attribute once"));
            }
            rest = after;
        }
        // A header ends with a byte 0. Behind the last of several stands another one.
        let Some((0, after)) = rest.split_first() else { break };
        rest = after;
        if !has_parts || rest.first().is_none_or(|&byte| byte == 0) {
            break;
        }
        if parts == MAX_EXR_PARTS {
            let found = format!("{} parts or more", parts + 1);
            return Err(Fault::new("header", found, format!("at most {MAX_EXR_PARTS}")));
        }
    }
    Ok(())
}

/// Refuses a window that ends before it starts; counts the channels of all parts.
fn check_attribute(attribute: &Attribute, channels: &mut usize) -> Result<(), Fault> {
    match attribute.kind {
        b"box2i" => {
            if let Some(&[x0, y0, x1, y1]) = little_endian_words(attribute.value).first_chunk()
                && (x1 < x0 || y1 < y0)
            {
                let place = String::from_utf8_lossy(attribute.name).into_owned();
                let found = format!("from ({x0}, {y0}) to ({x1}, {y1})");
                return Err(Fault::new(place, found, "an end after its start"));
            }
        }
        b"chlist" => {
            let mut rest = attribute.value;
            while let Some((_, after)) = null_terminated(rest).filter(|(name, _)| !name.is_empty()) {
                *channels += 1;
                if *channels > MAX_EXR_CHANNELS {
                    let found = format!("{channels} channels or more");
                    return Err(Fault::new("header", found, format!("at most {MAX_EXR_CHANNELS}")));
                }
                // Type, a flag and three bytes, and the sampling along two axes.
                rest = after.get(16..).unwrap_or_default();
            }
        }
        _ => {}
    }
    Ok(())
}

/// Bytes of one attribute.
struct Attribute<'a> {
    name: &'a [u8],
    kind: &'a [u8],
    value: &'a [u8],
}

impl<'a> Attribute<'a> {
    /// The first attribute and the bytes after it; `None` at the end of the header, or where it is cut off.
    fn first(bytes: &'a [u8]) -> Option<(Self, &'a [u8])> {
        let (name, rest) = null_terminated(bytes)?;
        let (kind, rest) = null_terminated(rest).filter(|_| !name.is_empty())?;
        let (length, rest) = rest.split_first_chunk()?;
        let (value, rest) = rest.split_at_checked(usize::try_from(i32::from_le_bytes(*length)).ok()?)?;
        Some((Self { name, kind, value }, rest))
    }
}

/// A text up to its null byte, and the bytes after that.
fn null_terminated(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let end = bytes.iter().position(|&byte| byte == 0)?;
    Some((&bytes[..end], &bytes[end + 1..]))
}

fn little_endian_words(bytes: &[u8]) -> Vec<i32> {
    bytes.chunks_exact(4).map(|word| i32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
}

/// Refuses blocks that do not cover every part of the image exactly once.
///
/// The crate only counts them. Two blocks of one place leave another place unset, which would then read as 0.
pub(super) fn check_blocks(file: &[u8], headers: &[Header]) -> Result<(), Fault> {
    let invalid = |error: exr::error::Error| {
        Fault::new("pixels", error.to_string(), "an OpenEXR file that is complete")
    };
    let key = |at: TileCoordinates| [at.level_index.1, at.level_index.0, at.tile_index.1, at.tile_index.0];
    let mut missing: Vec<BTreeSet<_>> = headers
        .iter()
        .map(|header| header.blocks_increasing_y_order().map(|tile| key(tile.location)).collect())
        .collect();
    // In the order of the offset tables, in which the pixels are read.
    let blocks = exr::block::read(Cursor::new(file), false)
        .and_then(|reader| reader.filter_chunks(true, |_, _, _| true))
        .map_err(invalid)?;
    for (index, block) in blocks.enumerate() {
        let block = block.map_err(invalid)?;
        let part = block.layer_index;
        let (Some(header), Some(missing)) = (headers.get(part), missing.get_mut(part)) else {
            let found = format!("of part {part}");
            return Err(Fault::new(format!("pixels, block {index}"), found, "a part of the file"));
        };
        let block = block.compressed_block;
        let at = header.get_block_data_indices(&block).map_err(invalid)?;
        let lines = header.compression.scan_lines_per_block() as i64;
        // The crate rounds a block's line down to a multiple of its height.
        let line = match &block {
            CompressedBlock::ScanLine(block) => {
                i64::from(block.y_coordinate) - i64::from(header.own_attributes.layer_position.y())
            }
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
    if let Some(part) = missing.iter().position(|missing| !missing.is_empty()) {
        let found = format!("{} blocks too few in part {part}", missing[part].len());
        return Err(Fault::new("pixels", found, "each part of the image once"));
    }
    Ok(())
}
