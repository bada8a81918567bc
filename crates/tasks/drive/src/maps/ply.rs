//! Measured points as PLY, binary, little endian. (G. Turk, "The PLY polygon file format", 1994)

use std::path::Path;

use glam::DVec3;
use raypencil_files::{FileError, write_atomically};

/// Measured point with its origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarkedPoint {
    /// Global position, metres.
    pub point: DVec3,
    /// Index of the frame that measured it.
    pub frame: u32,
    /// Index of the beam whose stripe it lies on.
    pub beam: u8,
}

/// Writes points as a PLY file with the properties x, y, z (double), `frame` (uint) and `beam` (uchar).
///
/// # Errors
/// The file could not be written, with its path.
pub fn write_ply(path: impl AsRef<Path>, points: &[MarkedPoint]) -> Result<(), FileError> {
    write_atomically(path, |file| {
        write!(
            file,
            "ply\nformat binary_little_endian 1.0\ncomment global frame, metres, z up\nelement vertex {}\n\
             property double x\nproperty double y\nproperty double z\nproperty uint frame\nproperty uchar beam\n\
             end_header\n",
            points.len()
        )?;
        for MarkedPoint { point, frame, beam } in points {
            for value in point.to_array() {
                file.write_all(&value.to_le_bytes())?;
            }
            file.write_all(&frame.to_le_bytes())?;
            file.write_all(&[*beam])?;
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_counts_and_the_numbers_follow() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.ply");
        let points = [
            MarkedPoint { point: DVec3::new(1.5, -2.0, 0.25), frame: 7, beam: 1 },
            MarkedPoint { point: DVec3::ZERO, frame: 258, beam: 0 },
        ];
        write_ply(&path, &points).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let end = b"end_header\n";
        let at = bytes.windows(end.len()).position(|part| part == end).unwrap() + end.len();
        let header = std::str::from_utf8(&bytes[..at]).unwrap();
        assert!(header.starts_with("ply\nformat binary_little_endian 1.0\n"), "{header}");
        assert!(header.contains("\nelement vertex 2\nproperty double x\n"), "{header}");
        // Each point has three doubles, four bytes and one byte: 29 bytes.
        assert_eq!(bytes.len() - at, 2 * 29);
        assert_eq!(bytes[at..at + 8], 1.5_f64.to_le_bytes());
        assert_eq!(bytes[at + 24..at + 29], [7, 0, 0, 0, 1]);
        assert_eq!(bytes[at + 53..], [2, 1, 0, 0, 0]);
    }
}
