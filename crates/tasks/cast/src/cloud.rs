//! The points that are hit, as point clouds: PLY and PCD.

use std::path::Path;

use raypencil_files::{FileError, write_atomically};
use raypencil_scene::{NamedRaySet, Reading};

use crate::answers::Answers;

/// Writes one point for each hit, in the order of the rays: PLY, binary, little endian, with the properties x, y, z
/// (double), `face` (uint) and `cos_incidence` (double). (G. Turk, "The PLY polygon file format", 1994)
///
/// # Errors
/// The file cannot be written; the message names it.
pub fn write_ply(path: impl AsRef<Path>, answers: &Answers) -> Result<(), FileError> {
    write_atomically(path, |file| {
        write!(
            file,
            "ply\nformat binary_little_endian 1.0\ncomment raypencil cast, frame of the mesh\nelement vertex {}\n\
             property double x\nproperty double y\nproperty double z\nproperty uint face\n\
             property double cos_incidence\nend_header\n",
            answers.counts().0
        )?;
        for hit in answers.hits() {
            for value in hit.point.to_array() {
                file.write_all(&value.to_le_bytes())?;
            }
            file.write_all(&hit.face.0.to_le_bytes())?;
            file.write_all(&hit.cos_incidence.to_le_bytes())?;
        }
        Ok(())
    })
}

/// Writes one point for each ray: PCD 0.7, binary, organised. Where nothing is hit x, y, z and `range` are NaN. What is too near
/// is no point either: x, y, z are NaN, and `range` is -Inf. (Point Cloud Library, "The PCD (Point Cloud Data) file format";
/// REP-117)
///
/// The width is the last dimension of the set's shape, the height the product of the others, so that points are in the
/// order of the rays. Fields: x, y, z (float32), `ring` (uint16: the index in the second dimension, 0 without one, at most
/// 65535), `time` (float64, seconds, 0 for sets without times), `range` (float32).
///
/// # Errors
/// The file cannot be written; the message names it.
pub fn write_pcd(path: impl AsRef<Path>, answers: &Answers, set: &NamedRaySet) -> Result<(), FileError> {
    let count = answers.first.len() as u64;
    let width = set.shape.last().copied().unwrap_or(1);
    let height = count.checked_div(width).unwrap_or(0);
    // Number of rays with the same index in the second dimension, one after the other.
    let of_ring: u64 = set.shape.iter().skip(2).product();
    let ring = |index: u64| match set.shape.get(1) {
        Some(&rings) => u16::try_from(index / of_ring % rings).unwrap_or(u16::MAX),
        None => 0,
    };
    write_atomically(path, |file| {
        write!(
            file,
            "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z ring time range\n\
             SIZE 4 4 4 2 8 4\nTYPE F F F U F F\nCOUNT 1 1 1 1 1 1\nWIDTH {width}\nHEIGHT {height}\n\
             VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {count}\nDATA binary\n"
        )?;
        for (index, read) in answers.first.iter().enumerate() {
            let (point, range) = match read {
                Reading::Hit(hit) => (hit.point.to_array(), hit.range),
                Reading::TooNear => ([f64::NAN; 3], f64::NEG_INFINITY),
                Reading::Miss => ([f64::NAN; 3], f64::NAN),
            };
            for value in point {
                file.write_all(&(value as f32).to_le_bytes())?;
            }
            file.write_all(&ring(index as u64).to_le_bytes())?;
            let time = set.times.as_ref().map_or(0.0, |times| times[index]);
            file.write_all(&time.to_le_bytes())?;
            file.write_all(&(range as f32).to_le_bytes())?;
        }
        Ok(())
    })
}
