//! The files of a check.

use std::io;
use std::path::{Path, PathBuf};

use raypencil_files::{FileError, FolderError, begin_output_folder, write_atomically};

use crate::check::Checked;
use crate::check_report::json::check_json;
use crate::check_report::junit::junit;
use crate::check_report::page::check_page;

/// Writes `report.html`, `junit.xml` and then `check.json` into a folder, and returns their paths. A `check.json`
/// marks a complete folder.
///
/// # Errors
/// Names the file or folder that could not be written, and why.
pub fn write_check(checked: &Checked, folder: &Path) -> Result<Vec<PathBuf>, FolderError> {
    let last = begin_output_folder(folder, "check.json")?;
    let documents =
        [("report.html", check_page(checked).map_err(io::Error::other)), ("junit.xml", junit(checked))];
    let mut paths = Vec::new();
    for (name, document) in documents {
        let path = folder.join(name);
        let document =
            document.map_err(|source| FileError::Io { path: path.clone(), action: "write", source })?;
        write_atomically(&path, |file| file.write_all(document.as_bytes()))?;
        paths.push(path);
    }
    write_atomically(&last, |file| file.write_all(check_json(checked).as_bytes()))?;
    paths.push(last);
    Ok(paths)
}
