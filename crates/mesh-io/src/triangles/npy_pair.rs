//! Two NPY files to triangles: the vertices, (rows, 3) of real numbers, and the faces, (rows, 3) of integers.

use std::path::{Path, PathBuf};

use raypencil_files::{Fault, FileError, Triples, npy_triples_from_bytes};

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
    match npy_triples_from_bytes(vertices, &files[0])? {
        Triples::Reals(vertices) => parts.vertices = vertices,
        Triples::Wholes(_) => {
            return Err(wrong(0, "descr".into(), "integers", "vertices of type f2, f4 or f8"));
        }
    }
    for (row, vertex) in parts.vertices.iter().enumerate() {
        for (column, number) in vertex.iter().enumerate() {
            coordinate(*number, || format!("row {row}, column {column}"))
                .map_err(|fault| FileError::Array(fault.in_file(&files[0])))?;
        }
    }
    let Triples::Wholes(faces) = npy_triples_from_bytes(faces, &files[1])? else {
        return Err(wrong(1, "descr".into(), "real numbers", "faces of an integer type"));
    };
    let vertices = parts.vertices.len();
    parts.faces.reserve_exact(faces.len());
    for (row, face) in faces.iter().enumerate() {
        let mut corners = [0; 3];
        for (column, &index) in face.iter().enumerate() {
            let known = u32::try_from(index).ok().filter(|&index| (index as usize) < vertices);
            corners[column] = known.ok_or_else(|| {
                let place = format!("row {row}, column {column}");
                wrong(1, place, &format!("vertex {index}"), &format!("an index below {vertices}"))
            })?;
        }
        parts.add_polygon(&corners);
    }
    Ok(parts)
}
