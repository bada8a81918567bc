//! The files of a check.

use std::path::Path;

use raypencil_files::{FileError, FolderError, write_texts};
use raypencil_report::Document;

/// Writes `report.html`, `junit.xml`, `summary.md` and then `check.json` into a folder. A `check.json` marks a complete
/// folder.
///
/// # Errors
/// Names the file or folder that could not be written, and why.
pub fn write_document(document: &Document, folder: &Path) -> Result<(), FolderError> {
    let texts = document.files("check.json");
    write_texts(folder, &texts.map_err(|(name, source)| FileError::io(&folder.join(name), "write", source))?)
}
