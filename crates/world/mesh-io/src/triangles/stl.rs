//! STL to triangles, binary or text. (3D Systems, "StereoLithography Interface Specification", 1989)
//!
//! STL has no list of vertices: each face states its corners. CHOICE: corners with the same three numbers become one
//! vertex, the first of them, and -0 is the same number as +0. Vertices are in the order of their first appearance.
//! Normals and attributes are not read: the front of a face is where its corners are counter-clockwise.

use std::collections::HashMap;

use raypencil_files::Fault;

use crate::triangles::parts::{Parts, coordinate};
use crate::triangles::text::{Lines, number, quoted, without_mark, words};

/// Size of the header of a binary file: 80 bytes of any text, and the number of faces.
const HEADER_BYTES: usize = 84;

/// Size of a face of a binary file: a normal and three corners in single precision, and two bytes of attributes.
const FACE_BYTES: usize = 50;

pub(super) fn read(file: &[u8]) -> Result<Parts, Fault> {
    // A binary file may start with "solid" as well. It has bytes 0, which no text has but at its end: at least one is in its
    // number of faces, which would otherwise need more bytes than any file has.
    let text = without_mark(without_zeros(file));
    let starts_as_text = begins_as_text(text);
    // A header of text and a number of faces that is 0: no facet fits into a text of this length.
    let is_empty_binary = file.len() == HEADER_BYTES && claimed_faces(file) == Some(0);
    match starts_as_text && !text.contains(&0) && !is_empty_binary {
        true => read_text(text),
        false => read_binary(file),
    }
}

/// Whether a file begins with the word of a text.
pub(super) fn begins_as_text(file: &[u8]) -> bool {
    let text = without_mark(file).trim_ascii_start();
    text.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
}

/// A text without the bytes 0 that some programs write at its end.
fn without_zeros(file: &[u8]) -> &[u8] {
    let end = file.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
    &file[..end]
}

/// Whether a file is as long as its number of faces in the place of a binary file says.
pub(super) fn is_binary(file: &[u8]) -> bool {
    claimed_faces(file).is_some_and(|faces| claimed_bytes(faces) == file.len() as u64)
}

/// Number of faces that a binary file claims.
fn claimed_faces(file: &[u8]) -> Option<u32> {
    Some(u32::from_le_bytes(*file.get(80..)?.first_chunk()?))
}

/// Length of a binary file of so many faces.
fn claimed_bytes(faces: u32) -> u64 {
    HEADER_BYTES as u64 + FACE_BYTES as u64 * u64::from(faces)
}

/// Where each face of a binary file begins. Its last two bytes count the bytes of its attributes. They are zero, or a colour;
/// some programs do put attributes between the faces. Then, and only then, the file is as long as all counts say.
fn face_starts(file: &[u8], claimed: u32) -> Result<Vec<usize>, Fault> {
    let needed = claimed_bytes(claimed);
    let length = file.len() as u64;
    // CHOICE: less than a face may follow, or bytes 0, by which programs fill up blocks. Other bytes are refused: the number of
    // faces does not belong to them.
    let rest = usize::try_from(needed).ok().and_then(|needed| file.get(needed..));
    let is_filled =
        |rest: &[u8]| rest.len() < FACE_BYTES || (claimed > 0 && rest.iter().all(|&byte| byte == 0));
    let with_attributes = || {
        let (mut starts, mut at) = (Vec::new(), HEADER_BYTES);
        for _ in 0..claimed {
            let count = file.get(at + FACE_BYTES - 2..at + FACE_BYTES)?;
            starts.push(at);
            at += FACE_BYTES + usize::from(u16::from_le_bytes([count[0], count[1]]));
        }
        (at == file.len()).then_some(starts)
    };
    let plain = || (0..claimed as usize).map(|face| HEADER_BYTES + FACE_BYTES * face).collect();
    match rest {
        Some([]) => Ok(plain()),
        Some(rest) => match with_attributes() {
            Some(starts) => Ok(starts),
            None if is_filled(rest) => Ok(plain()),
            None => {
                let found = format!("{claimed} faces, and {} bytes behind them", rest.len());
                let expected = format!(
                    "{} faces, if all bytes are faces (is the number of faces right?)",
                    (length - HEADER_BYTES as u64) / FACE_BYTES as u64
                );
                Err(Fault::new("byte 80", found, expected))
            }
        },
        None => {
            let found = format!("{claimed} faces in a file of {length} bytes");
            Err(Fault::new("byte 80", found, format!("a file of {needed} bytes (is it cut off?)")))
        }
    }
}

fn read_binary(file: &[u8]) -> Result<Parts, Fault> {
    let Some(claimed) = claimed_faces(file) else {
        let found = format!("{} bytes", file.len());
        let expected = "a text that starts with `solid`, or the 84 bytes of a binary header";
        return Err(Fault::new("header", found, expected));
    };
    let mut corners = Corners::default();
    for (face, start) in face_starts(file, claimed)?.into_iter().enumerate() {
        let bytes = &file[start..start + FACE_BYTES];
        let mut indices = [0; 3];
        for (corner, index) in indices.iter_mut().enumerate() {
            let mut vertex = [0.0; 3];
            for (axis, coordinate_of_corner) in vertex.iter_mut().enumerate() {
                // The normal comes first.
                let at = 12 + 12 * corner + 4 * axis;
                let number = f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
                let place = || format!("byte {}, face {face}", start + at);
                *coordinate_of_corner = coordinate(number.into(), place)?;
            }
            *index = corners.index(vertex);
        }
        corners.parts.add_polygon(&indices);
    }
    Ok(corners.parts)
}

fn read_text(file: &[u8]) -> Result<Parts, Fault> {
    let mut corners = Corners::default();
    let mut text = Text { lines: Lines::new(file, 1), line: 1, rest: &[] };
    // A file may have several solids.
    while let Some(word) = text.next() {
        text.check(Some(word), &["solid"])?;
        text.rest = &[];
        loop {
            let word = text.next();
            // Some programs write the end in two words.
            let is_end = word.is_some_and(|word| word.eq_ignore_ascii_case(b"end"));
            if is_end {
                text.expect("solid")?;
            }
            if is_end || text.check(word, &["facet", "endsolid"])? == "endsolid" {
                text.rest = &[];
                break;
            }
            text.expect("normal")?;
            // Programs write anything for the normal of a face without area.
            for _ in 0..3 {
                text.next();
            }
            text.expect("outer")?;
            text.expect("loop")?;
            let mut indices = [0; 3];
            for index in &mut indices {
                text.expect("vertex")?;
                let mut vertex = [0.0; 3];
                for part in &mut vertex {
                    let word = text.next();
                    let face = corners.parts.polygon_count();
                    let place = || format!("line {}, face {face}", text.line);
                    *part = coordinate(number(word, place)?, place)?;
                }
                *index = corners.index(vertex);
            }
            text.expect("endloop")?;
            text.expect("endfacet")?;
            corners.parts.add_polygon(&indices);
        }
    }
    Ok(corners.parts)
}

/// Words of a text file, across its lines.
struct Text<'a> {
    lines: Lines<'a>,
    /// Number of the line with the last word.
    line: usize,
    rest: &'a [u8],
}

impl<'a> Text<'a> {
    fn next(&mut self) -> Option<&'a [u8]> {
        loop {
            if let Some(word) = words(self.rest).next() {
                let rest = self.rest.trim_ascii_start();
                self.rest = &rest[word.len()..];
                return Some(word);
            }
            (self.line, self.rest) = self.lines.next()?;
        }
    }

    /// Takes the next word, which must be a certain one.
    fn expect(&mut self, wanted: &'static str) -> Result<(), Fault> {
        let word = self.next();
        self.check(word, &[wanted]).map(drop)
    }

    /// Which of the wanted words a word is, in letters of either case.
    fn check(&self, word: Option<&[u8]>, wanted: &[&'static str]) -> Result<&'static str, Fault> {
        let is =
            |wanted: &&&'static str| word.is_some_and(|word| word.eq_ignore_ascii_case(wanted.as_bytes()));
        wanted.iter().find(is).copied().ok_or_else(|| {
            let found = word.map_or("the end of the file".to_string(), |word| quoted(Some(word)));
            Fault::new(format!("line {}", self.line), found, format!("`{}`", wanted.join("` or `")))
        })
    }
}

/// Faces whose equal corners become one vertex.
#[derive(Default)]
struct Corners {
    parts: Parts,
    /// Index of each vertex by the bits of its coordinates.
    known: HashMap<[u64; 3], u32>,
}

impl Corners {
    fn index(&mut self, vertex: [f64; 3]) -> u32 {
        // -0 + 0 is +0; every other number stays what it is.
        let bits = vertex.map(|coordinate| (coordinate + 0.0).to_bits());
        // At most one vertex for 12 bytes of a file of 1 GiB.
        let next = self.parts.vertices.len() as u32;
        *self.known.entry(bits).or_insert_with(|| {
            self.parts.vertices.push(vertex);
            next
        })
    }
}
