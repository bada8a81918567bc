//! Pictures as PNG, in memory, and as addresses that hold them.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use png::{BitDepth, ColorType, Compression, Encoder, Filter};

use crate::colour::Colour;

/// A picture of `columns` cells in a row, cells without a colour transparent.
pub(crate) fn rgba(columns: u32, cells: &[Option<Colour>]) -> Vec<u8> {
    let rows = (cells.len() / columns.max(1) as usize) as u32;
    let bytes: Vec<u8> =
        cells.iter().flat_map(|cell| cell.map_or([0; 4], |[r, g, b]| [r, g, b, 0xff])).collect();
    encode(columns, rows, &bytes, |encoder| {
        encoder.set_color(ColorType::Rgba);
        encoder.set_compression(Compression::Balanced);
    })
}

/// A picture of red, green and blue bytes, pixel by pixel.
pub(crate) fn rgb(width: u32, height: u32, bytes: &[u8]) -> Vec<u8> {
    encode(width, height, bytes, |encoder| {
        encoder.set_color(ColorType::Rgb);
        encoder.set_compression(Compression::Balanced);
    })
}

/// A picture of indices into `palette`, three bytes a colour, of which index `transparent` is not drawn.
pub(crate) fn indexed(width: u32, height: u32, indices: &[u8], palette: Vec<u8>, transparent: u8) -> Vec<u8> {
    let mut opacity = vec![0xff; 256];
    opacity[usize::from(transparent)] = 0;
    encode(width, height, indices, |encoder| {
        encoder.set_color(ColorType::Indexed);
        encoder.set_palette(palette);
        encoder.set_trns(opacity);
        encoder.set_compression(Compression::High);
        // Indices are not brightnesses: differences between neighbours compress no better than the indices.
        encoder.set_filter(Filter::NoFilter);
    })
}

/// Encoding into memory cannot fail if the sizes match.
fn encode(
    width: u32,
    height: u32,
    bytes: &[u8],
    settings: impl FnOnce(&mut Encoder<&mut Vec<u8>>),
) -> Vec<u8> {
    let mut out = Vec::new();
    let mut encoder = Encoder::new(&mut out, width, height);
    encoder.set_depth(BitDepth::Eight);
    settings(&mut encoder);
    let mut writer = encoder.write_header().expect("a picture of at least one cell");
    writer.write_image_data(bytes).expect("as many cells as the picture has");
    writer.finish().expect("writing to memory");
    out
}

/// A PNG as a `data:` address, which holds it.
pub(crate) fn data_uri(png: &[u8]) -> String {
    format!("data:image/png;base64,{}", STANDARD.encode(png))
}
