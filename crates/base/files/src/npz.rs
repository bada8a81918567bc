//! NPZ, NumPy's archive of arrays: a ZIP file with an NPY file for each.

use std::collections::BTreeSet;
use std::io::{Cursor, Read};
use std::path::Path;

use zip::ZipArchive;

use crate::bytes;
use crate::error::{Fault, FileError};
use crate::limits::{Limits, MAX_EXPANSION, MAX_INFLATED_BYTES};
use crate::npy::raster_from_bytes;
use crate::values::Array;

/// Maximum number of arrays of an archive.
const MAX_ARRAYS: usize = 1024;

/// Maximum length of the header of an array, bytes.
const MAX_HEADER_BYTES: u64 = 1 << 16;

/// Reads the arrays of an NPZ file by their names: those of shape (rows, columns) or (rows, columns, components). Arrays of
/// another shape are left out. Both `numpy.savez` and `numpy.savez_compressed` write what is read.
///
/// ```
/// use raypencil_files::{ArrayData, Limits, NamedArray, read_npz, write_npz};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("camera.npz");
/// let array = NamedArray {
///     name: "range.T".into(),
///     unit: "m",
///     meaning: "distance along the ray",
///     shape: vec![("row", 1), ("column", 2)],
///     data: ArrayData::F64(vec![1.5, f64::INFINITY]),
/// };
/// write_npz(&path, &[array])?;
/// let arrays = read_npz(&path, &Limits::default())?;
/// assert_eq!((arrays[0].0.as_str(), arrays[0].1.planes[0].real(0)), ("range.T", 1.5));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Names the file and the array. `limits.bytes` holds for all arrays together.
pub fn read_npz(path: impl AsRef<Path>, limits: &Limits) -> Result<Vec<(String, Array)>, FileError> {
    let path = path.as_ref();
    let most = limits.bytes.saturating_add(MAX_ARRAYS as u64 * MAX_HEADER_BYTES);
    let bytes = bytes::read_file(path, most).map_err(|error| FileError::io(path, "read", error))?;
    npz_from_bytes(&bytes, path, limits)
}

/// Reads the bytes of an NPZ file as [`read_npz`] does; `file` is its name in messages.
///
/// # Errors
/// As [`read_npz`].
pub fn npz_from_bytes(bytes: &[u8], file: &Path, limits: &Limits) -> Result<Vec<(String, Array)>, FileError> {
    let refuse = |fault: Fault| FileError::Array(fault.in_file(file));
    let invalid = |place: &str, error: &dyn std::fmt::Display| {
        refuse(Fault::new(place, error.to_string(), "an NPZ file that is complete, as numpy.savez writes it"))
    };
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| invalid("archive", &error))?;
    if archive.len() > MAX_ARRAYS {
        let found = format!("{} files", archive.len());
        return Err(refuse(Fault::new("archive", found, format!("at most {MAX_ARRAYS}"))));
    }
    if let Some(array) = listed_twice(bytes, archive.central_directory_start()) {
        return Err(refuse(Fault::new(format!("array {array:?}"), "there twice", "each array once")));
    }
    // A small file could ask for gigabytes.
    let inflated = MAX_INFLATED_BYTES.max(MAX_EXPANSION.saturating_mul(bytes.len() as u64));
    let mut left = Limits { bytes: limits.bytes.min(inflated), ..*limits };
    let mut arrays: Vec<(String, Array)> = Vec::new();
    for index in 0..archive.len() {
        let entry = archive.by_index(index).map_err(|error| invalid("archive", &error))?;
        let name = entry.name().map_err(|error| invalid("archive", &error))?.into_owned();
        let Some(array) = name.strip_suffix(".npy") else { continue };
        let place = format!("array {array:?}");
        let most = left.bytes.saturating_add(MAX_HEADER_BYTES);
        let size = entry.size();
        if size > most {
            return Err(refuse(Fault::new(place, format!("{size} bytes"), format!("at most {most}"))));
        }
        let mut contents = Vec::new();
        // One byte more than it claims, so that an entry that is longer is seen.
        entry.take(size + 1).read_to_end(&mut contents).map_err(|error| invalid(&place, &error))?;
        if contents.len() as u64 != size {
            let found = format!("{} bytes or more", contents.len());
            return Err(refuse(Fault::new(place, found, format!("the {size} of its header"))));
        }
        left.bytes = left.bytes.saturating_sub(size);
        let read = raster_from_bytes(&contents, &Limits { bytes: limits.bytes, ..*limits });
        let Some(read) = read.map_err(|fault| refuse(fault.inside(&place)))? else { continue };
        arrays.push((array.to_string(), read));
    }
    Ok(arrays)
}

/// An array that stands twice in the list at the end of an archive, which begins at `start`. The crate `zip` keeps the last of one
/// name, and does not say so.
fn listed_twice(bytes: &[u8], start: u64) -> Option<String> {
    let mut rest = bytes.get(usize::try_from(start).ok()?..)?;
    let mut seen = BTreeSet::new();
    // 46 bytes, then the name, an extra field and a comment, whose lengths are among them. (APPNOTE.TXT, section 4.3.12)
    while let Some((header, after)) = rest.split_first_chunk::<46>() {
        if !header.starts_with(b"PK\x01\x02") {
            break;
        }
        let length = |at: usize| usize::from(u16::from_le_bytes([header[at], header[at + 1]]));
        let [name, extra, comment] = [28, 30, 32].map(length);
        let own = after.get(..name)?;
        if let Some(array) = own.strip_suffix(b".npy").filter(|array| !seen.insert(*array)) {
            return Some(String::from_utf8_lossy(array).into_owned());
        }
        rest = after.get(name + extra + comment..)?;
    }
    None
}
