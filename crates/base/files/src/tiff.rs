//! TIFF to planes: depth images of whole or real numbers. (TIFF 6.0; elevation models are read elsewhere)

use std::io::Cursor;
use std::path::Path;

use raypencil_scene::Image;
use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;

use crate::bytes;
use crate::error::{Fault, FileError};
use crate::limits::Limits;
use crate::shape::Shape;
use crate::values::{Array, Storage, Values};

/// Maximum number of images of a file that are looked at. All but the first are overviews or masks.
const MAX_IMAGES: usize = 64;

/// Bits of NewSubfileType: an image of lower resolution, and a mask. (TIFF 6.0, page 36)
const OVERVIEW_OR_MASK: u64 = 1 | 4;

/// Reads a TIFF file: a plane for each sample of a pixel. Real numbers are widened exactly; of signed numbers, -1 means
/// "none".
///
/// # Errors
/// Names the file and its fault: a second image, pixels that do not begin at the top left, colours of a palette or of another
/// kind than grey and red, green, blue, packed bits, a compression that is not read. The size is checked before memory is
/// allocated.
pub fn read_picture_tiff(path: impl AsRef<Path>, limits: &Limits) -> Result<Array, FileError> {
    let path = path.as_ref();
    let bytes = bytes::read_file(path, limits.bytes).map_err(|error| FileError::io(path, "read", error))?;
    tiff_from_bytes(&bytes, path, limits)
}

/// Reads the bytes of a TIFF file as [`read_picture_tiff`] does; `file` is its name in messages.
///
/// # Errors
/// As [`read_picture_tiff`].
pub fn tiff_from_bytes(bytes: &[u8], file: &Path, limits: &Limits) -> Result<Array, FileError> {
    decode(bytes, limits).map_err(|fault| FileError::Array(fault.in_file(file)))
}

fn invalid(place: &'static str) -> impl Fn(tiff::TiffError) -> Fault {
    move |error| {
        Fault::new(place, error.to_string(), "a TIFF file that is complete, plain or by LZW or Deflate")
    }
}

fn decode(file: &[u8], limits: &Limits) -> Result<Array, Fault> {
    let mut decoder = Decoder::new(Cursor::new(file)).map_err(invalid("header"))?;
    let (width, height) = decoder.dimensions().map_err(invalid("header"))?;
    let colour = decoder.colortype().map_err(invalid("header"))?;
    let (samples, bits) = match colour {
        ColorType::Gray(bits) => (1, bits),
        ColorType::GrayA(bits) => (2, bits),
        ColorType::RGB(bits) => (3, bits),
        ColorType::RGBA(bits) => (4, bits),
        ColorType::Multiband { bit_depth, num_samples } => (num_samples, bit_depth),
        other => return Err(Fault::new("header", format!("{other:?}"), "grey, or red, green and blue")),
    };
    if !matches!(bits, 8 | 16 | 32 | 64) {
        return Err(Fault::new("header", format!("{bits} bits a sample"), "8, 16, 32 or 64"));
    }
    let shape = Shape { rows: height.into(), columns: width.into(), components: samples.into() };
    shape.check_decoded(file.len() as u64, limits)?;
    let mut number = |tag: Tag, default: u64| -> Result<u64, Fault> {
        Ok(decoder.find_tag_unsigned::<u64>(tag).map_err(invalid("header"))?.unwrap_or(default))
    };
    for (name, tag, wanted, meaning) in [
        ("Orientation", Tag::Orientation, 1, "1: row 0 on top, column 0 at the left"),
        ("PlanarConfiguration", Tag::PlanarConfiguration, 1, "1: the samples of a pixel side by side"),
    ] {
        let found = number(tag, wanted)?;
        if found != wanted && !(tag == Tag::PlanarConfiguration && samples == 1) {
            return Err(Fault::new(name, found.to_string(), meaning));
        }
    }
    // The reader turns white-is-zero over, and then the numbers are not those of the file.
    if number(Tag::PhotometricInterpretation, 1)? == 0 {
        return Err(Fault::new("PhotometricInterpretation", "0, where 0 is white", "1, where 0 is black"));
    }
    let decoder = &mut decoder;
    let mut most = tiff::decoder::Limits::default();
    // As many as were checked; the strips of a file are not larger than all of it.
    most.decoding_buffer_size = usize::try_from(limits.bytes).unwrap_or(usize::MAX);
    most.intermediate_buffer_size = most.decoding_buffer_size;
    let mut limited = Decoder::new(Cursor::new(file)).map_err(invalid("header"))?.with_limits(most);
    let array = planes(limited.read_image().map_err(invalid("pixels"))?, [width, height], samples.into())?;
    for _ in 1..MAX_IMAGES {
        if !decoder.more_images() {
            return Ok(array);
        }
        decoder.next_image().map_err(invalid("second image"))?;
        let kind = decoder.find_tag_unsigned::<u64>(Tag::NewSubfileType).map_err(invalid("second image"))?;
        if kind.unwrap_or(0) & OVERVIEW_OR_MASK == 0 {
            return Err(Fault::new("second image", "a page of its own", "one image a file"));
        }
    }
    Err(Fault::new("header", format!("{MAX_IMAGES} images or more"), "one image a file"))
}

/// The planes of samples that stand side by side.
fn planes(samples: DecodingResult, [width, height]: [u32; 2], count: usize) -> Result<Array, Fault> {
    fn split<S: Copy, T: Copy>(
        samples: Vec<S>,
        [width, height]: [u32; 2],
        count: usize,
        cell: impl Fn(S) -> Result<T, i128>,
    ) -> Result<Vec<Image<T>>, Fault> {
        let cells = width as usize * height as usize;
        if samples.len() != cells * count {
            let expected = format!("{}", cells * count);
            return Err(Fault::new("pixels", format!("{} samples", samples.len()), expected));
        }
        let plane = |component: usize| {
            let cells = samples.iter().skip(component).step_by(count).enumerate().map(|(index, &sample)| {
                cell(sample).map_err(|found| {
                    let (i, j) = (index % width as usize, index / width as usize);
                    let expected = "0 to 4294967295, or -1 for none";
                    Fault::new(format!("pixel ({i}, {j})"), found.to_string(), expected)
                })
            });
            Ok(Image::from_cells(width, height, cells.collect::<Result<_, Fault>>()?))
        };
        (0..count).map(plane).collect()
    }
    fn wholes<S: Copy + Into<i128>>(
        samples: Vec<S>,
        size: [u32; 2],
        count: usize,
    ) -> Result<(Storage, Vec<Values>), Fault> {
        let whole = |sample: S| match sample.into() {
            -1 => Ok(u32::MAX),
            number => u32::try_from(number).map_err(|_| number),
        };
        let images = split(samples, size, count, whole)?;
        Ok((Storage::Whole, images.into_iter().map(Values::Wholes).collect()))
    }
    let size = [width, height];
    let reals = |storage: Storage, images: Vec<Image<f64>>| {
        (storage, images.into_iter().map(Values::Reals).collect::<Vec<_>>())
    };
    let (storage, planes) = match samples {
        DecodingResult::F16(samples) => {
            reals(Storage::F16, split(samples, size, count, |sample| Ok(f64::from(sample.to_f32())))?)
        }
        DecodingResult::F32(samples) => {
            reals(Storage::F32, split(samples, size, count, |sample| Ok(f64::from(sample)))?)
        }
        DecodingResult::F64(samples) => reals(Storage::F64, split(samples, size, count, Ok)?),
        DecodingResult::U8(samples) => wholes(samples, size, count)?,
        DecodingResult::U16(samples) => wholes(samples, size, count)?,
        DecodingResult::U32(samples) => wholes(samples, size, count)?,
        DecodingResult::U64(samples) => wholes(samples, size, count)?,
        DecodingResult::I8(samples) => wholes(samples, size, count)?,
        DecodingResult::I16(samples) => wholes(samples, size, count)?,
        DecodingResult::I32(samples) => wholes(samples, size, count)?,
        DecodingResult::I64(samples) => wholes(samples, size, count)?,
    };
    Ok(Array { storage, planes })
}
