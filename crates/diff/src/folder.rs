//! The folder that a comparison leaves behind.

use std::io;
use std::path::{Path, PathBuf};

use crate::difference::{Difference, Sides};
use crate::junit;
use crate::report;
use crate::summary::diff_json;
use raypencil_files::{FileError, FolderError, begin_output_folder, write_atomically};
use raypencil_scene::Progress;

/// What [`write_diff`] wrote.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenDiff {
    /// `report.html`.
    pub report: PathBuf,
    /// `junit.xml`.
    pub junit: PathBuf,
    /// `summary.json`.
    pub summary: PathBuf,
}

/// Writes `report.html`, `junit.xml`, and last `summary.json`: where it is, the folder is complete. Other
/// files of the folder are left alone.
///
/// # Errors
/// Names the file or folder that could not be written, and why.
pub fn write_diff(
    difference: &Difference,
    sides: &Sides,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<WrittenDiff, FolderError> {
    let summary = begin_output_folder(folder, "summary.json")?;
    progress.stage("writing the report");
    let write = |name: &str, contents: Result<String, io::Error>| -> Result<PathBuf, FolderError> {
        let path = folder.join(name);
        // A template or a document that fails is reported with the file that it was to become.
        let contents =
            contents.map_err(|source| FileError::Io { path: path.clone(), action: "write", source })?;
        write_atomically(&path, |file| file.write_all(contents.as_bytes()))?;
        Ok(path)
    };
    let report = write("report.html", report::html(difference, sides).map_err(io::Error::other))?;
    let junit = write("junit.xml", junit::junit(difference, sides).map_err(io::Error::other))?;
    write("summary.json", Ok(diff_json(difference, sides)))?;
    Ok(WrittenDiff { report, junit, summary })
}
