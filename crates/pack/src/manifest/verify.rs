//! A manifest from a file, and the pack held to it.

use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::manifest::{
    FILE_NAME, FileType, MANIFEST_FORMAT, Manifest, ManifestFile, ManifestSensor, PackKind, unfit,
};
use raypencil_files::bytes;
use raypencil_files::file_sha256_hex;
use raypencil_files::{Fault, FileError};

/// A manifest larger than this is none: 16 MiB.
const LARGEST: u64 = 1 << 24;

/// The manifest of `folder`, which does not contradict itself.
pub(super) fn read(folder: &Path) -> Result<Manifest, FileError> {
    let path = folder.join(FILE_NAME);
    if !path.exists() {
        let expected = format!("a folder with {FILE_NAME} (is this a pack?)");
        return Err(unfit(folder, Fault::new("pack", format!("no {FILE_NAME}"), expected)));
    }
    let text = bytes::read_file(&path, LARGEST).map_err(|error| FileError::io(&path, "read", error))?;
    Manifest::from_bytes(&text, &path)
}

/// The manifest that a text is, checked by its form alone.
fn parse(text: &[u8], path: &Path) -> Result<Manifest, FileError> {
    let invalid = |error: serde_json::Error| {
        unfit(
            path,
            Fault::new("JSON", error.to_string(), "a manifest as docs/formats/pack.schema.json describes"),
        )
    };
    // A newer format fails by its number and not by a key.
    #[derive(Deserialize)]
    struct Head {
        format: u64,
    }
    let Head { format } = serde_json::from_slice(text).map_err(invalid)?;
    if format != u64::from(MANIFEST_FORMAT) {
        let newer =
            if format > MANIFEST_FORMAT.into() { " (was it written by a newer version?)" } else { "" };
        let fault = Fault::new("format", format.to_string(), format!("{MANIFEST_FORMAT}{newer}"));
        return Err(unfit(path, fault));
    }
    serde_json::from_slice(text).map_err(invalid)
}

impl Manifest {
    /// A manifest from the bytes of its file, held to its own words but to none of the files that it lists;
    /// `file` is for messages.
    ///
    /// # Errors
    /// Names the manifest and the place in it, what was found and what was expected.
    pub fn from_bytes(bytes: &[u8], file: &Path) -> Result<Self, FileError> {
        let manifest = parse(bytes, file)?;
        manifest.check().map_err(|fault| unfit(file, fault))?;
        Ok(manifest)
    }

    /// Refuses what contradicts itself.
    pub(super) fn check(&self) -> Result<(), Fault> {
        if self.format != MANIFEST_FORMAT {
            return Err(Fault::new("format", self.format.to_string(), MANIFEST_FORMAT.to_string()));
        }
        match (self.kind, self.blind_seed) {
            (PackKind::Blind, None) => {
                return Err(Fault::new("blindSeed", "absent", "a seed: the pack is blind"));
            }
            (PackKind::Answers, Some(seed)) => {
                let found = seed.to_string();
                return Err(Fault::new("blindSeed", found, "none: the answers are in the pack"));
            }
            _ => {}
        }
        hexadecimal("scene.sha256", &self.scene.sha256)?;
        self.check_sensors()?;
        // Looked up, not searched: a manifest may have thousands of both.
        let sensors = self.sensors.iter().map(|sensor| (sensor.name.as_str(), sensor)).collect();
        let mut paths = BTreeSet::new();
        for (index, file) in self.files.iter().enumerate() {
            let place = format!("files[{index}] {:?}", file.path.chars().take(80).collect::<String>());
            relative(&file.path).map_err(|why| Fault::new(&place, why, STAYS))?;
            if !paths.insert(&file.path) {
                return Err(Fault::new(place, "there twice", "each file once"));
            }
            hexadecimal(&format!("{place}: sha256"), &file.sha256)?;
            check_shape(&place, file, &sensors)?;
        }
        Ok(())
    }

    /// The camera first, then beam-0, beam-1 and so on, each with cells.
    fn check_sensors(&self) -> Result<(), Fault> {
        if self.sensors.is_empty() {
            return Err(Fault::new("sensors", "none", "the camera at least"));
        }
        for (index, sensor) in self.sensors.iter().enumerate() {
            let expected = match index {
                0 => "camera".to_string(),
                beam => format!("beam-{}", beam - 1),
            };
            let place = format!("sensors[{index}]");
            if sensor.name != expected {
                return Err(Fault::new(place, format!("{:?}", sensor.name), format!("{expected:?}")));
            }
            let sides = 1..=1 << 20;
            if !sides.contains(&sensor.columns) || !sides.contains(&sensor.rows) {
                let found = format!("{expected} of {} x {} cells", sensor.columns, sensor.rows);
                return Err(Fault::new(place, found, "1 to 1048576 columns and rows"));
            }
        }
        Ok(())
    }
}

/// A map has the size of the sensor in whose folder, or under whose name, it stands.
fn check_shape(
    place: &str,
    file: &ManifestFile,
    sensors: &BTreeMap<&str, &ManifestSensor>,
) -> Result<(), Fault> {
    let (kind, shape) = match (file.kind, &file.shape) {
        (None, None) => return Ok(()),
        (Some(kind), Some(shape)) => (kind, shape),
        _ => return Err(Fault::new(place, "one of type and shape", "both or neither")),
    };
    let lengths = if kind == FileType::Exr { 2..=2 } else { 2..=3 };
    if !lengths.contains(&shape.len()) {
        let found = format!("a shape of {} numbers", shape.len());
        return Err(Fault::new(place, found, "rows and columns, and components of an array"));
    }
    let (folder, _) = file.path.split_once('/').unwrap_or((file.path.trim_end_matches(".exr"), ""));
    match sensors.get(folder) {
        Some(sensor) if shape[..2] != [sensor.rows, sensor.columns] => {
            let expected = format!("{} rows of {} columns, as {folder} has", sensor.rows, sensor.columns);
            Err(Fault::new(place, format!("{} rows of {} columns", shape[0], shape[1]), expected))
        }
        _ => Ok(()),
    }
}

/// Refuses what is no SHA-256 as it is written here.
fn hexadecimal(place: &str, sha256: &str) -> Result<(), Fault> {
    let digit = |byte: u8| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte);
    match sha256.len() == 64 && sha256.bytes().all(digit) {
        true => Ok(()),
        false => {
            let found = format!("{:?}", sha256.chars().take(80).collect::<String>());
            Err(Fault::new(place, found, "64 hexadecimal digits in lower case"))
        }
    }
}

/// What a path has to be.
const STAYS: &str = "a path within the pack's folder, with / between its parts";

/// Refuses a path that may mean a place out of its folder, on this system or another.
fn relative(path: &str) -> Result<(), &'static str> {
    if path.contains(['\\', ':', '\0']) {
        return Err("has a backslash, a drive or a scheme");
    }
    match path.split('/').all(|part| !part.is_empty() && part != "." && part != "..") {
        true => Ok(()),
        false => Err("is absolute, leads out of the folder or names no file"),
    }
}

/// The place of a listed file, if it is there and within the folder, links included.
pub(super) fn inside(folder: &Path, path: &str) -> Result<PathBuf, Fault> {
    let place = || format!("file {:?}", path.chars().take(80).collect::<String>());
    relative(path).map_err(|why| Fault::new(place(), why, STAYS))?;
    let file = folder.join(path);
    let missing = |_| Fault::new(place(), "missing", "the file that was packed");
    let real = file.canonicalize().map_err(missing)?;
    match real.starts_with(folder.canonicalize().map_err(missing)?) {
        true => Ok(file),
        false => Err(Fault::new(place(), "leads out of the folder by a link", STAYS)),
    }
}

/// Holds one file of the pack to its entry.
pub(super) fn file(folder: &Path, entry: &ManifestFile) -> Result<(), FileError> {
    let path = inside(folder, &entry.path).map_err(|fault| unfit(&folder.join(FILE_NAME), fault))?;
    let refused = |error| FileError::io(&path, "read", error);
    let metadata = std::fs::metadata(&path).map_err(refused)?;
    let changed = "(was it changed after it was written?)";
    // Told apart from the digest: a cut file is seen at once, and need not be read.
    if metadata.is_file() && metadata.len() != entry.bytes {
        let expected = format!("{} {changed}", entry.bytes);
        return Err(unfit(&path, Fault::new("bytes", metadata.len().to_string(), expected)));
    }
    let (_, sha256) = file_sha256_hex(&path).map_err(refused)?;
    match sha256 == entry.sha256 {
        true => Ok(()),
        false => Err(unfit(&path, Fault::new("SHA-256", sha256, format!("{} {changed}", entry.sha256)))),
    }
}
