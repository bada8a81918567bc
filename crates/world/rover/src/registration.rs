//! Registration of a frame's stripes with the map: how much too high the vehicle believes to be.
//!
//! The near stripe meets ground that the far stripe, or a scan, measured some metres ago. The mean height of its points
//! over that ground is the error of the vehicle's elevation relative to the map. "Although, to a degree, only relative
//! elevations are important, error accumulation can lead to inconsistency between points taken at different frames." (§7)

use glam::DVec3;

use crate::elevation_estimate::Estimate;
use crate::elevation_map::{ElevationMap, ElevationSource, GridPoint};

/// Ground must have been measured at least this way ago, metres. CHOICE: three cells. What the same stripe measured just
/// before says nothing new.
const MIN_WAY_M: f64 = 0.3;

/// What rounding may make of a way that is just long enough: frames of 3 or 6 cm meet the limit to the last digit.
const WAY_ROUNDING_M: f64 = 1e-9;

/// Fewest points that count. CHOICE: those of a few cells.
const MIN_POINTS: usize = 20;

/// Ground steeper than this around a point is left out: there a small shift in the plane looks like one in height. Rise
/// over distance. CHOICE: a slope of 45 degrees.
const MAX_SLOPE: f64 = 1.0;

/// The cells around a point are one surface if they lie off the plane through them by no more than this share of their
/// spacing, root mean square. CHOICE: the rise over distance up to which two points of a cell lie on one surface.
const MAX_ROUGHNESS: f64 = 0.35;

/// Of nine cells, one may stand out by this share of their spacing and they are still one surface: its h raises their plane by h / 9, so that it
/// lies 8/9 h off it and each other one 1/9 h, and the root mean square is h sqrt(8) / 9. A thing lower than that is not told from the ground.
const LARGEST_STEP_OF_A_SURFACE: f64 = MAX_ROUGHNESS * 9.0 / (2.0 * std::f64::consts::SQRT_2);

/// Standard deviations up to which an error is expected. CHOICE: as for the ground under the origin.
const EXPECTED_DEVIATIONS: f64 = 3.0;

/// Least standard error that all points of a stripe share, metres. CHOICE: what a fifth of a pixel's row makes at the
/// stripes of the default rig.
const MIN_SHARED_ERROR_M: f64 = 0.005;

/// Ground under a point, as it was measured some way ago.
struct OldGround {
    /// Metres.
    elevation: f64,
    /// Whether its cells lie on one surface.
    is_surface: bool,
}

/// Error of the vehicle's elevation relative to the map, with its variance, from points of a frame (global, metres) that
/// were placed by that elevation. `own_variance` is the variance of that elevation, square metres. `None` if too few points lie
/// on ground that was measured long enough ago.
///
/// An error that the belief does not expect is taken only from ground that is one surface. A stripe that climbs a thing lies
/// lower or higher than what was measured of it before, by up to its height, and no error of the vehicle is needed for that.
///
/// `row_error` is the standard error of a point by its row in the image, metres. On level ground the whole stripe lies in
/// one row, so that all of its points share that error.
pub(crate) fn elevation_error(
    map: &ElevationMap,
    points: &[DVec3],
    row_error: f64,
    own_variance: f64,
) -> Option<Estimate> {
    let met = points.iter().filter_map(|&point| Some((point.z, old_ground(map, point)?)));
    let heights: Vec<(f64, bool)> = met.map(|(z, old)| (z - old.elevation, old.is_surface)).collect();
    let shared = row_error.max(MIN_SHARED_ERROR_M);
    let error = median_estimate(heights.iter().map(|&(height, _)| height), shared)?;
    let expected = EXPECTED_DEVIATIONS * (own_variance + error.variance).sqrt()
        + LARGEST_STEP_OF_A_SURFACE * map.size().spacing;
    if error.elevation.abs() <= expected {
        return Some(error);
    }
    median_estimate(heights.iter().filter(|(_, is_surface)| *is_surface).map(|&(height, _)| height), shared)
}

/// The median of heights, with its variance. `shared` is a standard error that all of them have in common, metres. `None` if there are
/// too few.
fn median_estimate(heights: impl Iterator<Item = f64>, shared: f64) -> Option<Estimate> {
    let mut heights: Vec<f64> = heights.collect();
    if heights.len() < MIN_POINTS {
        return None;
    }
    // The median: walls, edges and what moved into another cell do not count.
    heights.sort_by(f64::total_cmp);
    let median = |sorted: &[f64]| sorted[sorted.len() / 2];
    let middle = median(&heights);
    let mut off: Vec<f64> = heights.iter().map(|height| (height - middle).abs()).collect();
    off.sort_by(f64::total_cmp);
    // 1.4826 times the median deviation is the standard deviation of a normal distribution, and its median has a standard
    // error of sqrt(pi / 2) times that of its mean.
    let deviation = 1.4826 * median(&off);
    let variance = std::f64::consts::FRAC_PI_2 * deviation * deviation / heights.len() as f64;
    Some(Estimate { elevation: middle, variance: variance + shared * shared })
}

/// Elevation of the ground at a point's place by what was measured around it some way ago: a plane through the nine cells
/// around. `None` if its own cell was not measured then, or if the ground is too steep there.
fn old_ground(map: &ElevationMap, point: DVec3) -> Option<OldGround> {
    let at = map.nearest(point.truncate());
    let is_old = |at: GridPoint| {
        let cell = map.cell(at);
        let old = cell.source == ElevationSource::Measured
            && map.odometer - cell.odometer >= MIN_WAY_M - WAY_ROUNDING_M;
        old.then(|| cell.place.extend(cell.elevation))
    };
    is_old(at)?;
    let around = (-1..=1).flat_map(|j| (-1..=1).map(move |i| GridPoint { i: at.i + i, j: at.j + j }));
    let near: Vec<DVec3> = around.filter_map(is_old).collect();
    let count = near.len() as f64;
    let mean = near.iter().sum::<DVec3>() / count;
    let (mut xx, mut xy, mut yy, mut xz, mut yz) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for sample in &near {
        let from = *sample - mean;
        xx += from.x * from.x;
        xy += from.x * from.y;
        yy += from.y * from.y;
        xz += from.x * from.z;
        yz += from.y * from.z;
    }
    let (det, trace) = (xx * yy - xy * xy, xx + yy);
    // Points on a line have no slope across it.
    if near.len() < 4 || !(det > 1e-2 * trace * trace) {
        return None;
    }
    let slope = [(yy * xz - xy * yz) / det, (xx * yz - xy * xz) / det];
    let steep = slope[0] * slope[0] + slope[1] * slope[1] > MAX_SLOPE * MAX_SLOPE;
    let plane_at = |at: DVec3| {
        let away = at - mean;
        mean.z + slope[0] * away.x + slope[1] * away.y
    };
    let off = near.iter().map(|&sample| {
        let residual = sample.z - plane_at(sample);
        residual * residual
    });
    let limit = MAX_ROUGHNESS * map.size().spacing;
    let is_surface = off.sum::<f64>() <= limit * limit * count;
    (!steep).then(|| OldGround { elevation: plane_at(point), is_surface })
}
