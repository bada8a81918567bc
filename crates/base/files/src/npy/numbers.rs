//! NPY of any shape to one list of numbers.

use std::path::Path;

use crate::bytes;
use crate::error::{Fault, FileError};
use crate::limits::Limits;
use crate::npy::header::{self, Header, Number};
use crate::npy::read::{bits, real, signed};
use crate::shape::why_not_so_long;
use crate::values::Storage;

/// An array of any shape.
#[derive(Debug, Clone, PartialEq)]
pub struct Numbers {
    /// Its dimensions, the slowest first. An array of none has one number; one with a dimension of 0 has no number.
    pub shape: Vec<u64>,
    /// How the file stores a number.
    pub storage: Storage,
    /// The numbers in C order: the last dimension runs fastest. Real numbers are widened exactly; whole numbers are
    /// those of f64, exact up to 2^53.
    pub values: Vec<f64>,
}

/// Maximum number of dimensions, as in NumPy.
const MAX_DIMENSIONS: usize = 64;

/// Reads an NPY file of any shape: f2, f4, f8, and all integers, either endianness, C or Fortran order.
///
/// # Errors
/// Names the file and the fault of its header, or the place of a whole number that is no f64. The shape is compared with
/// the length of the file before memory is allocated; of `limits` only the bytes count.
pub fn read_npy_numbers(path: impl AsRef<Path>, limits: &Limits) -> Result<Numbers, FileError> {
    let path = path.as_ref();
    // The header comes on top of the numbers, at most 2^16 bytes.
    let most = limits.bytes.saturating_add(1 << 16);
    let bytes = bytes::read_file(path, most).map_err(|error| FileError::io(path, "read", error))?;
    npy_numbers_from_bytes(&bytes, path)
}

/// Reads the bytes of an NPY file as [`read_npy_numbers`] does; `file` is its name in messages.
///
/// # Errors
/// As [`read_npy_numbers`].
pub fn npy_numbers_from_bytes(bytes: &[u8], file: &Path) -> Result<Numbers, FileError> {
    decode(bytes).map_err(|fault| FileError::Array(fault.in_file(file)))
}

fn decode(file: &[u8]) -> Result<Numbers, Fault> {
    let (header, numbers) = header::split(file)?;
    let size = header.number.bytes();
    if header.shape.len() > MAX_DIMENSIONS {
        let found = format!("{} dimensions", header.shape.len());
        return Err(Fault::new("shape", found, format!("at most {MAX_DIMENSIONS}")));
    }
    let shape = || format!("{:?}", header.shape);
    // Beyond the length of any file there is nothing to tell apart.
    let claimed = header.shape.iter().try_fold(size as u64, |bytes, &length| bytes.checked_mul(length));
    if claimed != Some(numbers.len() as u64) {
        let expected = match claimed {
            Some(claimed) => {
                let why = why_not_so_long(numbers.len() as u64, claimed.into());
                format!("the {claimed} bytes of shape {} ({why})", shape())
            }
            None => format!("more bytes than any file has, of shape {}", shape()),
        };
        return Err(Fault::new("numbers", format!("{} bytes", numbers.len()), expected));
    }
    let count = numbers.len() / size;
    let values = (0..count).map(|index| value(&header, numbers, index));
    let storage = match header.number {
        Number::Real(2) => Storage::F16,
        Number::Real(4) => Storage::F32,
        Number::Real(_) => Storage::F64,
        _ => Storage::Whole,
    };
    Ok(Numbers { storage, values: values.collect::<Result<_, _>>()?, shape: header.shape })
}

/// The place in the file of the number with this index in C order.
fn place(header: &Header, index: usize) -> usize {
    if !header.fortran_order {
        return index;
    }
    // The digits of the index, from the fastest dimension on; in the file the first dimension is the fastest.
    let (mut rest, mut place) = (index, 0);
    let mut stride: usize = header.shape.iter().map(|&length| length as usize).product();
    for &length in header.shape.iter().rev() {
        stride /= length as usize;
        place += rest % length as usize * stride;
        rest /= length as usize;
    }
    place
}

fn value(header: &Header, numbers: &[u8], index: usize) -> Result<f64, Fault> {
    let bits = bits(header, numbers, place(header, index));
    let whole = |value: i128| {
        if value.unsigned_abs() > 1 << 53 {
            return Err(Fault::new(
                format!("number {index}"),
                value.to_string(),
                "a whole number up to 2^53",
            ));
        }
        Ok(value as f64)
    };
    match header.number {
        Number::Real(_) => Ok(real(header.number, bits)),
        Number::Signed(size) => whole(i128::from(signed(size, bits))),
        Number::Unsigned(_) | Number::Bool => whole(i128::from(bits)),
    }
}
