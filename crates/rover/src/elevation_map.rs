//! The elevation map, the paper's local terrain map (LTM): a square grid that moves with the vehicle. (Paper, §7)

use glam::{DVec2, DVec3};
use raypencil_scene::{SceneError, check_count, check_range};

/// Size of an elevation map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapSize {
    /// Distance between grid points, metres: "a nominal spacing of 0.1 meters" (§7).
    pub spacing: f64,
    /// Number of grid points along a side, odd: "201 by 201 grid points" (§7).
    pub points: u32,
}

impl Default for MapSize {
    /// The paper's size, 20 by 20 metres. (§7)
    fn default() -> Self {
        Self { spacing: 0.1, points: 201 }
    }
}

/// Index of a grid point, in grid spacings from the grid point at the start. It denotes the same global position
/// however the map has moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct GridPoint {
    /// Index along the global x axis.
    pub i: i64,
    /// Index along the global y axis.
    pub j: i64,
}

/// Source of a grid point's elevation. The paper's key is 's' for [`ElevationSource::Unknown`] and 'u' for all others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ElevationSource {
    /// No elevation: "the elevation at this grid point is not known" (§7).
    #[default]
    Unknown,
    /// Proximity sensor: the point was under the vehicle at the start or at a scan.
    Proximity,
    /// Elevation of a measured neighbour.
    Extrapolated,
    /// Elevation of a measured point, to which this grid point is the nearest.
    Measured,
}

impl ElevationSource {
    /// The paper's key: 's' if the elevation is not known, 'u' if it is. (§7)
    pub fn key(self) -> char {
        if self == Self::Unknown { 's' } else { 'u' }
    }
}

/// Content of the map at a grid point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Cell {
    /// Global z, metres. Meaningless if the source is unknown.
    elevation: f64,
    source: ElevationSource,
    /// Number of the update that made it a new data point; 0 if its elevation was not measured.
    update: u64,
}

/// Difference between new measurements and the elevations measured before.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inconsistency {
    /// Number of grid points that were measured now and before.
    pub count: u32,
    /// Mean of |new - old| over these points, metres.
    pub mean: f64,
    /// Maximum of |new - old|, metres.
    pub largest: f64,
}

/// The elevation map: the paper's local terrain map, LTM, of section 7. "The map does not rotate but the x and y
/// directions are always parallel to the x and y global axes. The central grid point at the start of a mission is at
/// the local vehicle origin." (§7)
///
/// ```
/// use glam::{DVec2, DVec3};
/// use raypencil_rover::{ElevationMap, ElevationSource, MapSize};
///
/// // 201 by 201 points 0.1 m apart, centred on (0, 0). The grid point nearest to (2.03, 0.98) is (2.0, 1.0).
/// let mut map = ElevationMap::new(MapSize::default(), DVec2::ZERO);
/// map.insert([DVec3::new(2.03, 0.98, 0.3)]);
/// let point = map.nearest(DVec2::new(2.0, 1.0));
/// assert_eq!((map.elevation(point), map.source(point)), (Some(0.3), ElevationSource::Measured));
///
/// // Its eight neighbours inherit the elevation; the next point does not.
/// let [beside, farther] = [2.1, 2.2].map(|x| map.nearest(DVec2::new(x, 1.0)));
/// assert_eq!((map.source(beside), map.elevation(farther)), (ElevationSource::Extrapolated, None));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ElevationMap {
    size: MapSize,
    /// Global x and y of grid point (0, 0), metres.
    origin: DVec2,
    centre: GridPoint,
    /// Row by row. The index of a grid point is its i and j modulo `points`, so that no cell moves with the map.
    cells: Vec<Cell>,
    update: u64,
}

impl ElevationMap {
    /// An unknown map centred on the global `origin`. "All of the grid points are initialized to 's' at the start of
    /// the run." (§7)
    ///
    /// # Panics
    /// If the size is not valid.
    pub fn new(size: MapSize, origin: DVec2) -> Self {
        assert!(size.validate("map").is_ok(), "invalid map size: {size:?}");
        let cells = vec![Cell::default(); size.points as usize * size.points as usize];
        Self { size, origin, centre: GridPoint { i: 0, j: 0 }, cells, update: 0 }
    }

    /// Size of the map.
    pub fn size(&self) -> MapSize {
        self.size
    }

    /// Central grid point.
    pub fn centre(&self) -> GridPoint {
        self.centre
    }

    /// Global x and y of a grid point, metres. "The global coordinate of the central grid point is updated so that the
    /// global coordinates of the other grid points can be computed." (§7)
    pub fn place(&self, point: GridPoint) -> DVec2 {
        self.origin + DVec2::new(point.i as f64, point.j as f64) * self.size.spacing
    }

    /// Grid point nearest to a global position, on the map or not.
    pub fn nearest(&self, place: DVec2) -> GridPoint {
        let steps = (place - self.origin) / self.size.spacing;
        // Half way between two points, the greater index is taken, on either side of 0.
        GridPoint { i: (steps.x + 0.5).floor() as i64, j: (steps.y + 0.5).floor() as i64 }
    }

    /// Whether a grid point is on the map at present.
    pub fn contains(&self, point: GridPoint) -> bool {
        let half = i64::from(self.size.points / 2);
        (point.i - self.centre.i).abs() <= half && (point.j - self.centre.j).abs() <= half
    }

    /// All grid points on the map, row by row from the lowest x and y.
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

    /// Source of a grid point's elevation; unknown beyond the map.
    pub fn source(&self, point: GridPoint) -> ElevationSource {
        self.cell(point).source
    }

    /// Elevation of a grid point, global z in metres. `None` if it is not known.
    pub fn elevation(&self, point: GridPoint) -> Option<f64> {
        let cell = self.cell(point);
        (cell.source != ElevationSource::Unknown).then_some(cell.elevation)
    }

    /// Centres the map on the grid point nearest to the vehicle, and returns the motion in grid steps. "The
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

    /// Makes all elevations unknown.
    pub fn clear(&mut self) {
        self.cells.fill(Cell::default());
    }

    /// Sets the elevation of a grid point, global z in metres, as from the proximity sensor. A point beyond the map is
    /// ignored.
    pub fn set_proximity(&mut self, point: GridPoint, elevation: f64) {
        if self.contains(point) {
            let index = self.index(point);
            self.cells[index] = Cell { elevation, source: ElevationSource::Proximity, update: 0 };
        }
    }

    /// Enters measured points (global, metres). One call takes all points of a frame or of a scan; the points of each
    /// stripe are in row-major order of its image. Points beyond the map and points that are not finite are ignored.
    ///
    /// "The grid point having x,y coordinates closest to an edge point inherits the elevation of the edge point and its
    /// key field is set to 'u'." If several points have the same grid point, the last one counts. Then "extrapolating
    /// the elevation of each new data point to each of its neighboring grid points that is not itself a new data point"
    /// (§7): eight neighbours, even if their elevation was known before.
    ///
    /// CHOICE: data points are extrapolated in the order in which they first became data points. If several have the
    /// same neighbour, the last one counts.
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
    /// Checks every field. The error names the first one that is out of range.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(|| format!("{field}.spacing"), self.spacing, 1e-4, 1e3, "m")?;
        check_count(|| format!("{field}.points"), self.points.into(), 3, 8191)?;
        if self.points.is_multiple_of(2) {
            return Err(SceneError::new(format!("{field}.points"), self.points, "an odd number"));
        }
        Ok(())
    }
}
