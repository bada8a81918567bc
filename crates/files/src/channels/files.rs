//! Which files belong to a recording, and what their keys start with.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::channels::unfit;
use crate::error::{Fault, FileError};

/// What a file's name says that it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Exr,
    Npy,
    Pfm,
}

/// A file that is to be read.
#[derive(Debug)]
pub(crate) struct Found {
    pub path: PathBuf,
    pub kind: Kind,
    /// What its keys start with: its path in the folder, with `/` and without the ending. `None` for a file
    /// that is the whole recording.
    pub stem: Option<String>,
}

/// The files of a recording, by their names.
pub(super) fn find(path: &Path) -> Result<Vec<Found>, FileError> {
    let refused = |error| FileError::io(path, "read", error);
    if !fs::metadata(path).map_err(refused)?.is_dir() {
        let Some(kind) = kind(path) else {
            let found = "a file of an unknown kind";
            let expected = "a folder, or a file that ends in .exr, .npy or .pfm";
            return Err(unfit(path, Fault::new("recording", found, expected)));
        };
        return Ok(vec![Found { path: path.to_path_buf(), kind, stem: None }]);
    }
    let mut found = Vec::new();
    for entry in entries(path).map_err(refused)? {
        if entry.is_dir() {
            let below = entries(&entry).map_err(|error| FileError::io(&entry, "read", error))?;
            let folder = name(&entry);
            let files = below.into_iter().filter(|file| !file.is_dir());
            found.extend(files.filter_map(|file| candidate(file, Some(&folder))));
        } else {
            found.extend(candidate(entry, None));
        }
    }
    if found.is_empty() {
        let expected = "at least one .exr, .npy or .pfm file, here or one folder below";
        return Err(unfit(path, Fault::new("folder", "no maps", expected)));
    }
    found.sort_by(|a, b| (&a.stem, &a.path).cmp(&(&b.stem, &b.path)));
    Ok(found)
}

fn entries(folder: &Path) -> io::Result<Vec<PathBuf>> {
    fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect()
}

fn candidate(path: PathBuf, folder: Option<&str>) -> Option<Found> {
    let kind = kind(&path)?;
    let stem = match folder {
        Some(folder) => format!("{folder}/{}", stem(&path)),
        None => stem(&path),
    };
    Some(Found { path, kind, stem: Some(stem) })
}

/// A map or an array by its path from a folder; `None` if it is neither.
pub(super) fn listed(folder: &Path, path: &str) -> Option<Found> {
    let kind = kind(Path::new(path))?;
    let stem = path.rsplit_once('.').map_or(path, |(stem, _)| stem);
    Some(Found { path: folder.join(path), kind, stem: Some(stem.to_string()) })
}

fn kind(path: &Path) -> Option<Kind> {
    let ending = path.extension()?.to_str()?.to_ascii_lowercase();
    match ending.as_str() {
        "exr" => Some(Kind::Exr),
        "npy" => Some(Kind::Npy),
        "pfm" => Some(Kind::Pfm),
        _ => None,
    }
}

fn name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// A file's name without its ending.
pub(super) fn stem(path: &Path) -> String {
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}
