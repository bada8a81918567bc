//! Arrays with names and units, as what programs other than this one read at once: NPY, NPZ and Zarr.

use std::io::{Cursor, Write as _};
use std::path::Path;

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::atomic::write_atomically;
use crate::error::FileError;
use crate::folder::{FolderError, create_folder};
use crate::npy::header;

/// Size from which an entry of a ZIP archive needs its 64-bit form, bytes, with room for a header.
const LARGE_ENTRY_BYTES: usize = (1 << 32) - (1 << 20);

/// Numbers of an array.
#[derive(Debug, Clone, PartialEq)]
pub enum ArrayData {
    /// Double precision.
    F64(Vec<f64>),
    /// Indices.
    U32(Vec<u32>),
    /// Truths, 0 or 1.
    U8(Vec<u8>),
}

/// An array with its name.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedArray {
    /// Name, fit for a file.
    pub name: String,
    /// Unit of its numbers; 1 for a pure number.
    pub unit: &'static str,
    /// What its numbers mean.
    pub meaning: &'static str,
    /// Number of elements along each dimension, with its name. The last runs fastest.
    pub shape: Vec<(&'static str, u64)>,
    /// The numbers.
    pub data: ArrayData,
}

impl NamedArray {
    /// Name of the type in NPY headers, and in Zarr.
    fn types(&self) -> [&'static str; 2] {
        match self.data {
            ArrayData::F64(_) => ["<f8", "float64"],
            ArrayData::U32(_) => ["<u4", "uint32"],
            ArrayData::U8(_) => ["|u1", "uint8"],
        }
    }

    /// The numbers as little-endian bytes.
    fn bytes(&self) -> Vec<u8> {
        match &self.data {
            ArrayData::F64(numbers) => numbers.iter().flat_map(|number| number.to_le_bytes()).collect(),
            ArrayData::U32(numbers) => numbers.iter().flat_map(|number| number.to_le_bytes()).collect(),
            ArrayData::U8(numbers) => numbers.clone(),
        }
    }

    fn lengths(&self) -> Vec<String> {
        self.shape.iter().map(|(_, length)| length.to_string()).collect()
    }

    /// The array as the contents of an NPY file.
    pub fn npy(&self) -> Vec<u8> {
        let comma = if self.shape.len() == 1 { "," } else { "" };
        let mut bytes = header(self.types()[0], &format!("({}{comma})", self.lengths().join(", ")));
        bytes.extend(self.bytes());
        bytes
    }
}

/// Writes arrays as one NPZ file, an uncompressed ZIP archive of NPY files that `numpy.load` opens. The same arrays give the
/// same bytes.
///
/// ```
/// use raypencil_files::{ArrayData, NamedArray, write_npz};
///
/// let folder = tempfile::tempdir()?;
/// let array = NamedArray {
///     name: "range.T".into(),
///     unit: "m",
///     meaning: "distance along the ray",
///     shape: vec![("row", 1), ("column", 2)],
///     data: ArrayData::F64(vec![1.5, f64::INFINITY]),
/// };
/// write_npz(&folder.path().join("camera.npz"), &[array])?;
/// // A ZIP archive begins with the header of its first entry.
/// assert!(std::fs::read(folder.path().join("camera.npz"))?.starts_with(b"PK\x03\x04"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// An error of the file system, with the path.
pub fn write_npz(path: &Path, arrays: &[NamedArray]) -> Result<(), FileError> {
    let archive = || -> zip::result::ZipResult<Vec<u8>> {
        let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
        for array in arrays {
            let bytes = array.npy();
            let options = SimpleFileOptions::default()
                .compression_method(CompressionMethod::Stored)
                .last_modified_time(DateTime::default())
                .large_file(bytes.len() > LARGE_ENTRY_BYTES);
            archive.start_file(format!("{}.npy", array.name), options)?;
            archive.write_all(&bytes)?;
        }
        Ok(archive.finish()?.into_inner())
    };
    let bytes = archive().map_err(|error| FileError::io(path, "write", std::io::Error::other(error)))?;
    write_atomically(path, |file| file.write_all(&bytes))
}

/// Writes groups of arrays as a Zarr store, version 3: a folder with a group for each name. Each array is one chunk of plain
/// bytes, with its unit and meaning as attributes and the names of its dimensions, so that xarray opens a group as a dataset.
///
/// The store's own `zarr.json` is written last: a folder that has it is whole.
///
/// # Errors
/// A folder or file that cannot be written, with its path.
pub fn write_zarr(
    folder: &Path,
    attributes: &[(&str, &str)],
    groups: &[(String, Vec<NamedArray>)],
) -> Result<(), FolderError> {
    let document = |path: &Path, text: String| write_atomically(path, |file| file.write_all(text.as_bytes()));
    let group = |attributes: String| {
        format!("{{\"zarr_format\": 3, \"node_type\": \"group\", \"attributes\": {{{attributes}}}}}\n")
    };
    for (name, arrays) in groups {
        let of_group = folder.join(name);
        for array in arrays {
            let of_array = of_group.join(&array.name);
            let chunk = array.shape.iter().fold(of_array.join("c"), |path, _| path.join("0"));
            create_folder(chunk.parent().unwrap_or(&of_array))?;
            let bytes = array.bytes();
            write_atomically(&chunk, |file| file.write_all(&bytes))?;
            document(&of_array.join("zarr.json"), array_document(array))?;
        }
        create_folder(&of_group)?;
        document(&of_group.join("zarr.json"), group(String::new()))?;
    }
    let attributes: Vec<String> =
        attributes.iter().map(|(name, value)| format!("{}: {}", quoted(name), quoted(value))).collect();
    create_folder(folder)?;
    Ok(document(&folder.join("zarr.json"), group(attributes.join(", ")))?)
}

/// `zarr.json` of an array. (Zarr 3.0, "Array metadata")
fn array_document(array: &NamedArray) -> String {
    let shape = array.lengths().join(", ");
    let names: Vec<String> = array.shape.iter().map(|(name, _)| quoted(name)).collect();
    format!(
        "{{\"zarr_format\": 3, \"node_type\": \"array\", \"shape\": [{shape}], \"data_type\": \"{}\", \"chunk_grid\": \
         {{\"name\": \"regular\", \"configuration\": {{\"chunk_shape\": [{shape}]}}}}, \"chunk_key_encoding\": {{\"name\": \
         \"default\", \"configuration\": {{\"separator\": \"/\"}}}}, \"fill_value\": 0, \"codecs\": [{{\"name\": \"bytes\", \
         \"configuration\": {{\"endian\": \"little\"}}}}], \"dimension_names\": [{}], \"attributes\": {{\"units\": {}, \
         \"long_name\": {}}}}}\n",
        array.types()[1],
        names.join(", "),
        quoted(array.unit),
        quoted(array.meaning),
    )
}

/// A text in JSON.
fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' => out += "\\\"",
            '\\' => out += "\\\\",
            letter if letter.is_control() => out += &format!("\\u{:04x}", u32::from(letter)),
            letter => out.push(letter),
        }
    }
    out + "\""
}
