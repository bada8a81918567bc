//! OpenEXR of any program to named channels. The header's claims are checked before memory is allocated.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;

use exr::image::FlatSamples;
use exr::image::read::image::ReadLayers;
use exr::image::read::layers::ReadChannels;
use exr::math::Vec2;
use exr::meta::attribute::AttributeValue;
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
/// Scan lines and tiles are read, and the largest of several resolutions. Several parts, deep data, subsampled channels
/// and lossy compression are refused.
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
    // A file larger than the limit of its decompressed data holds something else.
    let bytes = bytes::read_file(path, limits.bytes).map_err(|error| FileError::io(path, "read", error))?;
    exr_from_bytes(&bytes, path, limits)
}

/// Reads the bytes of an OpenEXR file as [`read_exr`] does; `file` is its name in messages.
///
/// # Errors
/// As [`read_exr`].
pub fn exr_from_bytes(bytes: &[u8], file: &Path, limits: &Limits) -> Result<ExrMap, FileError> {
    decode(bytes, limits).map_err(|fault| FileError::Exr(fault.in_file(file)))
}

fn decode(file: &[u8], limits: &Limits) -> Result<ExrMap, Fault> {
    let invalid = |place: &'static str| {
        move |error: exr::error::Error| {
            Fault::new(place, error.to_string(), "an OpenEXR file that is complete")
        }
    };
    header::check_attributes(file)?;
    // Only the headers are read here, not the offset tables and the pixels.
    let reader = exr::block::read(Cursor::new(file), false).map_err(invalid("header"))?;
    let [header] = reader.headers() else {
        let found = format!("{} parts", reader.headers().len());
        return Err(Fault::new("header", found, "one part: split multi-part files first"));
    };
    check_claims(header, file.len() as u64, limits)?;
    header::check_blocks(file, header)?;
    let (width, height) = (header.layer_size.width() as u32, header.layer_size.height() as u32);

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

    let mut map = ExrMap::new(width, height);
    map.attributes = texts(&image.attributes.other);
    for layer in image.layer_data {
        map.attributes.extend(texts(&layer.attributes.other));
        for part in layer.channel_data.list {
            let name = part.name.to_string();
            let raster = match part.sample_data {
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
    }
    Ok(map)
}

/// Refuses a header that claims more than `limits` allow, or more than a file of this length can hold.
fn check_claims(header: &Header, file_bytes: u64, limits: &Limits) -> Result<(), Fault> {
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
    let bytes = width * height * bytes_per_cell;
    if bytes > limits.bytes {
        return Err(Fault::new("channels", format!("{bytes} bytes"), format!("at most {}", limits.bytes)));
    }
    // What a caller makes of the samples: doubles. A small file could otherwise ask for gigabytes.
    let doubles = (width * height).saturating_mul(8 * header.channels.list.len() as u64);
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
    let blocks = header.chunk_count as u64;
    let Some(expansion) = max_expansion(header.compression) else {
        let expected = "none, RLE, ZIPS, ZIP or PIZ, which keep every bit";
        return Err(Fault::new("header", header.compression.to_string(), expected));
    };
    let max_bytes = expansion.saturating_mul(file_bytes);
    if blocks.saturating_mul(16) > file_bytes || bytes > max_bytes {
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
    attributes: impl IntoIterator<Item = (&'a exr::meta::attribute::Text, &'a AttributeValue)>,
) -> BTreeMap<String, String> {
    let text = |(name, value): (&exr::meta::attribute::Text, &AttributeValue)| match value {
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
