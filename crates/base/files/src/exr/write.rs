//! Named channels to OpenEXR: one part, scan lines in increasing order, ZIP.

use std::io::{Cursor, Write};
use std::path::Path;

use exr::image::write::WritableImage;
use exr::image::{AnyChannel, AnyChannels, Blocks, Encoding, FlatSamples, Image, Layer};
use exr::meta::attribute::{AttributeValue, LineOrder, Text};
use exr::meta::header::LayerAttributes;
use exr::prelude::{Compression, SmallVec};

use crate::atomic::write_atomically;
use crate::error::{Fault, FileError};
use crate::exr::map::{ExrMap, Raster, channel};

/// Writes channels and text attributes as one OpenEXR file. The same map gives the same bytes.
///
/// # Errors
/// A map without channels, a name or text that OpenEXR cannot hold, or an error of the file system, with the path.
pub fn write_exr(path: impl AsRef<Path>, map: &ExrMap) -> Result<(), FileError> {
    let path = path.as_ref();
    let bytes = encode(map, true).map_err(|fault| FileError::Exr(fault.in_file(path)))?;
    write_atomically(path, |file| file.write_all(&bytes))
}

/// Bytes of the file. Blocks are compressed one by one and stored in order, so that `parallel` changes only the time;
/// a test checks it.
fn encode(map: &ExrMap, parallel: bool) -> Result<Vec<u8>, Fault> {
    if map.channels.is_empty() {
        return Err(Fault::new("channels", "none", "at least one"));
    }
    let mut channels = Vec::with_capacity(map.channels.len());
    for (name, raster) in &map.channels {
        let text = latin1(name).filter(|_| !name.is_empty() && name.len() < 256);
        let text = text
            .ok_or_else(|| Fault::new(channel(name), "a name for no file", "1 to 255 Latin-1 characters"))?;
        let samples = match raster {
            Raster::F32(image) => FlatSamples::F32(image.cells().to_vec()),
            Raster::U32(image) => FlatSamples::U32(image.cells().to_vec()),
        };
        channels.push(AnyChannel::new(text, samples));
    }
    let mut attributes = LayerAttributes::default();
    for (name, value) in &map.attributes {
        let wrong =
            || Fault::new(format!("attribute {name:?}"), "a name or text for no file", "Latin-1 characters");
        let name = latin1(name).filter(|_| !name.is_empty() && name.len() < 256).ok_or_else(wrong)?;
        attributes.other.insert(name, AttributeValue::Text(latin1(value).ok_or_else(wrong)?));
    }
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let size = (map.width as usize, map.height as usize);
    let layer = Layer::new(size, attributes, encoding, AnyChannels::sort(SmallVec::from_vec(channels)));
    let image = Image::from_layer(layer);
    let mut file = Cursor::new(Vec::new());
    let write = image.write();
    let write = if parallel { write } else { write.non_parallel() };
    write
        .to_buffered(&mut file)
        .map_err(|error| Fault::new("file", error.to_string(), "maps that OpenEXR can hold"))?;
    let mut file = file.into_inner();
    sort_attributes(&mut file).ok_or_else(|| Fault::new("header", "no end", "a header as it was written"))?;
    Ok(file)
}

/// A text in Latin-1, the encoding of an OpenEXR header; `None` if it cannot be encoded.
fn latin1(string: &str) -> Option<Text> {
    Text::new_or_none(string).filter(|_| !string.contains('\0'))
}

/// Sorts the attributes of a header by their names; `None` if the header has no end.
///
/// The `exr` crate keeps custom attributes in a hash map, so that their order differs from run to run. The format
/// leaves the order open. Sorting moves no other byte of the file.
fn sort_attributes(file: &mut [u8]) -> Option<()> {
    // After the magic number and the version.
    const HEADER_START: usize = 8;
    let mut attributes = Vec::new();
    let mut at = HEADER_START;
    // Each is a name, a type (both end in 0), a size and as many bytes. An empty name ends the list.
    while *file.get(at)? != 0 {
        let start = at;
        for _ in 0..2 {
            at += file.get(at..)?.iter().position(|&byte| byte == 0)? + 1;
        }
        let size = u32::from_le_bytes(file.get(at..at + 4)?.try_into().ok()?) as usize;
        at += 4 + size;
        attributes.push(file.get(start..at)?.to_vec());
    }
    attributes.sort_unstable();
    (&mut file[HEADER_START..at]).write_all(&attributes.concat()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_and_runs_do_not_change_a_byte() {
        let mut map = ExrMap::new(300, 70);
        let noise = |i: u32| f32::from_bits(0x3f80_0000 | (i.wrapping_mul(2_654_435_761) >> 9));
        for name in ["a", "b.X", "c"] {
            let cells = (0..300 * 70).map(noise).collect();
            map.insert(name, Raster::F32(raypencil_scene::Image::from_cells(300, 70, cells)));
        }
        for index in 0..12 {
            map.attributes.insert(format!("attribute{index}"), "text".repeat(index));
        }
        let first = encode(&map, false).unwrap();
        for _ in 0..5 {
            assert_eq!(encode(&map, true).unwrap(), first);
        }
    }
}
