//! Images to NPY: version 1.0, C order, little endian.

use std::path::Path;

use raypencil_scene::Image;

use crate::atomic::write_atomically;
use crate::error::FileError;
use crate::shape::common_size;

/// Alignment of the numbers in the file, bytes. It is NumPy's, and lets a program map them into memory.
const ALIGNMENT_BYTES: usize = 64;

/// Writes images as an NPY file: one image as (rows, columns), several as (rows, columns, components).
///
/// The same images give the same bytes.
///
/// # Errors
/// No image, images of several sizes, or an error of the file system, with the path.
pub fn write_npy<T: ArrayNumber>(path: impl AsRef<Path>, planes: &[&Image<T>]) -> Result<(), FileError> {
    let path = path.as_ref();
    let (width, height) = common_size(planes).map_err(|fault| FileError::Array(fault.in_file(path)))?;
    let components = if planes.len() == 1 { String::new() } else { format!(", {}", planes.len()) };
    let mut dictionary = format!(
        "{{'descr': '{}', 'fortran_order': False, 'shape': ({height}, {width}{components}), }}",
        T::DESCRIPTION
    );
    // Magic, version and length take 10 bytes; spaces and a line feed fill the rest.
    let length = (10 + dictionary.len() + 1).next_multiple_of(ALIGNMENT_BYTES) - 10;
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

/// Number type that [`write_npy`] writes: `f64`, `f32`, `u32` or `u8`.
pub trait ArrayNumber: Copy + private::Bytes {}

impl ArrayNumber for f64 {}

impl ArrayNumber for f32 {}

impl ArrayNumber for u32 {}

impl ArrayNumber for u8 {}

mod private {
    use std::io::Write;

    /// Writes a number as little-endian bytes.
    pub trait Bytes {
        /// Name of the type in NPY headers.
        const DESCRIPTION: &'static str;

        /// Writes the bytes of one number.
        fn write(self, file: &mut dyn Write) -> std::io::Result<()>;
    }

    macro_rules! bytes {
        ($($number:ty: $name:literal),*) => {$(
            impl Bytes for $number {
                const DESCRIPTION: &'static str = $name;
                fn write(self, file: &mut dyn Write) -> std::io::Result<()> {
                    file.write_all(&self.to_le_bytes())
                }
            }
        )*};
    }
    bytes!(f64: "<f8", f32: "<f4", u32: "<u4", u8: "|u1");
}
