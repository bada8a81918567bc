//! Rays from NPY arrays and from CSV.

use std::path::Path;

use glam::DVec3;
use raypencil_scene::CastRay;

use crate::bytes;
use crate::comment_heading::heading_in_comment;
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

/// Names of the numbers of a ray, in their order.
const NAMES: [&str; 9] = ["ox", "oy", "oz", "dx", "dy", "dz", "t_min", "t_max", "t_blind"];

/// How many of them each ray must have.
const MIN_NAMES: usize = 6;

/// Reads rays from a file: NPY of shape (..., 6), (..., 8) or (..., 9), or CSV with 6, 8 or 9 numbers in a row, or with columns named by a
/// heading: `ox`, `oy`, `oz`, `dx`, `dy`, `dz` and if wanted `t_min`, `t_max`, `t_blind`, in any order.
///
/// # Errors
/// Names the file, and the number, line or ray that is wrong; a file without a ray.
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
    match bytes.starts_with(NPY_MAGIC) {
        true => of_npy(bytes, file),
        false => of_csv(bytes, file),
    }
}

/// A ray from its 6, 8 or 9 numbers, if they are valid. `line` is where it stands, if that is known.
fn checked(row: &[f64], index: usize, (file, line): (&Path, Option<u64>)) -> Result<CastRay, FileError> {
    let ray = ray(row);
    let checked = ray.validate("").or_else(|_| ray.validate(&format!("ray {index}")));
    let origin = || match line {
        Some(line) => format!("{}: line {line}", file.display()),
        None => file.display().to_string(),
    };
    checked.map_err(|source| FileError::Scene { origin: origin(), source })?;
    Ok(ray)
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

fn of_npy(bytes: &[u8], file: &Path) -> Result<RayArray, FileError> {
    let array = npy_numbers_from_bytes(bytes, file)?;
    let refuse = |expected: String| {
        let fault = Fault::new("shape", format!("{:?}", array.shape), expected);
        Err(FileError::Array(fault.in_file(file)))
    };
    let Some((&width @ (6 | 8 | 9), leading)) = array.shape.split_last() else {
        return refuse(format!("(..., 6), (..., 8) or (..., 9): {ROW}"));
    };
    if array.values.is_empty() {
        return refuse("one ray or more".into());
    }
    let rows = array.values.chunks_exact(width as usize).enumerate();
    let rays = rows.map(|(index, row)| checked(row, index, (file, None)));
    Ok(RayArray { shape: leading.to_vec(), rays: rays.collect::<Result<_, _>>()? })
}

/// The line on which a record stands, whose position is where the reader began to look for it: before comments and empty lines.
fn line_of(bytes: &[u8], start: &csv::Position) -> u64 {
    let rest = bytes.get(start.byte() as usize..).unwrap_or_default();
    let is_skipped = |line: &&[u8]| line.starts_with(b"#") || line.trim_ascii().is_empty();
    start.line() + rest.split(|byte| *byte == b'\n').take_while(is_skipped).count() as u64
}

/// The heading of a CSV file: for each of its columns the place of its number in a ray.
struct Heading {
    line: u64,
    places: Vec<usize>,
}

impl Heading {
    fn of<'a>(fields: impl Iterator<Item = &'a str>, line: u64) -> Result<Self, Fault> {
        let refuse = |found: String| {
            let (needed, wanted) = NAMES.split_at(MIN_NAMES);
            let expected = format!(
                "a heading of the names {}, and if wanted {}, in any order with commas between them",
                needed.join(","),
                wanted.join(",")
            );
            Fault::new(format!("line {line}"), found, expected)
        };
        let mut places = Vec::new();
        for field in fields {
            let place = NAMES.iter().position(|name| field.eq_ignore_ascii_case(name));
            match place.ok_or_else(|| refuse(format!("{field:?}")))? {
                place if places.contains(&place) => return Err(refuse(format!("{} twice", NAMES[place]))),
                place => places.push(place),
            }
        }
        match (0..MIN_NAMES).find(|place| !places.contains(place)) {
            Some(place) => Err(refuse(format!("no {}", NAMES[place]))),
            None => Ok(Self { line, places }),
        }
    }

    /// The heading in the comments before the first line of numbers, as NumPy's `savetxt` writes it. Other comments are none; but one
    /// that is meant as a heading must be one.
    fn of_comments(bytes: &[u8]) -> Result<Option<Self>, Fault> {
        let before = numbered_lines(bytes).take_while(|(line, _)| is_no_row(line));
        before.filter_map(Self::of_comment).last().transpose()
    }

    /// The heading in a comment, with the number of its line; `None`: it is none.
    fn of_comment((line, number): (&[u8], u64)) -> Option<Result<Self, Fault>> {
        let is_name = |word: &str| NAMES.iter().any(|name| word.eq_ignore_ascii_case(name));
        let line = std::str::from_utf8(line).ok().filter(|line| line.starts_with('#'))?;
        let words = heading_in_comment(line, MIN_NAMES..=NAMES.len(), is_name)?;
        Some(Self::of(words.iter().map(String::as_str), number))
    }

    /// Refuses a heading between rows, as files have that were joined, if it names other columns than these.
    fn check_others(bytes: &[u8], places: &[usize]) -> Result<(), Fault> {
        let after = numbered_lines(bytes).skip_while(|(line, _)| is_no_row(line));
        for other in after.filter_map(Self::of_comment) {
            let other = other?;
            if other.places != places {
                let names =
                    |places: &[usize]| places.iter().map(|&place| NAMES[place]).collect::<Vec<_>>().join(",");
                let found = format!("a heading of other columns, {}", names(&other.places));
                let expected = format!(
                    "{}, as the rows before it (files that were joined are to be read one by one)",
                    names(places)
                );
                return Err(Fault::new(format!("line {}", other.line), found, expected));
            }
        }
        Ok(())
    }

    /// The numbers of a ray from those of a row; what has no column is left at what it is without.
    fn row(&self, numbers: &[f64]) -> [f64; 9] {
        let mut row = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, f64::INFINITY, 0.0];
        self.places.iter().zip(numbers).for_each(|(place, number)| row[*place] = *number);
        row
    }
}

/// The lines of a text with their numbers.
fn numbered_lines(bytes: &[u8]) -> impl Iterator<Item = (&[u8], u64)> {
    bytes.split(|byte| *byte == b'\n').zip(1..)
}

/// Whether a line is a comment or empty.
fn is_no_row(line: &[u8]) -> bool {
    line.starts_with(b"#") || line.trim_ascii().is_empty()
}

fn of_csv(bytes: &[u8], file: &Path) -> Result<RayArray, FileError> {
    let in_file = |fault: Fault| FileError::Array(fault.in_file(file));
    // The mark that some editors put before a text in UTF-8.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(bytes);
    let mut heading = Heading::of_comments(bytes).map_err(in_file)?;
    let mut width = heading.as_ref().map(|heading| (heading.places.len(), heading.line));
    let (mut rays, mut numbers, mut is_first) = (Vec::new(), Vec::new(), true);
    for record in reader.records() {
        let record = record.map_err(|error| {
            let line = error.position().map_or(0, csv::Position::line);
            let expected = "rows of numbers with commas between them";
            in_file(Fault::new(format!("line {line}"), "bytes that are no text", expected))
        })?;
        let line = record.position().map_or(0, |start| line_of(bytes, start));
        // Numbers with something else than commas between them are no names of columns.
        let is_number = |word: &str| word.parse::<f64>().is_ok();
        let has_number = |field: &str| field.split(|c: char| c == ';' || c.is_whitespace()).any(is_number);
        let is_heading = std::mem::take(&mut is_first) && !record.iter().any(has_number);
        if is_heading && record.iter().any(|field| !field.is_empty()) {
            let of_line = Heading::of(record.iter(), line).map_err(in_file)?;
            width = Some((of_line.places.len(), line));
            heading = Some(of_line);
            continue;
        }
        let refuse = |found: String, expected: String| {
            Err(in_file(Fault::new(format!("line {line}"), found, expected)))
        };
        if heading.is_none() && !matches!(record.len(), 6 | 8 | 9) {
            let found = match record.len() {
                1 if has_number(&record[0]) => "no comma between its numbers".into(),
                count => format!("{count} fields"),
            };
            return refuse(found, ROW.into());
        }
        if record.len() == 1 && has_number(&record[0]) && record[0].parse::<f64>().is_err() {
            return refuse("no comma between its numbers".into(), ROW.into());
        }
        if let Some((first, of_line)) = width
            && first != record.len()
        {
            return refuse(format!("{} fields", record.len()), format!("{first}, as line {of_line} has"));
        }
        width.get_or_insert((record.len(), line));
        numbers.clear();
        for (column, field) in record.iter().enumerate() {
            match field.parse::<f64>() {
                Ok(number) => numbers.push(number),
                Err(_) => return refuse(format!("field {}: {field:?}", column + 1), "a number".into()),
            }
        }
        let place = (file, Some(line));
        rays.push(match &heading {
            Some(heading) => checked(&heading.row(&numbers), rays.len(), place)?,
            None => checked(&numbers, rays.len(), place)?,
        });
    }
    if rays.is_empty() {
        return Err(in_file(Fault::new("file", "no ray", format!("rows of {ROW}"))));
    }
    let of_numbers: Vec<usize> = (0..numbers.len()).collect();
    let places = heading.as_ref().map_or(&of_numbers, |heading| &heading.places);
    Heading::check_others(bytes, places).map_err(in_file)?;
    Ok(RayArray { shape: vec![rays.len() as u64], rays })
}
