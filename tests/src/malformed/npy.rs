//! Malformed NPY files: headers, shapes, values out of range.

use super::bytes::cuts;
use super::case::{Case, Item};

const FILE: &str = "range.npy";
const RUN: &str = "diff range.npy range.npy -o out";

/// A file of version 1.0 with the given header and data.
fn npy(header: &str, bytes: &[u8]) -> Vec<u8> {
    let mut file = b"\x93NUMPY\x01\0".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.as_bytes());
    file.extend(bytes);
    file
}

/// A header from its three values.
fn header(descr: &str, fortran: &str, shape: &str) -> String {
    format!("{{'descr': {descr}, 'fortran_order': {fortran}, 'shape': {shape}, }}\n")
}

/// An array in C order with the given data.
pub(super) fn array(descr: &str, shape: &str, bytes: &[u8]) -> Vec<u8> {
    npy(&header(&format!("'{descr}'"), "False", shape), bytes)
}

pub(super) fn good() -> Vec<u8> {
    npy(&header("'<f8'", "False", "(2, 3)"), &[0; 48])
}

pub(super) fn cases() -> Vec<Case> {
    let case = |name: &str, what, place: &str, bytes: Vec<u8>| {
        Case::of_file(&format!("npy-{name}"), what, RUN, FILE, bytes, place)
    };
    let text = |name: &str, what, place: &str, header: &str| case(name, what, place, npy(header, &[0; 48]));
    let kind = |name: &str, what, descr: &str| {
        text(&format!("type-{name}"), what, "descr", &header(descr, "False", "(2, 3)"))
    };
    let shape = |name: &str, what, numbers: &str| {
        text(&format!("shape-{name}"), what, "", &header("'<f8'", "False", numbers))
    };
    let cells = |name: &str, what, descr: &str, bytes: &[u8]| {
        case(name, what, "cell (0, 1)", npy(&header(descr, "False", "(2, 1)"), bytes))
    };
    // From version 2 on the length has four bytes.
    let long = |version: u8, length: u32| {
        let mut file = b"\x93NUMPY".to_vec();
        file.extend([version, 0]);
        file.extend(length.to_le_bytes());
        file.extend(header("'<f8'", "False", "(2, 3)").as_bytes());
        file
    };
    let mut cases = vec![
        case("empty", "an empty file", "first bytes", Vec::new()),
        case("words", "plain text of another kind", "first bytes", b"Dear rover,".to_vec()),
        case("version-9", "an unknown version", "version 9.0", long(9, 60)),
        case("header-top", "a header of 2^32 - 1 bytes", "4294967295", long(2, u32::MAX)),
        case("header-beyond", "a header longer than the file", "header", long(3, 60_000)),
        text("code", "Python code", "header", "__import__('os').system('touch owned')"),
        text(
            "code-in-value",
            "Python code in a value",
            "header",
            "{'descr': eval('1'), 'fortran_order': False, 'shape': (2, 3)}",
        ),
        text(
            "nested",
            "nested brackets in a shape",
            "header",
            &header("'<f8'", "False", &"(".repeat(30_000)),
        ),
        text("open", "an unterminated string", "header", "{'descr"),
        text("escape", "a string with escapes", "header", &header("'\\x3cf8'", "False", "(2, 3)")),
        text("key-twice", "a duplicate key", "each key once", "{'shape': (2, 3), 'shape': (2, 3)}"),
        text("key-missing", "no shape", "shape", "{'descr': '<f8', 'fortran_order': False}"),
        text("key-unknown", "an unknown key", "header", "{'descr': '<f8', 'evil': True}"),
        text(
            "after",
            "text after the dictionary",
            "header",
            &(header("'<f8'", "False", "(2, 3)") + "import os"),
        ),
        text("order-number", "a number in place of True or False", "header", &header("'<f8'", "1", "(2, 3)")),
        case(
            "not-utf8",
            "a header that is not UTF-8",
            "header",
            npy(&header("'<f8'", "False", "(2, 3)"), &[0; 48])
                .iter()
                .map(|&byte| if byte == b'd' { 255 } else { byte })
                .collect(),
        ),
        kind("object", "Python objects, which are executable code", "'|O'"),
        kind("structured", "a structured type", "[('x', '<f8'), ('y', '<f8')]"),
        kind("complex", "complex numbers", "'<c16'"),
        kind("text", "strings", "'<U1000000000'"),
        kind("date", "dates", "'<M8[ns]'"),
        kind("wide", "reals of 16 bytes", "'<f16'"),
        kind("order", "no byte order", "'f8'"),
        kind("native", "the native byte order of the writer", "'=f8'"),
        kind("nothing", "an empty type", "''"),
        shape("0", "no rows", "(0, 3)"),
        shape("1", "one dimension", "(6,)"),
        shape("4", "four dimensions", "(1, 1, 2, 3)"),
        shape("none", "no dimensions", "()"),
        shape("negative", "a negative number of rows", "(-2, 3)"),
        shape("real", "two and a half rows", "(2.5, 3)"),
        shape("square", "2,000,000 x 2,000,000 cells", "(2000000, 2000000)"),
        shape("wraps", "2^32 x 2^32 cells, which are 0 in 64 bits", "(4294967296, 4294967296)"),
        shape("wraps-bytes", "2^61 rows, whose bytes are 0 in 64 bits", "(2305843009213693952, 8)"),
        shape("top", "2^64 - 1 rows", "(18446744073709551615, 1)"),
        shape("beyond", "2^64 rows", "(18446744073709551616, 1)"),
        shape("components", "a million components", "(1, 1, 1000000)"),
        shape("fewer", "fewer cells than there are bytes", "(1, 3)"),
        text(
            "fortran-huge",
            "Fortran order of 2^40 columns",
            "",
            &header("'<f8'", "True", "(1, 1099511627776)"),
        ),
        text(
            "shape-long",
            "a shape of thirty thousand numbers",
            "shape",
            &header("'<f8'", "False", &format!("({})", "1,".repeat(30_000))),
        ),
        cells("negative", "-2 as an index", "'<i8'", &[[0_i64, -2].map(i64::to_le_bytes).concat()].concat()),
        cells("beyond-2-32", "an index of 2^32", "'<u8'", &[0, 1_u64 << 32].map(u64::to_le_bytes).concat()),
        cells(
            "beyond-2-53",
            "an integer beyond 2^53",
            "'<i8'",
            &[0, (1_i64 << 53) + 1].map(i64::to_le_bytes).concat(),
        ),
        cells("truth-2", "a Boolean value of 2", "'|b1'", &[0, 2]),
        Case::new("npy-folder", "a folder in place of the file", RUN, &[FILE]).item(FILE, Item::Folder),
        Case::new("npy-pipe", "a pipe in place of the file", RUN, &[FILE, "not a regular file"])
            .item(FILE, Item::Pipe),
    ];
    let length = good().len();
    for at in cuts(length, &[5, 6, 7, 8, 9, 10, length - 48, length - 1], 4) {
        cases.push(case(&format!("cut-at-{at}"), "a truncated good file", "", good()[..at].to_vec()));
    }
    cases
}
