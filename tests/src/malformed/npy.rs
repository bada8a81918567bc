//! NPY: headers in Python that are no header, shapes that lie, numbers that fit no cell.

use super::bytes::cuts;
use super::case::{Case, Item};

const FILE: &str = "range.npy";
const RUN: &str = "diff range.npy range.npy -o out";

/// A file of version 1.0 with a header as it is and so many bytes.
fn npy(header: &str, bytes: &[u8]) -> Vec<u8> {
    let mut file = b"\x93NUMPY\x01\0".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.as_bytes());
    file.extend(bytes);
    file
}

fn header(descr: &str, fortran: &str, shape: &str) -> String {
    format!("{{'descr': {descr}, 'fortran_order': {fortran}, 'shape': {shape}, }}\n")
}

/// An array in C order, of whatever bytes.
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
    // Version 2 has a length of four bytes.
    let long = |version: u8, length: u32| {
        let mut file = b"\x93NUMPY".to_vec();
        file.extend([version, 0]);
        file.extend(length.to_le_bytes());
        file.extend(header("'<f8'", "False", "(2, 3)").as_bytes());
        file
    };
    let mut cases = vec![
        case("empty", "an empty file", "first bytes", Vec::new()),
        case("words", "a letter, not a file", "first bytes", b"Dear rover,".to_vec()),
        case("version-9", "a version that is not yet", "version 9.0", long(9, 60)),
        case("header-top", "a header of 2^32 - 1 bytes", "4294967295", long(2, u32::MAX)),
        case("header-beyond", "a header longer than the file", "header", long(3, 60_000)),
        text("code", "Python code to be run", "header", "__import__('os').system('touch owned')"),
        text(
            "code-in-value",
            "Python code in a value",
            "header",
            "{'descr': eval('1'), 'fortran_order': False, 'shape': (2, 3)}",
        ),
        text(
            "nested",
            "a shape of brackets in brackets",
            "header",
            &header("'<f8'", "False", &"(".repeat(30_000)),
        ),
        text("open", "a text that does not end", "header", "{'descr"),
        text("escape", "a text with escapes", "header", &header("'\\x3cf8'", "False", "(2, 3)")),
        text("key-twice", "a key that is there twice", "each key once", "{'shape': (2, 3), 'shape': (2, 3)}"),
        text("key-missing", "no shape", "shape", "{'descr': '<f8', 'fortran_order': False}"),
        text("key-unknown", "a key of nobody", "header", "{'descr': '<f8', 'evil': True}"),
        text(
            "after",
            "something after the dictionary",
            "header",
            &(header("'<f8'", "False", "(2, 3)") + "import os"),
        ),
        text(
            "order-number",
            "a number where True or False belongs",
            "header",
            &header("'<f8'", "1", "(2, 3)"),
        ),
        case(
            "not-utf8",
            "a header that is no UTF-8",
            "header",
            npy(&header("'<f8'", "False", "(2, 3)"), &[0; 48])
                .iter()
                .map(|&byte| if byte == b'd' { 255 } else { byte })
                .collect(),
        ),
        kind("object", "Python objects, which are code to be run", "'|O'"),
        kind("structured", "a structured type", "[('x', '<f8'), ('y', '<f8')]"),
        kind("complex", "complex numbers", "'<c16'"),
        kind("text", "texts", "'<U1000000000'"),
        kind("date", "dates", "'<M8[ns]'"),
        kind("wide", "reals of 16 bytes", "'<f16'"),
        kind("order", "no order of bytes", "'f8'"),
        kind("native", "an order of bytes that is the writer's own", "'=f8'"),
        kind("nothing", "an empty type", "''"),
        shape("0", "no rows", "(0, 3)"),
        shape("1", "one dimension", "(6,)"),
        shape("4", "four dimensions", "(1, 1, 2, 3)"),
        shape("none", "no dimension", "()"),
        shape("negative", "a negative number of rows", "(-2, 3)"),
        shape("real", "two and a half rows", "(2.5, 3)"),
        shape("square", "two million cells square", "(2000000, 2000000)"),
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
        cells(
            "negative",
            "-2 where an index belongs",
            "'<i8'",
            &[[0_i64, -2].map(i64::to_le_bytes).concat()].concat(),
        ),
        cells("beyond-2-32", "an index of 2^32", "'<u8'", &[0, 1_u64 << 32].map(u64::to_le_bytes).concat()),
        cells(
            "beyond-2-53",
            "an integer beyond 2^53",
            "'<i8'",
            &[0, (1_i64 << 53) + 1].map(i64::to_le_bytes).concat(),
        ),
        cells("truth-2", "a truth value of 2", "'|b1'", &[0, 2]),
        Case::new("npy-folder", "a folder with the name of a file", RUN, &[FILE]).item(FILE, Item::Folder),
        Case::new("npy-pipe", "a pipe with the name of a file", RUN, &[FILE, "not a regular file"])
            .item(FILE, Item::Pipe),
    ];
    let length = good().len();
    for at in cuts(length, &[5, 6, 7, 8, 9, 10, length - 48, length - 1], 4) {
        cases.push(case(&format!("cut-at-{at}"), "a good file, cut off", "", good()[..at].to_vec()));
    }
    cases
}
