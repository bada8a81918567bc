//! Sets of rays in a folder, as channels: `rays/NAME/*.npy`.

use std::fs;
use std::path::{Path, PathBuf};

use raypencil_scene::Image;

use crate::channels::channel::{Channel, Channels};
use crate::error::{Fault, FileError};
use crate::limits::Limits;
use crate::npy::{Numbers, read_npy_numbers};
use crate::values::{Storage, Values};

/// Arrays of a set that have one number per ray: the shape of the first that is there is that of the set.
const OF_EACH_RAY: [&str; 4] = ["face.npy", "t.npy", "range.npy", "hit.npy"];

/// Arrays that only a set of rays has: maps of sensors have other names.
const OF_SETS_ALONE: [&str; 2] = ["t.npy", "ties.npy"];

/// Whether a folder is itself a set of rays, as `cast` writes it.
///
/// ```
/// use raypencil_files::{is_ray_set, write_npy_numbers};
///
/// let folder = tempfile::tempdir()?;
/// write_npy_numbers(folder.path().join("range.npy"), &[2], &[1.0, 2.0])?;
/// assert!(!is_ray_set(folder.path()), "this may be the map of a camera");
/// write_npy_numbers(folder.path().join("t.npy"), &[2], &[0.5, 1.0])?;
/// assert!(is_ray_set(folder.path()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn is_ray_set(folder: &Path) -> bool {
    OF_SETS_ALONE.iter().any(|name| folder.join(name).is_file())
}

/// Whether a folder has answers to sets of rays: folders `rays/NAME` with arrays.
///
/// # Errors
/// A folder that cannot be read.
pub fn has_ray_sets(folder: &Path) -> Result<bool, FileError> {
    let of_sets = folder.join("rays");
    Ok(of_sets.is_dir() && entries(&of_sets)?.iter().any(|set| first_of_each_ray(set).is_some()))
}

/// The channels of a folder that is itself a set of rays; their keys are the names of its arrays.
pub(super) fn ray_set_channels(folder: &Path, left: &mut Limits) -> Result<Channels, FileError> {
    let mut channels = Channels::default();
    add_ray_set(&mut channels, folder, "", left)?;
    Ok(channels)
}

/// Adds the arrays of a folder's sets of rays to its channels, with keys such as `rays/mast/point.X`. A set of shape
/// (..., n) becomes rasters of n columns; a flat one has one row. Arrays of another shape, such as those of all hits of
/// each ray, are rasters as wide as their last dimension.
///
/// ```
/// use raypencil_files::{Channels, Limits, add_ray_sets, create_folder, write_npy_numbers};
///
/// let folder = tempfile::tempdir()?;
/// let set = folder.path().join("rays/mast");
/// create_folder(&set)?;
/// write_npy_numbers(set.join("face.npy"), &[2, 3], &[0.0, 0.0, 1.0, 1.0, 2.0, 2.0])?;
/// write_npy_numbers(set.join("normal.npy"), &[2, 3, 3], &[0.5; 18])?;
/// let mut channels = Channels::default();
/// add_ray_sets(&mut channels, folder.path(), &Limits::default())?;
/// assert_eq!(channels.by_key["rays/mast/face"].values.size(), (3, 2));
/// assert_eq!(channels.by_key["rays/mast/normal.Z"].values.real(5), 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Names the folder or the file, and the place in it.
pub fn add_ray_sets(channels: &mut Channels, folder: &Path, limits: &Limits) -> Result<(), FileError> {
    let of_sets = folder.join("rays");
    if !of_sets.is_dir() {
        return Ok(());
    }
    let mut left = *limits;
    for set in entries(&of_sets)? {
        let start = format!("rays/{}/", name(set.file_name()));
        add_ray_set(channels, &set, &start, &mut left)?;
    }
    Ok(())
}

/// Adds the arrays of one set; `start` is that of their keys. A folder without arrays of each ray has none.
fn add_ray_set(channels: &mut Channels, set: &Path, start: &str, left: &mut Limits) -> Result<(), FileError> {
    let Some(first) = first_of_each_ray(set) else { return Ok(()) };
    let of_each = read_npy_numbers(first, left)?;
    for file in entries(set)?.into_iter().filter(|file| file.extension().is_some_and(|end| end == "npy")) {
        let mut array = read_npy_numbers(&file, left)?;
        left.bytes = left.bytes.saturating_sub(8 * array.values.len() as u64);
        let own = name(file.file_stem());
        if array.storage == Storage::Whole && own.split('.').next_back() == Some("face") {
            // Both mean no face.
            array
                .values
                .iter_mut()
                .filter(|face| **face == -1.0)
                .for_each(|face| *face = f64::from(u32::MAX));
        }
        let key = format!("{start}{own}");
        for (component, values) in planes(&array, &of_each.shape, &file)? {
            let key = if component.is_empty() { key.clone() } else { format!("{key}.{component}") };
            let channel = Channel { file: file.clone(), name: component, storage: array.storage, values };
            channels.by_key.insert(key, channel);
        }
        channels.files.push(file);
    }
    Ok(())
}

/// The array that has the shape of the set in this folder.
fn first_of_each_ray(set: &Path) -> Option<PathBuf> {
    OF_EACH_RAY.iter().map(|name| set.join(name)).find(|path| path.is_file())
}

/// The paths in a folder, in the order of their names.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, FileError> {
    let refused = |error| FileError::io(folder, "read", error);
    let paths = fs::read_dir(folder).map_err(refused)?.map(|entry| Ok(entry.map_err(refused)?.path()));
    let mut paths: Vec<PathBuf> = paths.collect::<Result<_, FileError>>()?;
    paths.sort();
    Ok(paths)
}

fn name(part: Option<&std::ffi::OsStr>) -> String {
    part.map(|part| part.to_string_lossy().into_owned()).unwrap_or_default()
}

/// The components of an array: those that each ray of a set of this shape has. An array of another shape is one raster, as wide as its last
/// dimension.
fn planes(array: &Numbers, shape: &[u64], file: &Path) -> Result<Vec<(String, Values)>, FileError> {
    let (of_ray, columns): (&[u64], u64) = match (array.shape.strip_prefix(shape), array.shape.as_slice()) {
        (Some(of_ray), _) => (of_ray, shape.last().copied().unwrap_or(1)),
        (None, shape) => (&[], shape.last().copied().unwrap_or(1)),
    };
    // Before the names: a shape with a 0 may have any number of components.
    if array.values.is_empty() {
        return Ok(Vec::new());
    }
    let names = component_names(of_ray);
    let rays = (array.values.len() / names.len()) as u64;
    let rows = rays.checked_div(columns).unwrap_or(0);
    let (Ok(width), Ok(height)) = (u32::try_from(columns), u32::try_from(rows)) else {
        let found = format!("shape {:?}", array.shape);
        return Err(FileError::recording(
            file,
            Fault::new("array", found, "fewer than 4294967296 rows and columns"),
        ));
    };
    let plane = |k: usize| {
        let cells = array.values.iter().skip(k).step_by(names.len()).copied().collect();
        Values::Reals(Image::from_cells(width, height, cells))
    };
    Ok(names.iter().enumerate().map(|(k, name)| (name.clone(), plane(k))).collect())
}

/// Names of the numbers that each ray has in an array: one has none, two or three are X, Y and Z, the vectors of `across` are
/// `0.X` to `1.Z`, and more are counted.
fn component_names(of_ray: &[u64]) -> Vec<String> {
    let Some((last, before)) = of_ray.split_last() else { return vec![String::new()] };
    let own: Vec<String> = match last {
        2 | 3 => ["X", "Y", "Z"][..*last as usize].iter().map(ToString::to_string).collect(),
        // An array of so many numbers was read: they are in memory.
        many => (0..*many).map(|k| k.to_string()).collect(),
    };
    match before {
        [] => own,
        _ => {
            let count: u64 = before.iter().product();
            (0..count).flat_map(|k| own.iter().map(move |name| format!("{k}.{name}"))).collect()
        }
    }
}
