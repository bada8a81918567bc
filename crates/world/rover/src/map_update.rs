//! New points in the elevation map: which one a cell keeps, and what its neighbours get. (Paper, §7)

use glam::{DVec2, DVec3};

use crate::elevation_map::{Cell, ElevationMap, ElevationSource, GridPoint, Inconsistency, Sight, Top};
use crate::rules::Rule;

/// Measured point, on its way into the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapPoint {
    /// The point, global, metres.
    pub point: DVec3,
    /// Standard error of its elevation, metres.
    pub standard_error: f64,
    /// The flatter of the two lines of sight to it, from camera and beam. `None`: not known.
    pub sight: Option<Sight>,
}

/// New data of a cell: the point that it keeps, and the range of all.
#[derive(Debug, Clone, Copy)]
struct NewData {
    at: GridPoint,
    /// The point that stands for the cell's ground: as printed the last one, mended the mean.
    point: MapPoint,
    /// The highest point; as printed the last one.
    top: MapPoint,
    /// Lowest and highest elevation, metres.
    range: (f64, f64),
}

/// Standard error of a point about which nothing else is said, metres. CHOICE.
const DEFAULT_STANDARD_ERROR_M: f64 = 0.01;

impl From<DVec3> for MapPoint {
    /// A point with a standard error of 1 cm, seen from nowhere in particular.
    fn from(point: DVec3) -> Self {
        Self { point, standard_error: DEFAULT_STANDARD_ERROR_M, sight: None }
    }
}

/// Slope of the ground at which a displacement in plan becomes an error of its elevation, rise over distance. CHOICE: 45
/// degrees. What is steeper is an edge, and moves as a whole.
const AGEING_SLOPE: f64 = 1.0;

/// Two elevations of a cell belong to one surface if they differ by at most this many standard deviations, beyond what
/// a slope accounts for. CHOICE: three.
const GATE_DEVIATIONS: f64 = 3.0;

/// Maximum slope of one surface in a cell, rise over distance. CHOICE: the limit of the default vehicle's slope tests,
/// 0.35; what is steeper is a step, and its top counts.
const MAX_SURFACE_SLOPE: f64 = 0.35;

/// Smallest variance of a cell, square metres: half a millimetre. Blending cannot remove the errors that all points of
/// a drive share.
const MIN_VARIANCE_M2: f64 = 0.25e-6;

/// Points of a cell that differ by less are equally high, and the first of them stays, metres. The points of one image row
/// on level ground are equally high but for rounding, which must not choose between them.
const HEIGHT_ROUNDING_M: f64 = 1e-9;

/// The eight neighbours of a grid point, in steps.
const NEIGHBOURS: [(i64, i64); 8] = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];

impl ElevationMap {
    /// Enters measured points (global, metres). One call takes all points of a frame or of a scan; the points of each
    /// stripe are in row-major order of its image. Points beyond the map and points that are not finite are ignored.
    ///
    /// "The grid point having x,y coordinates closest to an edge point inherits the elevation of the edge point and its
    /// key field is set to 'u'." Then "extrapolating the elevation of each new data point to each of its neighboring
    /// grid points that is not itself a new data point" (§7): eight neighbours. [`crate::MapRules`] says which of
    /// several points a cell keeps, and which neighbours get an elevation.
    ///
    /// CHOICE: data points are extrapolated in the order in which they first became data points.
    pub fn insert<P: Into<MapPoint>>(&mut self, points: impl IntoIterator<Item = P>) -> Inconsistency {
        self.update += 1;
        let new = self.one_for_each_cell(points.into_iter().map(Into::into));
        let mut found = Inconsistency::default();
        for &NewData { at, point, top, range } in &new {
            let index = self.index(at);
            let before = self.cells[index];
            if let (Rule::Mended, Some((low, high))) = (self.rules.inconsistency, before.measured) {
                let difference = (low - top.point.z).max(top.point.z - high).max(0.0);
                found.count += 1;
                found.mean += difference;
                found.largest = found.largest.max(difference);
            }
            let (low, high) = before.measured.unwrap_or(range);
            let measured = Some((low.min(range.0), high.max(range.1)));
            self.cells[index] = Cell { measured, ..self.measured_cell(&before, &point, &top) };
        }
        found.mean /= f64::from(found.count.max(1));
        match self.rules.extrapolate {
            Rule::Paper => self.extrapolate_over_all(&new),
            Rule::Mended => self.extrapolate_to_unmeasured(&new),
        }
        found
    }

    /// The point of each cell that holds new ones, in the order in which the cells got their first.
    fn one_for_each_cell(&self, points: impl Iterator<Item = MapPoint>) -> Vec<NewData> {
        let mut new: Vec<NewData> = Vec::new();
        // Index into `new`, plus one; 0: no new point.
        let mut slots = vec![0_u32; self.cells.len()];
        let mut all: Vec<(u32, MapPoint)> = Vec::new();
        for point in points {
            if !point.point.is_finite() {
                continue;
            }
            let at = self.nearest(point.point.truncate());
            if !self.contains(at) {
                continue;
            }
            let slot = &mut slots[self.index(at)];
            if *slot == 0 {
                new.push(NewData { at, point, top: point, range: (point.point.z, point.point.z) });
                *slot = new.len() as u32;
                all.push((*slot - 1, point));
                continue;
            }
            all.push((*slot - 1, point));
            let NewData { top: kept, range, .. } = &mut new[*slot as usize - 1];
            *range = (range.0.min(point.point.z), range.1.max(point.point.z));
            let replaces = match self.rules.several {
                Rule::Paper => true,
                // The pan goes from far to near and a stripe climbs what it meets: the last point of a wall is its foot.
                Rule::Mended => point.point.z > kept.point.z + HEIGHT_ROUNDING_M,
            };
            if replaces {
                *kept = point;
            }
        }
        match self.rules.several {
            Rule::Paper => new.iter_mut().for_each(|data| data.point = data.top),
            Rule::Mended => take_means(&mut new, &all),
        }
        new
    }

    /// A cell that held `before`, with this new point; without the range of its measurements.
    fn measured_cell(&self, before: &Cell, point: &MapPoint, highest: &MapPoint) -> Cell {
        let z = point.point.z;
        let new = Cell {
            elevation: z,
            source: ElevationSource::Measured,
            update: self.update,
            place: point.point.truncate(),
            variance: (point.standard_error * point.standard_error).max(MIN_VARIANCE_M2),
            odometer: self.odometer,
            frame: self.frame,
            corrected: self.corrected,
            top: None,
            sight: point.sight,
            measured: None,
            stood: before.stood,
        };
        if self.rules.several == Rule::Paper {
            return new;
        }
        let variance = (highest.standard_error * highest.standard_error).max(MIN_VARIANCE_M2);
        let own = Top { point: highest.point, variance, odometer: self.odometer, frame: self.frame };
        let new = Cell { top: Some(own), ..new };
        if before.source != ElevationSource::Measured {
            return new;
        }
        let top = match before.top {
            Some(top) if top.point.z >= highest.point.z - HEIGHT_ROUNDING_M => Some(top),
            _ => Some(own),
        };
        let aged = before.variance + self.ageing_variance(before);
        let rise = new.elevation - before.elevation;
        if !on_one_surface(rise, aged + new.variance, (new.place - before.place).length()) {
            // There is a step in the cell, and its top decides what a wheel meets.
            let kept = if rise > 0.0 { new } else { Cell { update: new.update, ..*before } };
            return Cell { top, ..kept };
        }
        // The mean by inverse variances, of the place too: on a plane it stays on the plane.
        let share = aged / (aged + new.variance);
        Cell {
            elevation: before.elevation + share * rise,
            place: before.place + (new.place - before.place) * share,
            corrected: before.corrected + (new.corrected - before.corrected) * share,
            variance: (share * new.variance).max(MIN_VARIANCE_M2),
            sight: flatter(new.sight, before.sight),
            top,
            ..new
        }
    }

    /// Variance that a measurement has gained since it was made, square metres: the ground has moved in plan against the
    /// vehicle, by the drift that its sensors are known to have. Nothing with perfect sensors.
    pub(crate) fn ageing_variance(&self, cell: &Cell) -> f64 {
        self.aged(cell.place, cell.odometer, cell.frame)
    }

    /// Variance of the highest point of a cell now, square metres.
    pub(crate) fn top_variance(&self, top: &Top) -> f64 {
        top.variance + self.aged(top.point.truncate(), top.odometer, top.frame)
    }

    fn aged(&self, place: DVec2, odometer: f64, frame: u64) -> f64 {
        let (way, away) = (self.odometer - odometer, (place - self.place(self.centre())).length());
        let paused = |frame: u64| -> f64 {
            self.pauses.iter().filter(|(after, _)| *after < frame).map(|(_, seconds)| seconds).sum()
        };
        let moved = self.drift.displacement_variance(frame, self.frame, way, away, paused);
        AGEING_SLOPE * AGEING_SLOPE * moved
    }

    /// As printed: to all neighbours that are not new data points, "even" to those measured before. The last one counts.
    fn extrapolate_over_all(&mut self, new: &[NewData]) {
        for NewData { at, .. } in new {
            let elevation = self.cells[self.index(*at)].elevation;
            for index in self.neighbours(*at) {
                let cell = &mut self.cells[index];
                if cell.update != self.update {
                    let (measured, stood) = (cell.measured, cell.stood);
                    *cell = Cell {
                        elevation,
                        source: ElevationSource::Extrapolated,
                        measured,
                        stood,
                        ..Cell::default()
                    };
                }
            }
        }
    }

    /// Mended: only where nothing was measured. The highest neighbour counts, for a guess must not hide a step.
    fn extrapolate_to_unmeasured(&mut self, new: &[NewData]) {
        let mut guesses: Vec<(usize, f64)> = Vec::new();
        for NewData { at, .. } in new {
            let elevation = self.cells[self.index(*at)].elevation;
            guesses.extend(
                self.neighbours(*at)
                    .filter(|&index| {
                        let source = self.cells[index].source;
                        matches!(source, ElevationSource::Unknown | ElevationSource::Extrapolated)
                    })
                    .map(|index| (index, elevation)),
            );
        }
        // An older guess gives way; of those of this update the highest stays.
        for &(index, _) in &guesses {
            self.cells[index] = Cell {
                elevation: f64::NEG_INFINITY,
                source: ElevationSource::Extrapolated,
                measured: self.cells[index].measured,
                stood: self.cells[index].stood,
                ..Cell::default()
            };
        }
        for (index, elevation) in guesses {
            let cell = &mut self.cells[index];
            cell.elevation = cell.elevation.max(elevation);
        }
    }

    /// Indices of the neighbours that are on the map.
    fn neighbours(&self, of: GridPoint) -> impl Iterator<Item = usize> + use<> {
        let on_map = NEIGHBOURS.map(|(i, j)| {
            let at = GridPoint { i: of.i + i, j: of.j + j };
            self.contains(at).then(|| self.index(at))
        });
        on_map.into_iter().flatten()
    }
}

/// Whether two points lie on one surface: their elevations differ by no more than their errors and a slope account for.
fn on_one_surface(rise: f64, variance: f64, apart: f64) -> bool {
    rise.abs() <= GATE_DEVIATIONS * variance.sqrt() + MAX_SURFACE_SLOPE * apart
}

/// Gives each cell the mean of its new points that lie on one surface with the highest of them, of their places too: on a plane it
/// stays on the plane. The highest of several points would lie above the ground by their errors, and a vehicle that finds its
/// elevation by such a map climbs with every frame.
fn take_means(new: &mut [NewData], all: &[(u32, MapPoint)]) {
    let mut sums = vec![(0_u32, DVec3::ZERO, 0.0); new.len()];
    new.iter_mut().for_each(|data| data.point = data.top);
    for (slot, MapPoint { point, standard_error, sight }) in all {
        let data = &mut new[*slot as usize];
        let top = data.top;
        let variance = standard_error * standard_error + top.standard_error * top.standard_error;
        if on_one_surface(top.point.z - point.z, variance, (top.point - *point).truncate().length()) {
            let (count, sum, variances) = &mut sums[*slot as usize];
            *count += 1;
            // From the highest: far from the origin a sum of coordinates would lose digits.
            *sum += *point - top.point;
            *variances += standard_error * standard_error;
            data.point.sight = flatter(data.point.sight, *sight);
        }
    }
    for (data, (count, sum, variances)) in new.iter_mut().zip(sums) {
        let count = f64::from(count.max(1));
        data.point.point = data.top.point + sum / count;
        // Points of a stripe share the errors of their rows and of the vehicle: their mean is no better than one of them.
        data.point.standard_error = (variances / count).sqrt();
    }
}

/// The flatter of two lines of sight.
pub(crate) fn flatter(a: Option<Sight>, b: Option<Sight>) -> Option<Sight> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b.slope < a.slope { b } else { a }),
        (a, b) => a.or(b),
    }
}
