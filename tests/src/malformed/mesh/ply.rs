//! Malformed PLY, text and binary. (Greg Turk, 1994)

use super::{WRONG_NUMBERS, terrain};
use crate::malformed::bytes::cuts;
use crate::malformed::case::Case;

/// A triangle as text.
const TEXT: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
    property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
    -9 -9 0\n9 -9 0\n9 9 0\n3 0 1 2\n";

/// Names of the binary formats.
const BINARY: [(&str, bool); 2] = [("binary_little_endian", false), ("binary_big_endian", true)];

/// The triangle as text, with texts replaced.
pub(super) fn with(changes: &[(&str, &str)]) -> Vec<u8> {
    changes
        .iter()
        .fold(TEXT.to_string(), |text, (from, to)| {
            assert!(text.contains(from), "{from}");
            text.replacen(from, to, 1)
        })
        .into_bytes()
}

/// The header of a binary file, with texts replaced, and its numbers: three vertices and a list of three indices.
fn binary(format: &str, is_big: bool, changes: &[(&str, &str)], list: &[u8], indices: &[i32]) -> Vec<u8> {
    let text = String::from_utf8(with(&[&[("ascii", format)], changes].concat())).expect("a text");
    let header = text.find("end_header\n").expect("its end") + "end_header\n".len();
    let mut bytes = text.as_bytes()[..header].to_vec();
    let mut word = |number: u32| {
        bytes.extend(if is_big { number.to_be_bytes() } else { number.to_le_bytes() });
    };
    for coordinate in [-9.0_f32, -9.0, 0.0, 9.0, -9.0, 0.0, 9.0, 9.0, 0.0] {
        word(coordinate.to_bits());
    }
    let mut indices_as_bytes = Vec::new();
    for index in indices {
        indices_as_bytes.extend(if is_big { index.to_be_bytes() } else { index.to_le_bytes() });
    }
    bytes.extend(list);
    bytes.extend(indices_as_bytes);
    bytes
}

pub(super) fn cases() -> Vec<Case> {
    [headers(), counts(), rows(), binaries(), cut()].concat()
}

fn case(name: &str, what: &'static str, place: &str, bytes: impl Into<Vec<u8>>) -> Case {
    terrain("ply", name, what, place, bytes)
}

/// Wrong headers.
fn headers() -> Vec<Case> {
    let one =
        |name: &str, what, place: &str, from: &str, to: &str| case(name, what, place, with(&[(from, to)]));
    vec![
        case("empty", "an empty file", "line 1", ""),
        case("words", "plain text of another kind", "line 1", "Dear rover,\n"),
        case("magic", "the first word alone", "line 1", "ply"),
        one("format-2", "version 2.0", "line 2", "ascii 1.0", "ascii 2.0"),
        one("format-unknown", "an unknown format", "line 2", "ascii", "utf8"),
        one("format-twice", "two formats", "line 3", "element vertex", "format ascii 1.0\nelement vertex"),
        one("format-none", "no format", "header", "format ascii 1.0\n", ""),
        one("vertex-none", "no vertices", "header", "element vertex", "element point"),
        one("vertex-twice", "vertices twice", "line 7", "element face", "element vertex"),
        one("face-none", "no faces", "no triangles", "element face", "element edge"),
        one("strips", "strips in place of faces", "header", "element face", "element tristrips"),
        one(
            "property-first",
            "a property before all elements",
            "line 3",
            "element vertex 3",
            "property int a",
        ),
        one("property-twice", "a property twice", "line 5", "float y", "float x"),
        one("property-type", "an unknown type", "line 4", "float x", "half x"),
        one("property-nameless", "a property without a name", "line 4", "float x", "float"),
        one("list-real-length", "a list whose length is a real number", "line 8", "list uchar", "list float"),
        one(
            "list-real-index",
            "vertices that are real numbers",
            "element `face`",
            "uchar int",
            "uchar float",
        ),
        one("list-of-list", "a list of lists", "line 8", "list uchar int", "list list uchar int"),
        one("list-no-name", "a list without a name", "line 8", "int vertex_indices", "int"),
        one("list-missing", "faces without corners", "element `face`", "vertex_indices", "corners"),
        one("list-twice", "two lists of corners", "element `face`", "end_header", {
            "property list uchar int vertex_index\nend_header"
        }),
        one("x-none", "vertices without x", "element `vertex`", "float x", "float w"),
        one("x-list", "a list of x", "element `vertex`", "float x", "list uchar float x"),
        one("element-nameless", "an element without a name", "line 3", "element vertex 3", "element"),
        one("keyword", "an unknown line", "line 3", "element vertex", "elements vertex"),
        one("control", "the code that clears a terminal", "line 3", "element vertex", "\u{1b}[2J"),
        one("end-none", "a header without an end", "line ", "end_header", "comment"),
        case("endless-comment", "a comment of two megabytes", "line 3", {
            format!("ply\nformat ascii 1.0\ncomment {}", "x".repeat(2 << 20))
        }),
        case("endless-comments", "two hundred thousand comments", "line ", {
            format!("ply\nformat ascii 1.0\n{}", "comment\n".repeat(200_000))
        }),
        case("endless-elements", "a hundred thousand elements", "elements", {
            let elements: String = (0..100_000).map(|k| format!("element e{k} 0\n")).collect();
            with(&[("element vertex", &format!("{elements}element vertex"))])
        }),
        case("endless-properties", "a hundred thousand properties", "properties", {
            let properties: String = (0..100_000).map(|k| format!("property float p{k}\n")).collect();
            with(&[("property float x", &format!("{properties}property float x"))])
        }),
        case("line-ends", "lines that end in another way than the first", "line 2", {
            String::from_utf8(with(&[("ply\n", "ply\r")])).expect("a text")
        }),
    ]
}

/// Counts that the file does not have.
fn counts() -> Vec<Case> {
    let mut cases = Vec::new();
    for (format, is_big) in [("ascii", false)].into_iter().chain(BINARY) {
        let counts = [
            ("4", "one more"),
            ("65536", "2^16"),
            ("4294967295", "2^32 - 1"),
            ("4294967296", "2^32"),
            ("18446744073709551615", "2^64 - 1"),
        ];
        for (count, _) in counts {
            for (element, old) in [("vertex", "element vertex 3"), ("face", "element face 1")] {
                let new = format!("element {element} {count}");
                let bytes = match format {
                    "ascii" => with(&[(old, &new)]),
                    _ => binary(format, is_big, &[(old, &new)], &[3], &[0, 1, 2]),
                };
                // A text has room for one more vertex by its lengths: the rows run out later.
                let place = if count == "4" { "ground.ply" } else { "element `" };
                let what = "a count that the file has no bytes for";
                cases.push(case(&format!("{format}-{element}-{count}"), what, place, bytes));
            }
        }
        for (name, what, count) in [
            ("negative", "a negative count", "-3"),
            ("real", "a count of 3.5", "3.5"),
            ("beyond", "a count of 2^64", "18446744073709551616"),
            ("word", "a word in place of a count", "many"),
        ] {
            let new = format!("element vertex {count}");
            let bytes = match format {
                "ascii" => with(&[("element vertex 3", &new)]),
                _ => binary(format, is_big, &[("element vertex 3", &new)], &[3], &[0, 1, 2]),
            };
            cases.push(case(&format!("{format}-count-{name}"), what, "line 3", bytes));
        }
    }
    cases.push(case(
        "rows-of-nothing",
        "2^64 - 1 rows without numbers",
        "element `a`",
        with(&[("element vertex", "element a 18446744073709551615\nelement vertex")]),
    ));
    cases.push(case("no-faces", "no faces", "no triangles", {
        with(&[("element face 1", "element face 0"), ("3 0 1 2\n", "")])
    }));
    cases
}

/// Wrong rows of a text.
fn rows() -> Vec<Case> {
    let mut cases: Vec<Case> = WRONG_NUMBERS
        .iter()
        .map(|(name, what, number)| {
            let bytes = with(&[("\n9 -9 0", &format!("\n{number} -9 0"))]);
            case(&format!("text-{name}"), what, "line 11", bytes)
        })
        .collect();
    let faces = [
        ("index-3", "a vertex past the last", "3 0 1 3"),
        ("index-negative", "a negative vertex", "3 0 1 -1"),
        ("index-2-32", "a vertex of 2^32", "3 0 1 4294967296"),
        ("index-2-63", "a vertex of 2^63", "3 0 1 9223372036854775808"),
        ("index-real", "a vertex of 1.0", "3 0 1.0 2"),
        ("corners-0", "a polygon of no corners", "0"),
        ("corners-2", "a polygon of two corners", "2 0 1"),
        ("corners-negative", "a polygon of -3 corners", "-3 0 1 2"),
        ("corners-more", "a polygon of more corners than its line has", "4 0 1 2"),
        ("corners-fewer", "a polygon of fewer corners than its line has", "3 0 1 2 0"),
        ("corners-top", "a polygon of 2^63 - 1 corners", "9223372036854775807 0 1 2"),
        ("corners-nan", "a number of corners that is not a number", "nan 0 1 2"),
    ];
    for (name, what, face) in faces {
        cases.push(case(&format!("text-{name}"), what, "line 13", with(&[("3 0 1 2", face)])));
    }
    cases.extend([
        case("text-row-short", "a vertex of two numbers", "line 11", with(&[("\n9 -9 0", "\n9 -9")])),
        case("text-row-long", "a vertex of four numbers", "line 11", with(&[("\n9 -9 0", "\n9 -9 0 1")])),
        case(
            "text-surplus",
            "a line after the last row",
            "line 14",
            [with(&[]), b"3 0 1 2\n".to_vec()].concat(),
        ),
        case("text-endless-row", "a row of two megabytes", "line 13", {
            with(&[("3 0 1 2", &format!("3 0 1 2{}", " 0".repeat(1 << 20)))])
        }),
        case("text-of-bytes", "binary numbers in a file that says text", "line 10", {
            binary("ascii", false, &[], &[3], &[0, 1, 2])
        }),
        case("binary-of-text", "a text in a file that says binary", "", with(&[("ascii", BINARY[0].0)])),
    ]);
    cases
}

/// Wrong numbers of a binary file, in both byte orders.
fn binaries() -> Vec<Case> {
    let mut cases = Vec::new();
    for (format, is_big) in BINARY {
        let order = if is_big { "big" } else { "little" };
        let plain = binary(format, is_big, &[], &[3], &[0, 1, 2]);
        let numbers = plain.len() - 13 - 36;
        let mut add = |name: &str, what, place: &str, bytes: Vec<u8>| {
            cases.push(case(&format!("{order}-{name}"), what, place, bytes));
        };
        for (name, what, number) in [
            ("nan", "a binary coordinate that is not a number", f32::NAN),
            ("inf", "an infinite binary coordinate", f32::INFINITY),
            ("minus-inf", "a binary coordinate of minus infinity", f32::NEG_INFINITY),
            ("far", "a binary coordinate of 3e38", 3e38),
        ] {
            for vertex in 0..3 {
                let at = numbers + 12 * vertex + 4;
                let mut bytes = plain.clone();
                let number = if is_big { number.to_be_bytes() } else { number.to_le_bytes() };
                bytes[at..at + 4].copy_from_slice(&number);
                add(&format!("{name}-{vertex}"), what, &format!("byte {at}, vertex {vertex}"), bytes);
            }
        }
        for (name, what, index) in [
            ("index-3", "a vertex past the last", 3),
            ("index-negative", "a negative vertex", -1),
            ("index-top", "a vertex of 2^31 - 1", i32::MAX),
            ("index-least", "a vertex of -2^31", i32::MIN),
        ] {
            add(name, what, "polygon 0", binary(format, is_big, &[], &[3], &[0, 1, index]));
        }
        for (name, what, corners) in [
            ("corners-0", "a polygon of no corners", 0),
            ("corners-2", "a polygon of two corners", 2),
            ("corners-4", "a polygon of more corners than the file has", 4),
            ("corners-255", "a polygon of 255 corners in the bytes of three", 255),
        ] {
            add(name, what, "byte ", binary(format, is_big, &[], &[corners], &[0, 1, 2]));
        }
        let wide = if is_big { u32::MAX.to_be_bytes() } else { u32::MAX.to_le_bytes() };
        add("corners-top", "a polygon of 2^32 - 1 corners", "byte ", {
            binary(format, is_big, &[("uchar", "uint")], &wide, &[0, 1, 2])
        });
        add("surplus", "a byte after the last face", "byte ", [&plain[..], b"\n"].concat());
        let other = BINARY[usize::from(!is_big)];
        add(
            "order",
            "numbers in the other byte order",
            "byte ",
            binary(format, other.1, &[], &[3], &[0, 1, 2]),
        );
    }
    cases
}

/// Truncated files.
fn cut() -> Vec<Case> {
    let mut cases = Vec::new();
    let last = TEXT.len() - 2;
    for at in cuts(last, &[3, 4, 10, 100, 120, last - 1], 10) {
        // Within the last row the number of corners may already be there.
        cases.push(case(&format!("text-cut-at-{at}"), "a truncated text", "", &TEXT[..at]));
    }
    for (format, is_big) in BINARY {
        let order = if is_big { "big" } else { "little" };
        let bytes = binary(format, is_big, &[], &[3], &[0, 1, 2]);
        let end = bytes.len();
        for at in cuts(end, &[end - 50, end - 49, end - 13, end - 12, end - 1], 4) {
            cases.push(case(&format!("{order}-cut-at-{at}"), "a truncated binary file", "", &bytes[..at]));
        }
    }
    cases
}
