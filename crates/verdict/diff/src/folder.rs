//! The files of a comparison.

use std::io;
use std::path::{Path, PathBuf};

use raypencil_files::{FileError, FolderError, begin_output_folder, write_atomically};
use raypencil_scene::Progress;

use crate::difference::{Difference, Sides};
use crate::html::html;
use crate::junit::junit;
use crate::summary::diff_json;

/// Paths of the files that [`write_diff`] wrote.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenDiff {
    /// Path of `report.html`.
    pub report: PathBuf,
    /// Path of `junit.xml`.
    pub junit: PathBuf,
    /// Path of `summary.json`.
    pub summary: PathBuf,
}

/// Writes `report.html`, `junit.xml` and then `summary.json` into a folder. A `summary.json` marks a complete folder.
/// Other files in the folder stay.
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
        // An error of the template or the document is reported with the path of its file.
        let contents =
            contents.map_err(|source| FileError::Io { path: path.clone(), action: "write", source })?;
        write_atomically(&path, |file| file.write_all(contents.as_bytes()))?;
        Ok(path)
    };
    let report = write("report.html", html(difference, sides).map_err(io::Error::other))?;
    let junit = write("junit.xml", junit(difference, sides).map_err(io::Error::other))?;
    write("summary.json", Ok(diff_json(difference, sides)))?;
    Ok(WrittenDiff { report, junit, summary })
}
