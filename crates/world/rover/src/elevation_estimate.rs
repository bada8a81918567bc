//! The vehicle's own elevation, mended: a prediction by tilt, corrected by a fit of the measured ground around.
//!
//! The printed rule reads the one cell under the origin. That cell holds the elevation of a point up to half a cell's
//! diagonal away, and of whichever stripe came last, so that on a slope the vehicle's elevation errs by slope times
//! distance, with every new error entering the map ahead. Here two sources are weighed:
//!
//! * **Tilt.** Over a displacement d the plane of the wheels rises by its slope times d. On a straight way this error
//!   does not add up: with g the height of the ground and L the wheelbase, the sum of the slopes from axle to axle over a
//!   way X is the integral of (g(x + L/2) - g(x - L/2)) / L, which is the *mean of g over the wheelbase* at the end minus
//!   that at the start, while the vehicle rose by the mean of g at the two axles. Both differ by the curvature of the
//!   ground within one wheelbase, however long the way. Errors of the measured angles do add up: a bias b by b X.
//! * **Fit.** A plane through the measured points around the origin, by least squares, gives the ground under the origin;
//!   the proximity sensor adds the height above it. Points off the predicted ground by more than their errors and a slope
//!   explain belong to another level, a rock's top or a hole, and are left out.

use glam::DVec2;

use crate::elevation_map::{ElevationMap, ElevationSource, GridPoint};
use crate::vehicle_plane::WheelPlane;

/// Radius around the origin within which measured points are fitted, metres. CHOICE: three cells; enough for a plane,
/// and well inside the wheels' rectangle.
const FIT_RADIUS_M: f64 = 0.3;

/// Variance that the prediction gains by a metre driven, square metres per metre. CHOICE: 2 cm in the first metre, what
/// curvature within a wheelbase makes on ground of the default vehicle's limits.
const TILT_VARIANCE_M2_PER_M: f64 = 4e-4;

/// Points this many standard deviations off the prediction belong to another level. CHOICE: three.
const GATE_DEVIATIONS: f64 = 3.0;

/// Slope of the ground relative to the plane of the wheels that is still one level, rise over distance. CHOICE: the
/// limit of the default vehicle's slope tests.
const MAX_RELATIVE_SLOPE: f64 = 0.35;

/// Residuals above this many standard deviations count less. (P. Huber, "Robust estimation of a location parameter",
/// 1964, has 1.345 for 95 % efficiency)
const HUBER_DEVIATIONS: f64 = 1.345;

/// Rounds of reweighting. Tuned: the weights change by under a percent after them.
const REWEIGHTINGS: u32 = 3;

/// Points lie on a line if their spread across is under this share of the spread along, squared. CHOICE.
const MIN_SPREAD_RATIO: f64 = 1e-3;

/// Least variance of an estimate, square metres: a tenth of a millimetre, so that quotients stay finite.
const MIN_VARIANCE_M2: f64 = 1e-8;

/// An elevation and its variance, metres and square metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Estimate {
    pub elevation: f64,
    pub variance: f64,
}

impl Estimate {
    /// The elevation after a way of `distance` (horizontal, metres) on which the vehicle rose by `rise` by its tilt.
    /// `attitude_noise` is the standard error of an angle, radians.
    pub fn predicted(self, rise: f64, distance: f64, attitude_noise: f64) -> Self {
        let by_angle = attitude_noise * distance;
        let variance = self.variance + TILT_VARIANCE_M2_PER_M * distance + by_angle * by_angle;
        Self { elevation: self.elevation + rise, variance }
    }

    /// Both, weighed by their variances.
    pub fn corrected(self, by: Self) -> Self {
        let (a, b) = (self.variance.max(MIN_VARIANCE_M2), by.variance.max(MIN_VARIANCE_M2));
        let share = a / (a + b);
        Self { elevation: self.elevation + share * (by.elevation - self.elevation), variance: share * b }
    }
}

/// A measured point near the origin: place relative to it, elevation above the predicted ground, variance.
struct Near {
    offset: DVec2,
    residual: f64,
    variance: f64,
}

/// Elevation of the ground at a place: a plane through the measured points around it. `None` with fewer than three
/// points, or if they lie on a line. `predicted` is the elevation that the place is believed to have, `tilt` the plane
/// of the wheels.
pub(crate) fn fitted_ground(
    map: &ElevationMap,
    place: DVec2,
    predicted: Estimate,
    tilt: &WheelPlane,
) -> Option<Estimate> {
    let middle = map.nearest(place);
    let reach = (FIT_RADIUS_M / map.size().spacing).ceil() as i64;
    let mut near = Vec::new();
    for j in -reach..=reach {
        for i in -reach..=reach {
            let at = GridPoint { i: middle.i + i, j: middle.j + j };
            let cell = map.cell(at);
            if cell.source != ElevationSource::Measured {
                continue;
            }
            let offset = cell.place - place;
            let distance = offset.length();
            if distance > FIT_RADIUS_M {
                continue;
            }
            let variance = cell.variance + map.ageing_variance(cell);
            let residual = cell.elevation - predicted.elevation - tilt.rise(offset);
            let gate =
                GATE_DEVIATIONS * (predicted.variance + variance).sqrt() + MAX_RELATIVE_SLOPE * distance;
            if residual.abs() <= gate {
                // Far points say less about the ground at the place.
                let share = 1.0 - (distance / FIT_RADIUS_M) * (distance / FIT_RADIUS_M);
                near.push(Near { offset, residual, variance: variance / share.max(1e-3) });
            }
        }
    }
    let mut robust = vec![1.0; near.len()];
    let mut fit = None;
    for _ in 0..REWEIGHTINGS {
        let plane = Plane::through(&near, &robust)?;
        for (weight, point) in robust.iter_mut().zip(&near) {
            let off = (point.residual - plane.at(point.offset)).abs() / point.variance.sqrt();
            *weight = if off > HUBER_DEVIATIONS { HUBER_DEVIATIONS / off } else { 1.0 };
        }
        fit = Some(plane);
    }
    let plane = fit?;
    Some(Estimate { elevation: predicted.elevation + plane.height, variance: plane.variance })
}

/// A plane over offsets from the place: height there, slopes, and the height's variance.
struct Plane {
    height: f64,
    slope: DVec2,
    variance: f64,
}

impl Plane {
    fn at(&self, offset: DVec2) -> f64 {
        self.height + self.slope.dot(offset)
    }

    /// The plane of least squares. `None` if the points lie on a line.
    fn through(points: &[Near], robust: &[f64]) -> Option<Self> {
        let weights: Vec<f64> =
            points.iter().zip(robust).map(|(point, robust)| robust / point.variance).collect();
        let total: f64 = weights.iter().sum();
        if points.len() < 3 {
            return None;
        }
        let mut mean = DVec2::ZERO;
        let mut level = 0.0;
        for (point, weight) in points.iter().zip(&weights) {
            mean += point.offset * (weight / total);
            level += point.residual * (weight / total);
        }
        let (mut xx, mut xy, mut yy, mut xz, mut yz) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (point, weight) in points.iter().zip(&weights) {
            let (from, z) = (point.offset - mean, point.residual - level);
            xx += weight * from.x * from.x;
            xy += weight * from.x * from.y;
            yy += weight * from.y * from.y;
            xz += weight * from.x * z;
            yz += weight * from.y * z;
        }
        let det = xx * yy - xy * xy;
        // The determinant is the product of the spreads along and across; the trace is at least the greater one.
        let trace = xx + yy;
        if !(det > MIN_SPREAD_RATIO * trace * trace) {
            return None;
        }
        let slope = DVec2::new(yy * xz - xy * yz, xx * yz - xy * xz) / det;
        let height = level - slope.dot(mean);
        // Error of the mean, and of the slope over the distance to the mean.
        let across = (yy * mean.x * mean.x - 2.0 * xy * mean.x * mean.y + xx * mean.y * mean.y) / det;
        let chi: f64 = points
            .iter()
            .zip(&weights)
            .map(|(point, weight)| {
                let off = point.residual - height - slope.dot(point.offset);
                weight * off * off
            })
            .sum();
        // Ground that is no plane makes larger residuals than its errors do.
        let scatter = if points.len() > 3 { (chi / (points.len() - 3) as f64).max(1.0) } else { 1.0 };
        Some(Self { height, slope, variance: scatter * (1.0 / total + across) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elevation_map::MapSize;
    use glam::DVec3;
    use raypencil_scene::Pose;

    /// A map of ground with these elevations, where `is_measured` says so.
    fn map(z: impl Fn(DVec2) -> f64, is_measured: impl Fn(DVec2) -> bool) -> ElevationMap {
        let mut map = ElevationMap::new(MapSize { spacing: 0.1, points: 21 }, DVec2::ZERO);
        let places: Vec<DVec2> = map.points().map(|point| map.place(point)).collect();
        let points: Vec<DVec3> = places
            .into_iter()
            .filter(|place| is_measured(*place))
            .map(|place| place.extend(z(place)))
            .collect();
        map.insert(points);
        map
    }

    /// A vehicle that stands level, and believes the ground at 0 within 5 cm.
    const PREDICTED: Estimate = Estimate { elevation: 0.0, variance: 0.0025 };

    fn fitted(map: &ElevationMap) -> Option<Estimate> {
        fitted_ground(map, DVec2::ZERO, PREDICTED, &WheelPlane::of(&Pose::IDENTITY))
    }

    #[test]
    fn the_plane_is_continued_to_the_place() {
        // Ground ahead only, from 0.1 m on, that rises by 0.2: at the place it is at 0.01 m, not at its mean of some 5 cm.
        let ahead = map(|place| 0.01 + 0.2 * place.x, |place| place.x > 0.05);
        let ground = fitted(&ahead).unwrap();
        assert!((ground.elevation - 0.01).abs() < 1e-12, "{ground:?}");
        // The farther the points, the less certain.
        let around = fitted(&map(|place| 0.01 + 0.2 * place.x, |_| true)).unwrap();
        assert!((around.elevation - 0.01).abs() < 1e-12 && around.variance < ground.variance);
    }

    #[test]
    fn another_level_does_not_count() {
        // A step of 0.4 m, 0.1 m before the place: the upper level is no part of the ground under it.
        let step = map(|place| if place.x > 0.05 { 0.4 } else { 0.0 }, |_| true);
        assert!(fitted(&step).unwrap().elevation.abs() < 1e-12);
    }

    #[test]
    fn points_on_a_line_and_two_points_say_nothing() {
        assert_eq!(fitted(&map(|_| 0.0, |place| place.y.abs() < 0.05)), None);
        assert_eq!(
            fitted(&map(|_| 0.0, |place| place.y.abs() < 0.05 && (0.0..0.15).contains(&place.x))),
            None
        );
        // A third point beside the line makes a plane.
        let corner = |place: DVec2| place.x.abs().max(place.y.abs()) < 0.15 && place.x + place.y > 0.05;
        assert!(fitted(&map(|_| 0.0, corner)).is_some());
    }
}
