//! A comparison as arrays.

use std::path::Path;

use raypencil_files::{FileError, write_npy_numbers};

use super::stated::Stated;
use super::verdict::{Comparison, RayVerdict};

/// Writes `NAME.verdict.npy` (u1, the rays' shape: 0 the same, 1 the same at a tie, 2 rounding, 3 wrong), `NAME.moved.npy`
/// (f8, (..., 2): the displacement that excuses a ray, NaN for the others), and `NAME.face.npy` (u4) if faces are given.
/// Returns the names of the files.
///
/// # Errors
/// A file cannot be written; the message names it.
pub fn write_comparison(
    folder: &Path,
    name: &str,
    shape: &[u64],
    stated: &Stated,
    comparison: &Comparison,
) -> Result<Vec<String>, FileError> {
    let verdicts: Vec<u8> = comparison
        .verdicts
        .iter()
        .map(|verdict| match verdict {
            RayVerdict::Same { is_tie } => u8::from(*is_tie),
            RayVerdict::Rounding { .. } => 2,
            RayVerdict::Wrong(_) => 3,
        })
        .collect();
    let moved = comparison.verdicts.iter().flat_map(|verdict| match verdict {
        RayVerdict::Rounding { moved } => *moved,
        _ => [f64::NAN; 2],
    });
    let moved: Vec<f64> = moved.collect();
    let of_two: Vec<u64> = shape.iter().copied().chain([2]).collect();
    let file = |part: &str| format!("{name}.{part}.npy");
    write_npy_numbers(folder.join(file("verdict")), shape, &verdicts)?;
    write_npy_numbers(folder.join(file("moved")), &of_two, &moved)?;
    let mut files = vec![file("verdict"), file("moved")];
    if let Some(faces) = &stated.face {
        let faces: Vec<u32> = faces.iter().map(|face| face.map_or(u32::MAX, |face| face.0)).collect();
        write_npy_numbers(folder.join(file("face")), shape, &faces)?;
        files.push(file("face"));
    }
    Ok(files)
}
