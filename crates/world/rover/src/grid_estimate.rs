//! The elevation at a grid point itself, from measured points that lie beside it.
//!
//! A cell holds the highest point that was measured in it, at that point's own place, up to half a diagonal from the grid
//! point. Written at the grid point it would be too high, on a slope by slope times distance. Here a plane through the measured
//! points around carries it from its place to the grid point.

use glam::{DVec2, DVec3};

use crate::elevation_map::{ElevationMap, ElevationSource, GridPoint};
use crate::rules::Rule;

/// Rise over distance up to which two points lie on one surface. CHOICE: as in a cell, 0.35, the limit of the default vehicle's
/// slope tests. Beside walls and stones a steeper plane would be carried far off the ground.
const MAX_SLOPE: f64 = 0.35;

/// Beyond that slope, and this many standard deviations, there is a step between two points. CHOICE: three.
const GATE_DEVIATIONS: f64 = 3.0;

/// Points lie on a line if their spread across is under this share of the spread along, squared. CHOICE: as for registration.
const MIN_SPREAD_RATIO: f64 = 1e-2;

/// Cells on either side of a guess whose measured points tell it. CHOICE: beyond the last stripe that a drive swept, the
/// second row is needed for a plane.
const REACH_OF_GUESS: i64 = 2;

/// Elevation at a grid point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridEstimate {
    /// Global z, metres.
    pub elevation: f64,
    /// Its standard error, metres. `None` if nothing tells it.
    pub standard_error: Option<f64>,
}

/// Least squares of slopes, from points around.
struct Fit {
    mean: DVec3,
    slope: DVec2,
    /// Inverse of the second moments of the places, 1 per square metre: xx, xy, yy.
    inverse: [f64; 3],
    /// Variance of a point, square metres: by its own errors, or by its distance from the plane if that is more.
    variance: f64,
    count: f64,
}

impl ElevationMap {
    /// Elevation at a grid point, with its standard error now. `None` if it is not known.
    ///
    /// A measured point is carried to the grid point by the slope of the plane of least squares through it and the measured
    /// points of the eight cells around that lie on one surface with it. A guess is the height of the plane through the
    /// measured points within two cells that lie on one surface with the highest of the eight around. Where these are too few, or lie on a line, and with the
    /// printed rule `several`, the cell's own elevation is taken as it is.
    pub fn estimate(&self, point: GridPoint) -> Option<GridEstimate> {
        let cell = self.cell(point);
        let own =
            |error: Option<f64>| Some(GridEstimate { elevation: cell.elevation, standard_error: error });
        match cell.source {
            ElevationSource::Unknown => None,
            ElevationSource::Proximity => own(Some(cell.variance.sqrt())),
            ElevationSource::Measured => {
                let variance = cell.variance + self.ageing_variance(cell);
                if self.rules.several == Rule::Paper {
                    return own(Some(variance.sqrt()));
                }
                let here = (cell.place.extend(cell.elevation), variance);
                let away = self.place(point) - cell.place;
                let on_surface = on_surface_of(here, self.measured_around(point, 1));
                match Fit::through(&on_surface) {
                    None => own(Some(variance.sqrt())),
                    Some(fit) => Some(GridEstimate {
                        elevation: cell.elevation + fit.slope.dot(away),
                        standard_error: Some((variance + fit.slope_variance(away)).sqrt()),
                    }),
                }
            }
            ElevationSource::Extrapolated => {
                if self.rules.several == Rule::Paper {
                    return own(None);
                }
                // A guess has the height of its highest neighbour; of the points around, those on its surface tell the rest.
                let beside = self.measured_around(point, 1).into_iter();
                let Some(highest) = beside.reduce(|a, b| if b.0.z > a.0.z { b } else { a }) else {
                    return own(None);
                };
                let on_surface = on_surface_of(highest, self.measured_around(point, REACH_OF_GUESS));
                let Some(fit) = Fit::through(&on_surface) else { return own(None) };
                let away = self.place(point) - fit.mean.truncate();
                let variance = fit.variance / fit.count + fit.slope_variance(away);
                Some(GridEstimate {
                    elevation: fit.mean.z + fit.slope.dot(away),
                    standard_error: Some(variance.sqrt()),
                })
            }
        }
    }

    /// Measured points of the cells around a grid point, with its own, row by row, each with its variance now.
    fn measured_around(&self, point: GridPoint, reach: i64) -> Vec<(DVec3, f64)> {
        let around = (-reach..=reach).flat_map(|j| (-reach..=reach).map(move |i| (i, j)));
        around
            .filter_map(|(i, j)| {
                let cell = self.cell(GridPoint { i: point.i + i, j: point.j + j });
                (cell.source == ElevationSource::Measured)
                    .then(|| (cell.place.extend(cell.elevation), cell.variance + self.ageing_variance(cell)))
            })
            .collect()
    }
}

/// Those of the points, each with its variance, that lie on one surface with the first argument.
fn on_surface_of((here, variance): (DVec3, f64), points: Vec<(DVec3, f64)>) -> Vec<(DVec3, f64)> {
    let mut points = points;
    points.retain(|(other, of_other)| {
        let apart = (other.truncate() - here.truncate()).length();
        (other.z - here.z).abs() <= MAX_SLOPE * apart + GATE_DEVIATIONS * (variance + of_other).sqrt()
    });
    points
}

impl Fit {
    /// `None` with fewer than three points, if they lie on a line, or on a plane too steep for one surface.
    fn through(points: &[(DVec3, f64)]) -> Option<Self> {
        if points.len() < 3 {
            return None;
        }
        let count = points.len() as f64;
        let mean = points.iter().map(|(point, _)| *point).sum::<DVec3>() / count;
        let (mut xx, mut xy, mut yy, mut xz, mut yz) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (point, _) in points {
            let from = *point - mean;
            xx += from.x * from.x;
            xy += from.x * from.y;
            yy += from.y * from.y;
            xz += from.x * from.z;
            yz += from.y * from.z;
        }
        let (det, trace) = (xx * yy - xy * xy, xx + yy);
        if !(det > MIN_SPREAD_RATIO * trace * trace) {
            return None;
        }
        let slope = DVec2::new(yy * xz - xy * yz, xx * yz - xy * xz) / det;
        if slope.length() > MAX_SLOPE {
            return None;
        }
        let off: f64 = points
            .iter()
            .map(|(point, _)| {
                let from = *point - mean;
                let off = from.z - slope.dot(from.truncate());
                off * off
            })
            .sum();
        let stated = points.iter().map(|(_, variance)| variance).sum::<f64>() / count;
        let seen = if points.len() > 3 { off / (count - 3.0) } else { 0.0 };
        let inverse = [yy / det, -xy / det, xx / det];
        Some(Self { mean, slope, inverse, variance: stated.max(seen), count })
    }

    /// Variance of the rise over a displacement, square metres.
    fn slope_variance(&self, away: DVec2) -> f64 {
        let [xx, xy, yy] = self.inverse;
        self.variance * (xx * away.x * away.x + 2.0 * xy * away.x * away.y + yy * away.y * away.y)
    }
}
