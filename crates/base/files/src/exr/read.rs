//! OpenEXR of any program to named channels. The header's claims are checked before memory is allocated.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;

use exr::image::FlatSamples;
use exr::image::read::image::ReadLayers;
use exr::image::read::layers::ReadChannels;
use exr::math::Vec2;
use exr::meta::attribute::{AttributeValue, Text};
use exr::meta::header::Header;
use exr::prelude::Compression;
use raypencil_scene::Image;

use crate::bytes;
use crate::error::{Fault, FileError};
use crate::exr::header;
use crate::exr::map::{ExrMap, Raster, channel};
use crate::limits::{Limits, MAX_EXPANSION, MAX_INFLATED_BYTES};

/// Reads all channels of an OpenEXR file with one part.
///
/// Scan lines and tiles are read, and the largest of several resolutions. Several parts ([`read_exr_parts`] reads them), deep
/// data, subsampled channels and lossy compression are refused.
///
/// Limits beside `limits`, held before anything is decoded: [`MAX_EXR_ATTRIBUTES`](crate::MAX_EXR_ATTRIBUTES),
/// [`MAX_EXR_CHANNELS`](crate::MAX_EXR_CHANNELS) and [`MAX_EXR_HEADER_BYTES`](crate::MAX_EXR_HEADER_BYTES) of the header; all
/// channels together, as doubles, are at most [`MAX_INFLATED_BYTES`] or [`MAX_EXPANSION`] times as long as the file,
/// whichever is more.
///
/// # Errors
/// Names the file, the channel or other place in it, what was found and what was expected.
pub fn read_exr(path: impl AsRef<Path>, limits: &Limits) -> Result<ExrMap, FileError> {
    let path = path.as_ref();
    exr_from_bytes(&file_bytes(path, limits)?, path, limits)
}

/// Reads the bytes of an OpenEXR file as [`read_exr`] does; `file` is its name in messages.
///
/// # Errors
/// As [`read_exr`].
pub fn exr_from_bytes(bytes: &[u8], file: &Path, limits: &Limits) -> Result<ExrMap, FileError> {
    let mut parts = exr_parts_from_bytes(bytes, file, limits)?;
    match (parts.pop(), parts.len()) {
        (Some(part), 0) => Ok(part.map),
        (_, others) => {
            let fault = Fault::new("header", format!("{} parts", others + 1), "one part");
            Err(FileError::Exr(fault.in_file(file)))
        }
    }
}

/// Reads all parts of an OpenEXR file, at most [`MAX_EXR_PARTS`](crate::MAX_EXR_PARTS). Each may have a size of its own.
///
/// # Errors
/// As [`read_exr`]; two parts of one name.
pub fn read_exr_parts(path: impl AsRef<Path>, limits: &Limits) -> Result<Vec<ExrPart>, FileError> {
    let path = path.as_ref();
    exr_parts_from_bytes(&file_bytes(path, limits)?, path, limits)
}

/// Reads the bytes of an OpenEXR file as [`read_exr_parts`] does; `file` is its name in messages.
///
/// # Errors
/// As [`read_exr_parts`].
pub fn exr_parts_from_bytes(bytes: &[u8], file: &Path, limits: &Limits) -> Result<Vec<ExrPart>, FileError> {
    decode(bytes, limits).map_err(|fault| FileError::Exr(fault.in_file(file)))
}

/// A part of an OpenEXR file.
#[derive(Debug, Clone)]
pub struct ExrPart {
    /// Its name; empty if the file has only one.
    pub name: String,
    /// The eye or camera that it says to be of; empty if it says nothing.
    pub view: String,
    /// Its channels.
    pub map: ExrMap,
}

fn file_bytes(path: &Path, limits: &Limits) -> Result<Vec<u8>, FileError> {
    // A file larger than the limit of its decompressed data holds something else.
    bytes::read_file(path, limits.bytes).map_err(|error| FileError::io(path, "read", error))
}

fn decode(file: &[u8], limits: &Limits) -> Result<Vec<ExrPart>, Fault> {
    let invalid = |place: &'static str| {
        move |error: exr::error::Error| {
            Fault::new(place, error.to_string(), "an OpenEXR file that is complete")
        }
    };
    header::check_attributes(file)?;
    // Only the headers are read here, not the offset tables and the pixels.
    let reader = exr::block::read(Cursor::new(file), false).map_err(invalid("header"))?;
    let mut claimed = Claims::default();
    for header in reader.headers() {
        check_claims(header, file.len() as u64, limits, &mut claimed)?;
    }
    header::check_blocks(file, reader.headers())?;

    let image = exr::image::read::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        // On one thread, where a damaged block is reported as an error.
        .non_parallel()
        // Checks the blocks, not the header: an offset table with gaps would leave cells unset.
        .pedantic()
        .from_chunks(reader)
        .map_err(invalid("pixels"))?;

    let has_parts = image.layer_data.len() > 1;
    let mut parts: Vec<ExrPart> = Vec::new();
    for layer in image.layer_data {
        let text = |text: &Option<Text>| text.as_ref().map(Text::to_string).unwrap_or_default();
        let name = if has_parts { text(&layer.attributes.layer_name) } else { String::new() };
        if parts.iter().any(|other| other.name == name) {
            return Err(Fault::new(format!("part {name:?}"), "there twice", "each part once"));
        }
        let mut map = ExrMap::new(layer.size.width() as u32, layer.size.height() as u32);
        map.attributes = texts(&image.attributes.other);
        map.attributes.extend(texts(&layer.attributes.other));
        for of_layer in layer.channel_data.list {
            let name = of_layer.name.to_string();
            let (width, height) = (map.width, map.height);
            let raster = match of_layer.sample_data {
                FlatSamples::F16(cells) => {
                    map.halves.insert(name.clone());
                    let cells = cells.into_iter().map(|cell| cell.to_f32()).collect();
                    Raster::F32(Image::from_cells(width, height, cells))
                }
                FlatSamples::F32(cells) => Raster::F32(Image::from_cells(width, height, cells)),
                FlatSamples::U32(cells) => Raster::U32(Image::from_cells(width, height, cells)),
            };
            if map.channels.insert(name.clone(), raster).is_some() {
                return Err(Fault::new(channel(&name), "there twice", "each channel once"));
            }
        }
        parts.push(ExrPart { name, view: text(&layer.attributes.view_name), map });
    }
    Ok(parts)
}

/// What the headers of all parts that were checked claim together.
#[derive(Default)]
struct Claims {
    bytes: u64,
    doubles: u64,
    blocks: u64,
}

/// Refuses a header that claims more than `limits` allow, or more than a file of this length can hold.
fn check_claims(
    header: &Header,
    file_bytes: u64,
    limits: &Limits,
    claimed: &mut Claims,
) -> Result<(), Fault> {
    let Vec2(width, height) = header.layer_size;
    let (width, height) = (width as u64, height as u64);
    let refuse =
        |expected: String| Err(Fault::new("data window", format!("{width} x {height} cells"), expected));
    if width == 0 || height == 0 || width.saturating_mul(height) > limits.cells {
        return refuse(format!("1 to {} cells", limits.cells));
    }
    if let Some((columns, rows)) = limits.size
        && (width, height) != (columns.into(), rows.into())
    {
        return refuse(format!("{columns} x {rows}"));
    }
    // A cropped image would shift every cell against the sensor's cells.
    let (data, display) = (header.data_window(), header.shared_attributes.display_window);
    if data != display {
        let found = format!("{}", Window(data));
        return Err(Fault::new("data window", found, format!("the display window, {}", Window(display))));
    }
    if header.deep {
        return Err(Fault::new("header", "deep data", "one sample a cell"));
    }
    let mut bytes_per_cell = 0_u64;
    for description in &header.channels.list {
        let name = description.name.to_string();
        if description.sampling != Vec2(1, 1) {
            let Vec2(x, y) = description.sampling;
            return Err(Fault::new(channel(&name), format!("a sample every {x} x {y} cells"), "one a cell"));
        }
        bytes_per_cell += description.sample_type.bytes_per_sample() as u64;
    }
    let bytes_of_part = width * height * bytes_per_cell;
    claimed.bytes = claimed.bytes.saturating_add(bytes_of_part);
    let bytes = claimed.bytes;
    if bytes > limits.bytes {
        return Err(Fault::new("channels", format!("{bytes} bytes"), format!("at most {}", limits.bytes)));
    }
    // What a caller makes of the samples: doubles. A small file could otherwise ask for gigabytes.
    let of_part = (width * height).saturating_mul(8 * header.channels.list.len() as u64);
    claimed.doubles = claimed.doubles.saturating_add(of_part);
    let doubles = claimed.doubles;
    if doubles > max_inflated_bytes(file_bytes) {
        let found = format!(
            "{width} x {height} cells of {} channels, {doubles} bytes as doubles, in a file of {file_bytes} bytes",
            header.channels.list.len()
        );
        let expected =
            format!("at most {MAX_INFLATED_BYTES} bytes, or {MAX_EXPANSION} times the length of the file");
        return Err(Fault::new("data window", found, expected));
    }
    // Every block takes 8 bytes in the offset table and 8 of its own header.
    claimed.blocks = claimed.blocks.saturating_add(header.chunk_count as u64);
    let blocks = claimed.blocks;
    let Some(expansion) = max_expansion(header.compression) else {
        let expected = "none, RLE, ZIPS, ZIP or PIZ, which keep every bit";
        return Err(Fault::new("header", header.compression.to_string(), expected));
    };
    let max_bytes = expansion.saturating_mul(file_bytes);
    if blocks.saturating_mul(16) > file_bytes || bytes_of_part > max_bytes {
        let found =
            format!("{width} x {height} cells of {bytes_per_cell} bytes in a file of {file_bytes} bytes");
        return Err(Fault::new("data window", found, "a size that the file can hold (is it cut off?)"));
    }
    Ok(())
}

/// Maximum size of the samples of a file of this length, as doubles, bytes.
fn max_inflated_bytes(file_bytes: u64) -> u64 {
    MAX_INFLATED_BYTES.max(MAX_EXPANSION.saturating_mul(file_bytes))
}

/// Upper bound of the bytes of cells that one byte of the file can hold; `None` for lossy compressions.
///
/// CHOICE: lossy files are refused. Maps are compared to the last bit, which a lossy file no longer has. The decoders
/// of B44 and DWA also allocate memory by unchecked numbers.
fn max_expansion(compression: Compression) -> Option<u64> {
    match compression {
        Compression::Uncompressed => Some(1),
        // Runs of at most 128 in two bytes.
        Compression::RLE => Some(64),
        // Deflate codes at most 258 bytes in two bits: a factor of 1032.
        Compression::ZIP1 | Compression::ZIP16 => Some(1032),
        // After a wavelet transform, Huffman codes of at least ten bits for runs of at most 261 values of two bytes:
        // a factor of 418.
        Compression::PIZ => Some(1032),
        _ => None,
    }
}

/// A rectangle, formatted for messages.
struct Window(exr::meta::attribute::IntegerBounds);

impl std::fmt::Display for Window {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (Vec2(x, y), Vec2(width, height)) = (self.0.position, self.0.size);
        write!(f, "{width} x {height} at ({x}, {y})")
    }
}

/// Text attributes among `attributes`.
fn texts<'a>(
    attributes: impl IntoIterator<Item = (&'a Text, &'a AttributeValue)>,
) -> BTreeMap<String, String> {
    let text = |(name, value): (&Text, &AttributeValue)| match value {
        AttributeValue::Text(text) => Some((name.to_string(), text.to_string())),
        _ => None,
    };
    attributes.into_iter().filter_map(text).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_longer_file_may_hold_more() {
        // 512 MiB up to 8 MiB of file, from there 64 times as much.
        for file_bytes in [0, 1, 540_000, 1 << 23] {
            assert_eq!(max_inflated_bytes(file_bytes), 1 << 29);
        }
        assert_eq!(max_inflated_bytes((1 << 23) + 1), (1 << 29) + 64);
        assert_eq!(max_inflated_bytes(u64::MAX), u64::MAX);
    }
}
