//! Elevation map as images and as an elevation model.

use glam::DVec2;
use raypencil_rover::{ElevationMap, ElevationSource};
use raypencil_scene::Image;
use raypencil_terrain::HeightGrid;

/// Elevations at the grid points, metres, NaN where unknown. The row of smallest y comes first.
pub(crate) fn elevation_image(map: &ElevationMap) -> Image<f64> {
    let side = map.size().points;
    Image::from_cells(side, side, elevations(map))
}

/// Source of each elevation: 0 unknown, 1 proximity sensor, 2 extrapolated, 3 measured. The row of smallest y comes
/// first.
pub(crate) fn source_image(map: &ElevationMap) -> Image<u8> {
    let side = map.size().points;
    let sources = map.points().map(|point| match map.source(point) {
        ElevationSource::Unknown => 0,
        ElevationSource::Proximity => 1,
        ElevationSource::Extrapolated => 2,
        ElevationSource::Measured => 3,
    });
    Image::from_cells(side, side, sources.collect())
}

/// The paper's key of each grid point (§7), 's' not known, 'u' known: a line for each row, the northernmost first.
pub(crate) fn key_lines(map: &ElevationMap) -> String {
    let keys: Vec<char> = map.points().map(|point| map.source(point).key()).collect();
    let rows = keys.chunks_exact(map.size().points as usize).rev();
    rows.flat_map(|row| row.iter().copied().chain(['\n'])).collect()
}

/// Map as an elevation model, with NaN where it is unknown.
pub(crate) fn height_grid(map: &ElevationMap) -> HeightGrid {
    let side = map.size().points;
    HeightGrid {
        columns: side,
        rows: side,
        corner: map.points().next().map_or(DVec2::ZERO, |point| map.place(point)),
        spacing: DVec2::splat(map.size().spacing),
        heights: elevations(map),
    }
}

fn elevations(map: &ElevationMap) -> Vec<f64> {
    map.points().map(|point| map.estimate(point).map_or(f64::NAN, |estimate| estimate.elevation)).collect()
}

/// Standard errors of these elevations, metres, NaN where unknown, and where nothing tells how good a guess is.
pub(crate) fn error_image(map: &ElevationMap) -> Image<f64> {
    let side = map.size().points;
    let errors = map
        .points()
        .map(|point| map.estimate(point).and_then(|estimate| estimate.standard_error).unwrap_or(f64::NAN));
    Image::from_cells(side, side, errors.collect())
}
