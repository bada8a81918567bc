//! PFM, the portable float map: `Pf` has one component, `PF` three. (Debevec, HDR Shop)

use std::path::Path;

use raypencil_scene::Image;

use crate::atomic::write_atomically;
use crate::bytes;
use crate::error::{Fault, FileError};
use crate::limits::Limits;
use crate::shape::{Shape, common_size};
use crate::values::{Array, Storage, Values};

/// Maximum length of the header: four words of at most 32 characters, white space between them.
const MAX_HEADER_BYTES: u64 = 1 << 10;

/// Reads a PFM file.
///
/// The lowest row comes first in the file; row 0 of the planes is the top one. The sign of the header's scale gives the
/// order of the bytes.
///
/// # Errors
/// Names the file and the fault of its header. The size is compared with the length of the file before memory is
/// allocated.
pub fn read_pfm(path: impl AsRef<Path>, limits: &Limits) -> Result<Array, FileError> {
    let path = path.as_ref();
    let most = limits.bytes.saturating_add(MAX_HEADER_BYTES);
    let bytes = bytes::read_file(path, most).map_err(|error| FileError::io(path, "read", error))?;
    pfm_from_bytes(&bytes, path, limits)
}

/// Reads the bytes of a PFM file as [`read_pfm`] does; `file` is its name in messages.
///
/// # Errors
/// As [`read_pfm`].
pub fn pfm_from_bytes(bytes: &[u8], file: &Path, limits: &Limits) -> Result<Array, FileError> {
    decode(bytes, limits).map_err(|fault| FileError::Array(fault.in_file(file)))
}

fn decode(file: &[u8], limits: &Limits) -> Result<Array, Fault> {
    let mut words = Words { file, at: 0 };
    let components = match words.next("magic")? {
        "Pf" => 1,
        "PF" => 3,
        other => {
            let found = format!("\"{}\"", other.escape_debug());
            return Err(Fault::new("magic", found, "\"Pf\" or \"PF\""));
        }
    };
    let side = |words: &mut Words, name: &'static str| {
        let word = words.next(name)?;
        let number =
            if word.bytes().all(|byte| byte.is_ascii_digit()) { word.parse::<u64>().ok() } else { None };
        number.ok_or_else(|| Fault::new(name, format!("\"{}\"", word.escape_debug()), "a whole number"))
    };
    let (columns, rows) = (side(&mut words, "width")?, side(&mut words, "height")?);
    let word = words.next("scale")?;
    let big_endian = match word.parse::<f64>() {
        // CHOICE: other scales than 1 are refused. Some programs multiply by the scale, most ignore it: the same
        // numbers would mean two things.
        Ok(scale) if scale.abs() == 1.0 => scale > 0.0,
        _ => {
            let found = format!("\"{}\"", word.escape_debug());
            return Err(Fault::new("scale", found, "-1 (little endian) or 1 (big endian)"));
        }
    };
    let numbers = &file[words.at..];
    let shape = Shape { rows, columns, components };
    shape.check(4, numbers.len() as u64, limits)?;
    // The shape has been checked to be that of `numbers`, which are in memory.
    let (columns, rows, components) = (columns as usize, rows as usize, components as usize);
    let plane = |component: usize| {
        let mut cells = Vec::with_capacity(columns * rows);
        for row in (0..rows).rev() {
            for column in 0..columns {
                let at = 4 * ((row * columns + column) * components + component);
                let bytes = [numbers[at], numbers[at + 1], numbers[at + 2], numbers[at + 3]];
                let number = if big_endian { f32::from_be_bytes(bytes) } else { f32::from_le_bytes(bytes) };
                cells.push(f64::from(number));
            }
        }
        Values::Reals(Image::from_cells(columns as u32, rows as u32, cells))
    };
    Ok(Array { storage: Storage::F32, planes: (0..components).map(plane).collect() })
}

/// Words of the header, each followed by white space: by a single character of it after the last word.
struct Words<'a> {
    file: &'a [u8],
    at: usize,
}

impl<'a> Words<'a> {
    fn next(&mut self, name: &'static str) -> Result<&'a str, Fault> {
        const MAX_WORD_BYTES: usize = 32;
        let rest = &self.file[self.at..];
        // Before a word there may be more white space than the one character that ended the last.
        let skip = rest.iter().take(MAX_WORD_BYTES).take_while(|byte| byte.is_ascii_whitespace()).count();
        let word = &rest[skip..];
        let length =
            word.iter().take(MAX_WORD_BYTES + 1).take_while(|byte| !byte.is_ascii_whitespace()).count();
        let text = std::str::from_utf8(&word[..length]).ok().filter(|text| !text.is_empty());
        match text {
            Some(text) if length <= MAX_WORD_BYTES && length < word.len() => {
                self.at += skip + length + 1;
                Ok(text)
            }
            _ => {
                let found = format!("{:02x?}", &word[..word.len().min(8)]);
                Err(Fault::new(name, found, "a short word, then white space (is the file cut off?)"))
            }
        }
    }
}

/// Writes one image as `Pf` or three as `PF`, little endian, scale -1. The same images give the same bytes.
///
/// # Errors
/// Another number of images, images of several sizes, or an error of the file system, with the path.
///
/// ```
/// use raypencil_files::{Limits, read_pfm, write_pfm};
/// use raypencil_scene::Image;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("range.pfm");
/// write_pfm(&path, &[&Image::from_cells(1, 2, vec![7.5_f32, 2.0])])?;
/// // The lowest row comes first: 2 = 0x40000000, least significant byte first.
/// assert!(std::fs::read(&path)?.starts_with(b"Pf\n1 2\n-1.0\n\0\0\0\x40"));
/// assert_eq!(read_pfm(&path, &Limits::default())?.planes[0].real(0), 7.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_pfm(path: impl AsRef<Path>, planes: &[&Image<f32>]) -> Result<(), FileError> {
    let path = path.as_ref();
    let unfit = |fault: Fault| FileError::Array(fault.in_file(path));
    let (width, height) = common_size(planes).map_err(unfit)?;
    let magic = match planes.len() {
        1 => "Pf",
        3 => "PF",
        count => return Err(unfit(Fault::new("images", count.to_string(), "1 or 3"))),
    };
    write_atomically(path, |file| {
        write!(file, "{magic}\n{width} {height}\n-1.0\n")?;
        for row in (0..height).rev() {
            for column in 0..width {
                for plane in planes {
                    file.write_all(&plane.at(column, row).to_le_bytes())?;
                }
            }
        }
        Ok(())
    })
}
