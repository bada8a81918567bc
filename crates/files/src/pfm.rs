//! PFM, the portable float map, to planes and back: `Pf` has one component, `PF` three.

use std::path::Path;

use crate::array::{Array, Shape, Storage, Values};
use crate::atomic::write_atomically;
use crate::bytes;
use crate::error::{Fault, FileError};
use crate::limits::Limits;
use crate::npy::write::common_size;
use raypencil_scene::Image;

/// Reads a PFM file. The format has the lowest row first; row 0 of the planes is the one on top, the last in
/// the file. The sign of the scale tells the order of the bytes.
///
/// # Errors
/// Names the file and what is wrong in its header. The size is held against the file's length before memory
/// is asked for.
pub fn read_pfm(path: impl AsRef<Path>, limits: &Limits) -> Result<Array, FileError> {
    let path = path.as_ref();
    let most = limits.bytes.saturating_add(1 << 10);
    let bytes = bytes::read_file(path, most).map_err(|error| FileError::io(path, "read", error))?;
    pfm_from_bytes(&bytes, path, limits)
}

/// As [`read_pfm`] from the bytes of a file; `file` is for messages.
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
        // CHOICE: of a scale other than 1 some programs multiply by it, most ignore it. Numbers that mean two
        // things are not compared.
        Ok(scale) if scale.abs() == 1.0 => scale > 0.0,
        _ => {
            let found = format!("\"{}\"", word.escape_debug());
            return Err(Fault::new("scale", found, "-1 (little endian) or 1 (big endian)"));
        }
    };
    let numbers = &file[words.at..];
    let shape = Shape { rows, columns, components };
    shape.check(4, numbers.len() as u64, limits)?;
    // The shape is that of the numbers, so it fits into memory.
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

/// The header: words, each followed by white space; just one character of it after the last.
struct Words<'a> {
    file: &'a [u8],
    at: usize,
}

impl<'a> Words<'a> {
    fn next(&mut self, name: &'static str) -> Result<&'a str, Fault> {
        const LONGEST: usize = 32;
        let rest = &self.file[self.at..];
        // Only between words may there be more than one character of white space.
        let skip = rest.iter().take(LONGEST).take_while(|byte| byte.is_ascii_whitespace()).count();
        let word = &rest[skip..];
        let length = word.iter().take(LONGEST + 1).take_while(|byte| !byte.is_ascii_whitespace()).count();
        let text = std::str::from_utf8(&word[..length]).ok().filter(|text| !text.is_empty());
        match text {
            Some(text) if length <= LONGEST && length < word.len() => {
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
/// Another number of images, or images of several sizes; what the file system says.
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
