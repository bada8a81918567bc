//! OBJ to triangles: the statements `v` and `f`. (Wavefront, "Object Files", version 3.0)
//!
//! Every statement starts with a word; those that are not read are not looked at, since programs add their own.

use raypencil_files::Fault;

use crate::triangles::parts::{Parts, coordinate};
use crate::triangles::text::{Lines, number, quoted, without_mark};

/// Statements of other words that are told of a file without faces, at most.
const MAX_TOLD_WORDS: usize = 4;

/// Reads the vertices and the faces of a file.
pub(super) fn read(file: &[u8]) -> Result<Parts, Fault> {
    let file = without_mark(file);
    // Otherwise any file whose lines start with letters would be an empty mesh.
    if let Some(at) = file.iter().position(|&byte| byte == 0) {
        return Err(Fault::new(format!("byte {at}"), "a byte 0", "a text"));
    }
    let mut parts = Parts::default();
    let mut corners = Vec::new();
    let mut greatest = None;
    let mut others: Vec<&[u8]> = Vec::new();
    for (line, statement) in Lines::joined_by_backslash(file) {
        let mut words = words(statement);
        let Some(keyword) = words.next() else { continue };
        match keyword {
            b"v" => {
                let vertex = parts.vertices.len() + 1;
                let mut axis = |name: &str| {
                    let place = || format!("line {line}, {name} of vertex {vertex}");
                    coordinate(number(words.next(), place)?, place)
                };
                // A weight or a colour may follow.
                let vertex = [axis("x")?, axis("y")?, axis("z")?];
                parts.vertices.push(vertex);
            }
            // `fo`, face outline, is how version 2 wrote faces.
            b"f" | b"fo" => {
                corners.clear();
                for word in words {
                    let corner = corner(word, line, parts.vertices.len())?;
                    // A face may stand before its vertices: whether they exist is known at the end.
                    greatest = greatest.max(Some((corner, std::cmp::Reverse(line))));
                    corners.push(corner);
                }
                if corners.len() < 3 {
                    let place = format!("line {line}, polygon {}", parts.polygon_count());
                    return Err(Fault::new(place, format!("{} corners", corners.len()), "3 or more"));
                }
                parts.add_polygon(&corners);
            }
            _ if !keyword[0].is_ascii_alphabetic() => {
                let expected = "a statement that starts with a letter, like `v 0 0 0`";
                return Err(Fault::new(format!("line {line}"), quoted(Some(keyword)), expected));
            }
            other => {
                if others.len() < MAX_TOLD_WORDS && !others.contains(&other) {
                    others.push(other);
                }
            }
        }
    }
    if !others.is_empty() {
        let words: Vec<String> = others.into_iter().map(|word| quoted(Some(word))).collect();
        parts.others = format!("its lines begin with {}", words.join(", "));
    }
    match (greatest, parts.vertices.len()) {
        (Some((corner, std::cmp::Reverse(line))), count) if corner as usize >= count => {
            let found = format!("vertex {}", u64::from(corner) + 1);
            Err(Fault::new(format!("line {line}"), found, format!("1 to {count}, the vertices of the file")))
        }
        _ => Ok(parts),
    }
}

/// Whether a file, whatever its name, is one of this format with a face.
pub(super) fn is_like(file: &[u8]) -> bool {
    read(file).is_ok_and(|parts| parts.polygon_count() > 0)
}

/// The line of a polygon, counted from 0 among the polygons of a file that [`read`] has read.
pub(super) fn line_of_polygon(file: &[u8], polygon: u32) -> Option<usize> {
    let is_polygon = |(_, statement): &(usize, &[u8])| matches!(words(statement).next(), Some(b"f" | b"fo"));
    let mut polygons = Lines::joined_by_backslash(without_mark(file)).filter(is_polygon);
    polygons.nth(polygon as usize).map(|(line, _)| line)
}

/// Words of a statement. A backslash joins lines, and has no other meaning in the statements that are read.
fn words(statement: &[u8]) -> impl Iterator<Item = &[u8]> {
    let words = statement.split(|byte| byte.is_ascii_whitespace() || *byte == b'\\');
    words.filter(|word| !word.is_empty()).take_while(|word| !word.starts_with(b"#"))
}

/// Vertex index of `v`, `v/vt`, `v//vn` or `v/vt/vn`, from 0. `vertices` is the number of vertices so far, from which
/// negative numbers count backwards.
fn corner(word: &[u8], line: usize, vertices: usize) -> Result<u32, Fault> {
    let unfit = |found: String, expected: String| Fault::new(format!("line {line}"), found, expected);
    let mut numbers = word.split(|&byte| byte == b'/');
    let vertex = numbers.next().and_then(|text| std::str::from_utf8(text).ok()?.parse::<i64>().ok());
    let is_number = |text: &[u8]| text.iter().all(|byte| byte.is_ascii_digit() || *byte == b'-');
    let (Some(vertex), true) = (vertex, numbers.clone().count() <= 2 && numbers.all(is_number)) else {
        return Err(unfit(quoted(Some(word)), "a corner: v, v/vt, v//vn or v/vt/vn".into()));
    };
    let index = match vertex {
        1.. => Some(vertex - 1),
        0 => None,
        // Files are far below 2^63 vertices.
        _ => Some(vertices as i64 + vertex).filter(|&index| index >= 0),
    };
    let expected = || match vertex {
        ..0 => format!("-{vertices} to -1, the vertices so far"),
        _ => "vertices count from 1, backwards from -1".to_string(),
    };
    index
        .and_then(|index| u32::try_from(index).ok())
        .ok_or_else(|| unfit(format!("vertex {vertex}"), expected()))
}
