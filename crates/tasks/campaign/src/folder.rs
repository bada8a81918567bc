//! The files of a campaign's result.

use std::path::{Path, PathBuf};

use raypencil_files::{FileError, FolderError, write_texts};

use crate::document::campaign_document;
use crate::merge::Merged;

/// Writes `report.html`, `junit.xml`, `summary.md`, and last `summary.json`, into a folder. Returns the path of the summary.
///
/// # Errors
/// Names the file or folder that could not be written, and why.
pub fn write_campaign(merged: &Merged, folder: &Path) -> Result<PathBuf, FolderError> {
    const DATA: &str = "summary.json";
    let texts = campaign_document(merged, |path| folder.join(path).is_file()).files(DATA);
    write_texts(
        folder,
        &texts.map_err(|(name, source)| FileError::io(&folder.join(name), "write", source))?,
    )?;
    Ok(folder.join(DATA))
}
