//! The pixels that are asked for, gathered from blocks.

use std::ops::RangeInclusive;

use raypencil_files::Fault;

/// The requested pixels.
pub(super) struct Target {
    pub columns: RangeInclusive<u32>,
    pub rows: RangeInclusive<u32>,
    /// Samples of unknown heights.
    pub nodata: Vec<f64>,
    /// Row by row; NaN where the height is not known.
    pub heights: Vec<f64>,
}

impl Target {
    /// Copies the requested pixels of a block, whose first pixel is at `corner`. Its rows have `stride` samples, of which
    /// `across` are pixels.
    pub fn take<T: Copy + Into<f64>>(
        &mut self,
        corner: [u64; 2],
        [across, down]: [u64; 2],
        stride: u64,
        samples: &[T],
    ) -> Result<(), Fault> {
        let width = self.columns.end() - self.columns.start() + 1;
        for y in 0..down {
            let row = corner[1] + y;
            if row < u64::from(*self.rows.start()) || row > u64::from(*self.rows.end()) {
                continue;
            }
            let low = u64::from(*self.columns.start()).max(corner[0]);
            let end = (u64::from(*self.columns.end()) + 1).min(corner[0] + across);
            for column in low..end {
                let at = (y * stride + (column - corner[0])) as usize;
                let Some(&sample) = samples.get(at) else {
                    let found = format!("{} samples in its block", samples.len());
                    return Err(Fault::new(
                        format!("pixel ({column}, {row})"),
                        found,
                        format!("{}", stride * down),
                    ));
                };
                let sample: f64 = sample.into();
                let is_unknown = sample.is_nan() || self.nodata.contains(&sample);
                let place = (row - u64::from(*self.rows.start())) * u64::from(width)
                    + (column - u64::from(*self.columns.start()));
                // Adding zero turns -0 into +0.
                self.heights[place as usize] = if is_unknown { f64::NAN } else { sample + 0.0 };
            }
        }
        Ok(())
    }
}
