//! The local terrain map (LTM): a square grid of elevations that goes along with the vehicle. (Paper, §7)

use glam::{DVec2, DVec3};
use raypencil_scene::SceneError;

use crate::check::{check_count, check_range};

/// The measures of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapSize {
    /// Between grid points, metres: "a nominal spacing of 0.1 meters" (§7).
    pub spacing: f64,
    /// Grid points along a side, odd: "201 by 201 grid points" (§7).
    pub points: u32,
}

impl Default for MapSize {
    /// The paper's: 20 by 20 metres. (§7)
    fn default() -> Self {
        Self { spacing: 0.1, points: 201 }
    }
}

/// A grid point, counted in spacings from where the vehicle started. It names the same place for ever, wherever
/// the map has moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct GridPoint {
    /// Along the global x axis.
    pub i: i64,
    /// Along the global y axis.
    pub j: i64,
}

/// Where a grid point's elevation comes from. The paper's key is 's' for [`ElevationSource::Unknown`] and 'u' for all
/// others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ElevationSource {
    /// "The elevation at this grid point is not known."
    #[default]
    Unknown,
    /// Under the vehicle at the start or at a scan: from the proximity sensor.
    Proximity,
    /// A neighbour of a measured point.
    Extrapolated,
    /// The nearest grid point to a measured point.
    Measured,
}

impl ElevationSource {
    /// The paper's key: 's' not known, 'u' known. (§7)
    pub fn key(self) -> char {
        if self == Self::Unknown { 's' } else { 'u' }
    }
}

/// What the map holds at a grid point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Cell {
    /// Global z, metres; of no meaning where it is unknown.
    elevation: f64,
    source: ElevationSource,
    /// The update that made it a new data point, if it is the present one.
    update: u64,
}

/// By how much new measurements contradict what the map held.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inconsistency {
    /// Grid points measured now that had been measured before.
    pub count: u32,
    /// The mean of |new - old| over them, metres.
    pub mean: f64,
    /// The largest, metres.
    pub largest: f64,
}

/// The local terrain map. "The map does not rotate but the x and y directions are always parallel to the x and y
/// global axes. The central grid point at the start of a mission is at the local vehicle origin." (§7)
#[derive(Debug, Clone, PartialEq)]
pub struct ElevationMap {
    size: MapSize,
    /// Global place of grid point (0, 0).
    origin: DVec2,
    centre: GridPoint,
    /// Row by row, each grid point at its own remainder of `points`: moving the map moves no cell.
    cells: Vec<Cell>,
    update: u64,
}

impl ElevationMap {
    /// A map centred on the global `origin`. "All of the grid points are initialized to 's' at the start of the
    /// run." (§7)
    ///
    /// # Panics
    /// If the size is not valid.
    pub fn new(size: MapSize, origin: DVec2) -> Self {
        assert!(size.validate("map").is_ok(), "a map of {size:?}");
        let cells = vec![Cell::default(); size.points as usize * size.points as usize];
        Self { size, origin, centre: GridPoint { i: 0, j: 0 }, cells, update: 0 }
    }

    /// The map's measures.
    pub fn size(&self) -> MapSize {
        self.size
    }

    /// The central grid point.
    pub fn centre(&self) -> GridPoint {
        self.centre
    }

    /// The global place of a grid point. "The global coordinate of the central grid point is updated so that the
    /// global coordinates of the other grid points can be computed." (§7)
    pub fn place(&self, point: GridPoint) -> DVec2 {
        self.origin + DVec2::new(point.i as f64, point.j as f64) * self.size.spacing
    }

    /// The grid point nearest to a global place, on the map or not.
    pub fn nearest(&self, place: DVec2) -> GridPoint {
        let steps = (place - self.origin) / self.size.spacing;
        // Half way belongs to the greater one, on either side of 0.
        GridPoint { i: (steps.x + 0.5).floor() as i64, j: (steps.y + 0.5).floor() as i64 }
    }

    /// Whether a grid point is on the map now.
    pub fn contains(&self, point: GridPoint) -> bool {
        let half = i64::from(self.size.points / 2);
        (point.i - self.centre.i).abs() <= half && (point.j - self.centre.j).abs() <= half
    }

    /// The grid points on the map, row by row from the lowest x and y.
    pub fn points(&self) -> impl Iterator<Item = GridPoint> + use<> {
        let (half, centre) = (i64::from(self.size.points / 2), self.centre);
        (-half..=half)
            .flat_map(move |j| (-half..=half).map(move |i| GridPoint { i: centre.i + i, j: centre.j + j }))
    }

    fn index(&self, point: GridPoint) -> usize {
        let points = i64::from(self.size.points);
        (point.j.rem_euclid(points) * points + point.i.rem_euclid(points)) as usize
    }

    fn cell(&self, point: GridPoint) -> Cell {
        if self.contains(point) { self.cells[self.index(point)] } else { Cell::default() }
    }

    /// Where a grid point's elevation comes from; unknown beyond the map.
    pub fn source(&self, point: GridPoint) -> ElevationSource {
        self.cell(point).source
    }

    /// The elevation of a grid point, global z in metres, if it is known.
    pub fn elevation(&self, point: GridPoint) -> Option<f64> {
        let cell = self.cell(point);
        (cell.source != ElevationSource::Unknown).then_some(cell.elevation)
    }

    /// Centres the map on the grid point nearest to the vehicle, and gives by how many grid steps it moved. "The
    /// central grid point of the map is moved with the vehicle but only in increments of the grid spacing." (§7)
    pub fn recentre(&mut self, vehicle: DVec2) -> (i64, i64) {
        let (old, new) = (self.centre, self.nearest(vehicle));
        if old == new {
            return (0, 0);
        }
        let was_on = Self { centre: old, cells: Vec::new(), ..*self };
        self.centre = new;
        for point in self.points() {
            if !was_on.contains(point) {
                let index = self.index(point);
                self.cells[index] = Cell::default();
            }
        }
        (new.i - old.i, new.j - old.j)
    }

    /// Forgets all elevations.
    pub fn clear(&mut self) {
        self.cells.fill(Cell::default());
    }

    /// Gives a grid point an elevation from the proximity sensor; nothing beyond the map.
    pub fn set_proximity(&mut self, point: GridPoint, elevation: f64) {
        if self.contains(point) {
            let index = self.index(point);
            self.cells[index] = Cell { elevation, source: ElevationSource::Proximity, update: 0 };
        }
    }

    /// Enters measured points (global, metres), all those of one frame or of a whole scan, each stripe's in row-major
    /// order of its image.
    ///
    /// "The grid point having x,y coordinates closest to an edge point inherits the elevation of the edge point and
    /// its key field is set to 'u'." Of several the last one stays. Then "extrapolating the elevation of each new
    /// data point to each of its neighboring grid points that is not itself a new data point": to the eight,
    /// whatever they held. (§7) CHOICE: they are extrapolated in the order in which they first became data points,
    /// and again the last one stays.
    pub fn insert(&mut self, points: impl IntoIterator<Item = DVec3>) -> Inconsistency {
        self.update += 1;
        let mut new = Vec::new();
        let mut found = Inconsistency::default();
        let mut before = Vec::new();
        for edge in points {
            if !edge.is_finite() {
                continue;
            }
            let point = self.nearest(edge.truncate());
            if !self.contains(point) {
                continue;
            }
            let index = self.index(point);
            let old = self.cells[index];
            if old.update != self.update {
                new.push(point);
                before.push((old.source == ElevationSource::Measured).then_some(old.elevation));
            }
            self.cells[index] =
                Cell { elevation: edge.z, source: ElevationSource::Measured, update: self.update };
        }
        for (&point, before) in new.iter().zip(before) {
            let elevation = self.cells[self.index(point)].elevation;
            if let Some(before) = before {
                let difference = (elevation - before).abs();
                found.count += 1;
                found.mean += difference;
                found.largest = found.largest.max(difference);
            }
            for (i, j) in [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)] {
                let neighbour = GridPoint { i: point.i + i, j: point.j + j };
                if !self.contains(neighbour) {
                    continue;
                }
                let index = self.index(neighbour);
                if self.cells[index].update != self.update {
                    self.cells[index] = Cell { elevation, source: ElevationSource::Extrapolated, update: 0 };
                }
            }
        }
        found.mean /= f64::from(found.count.max(1));
        found
    }
}

impl MapSize {
    /// Refuses a size that no map can have, naming the field.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(field, "spacing", self.spacing, 1e-4, 1e3, "m")?;
        check_count(field, "points", self.points.into(), 3, 8191)?;
        if self.points.is_multiple_of(2) {
            return Err(SceneError::new(format!("{field}.points"), self.points, "an odd number"));
        }
        Ok(())
    }
}
