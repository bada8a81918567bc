//! Folder of a drive. Each file is written beside its place and then renamed; `summary.json` comes last.

use std::path::{Path, PathBuf};

use raypencil_files::{FileError, FolderError, begin_output_folder, write_atomically, write_npy};
use raypencil_mesh_io::write_geotiff;
use raypencil_scene::Progress;

use crate::animation::apng;
use crate::document::drive_document_with_pictures;
use crate::figures::figures;
use crate::job::DriveJob;
use crate::labels::label_word;
use crate::maps::camera_info::camera_info;
use crate::maps::elevations::{elevation_image, error_image, height_grid, key_lines, source_image};
use crate::maps::obstacle_grid::occupancy_grid;
use crate::maps::occupancy::write_occupancy;
use crate::maps::ply::write_ply;
use crate::maps::vectors::{VectorOnMap, vectors_csv, vectors_geojson};
use crate::run::DriveRun;

/// Name of the file that marks a complete folder.
const DATA: &str = "summary.json";

/// Files that [`write_drive`] wrote.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenDrive {
    /// All files, in the order of writing.
    pub files: Vec<PathBuf>,
    /// Path of `report.html`.
    pub report: PathBuf,
    /// Path of `summary.json`.
    pub summary: PathBuf,
}

/// Writes the results of a drive into a folder: figures, animation, maps, points, report and summary. The
/// `summary.json` of an earlier run is removed first and the new one is written last: it marks a complete folder.
///
/// # Errors
/// The file or folder that could not be written, and the reason.
pub fn write_drive(
    job: &DriveJob,
    run: &DriveRun,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<WrittenDrive, FolderError> {
    let summary = begin_output_folder(folder, DATA)?;
    let mut files = Vec::new();
    let mut write = |name: &str, contents: &[u8]| -> Result<PathBuf, FolderError> {
        let path = folder.join(name);
        write_atomically(&path, |file| file.write_all(contents))?;
        files.push(path.clone());
        Ok(path)
    };

    progress.stage("drawing figures");
    let figures = figures(job, run);
    for figure in &figures {
        write(&format!("{}.svg", figure.stem), figure.drawing.svg().as_bytes())?;
        write(&format!("{}.png", figure.stem), &figure.drawing.png())?;
    }
    progress.stage("drawing the animation");
    let animation = apng(&run.animation);
    write("drive.png", &animation)?;

    progress.stage("writing maps");
    write("camera_info.yaml", camera_info(&job.plan.rig.camera.sensor, &job.name).as_bytes())?;
    if let Some((frame, _, vectors)) = &run.obstacles {
        let vectors: Vec<VectorOnMap> = vectors
            .iter()
            .map(|vector| VectorOnMap {
                from: vector.from.to_array(),
                to: vector.to.to_array(),
                label: label_word(vector.label),
            })
            .collect();
        write("navigator-map.geojson", vectors_geojson(&vectors, *frame).as_bytes())?;
        write("navigator-map.csv", vectors_csv(&vectors).as_bytes())?;
    }
    let texts = drive_document_with_pictures(job, run, &figures, &animation).files(DATA);
    let texts =
        texts.map_err(|(name, source)| FileError::Io { path: folder.join(name), action: "write", source })?;
    let (data, reports): (Vec<_>, Vec<_>) = texts.into_iter().partition(|(name, _)| *name == DATA);
    for (name, text) in reports {
        write(name, text.as_bytes())?;
    }

    let named = |name: &str| folder.join(name);
    write_npy(named("local-map.npy"), &[&elevation_image(&run.map)])?;
    write_npy(named("local-map-error.npy"), &[&error_image(&run.map)])?;
    write_atomically(named("local-map-keys.txt"), |file| file.write_all(key_lines(&run.map).as_bytes()))?;
    write_npy(named("local-map-source.npy"), &[&source_image(&run.map)])?;
    write_geotiff(named("local-map.tif"), &height_grid(&run.map), job.map_code)?;
    write_ply(named("edge-points.ply"), &run.points)?;
    let maps = [
        "local-map.npy",
        "local-map-error.npy",
        "local-map-keys.txt",
        "local-map-source.npy",
        "local-map.tif",
        "edge-points.ply",
    ];
    files.extend(maps.map(named));
    if let Some((frame, obstacles, _)) = &run.obstacles {
        let pose = run.frames.iter().find(|one| one.index == *frame).map_or(run.believed, |one| one.believed);
        let grid = occupancy_grid(&run.map, obstacles, &job.plan.grid, &job.plan.vehicle, &pose);
        write_occupancy(folder, "obstacle-map-nav2", &grid)?;
        files.extend(["obstacle-map-nav2.pgm", "obstacle-map-nav2.yaml"].map(named));
    }

    write_atomically(&summary, |file| data.iter().try_for_each(|(_, text)| file.write_all(text.as_bytes())))?;
    files.push(summary.clone());
    Ok(WrittenDrive { files, report: folder.join("report.html"), summary })
}

#[cfg(test)]
#[path = "../tests/unit/folder.rs"]
mod tests;
