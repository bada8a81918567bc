//! A drive frame by frame, for the page's time line: poses, what changed in the elevation map, obstacle maps.

use glam::DVec2;
use raypencil_rover::{DriveFrame, ElevationMap, ElevationSource, GridPoint, SectorEnd};
use raypencil_scene::Pose;

use crate::sector_truth::JudgedSector;

/// Maximum number of frames that the time line has; of a longer drive it has every second one, every third, and so on.
const MAX_FRAMES: u64 = 600;

/// Maximum number of changes of cells: 40 MB in memory, some megabytes in the page. Later frames have none.
const MAX_CHANGES: usize = 2_500_000;

/// One change of a cell of the elevation map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CellChange {
    pub point: GridPoint,
    /// Global z, metres; NaN if the cell is not known any more.
    pub elevation: f32,
    /// 0 unknown, 1 proximity sensor, 2 extrapolated, 3 measured.
    pub source: u8,
}

/// A sector of an obstacle map, and what is true of it.
pub(crate) type JudgedEnd = (SectorEnd, Option<JudgedSector>);

/// One frame of the time line.
#[derive(Debug, Clone)]
pub(crate) struct HistoryFrame {
    /// Index of the frame in the drive.
    pub index: u64,
    /// True pose, `global_from_vehicle`.
    pub stance: Pose,
    /// Estimated pose.
    pub believed: Pose,
    /// Number of the first change of this frame; the last one's end is the next frame's beginning.
    pub first_change: usize,
    /// Whether a vertical scan was made in this frame.
    pub has_scan: bool,
    /// Centre and sectors of the obstacle map, if the frame made one, and each sector against the truth.
    pub obstacles: Option<(DVec2, Vec<JudgedEnd>)>,
}

/// The frames and changes of a drive.
#[derive(Debug, Clone)]
pub(crate) struct DriveHistory {
    /// Frames from one entry to the next.
    step: u64,
    /// Whether the frames after the last one with changes have none for want of room.
    pub is_cut: bool,
    pub frames: Vec<HistoryFrame>,
    pub changes: Vec<CellChange>,
    /// The map at the last entry, cell by cell in the order of its points, and its centre; no cells before the first.
    before: Vec<(f32, u8)>,
    centre: GridPoint,
    /// Grid point (0, 0), global x and y, metres, and the distance between points.
    pub origin: DVec2,
    pub spacing: f64,
}

impl DriveHistory {
    /// History of a drive of `planned` frames, before the first one.
    pub(crate) fn new(planned: u64) -> Self {
        Self {
            step: planned.div_ceil(MAX_FRAMES).max(1),
            is_cut: false,
            frames: Vec::new(),
            changes: Vec::new(),
            before: Vec::new(),
            centre: GridPoint { i: 0, j: 0 },
            origin: DVec2::ZERO,
            spacing: 0.0,
        }
    }

    /// Adds a frame and the map after it, if the time line has it. Frames with an obstacle map or a scan are always there.
    /// `judged` has its sectors against the truth, or is empty.
    pub(crate) fn add(&mut self, frame: &DriveFrame, judged: &[JudgedSector], map: &ElevationMap) {
        let is_marked = frame.obstacles.is_some() || frame.scan.is_some();
        if !frame.index.is_multiple_of(self.step) && !is_marked {
            return;
        }
        let first_change = self.changes.len();
        self.is_cut |= first_change >= MAX_CHANGES;
        if !self.is_cut {
            self.add_changes(map);
        }
        self.frames.push(HistoryFrame {
            index: frame.index,
            stance: frame.stance.pose(),
            believed: frame.believed,
            first_change,
            has_scan: frame.scan.is_some(),
            obstacles: frame.obstacles.as_ref().map(|(map, _)| {
                let sectors = map.sectors.iter().enumerate();
                let sectors = sectors.map(|(sector, end)| (*end, judged.get(sector).copied()));
                (map.centre, sectors.collect())
            }),
        });
    }

    fn add_changes(&mut self, map: &ElevationMap) {
        let side = i64::from(map.size().points);
        let half = side / 2;
        if self.before.is_empty() {
            // Before the first frame nothing is known.
            self.before = vec![(f32::NAN, 0); (side * side) as usize];
            self.origin = map.place(GridPoint { i: 0, j: 0 });
            self.spacing = map.size().spacing;
        }
        let index_about = |centre: GridPoint, point: GridPoint| {
            let (i, j) = (point.i - centre.i + half, point.j - centre.j + half);
            let is_inside = (0..side).contains(&i) && (0..side).contains(&j);
            is_inside.then(|| (j * side + i) as usize)
        };
        let now: Vec<(f32, u8)> = map.points().map(|point| content(map, point)).collect();
        // Cells that the map has left behind.
        let old_points = (0..side).flat_map(|j| (0..side).map(move |i| (i, j)));
        for ((i, j), (_, source)) in old_points.zip(&self.before) {
            let point = GridPoint { i: self.centre.i + i - half, j: self.centre.j + j - half };
            if *source != 0 && index_about(map.centre(), point).is_none() {
                self.changes.push(CellChange { point, elevation: f32::NAN, source: 0 });
            }
        }
        for (point, &(elevation, source)) in map.points().zip(&now) {
            let was = index_about(self.centre, point).map_or((f32::NAN, 0), |index| self.before[index]);
            let is_same = was.1 == source && (source == 0 || was.0.to_bits() == elevation.to_bits());
            if !is_same {
                self.changes.push(CellChange { point, elevation, source });
            }
        }
        self.before = now;
        self.centre = map.centre();
    }
}

fn content(map: &ElevationMap, point: GridPoint) -> (f32, u8) {
    let source = match map.source(point) {
        ElevationSource::Unknown => 0,
        ElevationSource::Proximity => 1,
        ElevationSource::Extrapolated => 2,
        ElevationSource::Measured => 3,
    };
    (map.elevation(point).map_or(f32::NAN, |elevation| elevation as f32), source)
}

#[cfg(test)]
#[path = "../tests/unit/history.rs"]
mod tests;
