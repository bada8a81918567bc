//! Writes a manifest, and removes an earlier pack.

use std::path::{Path, PathBuf};

use raypencil_files::{FileError, claim, file_sha256_hex, remove_file, write_atomically};

use crate::manifest::document::{FileRole, MANIFEST_NAME, Manifest, ManifestFile, pack_fault};
use crate::manifest::path::resolve_inside;
use crate::manifest::read::read_manifest;

impl ManifestFile {
    /// The entry of an existing file, `path` being relative to `folder`: size and digest, without type and channels.
    ///
    /// # Errors
    /// A path that leads out of the folder; a file that cannot be read.
    pub fn of(folder: &Path, path: impl Into<String>, role: FileRole) -> Result<Self, FileError> {
        let path = path.into();
        let file =
            resolve_inside(folder, &path).map_err(|fault| pack_fault(&folder.join(MANIFEST_NAME), fault))?;
        let (bytes, sha256) = file_sha256_hex(&file).map_err(|error| FileError::io(&file, "read", error))?;
        Ok(Self { path, role, bytes, sha256, kind: None, shape: None, channels: Vec::new() })
    }
}

impl Manifest {
    /// Writes `manifest.json` into `folder`. The same manifest gives the same bytes.
    ///
    /// # Errors
    /// A manifest that contradicts itself, as [`Manifest::from_bytes`] refuses it; a file that cannot be written.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<(), FileError> {
        let path = folder.as_ref().join(MANIFEST_NAME);
        self.check_consistency().map_err(|fault| pack_fault(&path, fault))?;
        let mut text = serde_json::to_vec_pretty(self).expect("JSON of numbers and texts");
        text.push(b'\n');
        write_atomically(&path, |file| file.write_all(&text))
    }

    /// Removes the manifest from `folder` and nothing else: the pack is no complete one until it is written again.
    ///
    /// # Errors
    /// A file that cannot be removed.
    pub fn withdraw(folder: impl AsRef<Path>) -> Result<(), FileError> {
        remove(&folder.as_ref().join(MANIFEST_NAME))
    }

    /// Removes an earlier pack from `folder`: first its manifest, then the files that the manifest lists, as far as they are
    /// as it says. A file that was changed is not the pack's, and stays; so does what is out of the folder.
    ///
    /// # Errors
    /// A file that cannot be removed; a `manifest.json` that is no regular file, or is none of a pack.
    pub fn remove_pack(folder: impl AsRef<Path>) -> Result<(), FileError> {
        let folder = folder.as_ref();
        let path = folder.join(MANIFEST_NAME);
        match std::fs::symlink_metadata(&path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(()),
            Err(error) => return Err(FileError::io(&path, "read", error)),
            Ok(_) => {}
        }
        let earlier = read_manifest(folder)?;
        let is_own = |(file, entry): &(PathBuf, &ManifestFile)| {
            file_sha256_hex(file).is_ok_and(|found| found == (entry.bytes, entry.sha256.clone()))
        };
        // A file that no longer exists cannot be resolved, and needs no removal.
        let listed = earlier.files.iter();
        let listed = listed.filter_map(|entry| Some((resolve_inside(folder, &entry.path).ok()?, entry)));
        let own: Vec<(PathBuf, &ManifestFile)> = listed.filter(is_own).collect();
        // Whoever dies after the manifest is gone leaves files that nobody would know otherwise.
        own.iter().try_for_each(|(file, entry)| claim(file, &entry.sha256))?;
        Self::withdraw(folder)?;
        own.iter().try_for_each(|(file, _)| remove(file))
    }
}

/// Removes a file; one that is not there is no error.
fn remove(path: &Path) -> Result<(), FileError> {
    match remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(FileError::io(path, "remove", error))
        }
        _ => Ok(()),
    }
}
