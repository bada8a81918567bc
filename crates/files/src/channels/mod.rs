//! A recording of any program: the channels of a file or a folder, by key. Rules: `docs/formats/files.md`.

pub(crate) mod files;
pub(crate) mod merge;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::array::{Array, Storage, Values};
use crate::channels::files::{Found, Kind};
use crate::error::{Fault, FileError};
use crate::exr::Raster;
use crate::exr::read::read_exr;
use crate::limits::Limits;
use crate::npy::read_npy;
use crate::pfm::read_pfm;

/// Cells of one quantity, as a file holds them.
#[derive(Debug, Clone)]
pub struct Channel {
    /// The file.
    pub file: PathBuf,
    /// The channel's name inside the file; of an array the component (`X`, `0`), or nothing if it has one.
    pub name: String,
    /// How the file stores the cells.
    pub storage: Storage,
    /// The cells.
    pub values: Values,
}

/// All that a recording holds.
#[derive(Debug, Clone, Default)]
pub struct Channels {
    /// The channels by their keys, as `camera/range.T`. Of several under one key the finest.
    pub by_key: BTreeMap<String, Channel>,
    /// The others, with their keys: they agree with the finest to within half an ulp of their own storage.
    pub coarser: Vec<(String, Channel)>,
    /// The text attributes of each OpenEXR file.
    pub attributes: BTreeMap<PathBuf, BTreeMap<String, String>>,
    /// Every file that was read, in the order of their names.
    pub files: Vec<PathBuf>,
}

/// Reads a recording: an `.exr`, `.npy` or `.pfm` file, or all of them in a folder and in the folders just
/// below it. Keys, components and duplicates are as `docs/formats/files.md` says.
///
/// # Errors
/// Names the file and the place in it; for two files that contradict each other, both and the first cell.
/// `limits.bytes` is for all files together.
pub fn read_channels(path: impl AsRef<Path>, limits: &Limits) -> Result<Channels, FileError> {
    read_found(files::find(path.as_ref())?, limits)
}

/// Reads those maps and arrays of a folder that a list names, by their paths from there with `/`, and no others.
///
/// # Errors
/// As [`read_channels`].
pub fn read_listed<'a>(
    folder: impl AsRef<Path>,
    paths: impl IntoIterator<Item = &'a str>,
    limits: &Limits,
) -> Result<Channels, FileError> {
    let found = paths.into_iter().filter_map(|path| files::listed(folder.as_ref(), path));
    read_found(found.collect(), limits)
}

fn read_found(found: Vec<Found>, limits: &Limits) -> Result<Channels, FileError> {
    let mut channels = Channels::default();
    let mut read: BTreeMap<String, Vec<Channel>> = BTreeMap::new();
    let mut left = *limits;
    for found in found {
        let of_file = one_file(&found, &left, &mut channels.attributes)?;
        let stored: u64 = of_file.iter().map(|(_, channel)| stored_bytes(channel)).sum();
        left.bytes = left.bytes.saturating_sub(stored);
        for (key, channel) in of_file {
            read.entry(key).or_default().push(channel);
        }
        channels.files.push(found.path);
    }
    for (key, several) in read {
        let (finest, coarser) = merge::merge(&key, several)?;
        channels.coarser.extend(coarser.into_iter().map(|channel| (key.clone(), channel)));
        channels.by_key.insert(key, finest);
    }
    Ok(channels)
}

/// What the cells take in their file before it is compressed. Wholes may take less there, never more here.
fn stored_bytes(channel: &Channel) -> u64 {
    let (width, height) = channel.values.size();
    let bytes = match channel.storage {
        Storage::F16 => 2,
        Storage::F32 | Storage::Whole => 4,
        Storage::F64 => 8,
    };
    u64::from(width) * u64::from(height) * bytes
}

/// The channels of one file with their keys.
fn one_file(
    found: &Found,
    limits: &Limits,
    attributes: &mut BTreeMap<PathBuf, BTreeMap<String, String>>,
) -> Result<Vec<(String, Channel)>, FileError> {
    let array = match found.kind {
        Kind::Exr => {
            let map = read_exr(&found.path, limits)?;
            let halves = map.halves;
            attributes.insert(found.path.clone(), map.attributes);
            let channel = |(name, raster): (String, Raster)| {
                let (storage, values) = match raster {
                    Raster::U32(image) => (Storage::Whole, Values::Wholes(image)),
                    Raster::F32(image) => {
                        let storage = if halves.contains(&name) { Storage::F16 } else { Storage::F32 };
                        (storage, Values::Reals(crate::exr::convert(&image, f64::from)))
                    }
                };
                let key = match &found.stem {
                    Some(stem) => format!("{stem}/{name}"),
                    None => name.clone(),
                };
                (key, Channel { file: found.path.clone(), name, storage, values })
            };
            return Ok(map.channels.into_iter().map(channel).collect());
        }
        Kind::Npy => read_npy(&found.path, limits)?,
        Kind::Pfm => read_pfm(&found.path, limits)?,
    };
    let stem = match &found.stem {
        Some(stem) => stem.clone(),
        None => files::stem(&found.path),
    };
    let Array { storage, planes } = array;
    let count = planes.len();
    let channel = |(index, values)| {
        let name = component(index, count);
        let key = if name.is_empty() { stem.clone() } else { format!("{stem}.{name}") };
        (key, Channel { file: found.path.clone(), name, storage, values })
    };
    Ok(planes.into_iter().enumerate().map(channel).collect())
}

/// The name of a component: none if it is alone, X, Y and Z of two or three, else its number.
fn component(index: usize, count: usize) -> String {
    match count {
        1 => String::new(),
        2 | 3 => ["X", "Y", "Z"][index].to_string(),
        _ => index.to_string(),
    }
}

/// An error of a recording as a whole.
pub(crate) fn unfit(path: &Path, fault: Fault) -> FileError {
    FileError::Recording(fault.in_file(path))
}
