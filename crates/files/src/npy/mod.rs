//! NPY, NumPy's file of one array, to planes and back. (NumPy Enhancement Proposal 1; numpy.lib.format)
//!
//! CHOICE: not by the crate `npyz` (0.9.1, the only one that is kept up). It asks for as much memory as a
//! header claims to be long, up to 4 GiB in a file of 12 bytes; its messages quote the whole header; and it
//! brings a general parser of Python literals, whose recursion needs a C compiler for its guard. The part of
//! the format that recordings use is three keys and three kinds of value.

pub(crate) mod header;
pub(crate) mod write;

use exr::prelude::f16;
use std::path::Path;

use crate::array::{Array, Storage, Values};
use crate::bytes;
use crate::error::{Fault, FileError};
use crate::limits::Limits;
use crate::npy::header::{Header, Number};
use raypencil_scene::Image;

/// Reads an NPY file: numbers of type f2, f4, f8, u1, u2, u4, u8, i1, i2, i4, i8 or b1, of either endianness,
/// in C or Fortran order, as (rows, columns) or (rows, columns, components).
///
/// Integers become [`Values::Wholes`]: -1 is 4294967295, "none"; truth values are 0 and 1. Real numbers are
/// widened exactly.
///
/// # Errors
/// Names the file, what is wrong in its header or which cell holds a number that does not fit. The shape is
/// held against the file's length before memory is asked for.
pub fn read_npy(path: impl AsRef<Path>, limits: &Limits) -> Result<Array, FileError> {
    let path = path.as_ref();
    // The header comes on top of the numbers.
    let most = limits.bytes.saturating_add(1 << 16);
    let bytes = bytes::read_file(path, most).map_err(|error| FileError::io(path, "read", error))?;
    npy_from_bytes(&bytes, path, limits)
}

/// As [`read_npy`] from the bytes of a file; `file` is for messages.
///
/// # Errors
/// As [`read_npy`].
pub fn npy_from_bytes(bytes: &[u8], file: &Path, limits: &Limits) -> Result<Array, FileError> {
    decode(bytes, limits).map_err(|fault| FileError::Array(fault.in_file(file)))
}

fn decode(file: &[u8], limits: &Limits) -> Result<Array, Fault> {
    let (header, numbers) = header::split(file)?;
    header.shape.check(header.number.bytes() as u64, numbers.len() as u64, limits)?;
    let storage = match header.number {
        Number::Real(2) => Storage::F16,
        Number::Real(4) => Storage::F32,
        Number::Real(_) => Storage::F64,
        _ => Storage::Whole,
    };
    let planes = (0..header.shape.components as usize).map(|component| plane(&header, numbers, component));
    Ok(Array { storage, planes: planes.collect::<Result<_, _>>()? })
}

/// One component of all cells. The shape is known to be that of `numbers`.
fn plane(header: &Header, numbers: &[u8], component: usize) -> Result<Values, Fault> {
    let shape = header.shape;
    let (rows, columns, components) =
        (shape.rows as usize, shape.columns as usize, shape.components as usize);
    let size = header.number.bytes();
    // The number in a cell, its least significant byte first; absent high bytes are zero.
    let word = |row: usize, column: usize| {
        let index = match header.fortran_order {
            false => (row * columns + column) * components + component,
            true => row + rows * (column + columns * component),
        };
        let mut word = [0; 8];
        word[..size].copy_from_slice(&numbers[size * index..size * (index + 1)]);
        if header.big_endian {
            word[..size].reverse();
        }
        u64::from_le_bytes(word)
    };
    let cells = || (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let (width, height) = (columns as u32, rows as u32);
    if let Number::Real(_) = header.number {
        let real = |(row, column)| {
            let bits = word(row, column);
            match size {
                2 => f16::from_bits(bits as u16).to_f64(),
                4 => f64::from(f32::from_bits(bits as u32)),
                _ => f64::from_bits(bits),
            }
        };
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

/// A whole number from its bits, or what was found and expected.
fn whole(number: Number, bits: u64) -> Result<u32, (String, &'static str)> {
    match number {
        Number::Bool if bits > 1 => Err((format!("a truth value of {bits}"), "0 or 1")),
        Number::Signed(size) => {
            // The sign bit is moved to the top and back.
            let shift = 64 - 8 * size;
            let value = (bits << shift) as i64 >> shift;
            match value {
                -1 => Ok(u32::MAX),
                _ => u32::try_from(value).map_err(|_| (value.to_string(), "0 to 4294967295, or -1 for none")),
            }
        }
        _ => u32::try_from(bits).map_err(|_| (bits.to_string(), "0 to 4294967295")),
    }
}
