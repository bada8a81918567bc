//! Axes and unit of a mesh file as `--up` and `--scale` give them.

use raypencil::io::{FileFrame, SCALE_RANGE, UpAxis};

use crate::Trouble;

/// Axes and unit that the options give.
pub(crate) fn file_frame(up: Option<UpAxis>, scale: Option<f64>) -> Result<FileFrame, Trouble> {
    let scale = scale.unwrap_or(1.0);
    if !SCALE_RANGE.contains(&scale) {
        return Err(Trouble::Usage(format!(
            "--scale {scale}: expected {:e} to {:e} metres for each unit of the file",
            SCALE_RANGE.start(),
            SCALE_RANGE.end()
        )));
    }
    Ok(FileFrame { up, scale })
}
