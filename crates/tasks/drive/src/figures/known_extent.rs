//! Extent of the known cells of an elevation map.

use raypencil_rover::{ElevationMap, GridPoint};

/// Extent of the known grid points of a map.
#[derive(Debug, Clone, Copy)]
pub(crate) struct KnownExtent {
    /// Lowest and highest elevation, metres.
    pub elevations: [f64; 2],
    /// Grid points with the smallest and with the largest indices.
    pub corners: [GridPoint; 2],
}

impl KnownExtent {
    /// Extent of a map; `None` if nothing is known.
    pub(crate) fn of(map: &ElevationMap) -> Option<Self> {
        let mut extent: Option<Self> = None;
        for point in map.points() {
            let Some(z) = map.elevation(point) else { continue };
            let Self { elevations, corners: [low, high] } =
                extent.get_or_insert(Self { elevations: [z, z], corners: [point, point] });
            *elevations = [elevations[0].min(z), elevations[1].max(z)];
            *low = GridPoint { i: low.i.min(point.i), j: low.j.min(point.j) };
            *high = GridPoint { i: high.i.max(point.i), j: high.j.max(point.j) };
        }
        extent
    }
}

/// Stride from `low` to `high` that leaves at most `max_points` grid points along either side.
pub(crate) fn stride(low: GridPoint, high: GridPoint, max_points: i64) -> i64 {
    let longest = (high.i - low.i).max(high.j - low.j).max(0);
    longest / max_points + 1
}
