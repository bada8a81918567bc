//! PNG to planes: depth images of 16 bits, masks, pictures.

use std::io::Cursor;
use std::path::Path;

use png::{BitDepth, ColorType, Decoder, Transformations};
use raypencil_scene::Image;

use crate::bytes;
use crate::error::{Fault, FileError};
use crate::limits::Limits;
use crate::shape::Shape;
use crate::values::{Array, Storage, Values};

/// Reads a PNG file as whole numbers: a plane for grey, two with alpha, three for colours, four with alpha. Colours of a
/// palette become their red, green and blue.
///
/// Numbers are those of the file: samples of fewer than 8 bits are not stretched, and no gamma is applied.
///
/// # Errors
/// Names the file and its fault. The size is checked before memory is allocated.
///
/// ```
/// use raypencil_files::{Limits, Storage, read_picture_png};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("depth.png");
/// let mut encoder = png::Encoder::new(std::fs::File::create(&path)?, 2, 1);
/// encoder.set_color(png::ColorType::Grayscale);
/// encoder.set_depth(png::BitDepth::Sixteen);
/// // 1500 = 0x05dc millimetres, and nothing.
/// encoder.write_header()?.write_image_data(&[0x05, 0xdc, 0, 0])?;
///
/// let array = read_picture_png(&path, &Limits::default())?;
/// assert_eq!((array.storage, array.planes[0].real(0), array.planes[0].real(1)), (Storage::Whole, 1500.0, 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_picture_png(path: impl AsRef<Path>, limits: &Limits) -> Result<Array, FileError> {
    let path = path.as_ref();
    let bytes = bytes::read_file(path, limits.bytes).map_err(|error| FileError::io(path, "read", error))?;
    png_from_bytes(&bytes, path, limits)
}

/// Reads the bytes of a PNG file as [`read_picture_png`] does; `file` is its name in messages.
///
/// # Errors
/// As [`read_picture_png`].
pub fn png_from_bytes(bytes: &[u8], file: &Path, limits: &Limits) -> Result<Array, FileError> {
    decode(bytes, limits).map_err(|fault| FileError::Array(fault.in_file(file)))
}

fn decode(file: &[u8], limits: &Limits) -> Result<Array, Fault> {
    let invalid = |place: &'static str| {
        move |error: png::DecodingError| Fault::new(place, error.to_string(), "a PNG file that is complete")
    };
    let mut decoder = Decoder::new(Cursor::new(file));
    decoder.set_transformations(Transformations::IDENTITY);
    // Texts and profiles of colours are not needed, and may be compressed a thousandfold.
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let (width, height, colour, depth) = {
        let info = decoder.read_header_info().map_err(invalid("header"))?;
        (info.width, info.height, info.color_type, info.bit_depth)
    };
    let samples = match colour {
        ColorType::Grayscale | ColorType::Indexed => 1,
        ColorType::GrayscaleAlpha => 2,
        ColorType::Rgb => 3,
        ColorType::Rgba => 4,
    };
    let is_indexed = colour == ColorType::Indexed;
    let shape = Shape {
        rows: height.into(),
        columns: width.into(),
        components: if is_indexed { 3 } else { samples as u64 },
    };
    shape.check_decoded(file.len() as u64, limits)?;
    let mut reader = decoder.read_info().map_err(invalid("header"))?;
    let bits = depth as usize;
    let line = (width as usize * samples * bits).div_ceil(8);
    let mut packed = vec![0; line * height as usize];
    if reader.output_buffer_size() != Some(packed.len()) {
        return Err(Fault::new("header", format!("{colour:?} of {bits} bits"), "one of the types of PNG"));
    }
    reader.next_frame(&mut packed).map_err(invalid("pixels"))?;
    let row = |j: usize| &packed[line * j..line * (j + 1)];
    let sample = |row: &[u8], at: usize| -> u32 {
        match depth {
            BitDepth::Sixteen => u32::from(u16::from_be_bytes([row[2 * at], row[2 * at + 1]])),
            BitDepth::Eight => row[at].into(),
            // From the highest bits of a byte down. (PNG, 7.2)
            _ => u32::from(row[at * bits / 8] >> (8 - bits - at * bits % 8)) & ((1 << bits) - 1),
        }
    };
    let (width, height) = (width as usize, height as usize);
    let image = |cells: Vec<u32>| Values::Wholes(Image::from_cells(width as u32, height as u32, cells));
    if is_indexed {
        let palette = reader.info().palette.as_deref().unwrap_or_default();
        let mut planes: [Vec<u32>; 3] = std::array::from_fn(|_| Vec::with_capacity(width * height));
        for (j, i) in (0..height).flat_map(|j| (0..width).map(move |i| (j, i))) {
            let index = sample(row(j), i) as usize;
            let Some(colour) = palette.get(3 * index..3 * index + 3) else {
                let found = format!("colour {index}");
                let expected = format!("one of the {} of the palette", palette.len() / 3);
                return Err(Fault::new(format!("pixel ({i}, {j})"), found, expected));
            };
            planes.iter_mut().zip(colour).for_each(|(plane, &part)| plane.push(part.into()));
        }
        return Ok(Array { storage: Storage::Whole, planes: planes.map(image).into() });
    }
    let plane = |component: usize| {
        let cells = (0..height).flat_map(|j| (0..width).map(move |i| (j, samples * i + component)));
        image(cells.map(|(j, at)| sample(row(j), at)).collect())
    };
    Ok(Array { storage: Storage::Whole, planes: (0..samples).map(plane).collect() })
}
