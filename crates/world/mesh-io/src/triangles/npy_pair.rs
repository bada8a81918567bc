//! Two NPY files to triangles: the vertices, (rows, 3) of real numbers, and the faces, (rows, 3) of integers.

use std::path::{Path, PathBuf};

use raypencil_files::{Fault, FileError, Numbers, Storage, npy_numbers_from_bytes};

use crate::triangles::parts::{Parts, coordinate};

/// Ends of the names of both files.
const NAMES: [&str; 2] = ["vertices.npy", "faces.npy"];

/// What may stand between a stem and these ends.
const SEPARATORS: [&str; 3] = [".", "_", "-"];

/// The files of vertices and faces that a path stands for: a folder, one of the two files, or their common stem.
pub(super) fn files(path: &Path) -> Option<[PathBuf; 2]> {
    if path.is_dir() {
        return Some(NAMES.map(|name| path.join(name)));
    }
    let name = path.file_name()?.to_str()?;
    if let Some(stem) = NAMES.iter().find_map(|end| name.strip_suffix(end)) {
        return Some(NAMES.map(|end| path.with_file_name(format!("{stem}{end}"))));
    }
    if path.exists() {
        return None;
    }
    let pairs = SEPARATORS.map(|sign| NAMES.map(|end| path.with_file_name(format!("{name}{sign}{end}"))));
    pairs.into_iter().find(|[vertices, _]| vertices.exists())
}

/// Reads both files from their bytes.
pub(super) fn read(files: &[PathBuf; 2], [vertices, faces]: [&[u8]; 2]) -> Result<Parts, FileError> {
    let mut parts = Parts::default();
    let wrong = |file: usize, place: String, found: &str, expected: &str| {
        FileError::Array(Fault::new(place, found, expected).in_file(&files[file]))
    };
    let rows = |file: usize, bytes: &[u8]| -> Result<(Storage, Vec<[f64; 3]>), FileError> {
        let Numbers { shape, storage, values } = npy_numbers_from_bytes(bytes, &files[file])?;
        if shape.len() != 2 || shape[1] != 3 {
            return Err(wrong(file, "shape".into(), &format!("{shape:?}"), "(rows, 3)"));
        }
        Ok((storage, values.chunks_exact(3).map(|row| [row[0], row[1], row[2]]).collect()))
    };
    let (storage, rows_of_vertices) = rows(0, vertices)?;
    if storage == Storage::Whole {
        return Err(wrong(0, "descr".into(), "integers", "vertices of type f2, f4 or f8"));
    }
    parts.vertices = rows_of_vertices;
    for (row, vertex) in parts.vertices.iter().enumerate() {
        for (column, number) in vertex.iter().enumerate() {
            coordinate(*number, || format!("row {row}, column {column}"))
                .map_err(|fault| FileError::Array(fault.in_file(&files[0])))?;
        }
    }
    let (storage, faces) = rows(1, faces)?;
    if storage != Storage::Whole {
        return Err(wrong(1, "descr".into(), "real numbers", "faces of an integer type"));
    }
    let vertices = parts.vertices.len();
    parts.faces.reserve_exact(faces.len());
    for (row, face) in faces.iter().enumerate() {
        let mut corners = [0; 3];
        for (column, &index) in face.iter().enumerate() {
            // A whole number of at most 2^53.
            let known = (0.0..vertices as f64).contains(&index).then_some(index as u32);
            corners[column] = known.ok_or_else(|| {
                let place = format!("row {row}, column {column}");
                wrong(1, place, &format!("vertex {index}"), &format!("an index below {vertices}"))
            })?;
        }
        parts.add_polygon(&corners);
    }
    Ok(parts)
}
