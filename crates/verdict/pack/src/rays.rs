//! The rays of a sensor as an NPY array, for programs that read no scene.

use std::path::Path;

use rayon::prelude::*;
use raypencil_files::{FileError, file_sha256_hex, write_npy};
use raypencil_referee::Referee;
use raypencil_scene::{Image, Scene, SensorId};

use crate::arrays::channel;
use crate::manifest::{ChannelType, FileRole, FileType, ManifestFile};

/// Names of the channels of a sensor's rays, all in metres.
pub(crate) const RAY_CHANNELS: [&str; 6] =
    ["origin.X", "origin.Y", "origin.Z", "direction.X", "direction.Y", "direction.Z"];

/// Name of the file of a sensor's rays.
pub(crate) fn rays_name(sensor: SensorId) -> String {
    format!("rays-{sensor}.npy")
}

/// Writes origin and direction of each ray: shape (rows, columns, 6), metres in the scene frame, the nearest f64.
pub(crate) fn write_rays(
    referee: &Referee<'_>,
    scene: &Scene,
    sensor: SensorId,
    folder: &Path,
) -> Result<ManifestFile, FileError> {
    let path = rays_name(sensor);
    let [height, width] = write_array(referee, scene, sensor, &folder.join(&path))?;
    Ok(ManifestFile {
        kind: Some(FileType::Float64),
        shape: Some(vec![height, width, 6]),
        channels: RAY_CHANNELS.map(|name| channel(name, "m", ChannelType::Float64)).to_vec(),
        ..ManifestFile::of(folder, path, FileRole::Rays)?
    })
}

/// Size and SHA-256 of the file that [`write_rays`] would write.
pub(crate) fn rays_sha256(
    referee: &Referee<'_>,
    scene: &Scene,
    sensor: SensorId,
) -> Result<(u64, String), FileError> {
    let failed = |path: &Path, error| FileError::io(path, "write", error);
    let folder = tempfile::tempdir().map_err(|error| failed(&std::env::temp_dir(), error))?;
    let file = folder.path().join("rays.npy");
    write_array(referee, scene, sensor, &file)?;
    file_sha256_hex(&file).map_err(|error| failed(&file, error))
}

/// Writes the rays, and returns their rows and columns.
fn write_array(
    referee: &Referee<'_>,
    scene: &Scene,
    sensor: SensorId,
    file: &Path,
) -> Result<[u32; 2], FileError> {
    let (width, height) = scene.size(sensor).expect("a sensor of this scene");
    let ray = |i: u32, j: u32| -> [f64; 6] {
        let [origin, direction] = referee.ray(sensor, i, j).expect("a cell of this sensor");
        let part = |k: usize| if k < 3 { origin[k].double } else { direction[k - 3].double };
        [0, 1, 2, 3, 4, 5].map(part)
    };
    let rows = (0..height).into_par_iter();
    let rays: Vec<[f64; 6]> =
        rows.flat_map_iter(|j| (0..width).map(move |i| (i, j))).map(|(i, j)| ray(i, j)).collect();
    let planes: Vec<Image<f64>> =
        (0..6).map(|k| Image::from_cells(width, height, rays.iter().map(|ray| ray[k]).collect())).collect();
    write_npy(file, &planes.iter().collect::<Vec<_>>())?;
    Ok([height, width])
}
