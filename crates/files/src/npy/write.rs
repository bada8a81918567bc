//! Images to NPY: version 1.0, C order, little endian.

use std::path::Path;

use crate::array::ArrayNumber;
use crate::atomic::write_atomically;
use crate::error::{Fault, FileError};
use raypencil_scene::Image;

/// The numbers start at a multiple of this, as NumPy's own do, so that they can be mapped into memory.
const ALIGNMENT: usize = 64;

/// Writes images of `f64`, `f32`, `u32` or `u8` as an NPY file: one of them as (rows, columns), several as
/// (rows, columns, components). The same images give the same bytes.
///
/// # Errors
/// No images at all, or images of several sizes; what the file system says.
pub fn write_npy<T: ArrayNumber>(path: impl AsRef<Path>, planes: &[&Image<T>]) -> Result<(), FileError> {
    let path = path.as_ref();
    let (width, height) = common_size(planes).map_err(|fault| FileError::Array(fault.in_file(path)))?;
    let components = if planes.len() == 1 { String::new() } else { format!(", {}", planes.len()) };
    let mut dictionary = format!(
        "{{'descr': '{}', 'fortran_order': False, 'shape': ({height}, {width}{components}), }}",
        T::DESCRIPTION
    );
    // Magic, version and length are 10 bytes; spaces and a line feed fill up.
    let length = (10 + dictionary.len() + 1).next_multiple_of(ALIGNMENT) - 10;
    dictionary.extend(std::iter::repeat_n(' ', length - 1 - dictionary.len()));
    dictionary.push('\n');
    write_atomically(path, |file| {
        file.write_all(b"\x93NUMPY\x01\x00")?;
        // A few hundred bytes: the dictionary has at most three numbers.
        file.write_all(&(length as u16).to_le_bytes())?;
        file.write_all(dictionary.as_bytes())?;
        for cell in 0..width as usize * height as usize {
            for plane in planes {
                plane.cells()[cell].write(file)?;
            }
        }
        Ok(())
    })
}

/// Columns and rows of all the images.
pub(crate) fn common_size<T: Copy>(planes: &[&Image<T>]) -> Result<(u32, u32), Fault> {
    let size = |image: &Image<T>| (image.width(), image.height());
    let Some((first, rest)) = planes.split_first() else {
        return Err(Fault::new("images", "none", "at least one"));
    };
    match rest.iter().find(|plane| size(plane) != size(first)) {
        None => Ok(size(first)),
        Some(other) => {
            let ((width, height), (columns, rows)) = (size(first), size(other));
            Err(Fault::new(
                "images",
                format!("{columns} x {rows}"),
                format!("{width} x {height} as the first"),
            ))
        }
    }
}
