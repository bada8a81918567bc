//! Which format a file has, and its cloud.

use std::io::Read as _;
use std::path::Path;

use raypencil_files::{Fault, FileError, Limits, bytes};

use super::columns::{Cloud, check_names};
use super::pcd;
use crate::triangles::ply_cloud;

/// Whether a file's name ends as that of a cloud does: `.pcd` or `.ply`.
pub fn is_cloud_file(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ["pcd", "ply"].iter().any(|known| ending.eq_ignore_ascii_case(known)))
}

/// Bytes of a file in which its number of points is looked for.
const HEAD_BYTES: u64 = 1 << 16;

/// The number of points that the header of a file claims, before anything is read of them; `None` if it names none, or the file cannot be
/// read.
///
/// ```
/// let folder = tempfile::tempdir()?;
/// let file = folder.path().join("mine.pcd");
/// std::fs::write(&file, "VERSION .7\nFIELDS x y z\nWIDTH 900000000\nHEIGHT 1\nPOINTS 900000000\nDATA binary\n")?;
/// assert_eq!(raypencil_mesh_io::claimed_points(&file), Some(900_000_000));
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn claimed_points(path: &Path) -> Option<u64> {
    // Asked before the file is opened: opening a pipe waits for its writer.
    if !std::fs::metadata(path).ok()?.is_file() {
        return None;
    }
    let mut head = Vec::new();
    std::fs::File::open(path).ok()?.take(HEAD_BYTES).read_to_end(&mut head).ok()?;
    for line in head.split(|&byte| byte == b'\n') {
        let line = String::from_utf8_lossy(line);
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match words.as_slice() {
            ["POINTS", count] | ["element", "vertex", count] => return count.parse().ok(),
            ["DATA", ..] | ["end_header"] => return None,
            _ => {}
        }
    }
    None
}

/// Reads those fields of a cloud that `keeps` names, and x, y and z.
///
/// # Errors
/// Names the file, and the place in it that is wrong.
pub fn read_cloud(path: &Path, keeps: impl Fn(&str) -> bool) -> Result<Cloud, FileError> {
    let bytes = bytes::read_file(path, Limits::default().bytes)
        .map_err(|error| FileError::io(path, "read", error))?;
    cloud_from_bytes(&bytes, path, keeps)
}

/// Reads the bytes of a file as [`read_cloud`] does; `file` is its name in messages.
///
/// ```
/// use raypencil_mesh_io::cloud_from_bytes;
///
/// let text = "VERSION .7\nFIELDS x y z ring\nSIZE 4 4 4 2\nTYPE F F F U\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n\
///             1 2 3.5 0\nnan nan nan 1\n";
/// let cloud = cloud_from_bytes(text.as_bytes(), "mine.pcd".as_ref(), |name| name == "ring")?;
/// assert_eq!((cloud.len(), cloud.column("z").unwrap().values[0]), (2, 3.5));
/// assert_eq!(cloud.column("ring").unwrap().values, [0.0, 1.0]);
/// # Ok::<(), raypencil_files::FileError>(())
/// ```
///
/// # Errors
/// As [`read_cloud`].
pub fn cloud_from_bytes(bytes: &[u8], file: &Path, keeps: impl Fn(&str) -> bool) -> Result<Cloud, FileError> {
    let keeps = |name: &str| ["x", "y", "z"].contains(&name) || keeps(name);
    let read = if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") {
        ply_cloud(bytes, keeps).and_then(|columns| {
            let names: Vec<String> = columns.iter().map(|column| column.name.clone()).collect();
            check_names(&names)?;
            let cloud = Cloud { width: 0, height: 1, columns };
            Ok(Cloud { width: cloud.len() as u64, ..cloud })
        })
    } else if bytes.starts_with(b"#") || bytes.starts_with(b"VERSION") || bytes.starts_with(b"FIELDS") {
        pcd::read(bytes, keeps)
    } else {
        Err(Fault::new("file", "neither `ply` nor the header of a PCD file", "a point cloud in PCD or PLY"))
    };
    read.map_err(|fault| FileError::Cloud(fault.in_file(file)))
}
