//! Reads a manifest, and verifies the files that it lists.

use std::path::Path;

use raypencil_files::{Fault, FileError, bytes, file_sha256_hex};
use serde::Deserialize;

use crate::manifest::document::{MANIFEST_FORMAT, MANIFEST_NAME, Manifest, ManifestFile, pack_fault};
use crate::manifest::path::resolve_inside;

/// Maximum size of a manifest: 16 MiB.
const MAX_MANIFEST_BYTES: u64 = 1 << 24;

/// Reads the manifest of `folder` and checks its consistency.
pub(super) fn read_manifest(folder: &Path) -> Result<Manifest, FileError> {
    let path = folder.join(MANIFEST_NAME);
    if !folder.exists() {
        let expected = format!("the folder of a pack, with {MANIFEST_NAME} or raypack.json");
        return Err(pack_fault(folder, Fault::new("pack", "there is no such folder", expected)));
    }
    if !path.exists() {
        let expected = format!("a folder with {MANIFEST_NAME} (is this a pack?)");
        return Err(pack_fault(folder, Fault::new("pack", format!("no {MANIFEST_NAME}"), expected)));
    }
    let text =
        bytes::read_file(&path, MAX_MANIFEST_BYTES).map_err(|error| FileError::io(&path, "read", error))?;
    Manifest::from_bytes(&text, &path)
}

/// Parses a manifest. Checks the format's number and the keys only.
fn parse(text: &[u8], path: &Path) -> Result<Manifest, FileError> {
    let invalid = |error: serde_json::Error| {
        pack_fault(
            path,
            Fault::new("JSON", error.to_string(), "a manifest as docs/formats/pack.schema.json describes"),
        )
    };
    // The number first: a newer format is refused by it, not by an unknown key.
    #[derive(Deserialize)]
    struct Head {
        format: u64,
    }
    let Head { format } = serde_json::from_slice(text).map_err(invalid)?;
    if format != u64::from(MANIFEST_FORMAT) {
        let newer =
            if format > MANIFEST_FORMAT.into() { " (was it written by a newer version?)" } else { "" };
        let fault = Fault::new("format", format.to_string(), format!("{MANIFEST_FORMAT}{newer}"));
        return Err(pack_fault(path, fault));
    }
    serde_json::from_slice(text).map_err(invalid)
}

impl Manifest {
    /// Reads the manifest of `folder` and checks its consistency. The files that it lists are not read.
    ///
    /// # Errors
    /// As [`Manifest::from_bytes`], and a folder without a manifest.
    pub fn read(folder: impl AsRef<Path>) -> Result<Self, FileError> {
        read_manifest(folder.as_ref())
    }

    /// Parses the bytes of a manifest and checks its consistency. The files that it lists are not read. `file` is the
    /// path that messages name.
    ///
    /// # Errors
    /// Names the manifest and the place in it, what was found and what was expected.
    pub fn from_bytes(bytes: &[u8], file: &Path) -> Result<Self, FileError> {
        let manifest = parse(bytes, file)?;
        manifest.check_consistency().map_err(|fault| pack_fault(file, fault))?;
        Ok(manifest)
    }

    /// Reads the manifest of the pack in `folder` and verifies every file that it lists: each must have the size and
    /// the digest of its entry. Files that are not listed are ignored.
    ///
    /// # Errors
    /// Names the manifest and the entry, or the file, what was found and what was expected.
    pub fn read_verified(folder: impl AsRef<Path>) -> Result<Self, FileError> {
        let folder = folder.as_ref();
        let manifest = read_manifest(folder)?;
        for file in &manifest.files {
            verify_file(folder, file)?;
        }
        Ok(manifest)
    }
}

/// Checks size and digest of one file against its entry.
fn verify_file(folder: &Path, entry: &ManifestFile) -> Result<(), FileError> {
    let path = resolve_inside(folder, &entry.path)
        .map_err(|fault| pack_fault(&folder.join(MANIFEST_NAME), fault))?;
    let refused = |error| FileError::io(&path, "read", error);
    let metadata = std::fs::metadata(&path).map_err(refused)?;
    let changed = "(was it changed after it was written?)";
    // The size first: a truncated file is refused without reading it.
    if metadata.is_file() && metadata.len() != entry.bytes {
        let expected = format!("{} {changed}", entry.bytes);
        return Err(pack_fault(&path, Fault::new("bytes", metadata.len().to_string(), expected)));
    }
    let (_, sha256) = file_sha256_hex(&path).map_err(refused)?;
    match sha256 == entry.sha256 {
        true => Ok(()),
        false => Err(pack_fault(&path, Fault::new("SHA-256", sha256, format!("{} {changed}", entry.sha256)))),
    }
}
