//! A file that grows line by line or row by row for a while, and is seen by others only when it is complete.

use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::disk::Temporary;
use crate::error::FileError;
use crate::npy::header;
use crate::placing::{persist, temporary_beside};

/// File that is written beside its path, and renamed when it is finished. Dropped before that, it leaves nothing.
///
/// ```
/// use raypencil_files::GrowingFile;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("log.csv");
/// let mut file = GrowingFile::create(&path)?;
/// file.add("a,b\n")?;
/// assert!(!path.exists());
/// file.finish()?;
/// assert_eq!(std::fs::read_to_string(&path)?, "a,b\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct GrowingFile {
    path: PathBuf,
    file: BufWriter<Temporary>,
}

impl GrowingFile {
    /// New file for `path`. Its folder must exist.
    ///
    /// # Errors
    /// The error of the file system, with the path.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, FileError> {
        let path = path.as_ref().to_path_buf();
        let file = temporary_beside(&path).map_err(|error| FileError::io(&path, "write", error))?;
        Ok(Self { path, file: BufWriter::new(file) })
    }

    /// Adds text, or any bytes.
    ///
    /// # Errors
    /// The error of the file system, with the path.
    pub fn add(&mut self, bytes: impl AsRef<[u8]>) -> Result<(), FileError> {
        self.file.write_all(bytes.as_ref()).map_err(|error| FileError::io(&self.path, "write", error))
    }

    /// Puts the complete file in its place.
    ///
    /// # Errors
    /// The error of the file system, with the path.
    pub fn finish(self) -> Result<PathBuf, FileError> {
        let Self { path, file } = self;
        let attempt = || {
            let file = file.into_inner().map_err(|error| error.into_error())?;
            persist(file, &path)
        };
        attempt().map_err(|error| FileError::io(&path, "write", error))?;
        Ok(path)
    }
}

/// For encoders that write where they like. Their errors do not name the path.
impl Write for GrowingFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for GrowingFile {
    fn seek(&mut self, place: SeekFrom) -> io::Result<u64> {
        self.file.seek(place)
    }
}

/// Digits that hold the number of rows in the header while it is not known: any number below 10^18 fits.
const ROWS_PLACEHOLDER: u64 = 999_999_999_999_999_999;

/// Table of doubles that grows row by row: an NPY file of shape (rows, columns).
///
/// ```
/// use raypencil_files::{Limits, NpyRows, read_npy_numbers};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("points.npy");
/// let mut rows = NpyRows::create(&path, 3)?;
/// rows.push(&[1.0, 2.0, 3.0])?;
/// rows.push(&[4.0, 5.0, f64::NAN])?;
/// rows.finish()?;
/// assert_eq!(read_npy_numbers(&path, &Limits::default())?.shape, [2, 3]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct NpyRows {
    file: GrowingFile,
    columns: u64,
    rows: u64,
}

impl NpyRows {
    /// New table for `path`.
    ///
    /// # Errors
    /// As [`GrowingFile::create`].
    pub fn create(path: impl AsRef<Path>, columns: u64) -> Result<Self, FileError> {
        let mut file = GrowingFile::create(path)?;
        file.add(header("<f8", &format!("({ROWS_PLACEHOLDER}, {columns})")))?;
        Ok(Self { file, columns, rows: 0 })
    }

    /// Adds one row.
    ///
    /// # Errors
    /// As [`GrowingFile::add`].
    ///
    /// # Panics
    /// If it has not as many numbers as there are columns.
    pub fn push(&mut self, row: &[f64]) -> Result<(), FileError> {
        assert_eq!(row.len() as u64, self.columns, "numbers in a row");
        self.rows += 1;
        row.iter().try_for_each(|number| self.file.add(number.to_le_bytes()))
    }

    /// Puts the complete file in its place.
    ///
    /// # Errors
    /// As [`GrowingFile::finish`].
    pub fn finish(self) -> Result<PathBuf, FileError> {
        let Self { mut file, columns, rows } = self;
        // The number of rows has fewer digits than its placeholder: spaces keep the header as long as it was.
        let digits = ROWS_PLACEHOLDER.to_string().len();
        let shape = format!("({rows}, {columns}){:1$}", "", digits - rows.to_string().len());
        let header = header("<f8", &shape);
        file.file
            .seek(SeekFrom::Start(0))
            .and_then(|_| file.file.write_all(&header))
            .map_err(|error| FileError::io(&file.path, "write", error))?;
        file.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Limits, read_npy_numbers};

    #[test]
    fn a_table_of_any_number_of_rows_has_the_same_header_as_one_written_at_once() {
        let folder = tempfile::tempdir().unwrap();
        for rows in [0_u64, 1, 9, 10, 1234] {
            let path = folder.path().join("rows.npy");
            let mut table = NpyRows::create(&path, 2).unwrap();
            for row in 0..rows {
                table.push(&[row as f64, -0.5]).unwrap();
            }
            table.finish().unwrap();
            let read = read_npy_numbers(&path, &Limits::default()).unwrap();
            assert_eq!(read.shape, [rows, 2]);
            let expected: Vec<f64> = (0..rows).flat_map(|row| [row as f64, -0.5]).collect();
            assert_eq!(read.values, expected);
        }
    }

    #[test]
    fn an_unfinished_file_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let mut table = NpyRows::create(folder.path().join("rows.npy"), 1).unwrap();
        table.push(&[1.0]).unwrap();
        drop(table);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        let missing = GrowingFile::create(folder.path().join("none").join("a.csv")).unwrap_err();
        assert!(missing.to_string().contains("a.csv"), "{missing}");
    }
}
