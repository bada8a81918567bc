//! Reads the channels of a file or of a folder, with their keys.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::channels::channel::{Channel, Channels};
use crate::channels::find::{self, FileFormat, RecordingFile};
use crate::channels::merge::merge;
use crate::error::FileError;
use crate::exr::{Raster, convert, read_exr};
use crate::limits::Limits;
use crate::npy::read_npy;
use crate::pfm::read_pfm;
use crate::values::{Array, Storage, Values};

/// Reads a recording: an `.exr`, `.npy` or `.pfm` file, or all such files of a folder and of the folders just below it.
///
/// `docs/formats/files.md` has the rules of keys, components and duplicates. `limits.bytes` holds for all files
/// together.
///
/// # Errors
/// Names the file and the place in it. Two files that contradict each other are both named, with the first cell in
/// which they do.
///
/// ```
/// use raypencil_files::{Limits, Storage, create_folder, read_channels, write_npy, write_pfm};
/// use raypencil_scene::Image;
///
/// let folder = tempfile::tempdir()?;
/// let camera = folder.path().join("camera");
/// create_folder(&camera)?;
/// write_npy(camera.join("range.T.npy"), &[&Image::filled(2, 1, 0.1_f64)])?;
/// write_pfm(camera.join("range.T.pfm"), &[&Image::filled(2, 1, 0.1_f32)])?;
///
/// // Both files have the key camera/range.T. The finer one stands for both: 0.1_f32 is 0.1 after rounding.
/// let channels = read_channels(folder.path(), &Limits::default())?;
/// assert_eq!(channels.by_key["camera/range.T"].storage, Storage::F64);
/// assert_eq!(channels.coarser[0].1.storage, Storage::F32);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_channels(path: impl AsRef<Path>, limits: &Limits) -> Result<Channels, FileError> {
    read_files(find::recording_files(path.as_ref())?, limits)
}

/// Reads the maps and arrays of a folder that `paths` lists, relative to the folder and with `/`. Paths of other files
/// are ignored.
///
/// # Errors
/// As [`read_channels`].
pub fn read_listed_channels<'a>(
    folder: impl AsRef<Path>,
    paths: impl IntoIterator<Item = &'a str>,
    limits: &Limits,
) -> Result<Channels, FileError> {
    let files = paths.into_iter().filter_map(|path| find::listed_file(folder.as_ref(), path));
    read_files(files.collect(), limits)
}

/// Reads these files, and puts the channels of each key together.
fn read_files(files: Vec<RecordingFile>, limits: &Limits) -> Result<Channels, FileError> {
    let mut channels = Channels::default();
    let mut read: BTreeMap<String, Vec<Channel>> = BTreeMap::new();
    let mut left = *limits;
    for file in files {
        let of_file = read_one_file(&file, &left, &mut channels.attributes)?;
        let stored: u64 = of_file.iter().map(|(_, channel)| channel.stored_bytes()).sum();
        left.bytes = left.bytes.saturating_sub(stored);
        for (key, channel) in of_file {
            read.entry(key).or_default().push(channel);
        }
        channels.files.push(file.path);
    }
    for (key, several) in read {
        let (finest, coarser) = merge(&key, several)?;
        channels.coarser.extend(coarser.into_iter().map(|channel| (key.clone(), channel)));
        channels.by_key.insert(key, finest);
    }
    Ok(channels)
}

/// Channels of one file with their keys.
fn read_one_file(
    file: &RecordingFile,
    limits: &Limits,
    attributes: &mut BTreeMap<PathBuf, BTreeMap<String, String>>,
) -> Result<Vec<(String, Channel)>, FileError> {
    let array = match file.format {
        FileFormat::Exr => {
            let map = read_exr(&file.path, limits)?;
            let halves = map.halves;
            attributes.insert(file.path.clone(), map.attributes);
            let channel = |(name, raster): (String, Raster)| {
                let (storage, values) = match raster {
                    Raster::U32(image) => (Storage::Whole, Values::Wholes(image)),
                    Raster::F32(image) => {
                        let storage = if halves.contains(&name) { Storage::F16 } else { Storage::F32 };
                        (storage, Values::Reals(convert(&image, f64::from)))
                    }
                };
                let key = match &file.stem {
                    Some(stem) => format!("{stem}/{name}"),
                    None => name.clone(),
                };
                (key, Channel { file: file.path.clone(), name, storage, values })
            };
            return Ok(map.channels.into_iter().map(channel).collect());
        }
        FileFormat::Npy => read_npy(&file.path, limits)?,
        FileFormat::Pfm => read_pfm(&file.path, limits)?,
    };
    let stem = match &file.stem {
        Some(stem) => stem.clone(),
        None => find::stem(&file.path),
    };
    let Array { storage, planes } = array;
    let count = planes.len();
    let channel = |(index, values)| {
        let name = component(index, count);
        let key = if name.is_empty() { stem.clone() } else { format!("{stem}.{name}") };
        (key, Channel { file: file.path.clone(), name, storage, values })
    };
    Ok(planes.into_iter().enumerate().map(channel).collect())
}

/// Name of a component: empty if it is the only one; X, Y, Z if there are two or three; else its number.
fn component(index: usize, count: usize) -> String {
    match count {
        1 => String::new(),
        2 | 3 => ["X", "Y", "Z"][index].to_string(),
        _ => index.to_string(),
    }
}
