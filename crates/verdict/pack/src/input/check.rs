//! A loader's triangles against those of the input pack.

use std::path::Path;

use raypencil_files::{Array, Fault, FileError, Limits, file_sha256_hex, hex_digits, read_npy, sha256};

use crate::input::clause::LoadingClause;
use crate::input::ground::{InputFace, input_faces, input_glb};
use crate::input::write::{GROUND_NAME, INPUT_NAME, REFLECTIVITY_NAME, TRIANGLES_NAME};
use crate::manifest::pack_fault;

/// Largest difference of a reflectivity, tuned: weights of a luminance are rounded, those of coordinates are not.
const MAX_REFLECTIVITY_ERROR: f64 = 1e-6;

/// A face that a loader got wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WrongFace {
    /// Its number.
    pub face: usize,
    /// Corners and reflectivity as they are.
    pub truth: InputFace,
    /// The loader's corners; `None` if it gave too few faces.
    pub corners: Option<[[f64; 3]; 3]>,
    /// The loader's reflectivity, if that is what is wrong.
    pub reflectivity: Option<f64>,
}

/// A loader's answer, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct InputChecked {
    /// Name of the candidate: that of its folder.
    pub name: String,
    /// SHA-256 of the pack's `input.json`.
    pub pack_sha256: String,
    /// Number of faces that the file has.
    pub faces: usize,
    /// Number of faces that the loader gave.
    pub given: usize,
    /// Whether it gave reflectivities.
    pub has_reflectivity: bool,
    /// The wrong faces, by number.
    pub wrong: Vec<WrongFace>,
}

impl InputChecked {
    /// Whether all faces are right, and there are no more of them.
    pub fn passes(&self) -> bool {
        self.wrong.is_empty() && self.given == self.faces
    }

    /// Faces of a clause: all, and the wrong ones. Faces too many are wrong ones of the scene, which has none of its own.
    pub fn of(&self, clause: LoadingClause) -> (usize, usize) {
        if clause == LoadingClause::Scene {
            return (0, self.given.saturating_sub(self.faces));
        }
        let all = input_faces().iter().filter(|face| face.clause == clause).count();
        (all, self.wrong.iter().filter(|wrong| wrong.truth.clause == clause).count())
    }
}

/// Whether a folder is an input pack.
pub fn is_input_pack(folder: &Path) -> bool {
    folder.join(INPUT_NAME).is_file()
}

/// Checks a loader's `triangles.npy`, and `reflectivity.npy` if it is there, against an input pack.
///
/// Coordinates must be equal, since all of them are exact in single precision; the translations of
/// [`LoadingClause::Decimals`] are so only in double precision. Any corner of a face may be the first.
///
/// # Errors
/// A pack that is not the one of this version; an array that is missing, cannot be read or has another shape.
pub fn check_input(pack: &Path, candidate: &Path) -> Result<InputChecked, FileError> {
    verify(pack)?;
    let truth = input_faces();
    let path = candidate.join(TRIANGLES_NAME);
    let array = read_npy(&path, &Limits::default())?;
    let corners = rows::<9>(&array, &path)?;
    let path = candidate.join(REFLECTIVITY_NAME);
    let reflectivity = match path.exists() {
        true => Some(rows::<1>(&read_npy(&path, &Limits::default())?, &path)?),
        false => None,
    };
    if let Some(reflectivity) = reflectivity.as_ref().filter(|given| given.len() != corners.len()) {
        let found = format!("{} rows", reflectivity.len());
        let expected = format!("{}, as {TRIANGLES_NAME} has", corners.len());
        return Err(pack_fault(&path, Fault::new("shape", found, expected)));
    }
    let mut wrong = Vec::new();
    for (face, truth) in truth.iter().enumerate() {
        let said = corners
            .get(face)
            .map(|&[ax, ay, az, bx, by, bz, cx, cy, cz]| [[ax, ay, az], [bx, by, bz], [cx, cy, cz]]);
        let reflectivity = reflectivity.as_ref().and_then(|given| given.get(face)).map(|[one]| *one);
        let is_off = |given: f64| !((given - truth.reflectivity).abs() <= MAX_REFLECTIVITY_ERROR);
        let reflectivity = reflectivity.filter(|given| is_off(*given));
        if said.is_none_or(|said| !is_same_face(said, truth.corners)) || reflectivity.is_some() {
            wrong.push(WrongFace { face, truth: *truth, corners: said, reflectivity });
        }
    }
    let name = candidate.file_name().map_or_else(|| ".".into(), |name| name.to_string_lossy().into_owned());
    let listing = pack.join(INPUT_NAME);
    let (_, pack_sha256) =
        file_sha256_hex(&listing).map_err(|error| FileError::io(&listing, "read", error))?;
    Ok(InputChecked {
        name,
        pack_sha256,
        faces: truth.len(),
        given: corners.len(),
        has_reflectivity: reflectivity.is_some(),
        wrong,
    })
}

/// Whether two triangles have the same corners in the same turn.
fn is_same_face(said: [[f64; 3]; 3], truth: [[f64; 3]; 3]) -> bool {
    (0..3).any(|first| (0..3).all(|k| said[(first + k) % 3] == truth[k]))
}

/// Refuses a pack whose terrain or answers are not those of this version.
fn verify(pack: &Path) -> Result<(), FileError> {
    let path = pack.join(GROUND_NAME);
    let (_, found) = file_sha256_hex(&path).map_err(|error| FileError::io(&path, "read", error))?;
    let expected = hex_digits(&sha256(&input_glb()));
    if found != expected {
        let expected = format!("{expected}, as this version writes it");
        return Err(pack_fault(&path, Fault::new("SHA-256", found, expected)));
    }
    Ok(())
}

/// The rows of an array of real numbers with `N` columns.
fn rows<const N: usize>(array: &Array, path: &Path) -> Result<Vec<[f64; N]>, FileError> {
    let shape = array.planes.first().map_or((0, 0), |plane| plane.size());
    if array.planes.len() != 1 || shape.0 as usize != N {
        let found = format!("{} arrays of {} rows and {} columns", array.planes.len(), shape.1, shape.0);
        let expected = format!("one array with a row for each face, of {N} columns");
        return Err(pack_fault(path, Fault::new("shape", found, expected)));
    }
    let plane = &array.planes[0];
    let row = |row: usize| std::array::from_fn(|column| plane.real(row * N + column));
    Ok((0..shape.1 as usize).map(row).collect())
}
