//! The files of a comparison.

use std::path::Path;

use raypencil_files::{FileError, FolderError, write_texts};
use raypencil_scene::Progress;

use crate::difference::{Difference, Sides};
use crate::document::diff_document_with_pictures;

/// Writes `report.html`, `junit.xml`, `summary.md` and then `summary.json` into a folder. A `summary.json` marks a complete
/// folder. Other files in the folder stay.
///
/// # Errors
/// Names the file or folder that could not be written, and why.
pub fn write_diff(
    difference: &Difference,
    sides: &Sides,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<(), FolderError> {
    progress.stage("writing the report");
    let page = |error| FileError::io(&folder.join("report.html"), "write", std::io::Error::other(error));
    let document = diff_document_with_pictures(difference, sides).map_err(page)?;
    let texts = document.files("summary.json");
    write_texts(folder, &texts.map_err(|(name, source)| FileError::io(&folder.join(name), "write", source))?)
}
