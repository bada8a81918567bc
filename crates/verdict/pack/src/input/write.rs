//! The files of an input pack.

use std::path::Path;

use raypencil_files::{FolderError, begin_output_folder, hex_digits, sha256, write_atomically, write_npy};
use raypencil_scene::Image;
use serde_json::json;

use crate::input::clause::LoadingClause;
use crate::input::ground::{input_faces, input_glb};

/// File that marks an input pack. It is written last.
pub(super) const INPUT_NAME: &str = "input.json";

/// The terrain in the state in which programs of other people write it.
pub(super) const GROUND_NAME: &str = "ground.glb";

/// Array of corners: a row for each face, nine numbers.
pub(super) const TRIANGLES_NAME: &str = "triangles.npy";

/// Array of reflectivities: a row for each face.
pub(super) const REFLECTIVITY_NAME: &str = "reflectivity.npy";

/// Number of the format of `input.json`.
const INPUT_FORMAT: u32 = 1;

/// Writes the input pack: `ground.glb`, the triangles that it must become, and last `input.json`.
///
/// ```
/// use raypencil_pack::{check_input, write_input};
///
/// let folder = tempfile::tempdir()?;
/// write_input(folder.path())?;
/// // The pack holds the right answer, so that it is a candidate that passes.
/// assert!(check_input(folder.path(), folder.path())?.passes());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Names the folder or file that could not be written, and why.
pub fn write_input(folder: &Path) -> Result<(), FolderError> {
    let last = begin_output_folder(folder, INPUT_NAME)?;
    let (glb, faces) = (input_glb(), input_faces());
    write_atomically(folder.join(GROUND_NAME), |file| file.write_all(&glb))?;
    let corners = faces.iter().flat_map(|face| face.corners.as_flattened()).copied().collect();
    let triangles = Image::from_cells(9, faces.len() as u32, corners);
    write_npy(folder.join(TRIANGLES_NAME), &[&triangles])?;
    let reflectivities = faces.iter().map(|face| face.reflectivity).collect();
    write_npy(folder.join(REFLECTIVITY_NAME), &[&Image::from_cells(1, faces.len() as u32, reflectivities)])?;
    let clause = |clause: &LoadingClause| {
        let of_clause = faces.iter().enumerate().filter(|(_, face)| face.clause == *clause);
        let numbers: Vec<usize> = of_clause.map(|(number, _)| number).collect();
        json!({"clause": clause.key(), "sentence": clause.sentence(), "faces": numbers})
    };
    let document = json!({
        "format": INPUT_FORMAT,
        "kind": "input",
        "raypencilVersion": env!("CARGO_PKG_VERSION"),
        "ground": {"path": GROUND_NAME, "bytes": glb.len(), "sha256": hex_digits(&sha256(&glb))},
        "triangles": {"path": TRIANGLES_NAME, "rows": faces.len(), "columns": 9, "unit": "m"},
        "reflectivity": {"path": REFLECTIVITY_NAME, "rows": faces.len(), "columns": 1, "unit": "1"},
        "clauses": LoadingClause::ALL.iter().map(clause).collect::<Vec<_>>(),
    });
    Ok(write_atomically(&last, |file| file.write_all(format!("{document:#}\n").as_bytes()))?)
}
