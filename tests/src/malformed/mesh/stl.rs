//! Malformed STL, binary and text. (3D Systems, 1989)

use super::{WRONG_NUMBERS, terrain};
use crate::malformed::bytes::cuts;
use crate::malformed::case::{Case, Item};

/// Bytes of a binary header, and of a face.
const HEADER: usize = 84;
const FACE: usize = 50;

/// Two triangles of a square, as text.
const TEXT: &str = "solid square\n\
    facet normal 0 0 1\nouter loop\nvertex -9 -9 0\nvertex 9 -9 0\nvertex 9 9 0\nendloop\nendfacet\n\
    facet normal 0 0 1\nouter loop\nvertex -9 -9 0\nvertex 9 9 0\nvertex -9 9 0\nendloop\nendfacet\n\
    endsolid square\n";

/// The same square, binary.
pub(super) fn good() -> Vec<u8> {
    binary(2, &[[[-9., -9., 0.], [9., -9., 0.], [9., 9., 0.]], [[-9., -9., 0.], [9., 9., 0.], [-9., 9., 0.]]])
}

/// A binary file that claims so many faces.
fn binary(claimed: u32, faces: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(claimed.to_le_bytes());
    for face in faces {
        bytes.extend([0; 12]);
        bytes.extend(face.as_flattened().iter().flat_map(|number| number.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

pub(super) fn cases() -> Vec<Case> {
    [headers(), numbers(), texts(), cut()].concat()
}

fn case(name: &str, what: &'static str, place: &str, bytes: impl Into<Vec<u8>>) -> Case {
    terrain("stl", name, what, place, bytes)
}

/// Wrong numbers of faces, and files of other kinds.
fn headers() -> Vec<Case> {
    let claims = |count: u32| {
        let mut bytes = good();
        bytes[80..HEADER].copy_from_slice(&count.to_le_bytes());
        bytes
    };
    let utf16: Vec<u8> = TEXT.encode_utf16().flat_map(u16::to_le_bytes).collect();
    vec![
        case("empty", "an empty file", "header", ""),
        case("words", "plain text of another kind", "header", "Dear rover,"),
        case("zip", "a ZIP archive", "header", b"PK\x03\x04".to_vec()),
        case("zeros", "a megabyte of zeros", "byte 80", vec![0; 1 << 20]),
        case("none", "no faces, binary", "no triangles", binary(0, &[])),
        case("none-but-bytes", "no faces, and the bytes of two", "byte 80", claims(0)),
        case("one", "one face, and the bytes of two", "byte 80", claims(1)),
        case("three", "three faces in the bytes of two", "byte 80", claims(3)),
        case("top", "2^32 - 1 faces in the bytes of two", "byte 80", claims(u32::MAX)),
        case("half", "2^31 faces in the bytes of two", "byte 80", claims(1 << 31)),
        // 50 * 85,899,346 = 2^32 + 4: the length of the file as 32 bits see it is that of 88 bytes.
        case("wraps", "faces whose bytes overflow 32 bits", "byte 80", {
            let mut bytes = claims(85_899_346);
            bytes.truncate(88);
            bytes
        }),
        case("surplus", "sixty bytes after the last face", "byte 80", [good(), vec![7; 60]].concat()),
        case(
            "big-endian",
            "a number of faces in the other byte order",
            "byte 80",
            claims(2_u32.swap_bytes()),
        ),
        case("solid-binary", "a binary file that starts with `solid` and is cut off", "byte 80", {
            let mut bytes = good();
            bytes[..5].copy_from_slice(b"solid");
            bytes.truncate(HEADER + FACE);
            bytes
        }),
        case("solid-and-binary", "a text whose second half is binary", "byte 80", {
            [&TEXT.as_bytes()[..120], &good()[HEADER..]].concat()
        }),
        case("utf16", "a text in UTF-16", "byte 80", utf16),
        case("null", "a text with a byte 0", "byte 80", TEXT.replacen("loop", "lo\0p", 1)),
        Case::new(
            "stl-folder",
            "a folder in place of the file",
            "validate ground.stl -o out",
            &["ground.stl", "folder"],
        )
        .item("ground.stl", Item::Folder),
        Case::new(
            "stl-pipe",
            "a pipe in place of the file",
            "validate ground.stl -o out",
            &["ground.stl", "not a regular file"],
        )
        .item("ground.stl", Item::Pipe),
        Case::new(
            "stl-hole",
            "a file of two gigabytes of nothing",
            "validate ground.stl -o out",
            &["ground.stl", "larger than"],
        )
        .item("ground.stl", Item::Hole(b"solid".to_vec(), 1 << 31)),
    ]
}

/// Wrong coordinates of a binary file, at each axis of the last face.
fn numbers() -> Vec<Case> {
    let wrong = [
        ("nan", "a binary coordinate that is not a number", f32::NAN),
        ("inf", "an infinite binary coordinate", f32::INFINITY),
        ("minus-inf", "a binary coordinate of minus infinity", f32::NEG_INFINITY),
        ("far", "a binary coordinate of 3e38", 3e38),
    ];
    let mut cases = Vec::new();
    for (name, what, number) in wrong {
        for corner in 0..3 {
            for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
                let at = HEADER + FACE + 12 + 12 * corner + 4 * axis;
                let mut bytes = good();
                bytes[at..at + 4].copy_from_slice(&number.to_le_bytes());
                let name = format!("binary-{name}-{letter}-{corner}");
                cases.push(case(&name, what, &format!("byte {at}, face 1"), bytes));
            }
        }
    }
    cases
}

/// Wrong words of a text.
fn texts() -> Vec<Case> {
    let with = |from: &str, to: &str| {
        assert!(TEXT.contains(from), "{from}");
        TEXT.replacen(from, to, 1)
    };
    let mut cases: Vec<Case> = WRONG_NUMBERS
        .iter()
        .map(|(name, what, number)| {
            let text = with("vertex 9 -9 0", &format!("vertex 9 {number} 0"));
            case(&format!("text-{name}"), what, "line 5, face 0", text)
        })
        .collect();
    for word in ["normal", "outer", "endloop", "endfacet"] {
        let what = "a text without a word that it needs";
        cases.push(case(&format!("text-no-{word}"), what, "line ", with(word, "")));
    }
    cases.extend([
        case("text-none", "a text without faces", "no triangles", "solid nothing\nendsolid nothing\n"),
        case("text-open", "a solid without an end", "line ", with("endsolid square\n", "")),
        case("text-after", "words after the last solid", "line 17", format!("{TEXT}stop\n")),
        case("text-two-corners", "a face of two corners", "line 6", with("vertex 9 9 0\n", "")),
        case("text-four-corners", "a face of four corners", "line 7", {
            with("vertex 9 9 0\n", "vertex 9 9 0\nvertex 0 9 0\n")
        }),
        case("text-two-numbers", "a corner of two numbers", "line 5, face 0", with("9 -9 0\n", "9 -9\n")),
        case("text-four-numbers", "a corner of four numbers", "line 4", with("9 -9 0\n", "9 -9 0 1\n")),
        case("text-many-corners", "a face of a hundred thousand corners", "line 7", {
            with("vertex 9 9 0\n", &"vertex 9 9 0\n".repeat(100_000))
        }),
        case(
            "text-nested",
            "a hundred thousand solids inside one another",
            "line 2",
            "solid\n".repeat(100_000),
        ),
        case("text-loops", "a hundred thousand loops inside one another", "line 4", {
            with("outer loop\n", &"outer loop\n".repeat(100_000))
        }),
        case("text-endless-line", "a line of two megabytes without an end", "line 1", {
            format!("solid {}", "x".repeat(2 << 20))
        }),
        case("text-endless-word", "a word of two megabytes", "line 2", with("facet", &"f".repeat(2 << 20))),
        case("text-endless-number", "a coordinate of two megabytes", "line 4, face 0", {
            with("-9 -9 0", &format!("{} -9 0", "9".repeat(2 << 20)))
        }),
        case("text-blank", "two megabytes of empty lines in a solid", "line ", {
            format!("solid{}", "\n".repeat(2 << 20))
        }),
    ]);
    cases
}

/// Truncated files.
fn cut() -> Vec<Case> {
    let binary = good();
    let places = [1, 79, 80, 83, HEADER, HEADER + 1, HEADER + FACE, binary.len() - 1];
    let mut cases: Vec<Case> = cuts(binary.len(), &places, 5)
        .into_iter()
        .map(|at| {
            let place = if at < HEADER { "header" } else { "byte 80" };
            case(&format!("cut-at-{at}"), "a truncated binary file", place, &binary[..at])
        })
        .collect();
    let end = TEXT.find("endsolid").expect("its end");
    for at in cuts(end, &[6, 20, 40, end - 1], 8) {
        cases.push(case(&format!("text-cut-at-{at}"), "a truncated text", "line ", &TEXT[..at]));
    }
    cases
}
