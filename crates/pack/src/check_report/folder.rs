//! The files of a check.

use std::path::{Path, PathBuf};

use raypencil_files::{FileError, FolderError, begin_output_folder, write_atomically};

use crate::check::Checked;
use crate::check_report::json::check_json;
use crate::check_report::junit::junit;

/// Writes `junit.xml` and then `check.json` into a folder, and returns their paths. A `check.json` marks a complete
/// folder.
///
/// # Errors
/// Names the file or folder that could not be written, and why.
pub fn write_check(checked: &Checked, folder: &Path) -> Result<Vec<PathBuf>, FolderError> {
    let last = begin_output_folder(folder, "check.json")?;
    let path = folder.join("junit.xml");
    let document = junit(checked).map_err(|error| FileError::Io {
        path: path.clone(),
        action: "write",
        source: std::io::Error::other(error),
    })?;
    write_atomically(&path, |file| file.write_all(document.as_bytes()))?;
    write_atomically(&last, |file| file.write_all(check_json(checked).as_bytes()))?;
    Ok(vec![path, last])
}
