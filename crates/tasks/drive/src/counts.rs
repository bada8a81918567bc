//! Counts of a drive's results: map cells by their source, sectors by their labels.

use raypencil_rover::{ElevationSource, Label};

use crate::run::DriveRun;

/// Numbers of the map's cells at the end of a drive.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct CellCounts {
    pub known: u64,
    pub unknown: u64,
    /// Number of known cells that were measured, not extrapolated and not from the proximity sensor.
    pub measured: u64,
}

impl CellCounts {
    pub(crate) fn of(run: &DriveRun) -> Self {
        let mut counts = Self::default();
        for point in run.map.points() {
            match run.map.source(point) {
                ElevationSource::Unknown => counts.unknown += 1,
                ElevationSource::Measured => {
                    (counts.known, counts.measured) = (counts.known + 1, counts.measured + 1)
                }
                _ => counts.known += 1,
            }
        }
        counts
    }
}

/// Number of sectors of the last obstacle map with each label.
pub(crate) fn sector_counts(run: &DriveRun) -> [(Label, u64); 3] {
    [Label::Obstacle, Label::Unknown, Label::Visibility].map(|label| {
        let sectors = run.obstacles.iter().flat_map(|(_, map, _)| &map.sectors);
        (label, sectors.filter(|sector| sector.label == label).count() as u64)
    })
}

/// Number of vertical scans.
pub(crate) fn scans(run: &DriveRun) -> u64 {
    run.frames.iter().filter(|frame| frame.scan.is_some()).count() as u64
}
