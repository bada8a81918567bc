//! Rays from NPY arrays and from CSV.

use std::path::Path;

use glam::DVec3;
use raypencil_scene::CastRay;

use crate::bytes;
use crate::error::{Fault, FileError};
use crate::limits::Limits;
use crate::npy::npy_numbers_from_bytes;

/// Rays with the shape of the array that they come from.
#[derive(Debug, Clone, PartialEq)]
pub struct RayArray {
    /// The leading dimensions: that of an array (480, 640, 6) is (480, 640); that of a CSV file is its number of rows.
    pub shape: Vec<u64>,
    /// The rays, the last dimension running fastest.
    pub rays: Vec<CastRay>,
}

/// First bytes of every NPY file.
const NPY_MAGIC: &[u8] = b"\x93NUMPY";

/// What a row of numbers must be.
const ROW: &str = "6 numbers (origin, direction), 8 (origin, direction, t_min, t_max) or 9 (with t_blind)";

/// Reads rays from a file: NPY of shape (..., 6), (..., 8) or (..., 9), or CSV with 6, 8 or 9 numbers in a row.
///
/// # Errors
/// Names the file, and the number, row or ray that is wrong.
pub fn read_rays(path: &Path) -> Result<RayArray, FileError> {
    // The header of an NPY file comes on top of its numbers, at most 2^16 bytes.
    let most = Limits::default().bytes + (1 << 16);
    let bytes = bytes::read_file(path, most).map_err(|error| FileError::io(path, "read", error))?;
    rays_from_bytes(&bytes, path)
}

/// Reads the bytes of a file as [`read_rays`] does; `file` is its name in messages.
///
/// # Errors
/// As [`read_rays`].
pub fn rays_from_bytes(bytes: &[u8], file: &Path) -> Result<RayArray, FileError> {
    let (shape, width, numbers) = match bytes.starts_with(NPY_MAGIC) {
        true => of_npy(bytes, file)?,
        false => of_csv(bytes).map_err(|fault| FileError::Array(fault.in_file(file)))?,
    };
    let rays = numbers.chunks_exact(width).enumerate().map(|(index, row)| {
        let ray = ray(row);
        let checked = ray.validate("").or_else(|_| ray.validate(&format!("ray {index}")));
        checked.map_err(|source| FileError::Scene { origin: file.display().to_string(), source })?;
        Ok(ray)
    });
    Ok(RayArray { shape, rays: rays.collect::<Result<_, FileError>>()? })
}

/// A ray from its 6, 8 or 9 numbers.
fn ray(row: &[f64]) -> CastRay {
    let ray = CastRay::new(DVec3::from_slice(row), DVec3::from_slice(&row[3..]));
    match row[6..] {
        [t_min, t_max] => CastRay { t_min, t_max, ..ray },
        [t_min, t_max, t_blind] => CastRay { t_min, t_max, t_blind, ..ray },
        _ => ray,
    }
}

/// The numbers of rays as rows of a file, and how many a row has: 8, or 9 if a ray of them has a `t_blind`.
///
/// ```
/// use glam::DVec3;
/// use raypencil_files::ray_rows;
/// use raypencil_scene::CastRay;
///
/// let ray = CastRay::new(DVec3::ZERO, DVec3::X);
/// assert_eq!(ray_rows(&[ray]), (8, vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, f64::INFINITY]));
/// assert_eq!(ray_rows(&[ray, CastRay { t_blind: 0.5, ..ray }]).1[8..], [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, f64::INFINITY, 0.5]);
/// ```
pub fn ray_rows(rays: &[CastRay]) -> (usize, Vec<f64>) {
    let width = if rays.iter().any(|ray| ray.t_blind > 0.0) { 9 } else { 8 };
    let row = |ray: &CastRay| {
        let ([ox, oy, oz], [dx, dy, dz]) = (ray.origin.to_array(), ray.direction.to_array());
        [ox, oy, oz, dx, dy, dz, ray.t_min, ray.t_max, ray.t_blind].into_iter().take(width)
    };
    (width, rays.iter().flat_map(row).collect())
}

type Table = (Vec<u64>, usize, Vec<f64>);

fn of_npy(bytes: &[u8], file: &Path) -> Result<Table, FileError> {
    let array = npy_numbers_from_bytes(bytes, file)?;
    match array.shape.split_last() {
        Some((&width @ (6 | 8 | 9), leading)) => Ok((leading.to_vec(), width as usize, array.values)),
        _ => {
            let fault = Fault::new(
                "shape",
                format!("{:?}", array.shape),
                format!("(..., 6), (..., 8) or (..., 9): {ROW}"),
            );
            Err(FileError::Array(fault.in_file(file)))
        }
    }
}

/// The line on which a record stands, whose position is where the reader began to look for it: before comments and empty lines.
fn line_of(bytes: &[u8], start: &csv::Position) -> u64 {
    let rest = bytes.get(start.byte() as usize..).unwrap_or_default();
    let is_skipped = |line: &&[u8]| line.starts_with(b"#") || line.trim_ascii().is_empty();
    start.line() + rest.split(|byte| *byte == b'\n').take_while(is_skipped).count() as u64
}

fn of_csv(bytes: &[u8]) -> Result<Table, Fault> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(bytes);
    let (mut width, mut rows, mut numbers) = (None, 0_u64, Vec::new());
    for record in reader.records() {
        let record = record.map_err(|error| {
            let line = error.position().map_or(0, csv::Position::line);
            Fault::new(
                format!("line {line}"),
                "bytes that are no text",
                "rows of numbers with commas between them",
            )
        })?;
        let line = record.position().map_or(0, |start| line_of(bytes, start));
        // Numbers with something else than commas between them are no names of columns.
        let is_number = |word: &str| word.parse::<f64>().is_ok();
        let has_number = |field: &str| field.split(|c: char| c == ';' || c.is_whitespace()).any(is_number);
        let is_heading = rows == 0 && !record.iter().any(has_number);
        if is_heading && record.iter().any(|field| !field.is_empty()) && width.is_none() {
            width = Some((record.len(), line));
            // The heading must fit what follows.
            continue;
        }
        let refuse =
            |found: String, expected: String| Err(Fault::new(format!("line {line}"), found, expected));
        if !matches!(record.len(), 6 | 8 | 9) {
            let found = match record.len() {
                1 if has_number(&record[0]) => "no comma between its numbers".into(),
                count => format!("{count} fields"),
            };
            return refuse(found, ROW.into());
        }
        if let Some((first, of_line)) = width
            && first != record.len()
        {
            return refuse(format!("{} fields", record.len()), format!("{first}, as line {of_line} has"));
        }
        width.get_or_insert((record.len(), line));
        for (column, field) in record.iter().enumerate() {
            match field.parse::<f64>() {
                Ok(number) => numbers.push(number),
                Err(_) => return refuse(format!("field {}: {field:?}", column + 1), "a number".into()),
            }
        }
        rows += 1;
    }
    let Some((width, _)) = width.filter(|_| rows > 0) else {
        return Err(Fault::new("file", "no ray", format!("rows of {ROW}")));
    };
    Ok((vec![rows], width, numbers))
}
