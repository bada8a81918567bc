//! NPY to rows of three numbers: vertices or faces of a mesh.

use std::path::Path;

use crate::error::{Fault, FileError};
use crate::npy::header::{self, Number};
use crate::npy::read::{bits, real, signed};

/// Rows of an NPY file of shape (rows, 3).
#[derive(Debug, Clone, PartialEq)]
pub enum Triples {
    /// Real numbers, widened exactly.
    Reals(Vec<[f64; 3]>),
    /// Whole numbers of any integer type.
    Wholes(Vec<[i64; 3]>),
}

/// Rows of the bytes of an NPY file of shape (rows, 3); `file` is its name in messages. There may be no rows.
///
/// The numbers have type f2, f4, f8, u1, u2, u4, u8, i1, i2, i4 or i8, either endianness, C or Fortran order.
///
/// # Errors
/// Names the file and the fault of its header, or the row whose number does not fit. The shape is compared with the
/// length of the file before memory is allocated.
///
/// ```
/// use raypencil_files::{Triples, npy_triples_from_bytes};
///
/// // One row of three signed bytes.
/// let text = "{'descr': '|i1', 'fortran_order': False, 'shape': (1, 3), }";
/// let mut file = b"\x93NUMPY\x01\x00".to_vec();
/// file.extend((text.len() as u16).to_le_bytes());
/// file.extend(text.bytes().chain([0x00, 0x02, 0xff]));
/// assert_eq!(npy_triples_from_bytes(&file, "faces.npy".as_ref())?, Triples::Wholes(vec![[0, 2, -1]]));
/// # Ok::<(), raypencil_files::FileError>(())
/// ```
pub fn npy_triples_from_bytes(bytes: &[u8], file: &Path) -> Result<Triples, FileError> {
    decode(bytes).map_err(|fault| FileError::Array(fault.in_file(file)))
}

fn decode(file: &[u8]) -> Result<Triples, Fault> {
    let (header, numbers) = header::split(file)?;
    let (shape, number) = (header.shape, header.number);
    if (shape.columns, shape.components) != (3, 1) {
        let found = format!("{} columns, {} components", shape.columns, shape.components);
        return Err(Fault::new("shape", found, "(rows, 3)"));
    }
    // Surplus bytes are refused as well: header and numbers then do not belong together.
    let claimed = u128::from(shape.rows) * 3 * number.bytes() as u128;
    if claimed != numbers.len() as u128 {
        let found = format!("{} bytes for {} rows", numbers.len(), shape.rows);
        let expected = format!("the {claimed} bytes of its shape (is the file cut off?)");
        return Err(Fault::new("numbers", found, expected));
    }
    let rows = shape.rows as usize;
    let word = |row: usize, column: usize| {
        let index = if header.fortran_order { row + rows * column } else { 3 * row + column };
        bits(&header, numbers, index)
    };
    let whole = |row: usize, column: usize| {
        let bits = word(row, column);
        let unfit = |_| {
            Fault::new(format!("row {row}, column {column}"), bits.to_string(), "at most 9223372036854775807")
        };
        match number {
            Number::Signed(size) => Ok(signed(size, bits)),
            _ => i64::try_from(bits).map_err(unfit),
        }
    };
    match number {
        Number::Bool => Err(Fault::new("descr", "truth values", "real or whole numbers")),
        Number::Real(_) => {
            let row = |row| [0, 1, 2].map(|column| real(number, word(row, column)));
            Ok(Triples::Reals((0..rows).map(row).collect()))
        }
        _ => {
            let row = |row| Ok([whole(row, 0)?, whole(row, 1)?, whole(row, 2)?]);
            Ok(Triples::Wholes((0..rows).map(row).collect::<Result<_, _>>()?))
        }
    }
}
