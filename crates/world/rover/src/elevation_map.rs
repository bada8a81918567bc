//! The elevation map, the paper's local terrain map (LTM): a square grid that moves with the vehicle. (Paper, §7)

use glam::{DVec2, DVec3};
use raypencil_scene::{SceneError, check_count, check_range};

use crate::known_drift::KnownDrift;
use crate::rules::MapRules;

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

/// Line of sight from a sensor to a measured point. Nothing between the two stands above it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sight {
    /// Direction from the point to the sensor in the plane, a unit vector.
    pub towards: DVec2,
    /// Rise of the line towards the sensor over horizontal distance.
    pub slope: f64,
}

/// Highest point that was ever measured in a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Top {
    /// The point, global, metres.
    pub point: DVec3,
    /// Variance of its elevation when it was measured, square metres.
    pub variance: f64,
    /// Odometer of the vehicle and number of the frame then.
    pub odometer: f64,
    pub frame: u64,
}

/// Content of the map at a grid point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Cell {
    /// Global z, metres. Meaningless if the source is unknown.
    pub elevation: f64,
    pub source: ElevationSource,
    /// Number of the update that made it a new data point; 0 if its elevation was not measured.
    pub update: u64,
    /// Place of the measured point, global x and y, metres. Meaningless if the source is not `Measured`.
    pub place: DVec2,
    /// Variance of the elevation, square metres.
    pub variance: f64,
    /// Odometer of the vehicle at the last measurement, metres.
    pub odometer: f64,
    /// Frame of the last measurement.
    pub frame: u64,
    /// Sum of the corrections of the vehicle's elevation until it was measured, metres: [`ElevationMap::correct`].
    pub corrected: f64,
    /// Highest point of all frames, which the mean of several frames does not lower. `None` without a measurement, and as printed.
    pub top: Option<Top>,
    /// Flattest line of sight by which it was measured.
    pub sight: Option<Sight>,
    /// Lowest and highest elevation ever measured here, metres; `None` before the first. Extrapolation leaves it.
    pub measured: Option<(f64, f64)>,
    /// Elevation of the wheels' plane when the vehicle stood over it or beside it, metres, by the rule `StartRule::Circle` alone.
    /// Obstacle tests use it where nothing was measured; it is no elevation of the map.
    pub stood: Option<f64>,
}

/// What is known beyond the map: nothing.
static BEYOND: Cell = Cell {
    elevation: 0.0,
    source: ElevationSource::Unknown,
    update: 0,
    place: DVec2::ZERO,
    variance: 0.0,
    odometer: 0.0,
    frame: 0,
    corrected: 0.0,
    top: None,
    sight: None,
    measured: None,
    stood: None,
};

/// Difference between new measurements and all that were measured before in the same cells: how far a new elevation
/// lies outside the range of the earlier ones.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inconsistency {
    /// Number of grid points that were measured now and before.
    pub count: u32,
    /// Mean difference over these points, metres.
    pub mean: f64,
    /// Maximum difference, metres.
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
    pub(crate) cells: Vec<Cell>,
    pub(crate) update: u64,
    pub(crate) rules: MapRules,
    /// Distance driven so far, metres. Measurements age with it, and with the frames.
    pub(crate) odometer: f64,
    pub(crate) frame: u64,
    /// Sum of the corrections of the vehicle's elevation so far, metres.
    pub(crate) corrected: f64,
    pub(crate) drift: KnownDrift,
    /// Pauses: the frame behind which each is, and its time, seconds.
    pub(crate) pauses: Vec<(u64, f64)>,
}

impl ElevationMap {
    /// An unknown map centred on the global `origin`. "All of the grid points are initialized to 's' at the start of
    /// the run." (§7)
    ///
    /// # Panics
    /// If the size is not valid.
    pub fn new(size: MapSize, origin: DVec2) -> Self {
        Self::with_rules(size, origin, MapRules::MENDED)
    }

    /// An unknown map that is updated by these rules. Of them `extrapolate`, `several` and `inconsistency` matter here.
    ///
    /// # Panics
    /// If the size is not valid.
    pub fn with_rules(size: MapSize, origin: DVec2, rules: MapRules) -> Self {
        assert!(size.validate("map").is_ok(), "invalid map size: {size:?}");
        let cells = vec![Cell::default(); size.points as usize * size.points as usize];
        let (centre, drift) = (GridPoint { i: 0, j: 0 }, KnownDrift::default());
        let pauses = Vec::new();
        Self {
            size,
            origin,
            centre,
            cells,
            update: 0,
            rules,
            odometer: 0.0,
            frame: 0,
            corrected: 0.0,
            drift,
            pauses,
        }
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

    pub(crate) fn index(&self, point: GridPoint) -> usize {
        let points = i64::from(self.size.points);
        (point.j.rem_euclid(points) * points + point.i.rem_euclid(points)) as usize
    }

    pub(crate) fn cell(&self, point: GridPoint) -> &Cell {
        if self.contains(point) { &self.cells[self.index(point)] } else { &BEYOND }
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

    /// Point of the ground that stands for a grid point, global, metres: the measured point itself, which may lie half a
    /// cell beside the grid point; otherwise the grid point with its elevation. `None` if it is not known.
    pub fn sample(&self, point: GridPoint) -> Option<DVec3> {
        let cell = self.cell(point);
        let place = match cell.source {
            ElevationSource::Unknown => return None,
            ElevationSource::Measured => cell.place,
            ElevationSource::Proximity | ElevationSource::Extrapolated => self.place(point),
        };
        Some(place.extend(cell.elevation))
    }

    /// Notes that the vehicle stands over a grid point, with the plane of its wheels at this elevation, metres.
    pub(crate) fn stand_over(&mut self, point: GridPoint, elevation: f64) {
        if self.contains(point) {
            let index = self.index(point);
            self.cells[index].stood = Some(elevation);
        }
    }

    /// Takes over from another map the ground on which its vehicle stood, by the rule
    /// [`StartRule::Circle`](crate::StartRule): what that rule invents, and no elevation. The other map may have wider cells.
    pub fn stand_as(&mut self, other: &Self) {
        if other.cells.iter().all(|cell| cell.stood.is_none()) {
            return;
        }
        for cell in other.points() {
            if let Some(elevation) = other.cell(cell).stood {
                for point in self.points_in(other, cell) {
                    self.stand_over(point, elevation);
                }
            }
        }
    }

    /// The grid points of this map that lie in a cell of another one, whose nearest grid point that cell is.
    pub fn points_in(&self, other: &Self, cell: GridPoint) -> Vec<GridPoint> {
        let half = (0.5 * other.size.spacing / self.size.spacing).ceil() as i64;
        let middle = self.nearest(other.place(cell));
        let around = (-half..=half).flat_map(|j| (-half..=half).map(move |i| (i, j)));
        let points = around.map(|(i, j)| GridPoint { i: middle.i + i, j: middle.j + j });
        points.filter(|point| self.contains(*point) && other.nearest(self.place(*point)) == cell).collect()
    }

    /// Adds to the distance driven, metres.
    pub fn drive(&mut self, distance: f64) {
        self.odometer += distance;
    }

    /// Notes that the vehicle's elevation was corrected by the ground: it is higher by this than its tilt had made it, metres.
    pub fn correct(&mut self, by: f64) {
        self.corrected += by;
    }

    /// Centres the map on the grid point nearest to the vehicle, and returns the motion in grid steps. "The
    /// central grid point of the map is moved with the vehicle but only in increments of the grid spacing." (§7)
    pub fn recentre(&mut self, vehicle: DVec2) -> (i64, i64) {
        let (old, new) = (self.centre, self.nearest(vehicle));
        if old == new {
            return (0, 0);
        }
        let was_on = Self { centre: old, cells: Vec::new(), pauses: Vec::new(), ..*self };
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

    /// Sets a measured elevation by one's own rules: the point (global, metres) is kept as it is in the cell of the grid
    /// point nearest to it, and no neighbour gets anything. A point beyond the map is ignored.
    pub fn set_measured(&mut self, point: DVec3, standard_error: f64) {
        let at = self.nearest(point.truncate());
        if self.contains(at) {
            let index = self.index(at);
            self.cells[index] = Cell {
                elevation: point.z,
                source: ElevationSource::Measured,
                place: point.truncate(),
                variance: standard_error * standard_error,
                odometer: self.odometer,
                frame: self.frame,
                corrected: self.corrected,
                stood: self.cells[index].stood,
                ..Cell::default()
            };
        }
    }

    /// Sets the elevation of a grid point, global z in metres, as from the proximity sensor. A point beyond the map is
    /// ignored.
    pub fn set_proximity(&mut self, point: GridPoint, elevation: f64) {
        if self.contains(point) {
            let index = self.index(point);
            let stood = self.cells[index].stood;
            self.cells[index] =
                Cell { elevation, source: ElevationSource::Proximity, stood, ..Cell::default() };
        }
    }
}

/// Whether a grid point's elevation is a measurement, by a stripe or by the proximity sensor.
pub(crate) fn is_measured(map: &ElevationMap, point: GridPoint) -> bool {
    matches!(map.source(point), ElevationSource::Measured | ElevationSource::Proximity)
}

impl MapSize {
    /// Distance from the middle of the map to its border, metres.
    pub fn reach(&self) -> f64 {
        f64::from(self.points / 2) * self.spacing
    }

    /// Checks every field. The error names the first one that is out of range.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(|| format!("{field}.spacing"), self.spacing, 1e-4, 1e3, "m")?;
        check_count(|| format!("{field}.points"), self.points.into(), 3, 4095)?;
        if self.points.is_multiple_of(2) {
            return Err(SceneError::new(format!("{field}.points"), self.points, "an odd number"));
        }
        Ok(())
    }
}
