//! Images, and numbers of any shape, to NPY: version 1.0, C order, little endian.

use std::path::Path;

use raypencil_scene::Image;

use crate::atomic::write_atomically;
use crate::error::{Fault, FileError};
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
    let header = header(T::DESCRIPTION, &format!("({height}, {width}{components})"));
    write_atomically(path, |file| {
        file.write_all(&header)?;
        for cell in 0..width as usize * height as usize {
            for plane in planes {
                plane.cells()[cell].write(file)?;
            }
        }
        Ok(())
    })
}

/// Writes numbers as an NPY file of any shape, the last dimension running fastest.
///
/// ```
/// use raypencil_files::{Limits, read_npy_numbers, write_npy_numbers};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("t.npy");
/// write_npy_numbers(&path, &[3], &[0.5, f64::INFINITY, 1.0 / 3.0])?;
/// let numbers = read_npy_numbers(&path, &Limits::default())?;
/// assert_eq!((numbers.shape, numbers.values), (vec![3], vec![0.5, f64::INFINITY, 1.0 / 3.0]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As many numbers as the shape has not, or an error of the file system, with the path.
pub fn write_npy_numbers<T: ArrayNumber>(
    path: impl AsRef<Path>,
    shape: &[u64],
    numbers: &[T],
) -> Result<(), FileError> {
    let path = path.as_ref();
    let count: u128 = shape.iter().map(|&length| u128::from(length)).product();
    if count != numbers.len() as u128 {
        let fault =
            Fault::new("numbers", numbers.len().to_string(), format!("{count}, as shape {shape:?} has"));
        return Err(FileError::Array(fault.in_file(path)));
    }
    let lengths: Vec<String> = shape.iter().map(u64::to_string).collect();
    // Python writes a tuple of one as `(3,)`.
    let comma = if shape.len() == 1 { "," } else { "" };
    let header = header(T::DESCRIPTION, &format!("({}{comma})", lengths.join(", ")));
    write_atomically(path, |file| {
        file.write_all(&header)?;
        numbers.iter().try_for_each(|number| number.write(file))
    })
}

/// Everything before the numbers.
pub(crate) fn header(description: &str, shape: &str) -> Vec<u8> {
    let mut dictionary = format!("{{'descr': '{description}', 'fortran_order': False, 'shape': {shape}, }}");
    // Magic, version and length take 10 bytes; spaces and a line feed fill the rest.
    let length = (10 + dictionary.len() + 1).next_multiple_of(ALIGNMENT_BYTES) - 10;
    dictionary.extend(std::iter::repeat_n(' ', length - 1 - dictionary.len()));
    dictionary.push('\n');
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    // A few hundred bytes: a shape has few numbers.
    header.extend((length as u16).to_le_bytes());
    header.extend(dictionary.into_bytes());
    header
}

/// Number type that is written to NPY: `f64`, `f32`, `i64`, `i32`, `u64`, `u32`, `u16`, `u8` or `i8`.
pub trait ArrayNumber: Copy + private::Bytes {}

impl ArrayNumber for f64 {}

impl ArrayNumber for f32 {}

impl ArrayNumber for u32 {}

impl ArrayNumber for u16 {}

impl ArrayNumber for u8 {}

impl ArrayNumber for u64 {}

impl ArrayNumber for i64 {}

impl ArrayNumber for i32 {}

impl ArrayNumber for i8 {}

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
    bytes!(
        f64: "<f8", f32: "<f4", u64: "<u8", u32: "<u4", u16: "<u2", u8: "|u1", i64: "<i8", i32: "<i4", i8: "|i1"
    );
}
