//! Sets of rays in a folder, as channels: `rays/NAME/*.npy`.

use std::fs;
use std::path::{Path, PathBuf};

use raypencil_scene::Image;

use crate::channels::channel::{Channel, Channels};
use crate::error::{Fault, FileError};
use crate::limits::Limits;
use crate::npy::{Numbers, read_npy_numbers};
use crate::values::Values;

/// The array of each set that has one number per ray: its shape is that of the set.
const OF_EACH_RAY: &str = "face.npy";

/// Adds the arrays of a folder's sets of rays to its channels, with keys such as `rays/mast/point.X`. A set of shape
/// (..., n) becomes rasters of n columns; a flat one has one row. Arrays of another shape, such as those of all hits of
/// each ray, are left out.
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
    for set in entries(&of_sets)?.iter().filter(|set| set.join(OF_EACH_RAY).is_file()) {
        let of_each = read_npy_numbers(set.join(OF_EACH_RAY), &left)?;
        for file in entries(set)?.into_iter().filter(|file| file.extension().is_some_and(|end| end == "npy"))
        {
            let array = read_npy_numbers(&file, &left)?;
            left.bytes = left.bytes.saturating_sub(8 * array.values.len() as u64);
            let key = format!("rays/{}/{}", name(set.file_name()), name(file.file_stem()));
            for (component, values) in planes(&array, &of_each.shape, &file)? {
                let key = if component.is_empty() { key.clone() } else { format!("{key}.{component}") };
                let name = component.to_string();
                let channel = Channel { file: file.clone(), name, storage: array.storage, values };
                channels.by_key.insert(key, channel);
            }
            channels.files.push(file);
        }
    }
    Ok(())
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

/// The components of an array with one, two or three numbers per ray of a set of this shape; none of another array.
fn planes(array: &Numbers, shape: &[u64], file: &Path) -> Result<Vec<(&'static str, Values)>, FileError> {
    let names: &[&str] = match array.shape.strip_prefix(shape) {
        Some([]) => &[""],
        Some([2]) => &["X", "Y"],
        Some([3]) => &["X", "Y", "Z"],
        _ => return Ok(Vec::new()),
    };
    let rays = array.values.len() / names.len();
    let columns = shape.last().map_or(1, |&columns| columns as usize);
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
    Ok(names.iter().enumerate().map(|(k, name)| (*name, plane(k))).collect())
}
