//! Snapshots of the elevation map.

use std::path::{Path, PathBuf};

use raypencil_files::{FileError, GrowingFile, write_npy};
use raypencil_rover::ElevationMap;

use crate::maps::elevations::{elevation_image, height_grid, source_image};

/// Snapshots and their table, as it grows.
#[derive(Debug)]
pub(super) struct MapFiles {
    folder: PathBuf,
    table: GrowingFile,
}

impl MapFiles {
    /// `folder` is the recording's, with a folder `maps` in it.
    pub(super) fn create(folder: &Path) -> Result<Self, FileError> {
        let mut table = GrowingFile::create(folder.join("maps.csv"))?;
        table.add("frame,west_m,south_m,spacing_m,points\n")?;
        Ok(Self { folder: folder.join("maps"), table })
    }

    pub(super) fn add(&mut self, frame: u64, map: &ElevationMap) -> Result<(), FileError> {
        let named = |name: &str| self.folder.join(format!("{frame:06}-{name}.npy"));
        write_npy(named("elevation"), &[&elevation_image(map)])?;
        write_npy(named("source"), &[&source_image(map)])?;
        let (corner, size) = (height_grid(map).corner, map.size());
        self.table.add(format!("{frame},{},{},{},{}\n", corner.x, corner.y, size.spacing, size.points))
    }

    pub(super) fn finish(self) -> Result<(), FileError> {
        self.table.finish().map(drop)
    }
}
