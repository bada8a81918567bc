//! Reads the channels of a file or of a folder, with their keys.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use raypencil_scene::HitQuantity;

use crate::channels::channel::{Channel, Channels};
use crate::channels::declared::Declared;
use crate::channels::find::{self, FileFormat, RecordingFile};
use crate::channels::found::{self, Found};
use crate::channels::merge::merge;
use crate::channels::ray_sets::{has_ray_sets, is_ray_set, ray_set_channels};
use crate::error::{Fault, FileError};
use crate::exr::read_exr_parts;
use crate::limits::Limits;
use crate::npy::read_npy;
use crate::npz::read_npz;
use crate::pfm::read_pfm;
use crate::png::read_picture_png;
use crate::tiff::read_picture_tiff;
use crate::zarr::{ZarrArray, read_zarr};

/// Reads a recording: a file of one of the formats below, or all such files of a folder and of the folders just below it.
/// They are `.exr`, `.npy`, `.npz`, `.pfm`, `.png` and `.tif`, and folders that are Zarr stores.
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
    read_channels_as(path, limits, &Declared::default(), None)
}

/// The same for a recording of which something is declared. Of the pictures in a folder (`.png`, `.tif`), those of which one of
/// the names in `pictures` or a declared channel speaks are read; without `pictures`, all but those beside arrays and maps, of
/// which a picture is no channel unless it has the name of a map. Without `pictures`, the arrays of a folder that is itself a
/// set of rays (see [`is_ray_set`]) are read as those of a set, whatever their dimensions.
///
/// ```
/// use raypencil_files::{Declared, Limits, create_folder, read_channels_as, write_npy};
/// use raypencil_scene::Image;
///
/// let folder = tempfile::tempdir()?;
/// create_folder(&folder.path().join("camera"))?;
/// write_npy(folder.path().join("camera/z16.npy"), &[&Image::from_cells(2, 1, vec![1500_u32, 0])])?;
///
/// // The file counts millimetres along the optical axis, and 0 is no reading.
/// let declared = Declared { channels: vec!["depth.Z=z16".parse()?], scale: Some(0.001), ..Declared::default() };
/// let channels = read_channels_as(folder.path(), &Limits::default(), &declared, None)?;
/// let depth = &channels.by_key["camera/depth.Z"];
/// assert_eq!((depth.values.real(0), depth.values.real(1)), (1.5, f64::INFINITY));
/// assert_eq!(depth.storage.to_string(), "steps of 0.001 m");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`read_channels`]; a declared channel that is not there, or there more than once, and a scale that concerns no map. The
/// message lists what is there.
pub fn read_channels_as(
    path: impl AsRef<Path>,
    limits: &Limits,
    declared: &Declared,
    pictures: Option<&[String]>,
) -> Result<Channels, FileError> {
    let path = path.as_ref();
    // Answers to sets of rays alone are a recording too; `add_ray_sets` reads them.
    let mut files = match pictures {
        None if has_ray_sets(path)? => find::files_in(path)?,
        _ => find::recording_files(path)?,
    };
    let mut set = Channels::default();
    let mut left = *limits;
    match (pictures, path.is_dir()) {
        (_, false) => (),
        (Some(names), true) => {
            files.retain(|file| !file.format.is_picture() || is_spoken_of(file, names, declared));
        }
        (None, true) => {
            let folders: BTreeSet<PathBuf> =
                files.iter().filter(|file| !file.format.is_picture()).filter_map(folder_of).collect();
            let names = map_names();
            files.retain(|file| {
                let has_arrays = folder_of(file).is_some_and(|folder| folders.contains(&folder));
                !file.format.is_picture() || !has_arrays || is_spoken_of(file, &names, declared)
            });
            if is_ray_set(path) {
                set = ray_set_channels(path, &mut left)?;
                files.retain(|file| !set.files.contains(&file.path));
            }
        }
    }
    read_files(files, set, &left, declared, path)
}

/// The folder of a file.
fn folder_of(file: &RecordingFile) -> Option<PathBuf> {
    file.path.parent().map(Path::to_path_buf)
}

/// Names of maps that a picture may have, whatever the scene is.
fn map_names() -> Vec<String> {
    let of_hits = HitQuantity::ALL.into_iter().flat_map(|quantity| quantity.channels().iter().copied());
    let vectors = of_hits.clone().filter_map(|name| name.strip_suffix(".X"));
    let names = of_hits.chain(vectors).chain(["view.Z", "face.I", "visible.V", "flux.V"]);
    names.map(String::from).collect()
}

/// Whether a picture has one of these names, or is declared to be a map.
fn is_spoken_of(file: &RecordingFile, names: &[String], declared: &Declared) -> bool {
    let stem = found::array_key(file);
    let own = stem.rsplit('/').next().unwrap_or(&stem);
    let is_declared = |channel: &str| {
        // Of a picture of several components with the component behind it.
        let end = channel.rsplit('/').next().unwrap_or(channel);
        end == own || end.rsplit_once('.').is_some_and(|(start, _)| start == own)
    };
    names.iter().any(|name| name == own) || declared.channels.iter().any(|one| is_declared(&one.channel))
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
    let folder = folder.as_ref();
    let files = paths.into_iter().filter_map(|path| find::listed_file(folder, path));
    read_files(files.collect(), Channels::default(), limits, &Declared::default(), folder)
}

/// Reads these files, and puts the channels of each key together, and with them those of a set of rays.
fn read_files(
    files: Vec<RecordingFile>,
    set: Channels,
    limits: &Limits,
    declared: &Declared,
    root: &Path,
) -> Result<Channels, FileError> {
    let mut channels = Channels { files: set.files, ..Channels::default() };
    let mut found: Vec<Found> =
        set.by_key.into_iter().map(|(key, channel)| Found::of_channel(key, channel)).collect();
    let mut left = *limits;
    for file in files {
        let of_file = read_one_file(&file, &left, &mut channels)?;
        let stored: u64 = of_file.iter().map(|one| one.channel.stored_bytes()).sum();
        left.bytes = left.bytes.saturating_sub(stored);
        found.extend(of_file);
        channels.files.push(file.path);
    }
    channels.used = declared.apply(&mut found, root)?;
    let mut read: BTreeMap<String, Vec<Channel>> = BTreeMap::new();
    for Found { key, channel, .. } in found {
        read.entry(key).or_default().push(channel);
    }
    for (key, several) in read {
        let (finest, coarser) = merge(&key, several)?;
        channels.coarser.extend(coarser.into_iter().map(|channel| (key.clone(), channel)));
        channels.by_key.insert(key, finest);
    }
    Ok(channels)
}

/// Refuses a map of a sensor whose attribute says that it is of another one: it would be compared with rays that are not its own.
fn refuse_other_sensor(file: &RecordingFile, attributes: &BTreeMap<String, String>) -> Result<(), FileError> {
    let is_sensor = |name: &&str| {
        let of_beam = name.strip_prefix("beam-").is_some_and(|number| number.parse::<u32>().is_ok());
        *name == "camera" || of_beam
    };
    let called = file.stem.as_ref().and_then(|stem| stem.split('/').next()).filter(is_sensor);
    let stated = attributes.get("sensor").map(String::as_str).filter(is_sensor);
    match (called, stated) {
        (Some(called), Some(stated)) if called != stated => {
            let expected = format!("{called}, as the file is called");
            Err(FileError::Exr(Fault::new("attribute sensor", stated, expected).in_file(&file.path)))
        }
        _ => Ok(()),
    }
}

/// Channels of one file with their keys.
fn read_one_file(
    file: &RecordingFile,
    limits: &Limits,
    channels: &mut Channels,
) -> Result<Vec<Found>, FileError> {
    let path = &file.path;
    let array = match file.format {
        FileFormat::Exr => {
            let parts = read_exr_parts(path, limits)?;
            let texts = parts.iter().flat_map(|part| part.map.attributes.clone());
            channels.attributes.insert(path.clone(), texts.collect());
            refuse_other_sensor(file, &channels.attributes[path])?;
            return Ok(found::of_exr(file, parts));
        }
        FileFormat::Npz => {
            let arrays = read_npz(path, limits)?;
            let found = arrays.into_iter().flat_map(|(name, array)| {
                let key = file.stem.as_ref().map_or(name.clone(), |stem| format!("{stem}/{name}"));
                found::of_array(&key, path, array)
            });
            return Ok(found.collect());
        }
        FileFormat::Zarr => {
            let arrays = read_zarr(path, limits)?;
            let found = arrays.into_iter().flat_map(|ZarrArray { path, group, name, array }| {
                let key = if group.is_empty() { name } else { format!("{group}/{name}") };
                found::of_array(&key, &path, array)
            });
            return Ok(found.collect());
        }
        FileFormat::Npy => read_npy(path, limits)?,
        FileFormat::Pfm => read_pfm(path, limits)?,
        FileFormat::Png => read_picture_png(path, limits)?,
        FileFormat::Tiff => read_picture_tiff(path, limits)?,
    };
    Ok(found::of_array(&found::array_key(file), path, array))
}
