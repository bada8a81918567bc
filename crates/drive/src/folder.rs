//! The folder that a drive leaves behind. Each file is written beside its place and renamed; `summary.json` last.

use glam::{DVec2, DVec3};
use std::io;
use std::path::{Path, PathBuf};

use crate::animation::apng;
use crate::figures::{figures, word};
use crate::job::DriveJob;
use crate::maps::camera_info::camera_info;
use crate::maps::occupancy::{Occupancy, OccupancyGrid, write_occupancy};
use crate::maps::ply::write_ply;
use crate::maps::vectors::{VectorOnMap, vectors_csv, vectors_geojson};
use crate::page;
use crate::run::DriveRun;
use crate::summary::drive_json;
use raypencil_files::{FileError, FolderError, begin_output_folder, write_atomically, write_npy};
use raypencil_mesh_io::write_geotiff;
use raypencil_rover::{ElevationMap, ElevationSource, Label, ObstacleMap, RadialGrid, Vehicle};
use raypencil_scene::{Image, Pose, Progress};
use raypencil_terrain::HeightGrid;

/// What [`write_drive`] wrote.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenDrive {
    /// Every file, in the order of writing.
    pub files: Vec<PathBuf>,
    /// `report.html`.
    pub report: PathBuf,
    /// `summary.json`.
    pub summary: PathBuf,
}

/// Writes everything that a drive leaves behind. The `summary.json` of an earlier run is removed first, and the new one
/// written last: it marks a complete folder.
///
/// # Errors
/// Names the file or folder that could not be written, and why.
pub fn write_drive(
    job: &DriveJob,
    run: &DriveRun,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<WrittenDrive, FolderError> {
    let summary = begin_output_folder(folder, "summary.json")?;
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
    let moving = apng(run);
    write("drive.png", &moving)?;

    progress.stage("writing maps");
    write("camera_info.yaml", camera_info(&job.plan.rig.camera.sensor, &job.name).as_bytes())?;
    if let Some((frame, _, vectors)) = &run.obstacles {
        let vectors: Vec<VectorOnMap> = vectors
            .iter()
            .map(|vector| VectorOnMap {
                from: vector.from.to_array(),
                to: vector.to.to_array(),
                label: word(vector.label),
            })
            .collect();
        write("navigator-map.geojson", vectors_geojson(&vectors, *frame).as_bytes())?;
        write("navigator-map.csv", vectors_csv(&vectors).as_bytes())?;
    }
    let page = page::html(job, run, &figures, &moving).map_err(io::Error::other);
    let report = folder.join("report.html");
    let page = page.map_err(|source| FileError::Io { path: report, action: "write", source })?;
    let report = write("report.html", page.as_bytes())?;

    let named = |name: &str| folder.join(name);
    let (elevations, sources) = images(&run.map);
    write_npy(named("local-map.npy"), &[&elevations])?;
    write_npy(named("local-map-source.npy"), &[&sources])?;
    write_geotiff(named("local-map.tif"), &posts(&run.map))?;
    write_ply(named("edge-points.ply"), &run.points)?;
    files.extend(["local-map.npy", "local-map-source.npy", "local-map.tif", "edge-points.ply"].map(named));
    if let Some((frame, obstacles, _)) = &run.obstacles {
        let pose = run.frames.iter().find(|one| one.index == *frame).map_or(run.believed, |one| one.believed);
        let grid = occupancy(&run.map, obstacles, &job.plan.grid, &job.plan.vehicle, &pose);
        write_occupancy(folder, "obstacle-map-nav2", &grid)?;
        files.extend(["obstacle-map-nav2.pgm", "obstacle-map-nav2.yaml"].map(named));
    }

    write_atomically(&summary, |file| file.write_all(drive_json(job, run).as_bytes()))?;
    files.push(summary.clone());
    Ok(WrittenDrive { files, report, summary })
}

/// Elevations, NaN where they are not known, and where each comes from: 0 not known, 1 proximity sensor, 2 extrapolated, 3
/// measured. The row of least y first.
fn images(map: &ElevationMap) -> (Image<f64>, Image<u8>) {
    let side = map.size().points;
    let elevations = map.points().map(|point| map.elevation(point).unwrap_or(f64::NAN)).collect();
    let sources = map.points().map(|point| match map.source(point) {
        ElevationSource::Unknown => 0,
        ElevationSource::Proximity => 1,
        ElevationSource::Extrapolated => 2,
        ElevationSource::Measured => 3,
    });
    (Image::from_cells(side, side, elevations), Image::from_cells(side, side, sources.collect()))
}

/// The map as an elevation model.
pub fn posts(map: &ElevationMap) -> HeightGrid {
    let side = map.size().points;
    HeightGrid {
        columns: side,
        rows: side,
        corner: map.points().next().map_or(DVec2::ZERO, |point| map.place(point)),
        spacing: DVec2::splat(map.size().spacing),
        heights: map.points().map(|point| map.elevation(point).unwrap_or(f64::NAN)).collect(),
    }
}

/// The obstacle map on the cells of the local map, each about its grid point: where the middle of the front axle may be.
/// Free before the end of the sector that a cell is nearest to, occupied at the end if an obstacle is there, not known
/// elsewhere; and free where the vehicle stands.
pub fn occupancy(
    map: &ElevationMap,
    obstacles: &ObstacleMap,
    grid: &RadialGrid,
    vehicle: &Vehicle,
    global_from_vehicle: &Pose,
) -> OccupancyGrid {
    let spacing = map.size().spacing;
    let first = map.points().next().map_or(DVec2::ZERO, |point| map.place(point));
    let vehicle_from_global = global_from_vehicle.inverse();
    let forward = global_from_vehicle.rotate(DVec3::X);
    let heading = libm::atan2(forward.y, forward.x);
    // CHOICE: three quarters of a step to either side, so that cells of an end touch one another.
    let reach = 0.75 * grid.step.max(spacing);
    let cell = |place: DVec2| {
        let way = place - obstacles.centre;
        let level = vehicle_from_global.rotate(way.extend(0.0)).truncate();
        if vehicle.covers(level) {
            return Occupancy::Free;
        }
        let Some(sector) = nearest_sector(grid, libm::atan2(way.y, way.x) - heading) else {
            return Occupancy::Unknown;
        };
        let end = &obstacles.sectors[sector];
        let radius = way.length();
        match end.label {
            // Nearer than the grid begins nothing was tested.
            _ if radius < grid.first - 0.5 * grid.step => Occupancy::Unknown,
            Label::Obstacle if (radius - end.radius).abs() <= reach => Occupancy::Occupied,
            Label::Visibility if radius <= end.radius + 0.5 * grid.step => Occupancy::Free,
            _ if radius < end.radius - 0.5 * grid.step => Occupancy::Free,
            _ => Occupancy::Unknown,
        }
    };
    OccupancyGrid {
        columns: map.size().points,
        rows: map.size().points,
        resolution: spacing,
        origin: (first - DVec2::splat(0.5 * spacing)).to_array(),
        cells: map.points().map(|point| cell(map.place(point))).collect(),
    }
}

/// The sector whose direction is nearest to an angle from the heading, if the angle is within the fan.
fn nearest_sector(grid: &RadialGrid, angle: f64) -> Option<usize> {
    use std::f64::consts::TAU;
    let angle = angle - TAU * (angle / TAU).round();
    let between = if grid.sectors < 2 { 0.1 } else { 2.0 * grid.half_angle / f64::from(grid.sectors - 1) };
    let sector = if grid.sectors < 2 { angle / between } else { (angle + grid.half_angle) / between };
    let sector = sector.round();
    (sector >= 0.0 && sector < f64::from(grid.sectors)).then_some(sector as usize)
}
