//! Malformed OBJ. (Wavefront, version 3.0)

use super::{WRONG_NUMBERS, terrain};
use crate::malformed::case::Case;

/// The vertices of a square.
const VERTICES: &str = "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\n";

pub(super) fn cases() -> Vec<Case> {
    [corners(), coordinates(), files()].concat()
}

fn case(name: &str, what: &'static str, place: &str, bytes: impl Into<Vec<u8>>) -> Case {
    terrain("obj", name, what, place, bytes)
}

/// Faces that cannot be, after the vertices of a square.
fn corners() -> Vec<Case> {
    let faces = [
        ("index-5", "a vertex past the last", "f 1 2 5"),
        ("index-0", "a vertex 0", "f 1 2 0"),
        ("index-minus-5", "a vertex before the first", "f 1 2 -5"),
        ("index-minus-0", "a vertex of minus zero", "f 1 2 -0"),
        ("index-2-31", "a vertex of 2^31", "f 1 2 2147483648"),
        ("index-2-32", "a vertex of 2^32 + 1, which is 1 in 32 bits", "f 2 3 4294967297"),
        ("index-2-63", "a vertex of 2^63", "f 1 2 9223372036854775808"),
        ("index-least", "a vertex of -2^63", "f 1 2 -9223372036854775808"),
        ("index-2-64", "a vertex of 2^64 + 1, which is 1 in 64 bits", "f 2 3 18446744073709551617"),
        ("index-long", "a vertex of a thousand digits", ""),
        ("index-real", "a vertex of 1.5", "f 1 2 1.5"),
        ("index-exponent", "a vertex in powers of ten", "f 1 2 3e0"),
        ("index-hexadecimal", "a hexadecimal vertex", "f 1 2 0x3"),
        ("index-nan", "a vertex that is not a number", "f 1 2 nan"),
        ("index-text", "a word in place of a vertex", "f a b c"),
        ("corners-0", "a face without corners", "f"),
        ("corners-1", "a face of one corner", "f 1"),
        ("corners-2", "a face of two corners", "f 1 2"),
        ("corners-comment", "a face whose third corner is in a comment", "f 1 2 # 3"),
        ("slash-first", "a corner that starts with a slash", "f /1 2 3"),
        ("slash-three", "a corner with three slashes", "f 1/1/1/1 2 3"),
        ("slash-text", "a texture that is a word", "f 1/a 2 3"),
        ("slash-alone", "a slash alone", "f 1 / 2 3"),
        ("bytes", "bytes that are no text", ""),
    ];
    let mut cases: Vec<Case> = faces
        .into_iter()
        .filter(|(_, _, face)| !face.is_empty())
        .map(|(name, what, face)| case(name, what, "line 5", format!("{VERTICES}{face}\n")))
        .collect();
    let [long, bytes] = ["index-long", "bytes"].map(|wanted| {
        let (name, what, _) = faces.into_iter().find(|(name, ..)| *name == wanted).expect("a name");
        (name, what)
    });
    cases.push(case(long.0, long.1, "line 5", format!("{VERTICES}f 1 2 {}\n", "3".repeat(1000))));
    cases.push(case(bytes.0, bytes.1, "line 5", [VERTICES.as_bytes(), b"f 1 2 \xff\xfe\n"].concat()));
    cases
}

/// Vertices that cannot be.
fn coordinates() -> Vec<Case> {
    let mut cases = Vec::new();
    for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
        for (name, what, number) in WRONG_NUMBERS {
            let mut numbers = ["9", "9", "0"];
            numbers[axis] = number;
            let text = format!("v -9 -9 0\nv 9 -9 0\nv {}\nv -9 9 0\nf 1 2 3\n", numbers.join(" "));
            cases.push(case(
                &format!("{name}-{letter}"),
                what,
                &format!("line 3, {letter} of vertex 3"),
                text,
            ));
        }
        let short = ["9"; 3][..axis].join(" ");
        let text = format!("v -9 -9 0\nv 9 -9 0\nv {short}\nf 1 2 3\n");
        let what = "a vertex of too few numbers";
        cases.push(case(&format!("numbers-{axis}"), what, &format!("line 3, {letter} of vertex 3"), text));
    }
    cases
}

/// Files of other kinds, and files that are long in one way.
fn files() -> Vec<Case> {
    let square = format!("{VERTICES}f 1 2 3 4\n");
    let utf16: Vec<u8> = square.encode_utf16().flat_map(u16::to_le_bytes).collect();
    vec![
        case("empty", "an empty file", "no triangles", ""),
        case("comments", "comments alone", "no triangles", "# nothing\n".repeat(1000)),
        case("vertices", "vertices without faces", "no triangles", VERTICES),
        case("faces", "faces without vertices", "line 1", "f 1 2 3\n"),
        case("lines", "lines and points without faces", "no triangles", format!("{VERTICES}l 1 2\np 1\n")),
        case("html", "a page of HTML", "line 1", "<html><body>404</body></html>\n"),
        case("json", "a JSON object", "line 1", "{\"asset\": {\"version\": \"2.0\"}}\n"),
        case("numbers", "numbers alone", "line 1", "0 0 0\n1 0 0\n"),
        case("null", "a byte 0", "byte 10", square.replacen('\n', "\n\0", 1)),
        case("utf16", "a text in UTF-16", "byte 1", utf16),
        case("binary", "the numbers of a binary mesh after a text", "byte ", {
            [square.as_bytes(), &[0x80, 0x3f, 0, 0].repeat(64)].concat()
        }),
        case("endless-line", "a face of half a million corners that do not exist", "line 5", {
            format!("{VERTICES}f{}", " 5".repeat(500_000))
        }),
        case(
            "endless-word",
            "a word of two megabytes",
            "line 5",
            format!("{VERTICES}f {}", "9".repeat(2 << 20)),
        ),
        case("endless-number", "a coordinate of two megabytes", "line 1, x of vertex 1", {
            format!("v {} 0 0\n", "9".repeat(2 << 20))
        }),
        case("endless-joins", "a statement that goes on over a million lines", "no triangles", {
            format!("{VERTICES}g {}", "\\\n".repeat(1 << 20))
        }),
        case("endless-blank", "two megabytes of empty lines", "no triangles", "\n".repeat(2 << 20)),
        case("endless-groups", "two hundred thousand groups", "no triangles", "g a\n".repeat(200_000)),
        case("join-cut", "a backslash at the end of the file", "line 5", format!("{VERTICES}f 1 2 \\")),
    ]
}
