//! NPY to planes.

use std::path::Path;

use exr::prelude::f16;
use raypencil_scene::Image;

use crate::bytes;
use crate::error::{Fault, FileError};
use crate::limits::Limits;
use crate::npy::header::{self, Header, Number};
use crate::shape::Shape;
use crate::values::{Array, Storage, Values};

/// Reads an NPY file of shape (rows, columns) or (rows, columns, components).
///
/// The numbers have type f2, f4, f8, u1, u2, u4, u8, i1, i2, i4, i8 or b1, either endianness, C or Fortran order.
/// Integers and truth values (0, 1) become [`Values::Wholes`], -1 as 4294967295, "none". Real numbers are widened
/// exactly.
///
/// # Errors
/// Names the file and the fault of its header, or the cell whose number does not fit. The shape is compared with the
/// length of the file before memory is allocated.
///
/// ```
/// use raypencil_files::{Limits, npy_from_bytes};
///
/// // The header as NumPy writes it; then the numbers 1.5 and -2 in half precision, 0x3e00 and 0xc000.
/// let text = "{'descr': '<f2', 'fortran_order': False, 'shape': (1, 2), }";
/// let mut file = b"\x93NUMPY\x01\x00".to_vec();
/// file.extend((text.len() as u16).to_le_bytes());
/// file.extend(text.bytes().chain([0x00, 0x3e, 0x00, 0xc0]));
/// let array = npy_from_bytes(&file, "here.npy".as_ref(), &Limits::default())?;
/// assert_eq!((array.planes[0].real(0), array.planes[0].real(1)), (1.5, -2.0));
/// # Ok::<(), raypencil_files::FileError>(())
/// ```
pub fn read_npy(path: impl AsRef<Path>, limits: &Limits) -> Result<Array, FileError> {
    let path = path.as_ref();
    // The header comes on top of the numbers, at most 2^16 bytes.
    let most = limits.bytes.saturating_add(1 << 16);
    let bytes = bytes::read_file(path, most).map_err(|error| FileError::io(path, "read", error))?;
    npy_from_bytes(&bytes, path, limits)
}

/// Reads the bytes of an NPY file as [`read_npy`] does; `file` is its name in messages.
///
/// # Errors
/// As [`read_npy`].
pub fn npy_from_bytes(bytes: &[u8], file: &Path, limits: &Limits) -> Result<Array, FileError> {
    decode(bytes, limits).map_err(|fault| FileError::Array(fault.in_file(file)))
}

/// Reads the bytes of an NPY file of shape (rows, columns) or (rows, columns, components); `None` for another shape.
pub(crate) fn raster_from_bytes(file: &[u8], limits: &Limits) -> Result<Option<Array>, Fault> {
    let (header, numbers) = header::split(file)?;
    header.raster().ok().map(|shape| raster(&header, shape, numbers, limits)).transpose()
}

fn decode(file: &[u8], limits: &Limits) -> Result<Array, Fault> {
    let (header, numbers) = header::split(file)?;
    raster(&header, header.raster()?, numbers, limits)
}

fn raster(header: &Header, shape: Shape, numbers: &[u8], limits: &Limits) -> Result<Array, Fault> {
    shape.check(header.number.bytes() as u64, numbers.len() as u64, limits)?;
    let storage = match header.number {
        Number::Real(2) => Storage::F16,
        Number::Real(4) => Storage::F32,
        Number::Real(_) => Storage::F64,
        _ => Storage::Whole,
    };
    let planes = (0..shape.components as usize).map(|component| plane(header, shape, numbers, component));
    Ok(Array { storage, planes: planes.collect::<Result<_, _>>()? })
}

/// One component of all cells. The shape has been checked to be that of `numbers`.
fn plane(header: &Header, shape: Shape, numbers: &[u8], component: usize) -> Result<Values, Fault> {
    let (rows, columns, components) =
        (shape.rows as usize, shape.columns as usize, shape.components as usize);
    let word = |row: usize, column: usize| {
        let index = match header.fortran_order {
            false => (row * columns + column) * components + component,
            true => row + rows * (column + columns * component),
        };
        bits(header, numbers, index)
    };
    let cells = || (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let (width, height) = (columns as u32, rows as u32);
    if let Number::Real(_) = header.number {
        let real = |(row, column)| real(header.number, word(row, column));
        return Ok(Values::Reals(Image::from_cells(width, height, cells().map(real).collect())));
    }
    let whole = |(row, column)| {
        let bits = word(row, column);
        whole(header.number, bits).map_err(|(found, expected)| {
            let part = if components > 1 { format!(", component {component}") } else { String::new() };
            Fault::new(format!("cell ({column}, {row}){part}"), found, expected)
        })
    };
    let wholes = cells().map(whole).collect::<Result<_, _>>()?;
    Ok(Values::Wholes(Image::from_cells(width, height, wholes)))
}

/// Bits of the number at `index` among all numbers of a file; absent high bytes are zero.
pub(super) fn bits(header: &Header, numbers: &[u8], index: usize) -> u64 {
    let size = header.number.bytes();
    let mut word = [0; 8];
    word[..size].copy_from_slice(&numbers[size * index..size * (index + 1)]);
    if header.big_endian {
        word[..size].reverse();
    }
    u64::from_le_bytes(word)
}

/// A real number from its bits, widened exactly.
pub(super) fn real(number: Number, bits: u64) -> f64 {
    match number.bytes() {
        2 => f16::from_bits(bits as u16).to_f64(),
        4 => f64::from(f32::from_bits(bits as u32)),
        _ => f64::from_bits(bits),
    }
}

/// Sign extension of a number of `size` bytes: the sign bit is moved to the top and back.
pub(super) fn signed(size: usize, bits: u64) -> i64 {
    let shift = 64 - 8 * size;
    (bits << shift) as i64 >> shift
}

/// A whole number from its bits, or the texts of what was found and what was expected.
fn whole(number: Number, bits: u64) -> Result<u32, (String, &'static str)> {
    match number {
        Number::Bool if bits > 1 => Err((format!("a truth value of {bits}"), "0 or 1")),
        Number::Signed(size) => {
            let value = signed(size, bits);
            match value {
                -1 => Ok(u32::MAX),
                _ => u32::try_from(value).map_err(|_| (value.to_string(), "0 to 4294967295, or -1 for none")),
            }
        }
        _ => u32::try_from(bits).map_err(|_| (bits.to_string(), "0 to 4294967295")),
    }
}
