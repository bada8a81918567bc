//! Samples to heights in metres, if all of them can be heights.

use glam::DVec2;
use raypencil_files::Fault;

use crate::dem::nodata::NoData;
use crate::dem::outliers::Posts;
use crate::dem::unit::HeightUnit;

/// Maximum absolute height, metres: the limit of a mesh.
const MAX_HEIGHT_M: f64 = 1e7;

/// Samples as a file has them.
pub(super) struct Raw {
    /// Row by row, the first row of the file first; NaN where the height is not known.
    pub samples: Vec<f64>,
    pub columns: usize,
    /// Column and row of the first of them in the file.
    pub first: [u32; 2],
    /// Distances between columns and between rows, metres.
    pub spacing: DVec2,
}

/// The heights of samples in this unit, metres. `decimal` writes a sample for people.
///
/// # Errors
/// A sample that is no height; a constant that can hardly be one, unless `nodata` says that it is.
pub(super) fn heights(
    raw: Raw,
    unit: HeightUnit,
    nodata: &NoData,
    decimal: &dyn Fn(f64) -> String,
) -> Result<Vec<f64>, Fault> {
    let Raw { mut samples, columns, first, spacing } = raw;
    let is_height = |sample: f64| sample.is_nan() || unit.to_height(sample).abs() <= MAX_HEIGHT_M;
    if let Some(at) = samples.iter().position(|&sample| !is_height(sample)) {
        let sample = samples[at];
        let place =
            format!("pixel ({}, {})", first[0] as usize + at % columns, first[1] as usize + at / columns);
        let others = samples.iter().filter(|&&other| other == sample).count() - 1;
        let found = match others {
            0 => decimal(sample),
            some => format!("{}, and the same in {some} more", decimal(sample)),
        };
        let expected = format!(
            "a height within 1e7 m, NaN, or the value of tag 42113 GDAL_NODATA; `--nodata {}` says that it is no height \
             (`dem_nodata` of a scene file)",
            decimal(sample)
        );
        return Err(Fault::new(place, found, expected));
    }
    let metre = 1.0 / unit.unit.metres();
    let posts = Posts { heights: &samples, columns, spacing: spacing * metre, metre };
    if let Some(constant) = (!nodata.is_complete).then(|| posts.constant()).flatten() {
        let sample = decimal(constant.height);
        let side = if constant.is_below == unit.is_depth { "above" } else { "below" };
        let found = format!(
            "{sample} in {} of {} posts, {:.1} m {side} the others, which span {:.1} m",
            constant.count,
            samples.len(),
            constant.gap / metre,
            constant.span / metre
        );
        let settled = nodata.values.iter().map(|&value| decimal(value) + ",").collect::<String>();
        let expected = format!(
            "heights alone: `--nodata {settled}{sample}` says that it stands for unknown heights, `--nodata {settled}none` \
             that it is a height (`dem_nodata` of a scene file)"
        );
        return Err(Fault::new("samples", found, expected));
    }
    // Adding zero turns -0 into +0.
    samples.iter_mut().for_each(|sample| *sample = unit.to_height(*sample) + 0.0);
    Ok(samples)
}
