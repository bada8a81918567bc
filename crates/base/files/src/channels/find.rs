//! Files of a recording, and the start of their keys.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::error::{Fault, FileError};
use crate::zarr::is_zarr;

/// Format of a file by the ending of its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FileFormat {
    Exr,
    Npy,
    Npz,
    Pfm,
    Png,
    Tiff,
    /// A folder.
    Zarr,
}

impl FileFormat {
    /// Whether other programs also write it as a picture for people.
    pub fn is_picture(self) -> bool {
        matches!(self, Self::Png | Self::Tiff)
    }
}

/// The formats, for messages.
const ENDINGS: &str = ".exr, .npy, .npz, .pfm, .png or .tif";

/// A file that is to be read.
#[derive(Debug)]
pub(super) struct RecordingFile {
    pub path: PathBuf,
    pub format: FileFormat,
    /// Start of its keys: its path in the folder, with `/` and without the ending. `None` for a file that is the
    /// whole recording, and for a store, whose groups are folders of their own.
    pub stem: Option<String>,
}

/// Whether a recording has any file that may hold maps: a folder may have answers to sets of rays alone.
///
/// # Errors
/// Names the file or folder that cannot be read.
pub fn has_maps(path: &Path) -> Result<bool, FileError> {
    match path.is_dir() {
        true => Ok(!files_in(path)?.is_empty()),
        false => Ok(true),
    }
}

/// Files of a recording, ordered by their keys. There is at least one.
pub(super) fn recording_files(path: &Path) -> Result<Vec<RecordingFile>, FileError> {
    let refused = |error| FileError::io(path, "read", error);
    if !fs::metadata(path).map_err(refused)?.is_dir() {
        let Some(format) = format_of(path) else {
            let found = "a file of an unknown kind";
            let expected = format!("a folder, or a file that ends in {ENDINGS}");
            return Err(FileError::recording(path, Fault::new("recording", found, expected)));
        };
        return Ok(vec![RecordingFile { path: path.to_path_buf(), format, stem: None }]);
    }
    let found = files_in(path)?;
    if found.is_empty() {
        let expected =
            format!("at least one file that ends in {ENDINGS}, here or one folder below, or a .zarr store");
        return Err(FileError::recording(path, Fault::new("folder", "no maps", expected)));
    }
    Ok(found)
}

/// Files of a recording in a folder, ordered by their keys.
pub(super) fn files_in(path: &Path) -> Result<Vec<RecordingFile>, FileError> {
    let refused = |error| FileError::io(path, "read", error);
    if is_zarr(path) {
        return Ok(vec![RecordingFile { path: path.to_path_buf(), format: FileFormat::Zarr, stem: None }]);
    }
    let mut found = Vec::new();
    for entry in entries(path).map_err(refused)? {
        if entry.is_dir() && is_zarr(&entry) {
            found.push(RecordingFile { path: entry, format: FileFormat::Zarr, stem: None });
        } else if entry.is_dir() {
            let below = entries(&entry).map_err(|error| FileError::io(&entry, "read", error))?;
            let folder = name(&entry);
            let files = below.into_iter().filter(|file| !file.is_dir());
            found.extend(files.filter_map(|file| candidate(file, Some(&folder))));
        } else {
            found.extend(candidate(entry, None));
        }
    }
    found.sort_by(|a, b| (&a.stem, &a.path).cmp(&(&b.stem, &b.path)));
    Ok(found)
}

fn entries(folder: &Path) -> io::Result<Vec<PathBuf>> {
    fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect()
}

/// A file of the recording's folder, or of `folder` just below it; `None` for other formats.
fn candidate(path: PathBuf, folder: Option<&str>) -> Option<RecordingFile> {
    let format = format_of(&path)?;
    let stem = match folder {
        Some(folder) => format!("{folder}/{}", stem(&path)),
        None => stem(&path),
    };
    Some(RecordingFile { path, format, stem: Some(stem) })
}

/// A map or array by its path relative to `folder`; `None` for other formats.
pub(super) fn listed_file(folder: &Path, path: &str) -> Option<RecordingFile> {
    let format = format_of(Path::new(path))?;
    let stem = path.rsplit_once('.').map_or(path, |(stem, _)| stem);
    Some(RecordingFile { path: folder.join(path), format, stem: Some(stem.to_string()) })
}

fn format_of(path: &Path) -> Option<FileFormat> {
    let ending = path.extension()?.to_str()?.to_ascii_lowercase();
    match ending.as_str() {
        "exr" => Some(FileFormat::Exr),
        "npy" => Some(FileFormat::Npy),
        "npz" => Some(FileFormat::Npz),
        "pfm" => Some(FileFormat::Pfm),
        "png" => Some(FileFormat::Png),
        "tif" | "tiff" => Some(FileFormat::Tiff),
        _ => None,
    }
}

fn name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Name of a file without its ending.
pub(super) fn stem(path: &Path) -> String {
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}
