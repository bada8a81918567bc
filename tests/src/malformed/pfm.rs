//! Malformed PFM files: sizes and scales.

use super::bytes::cuts;
use super::case::{Case, Item};

const FILE: &str = "range.pfm";
const RUN: &str = "diff range.pfm range.pfm -o out";

pub(super) fn good() -> Vec<u8> {
    pfm("Pf\n3 2\n-1.0\n", 24)
}

fn pfm(header: &str, bytes: usize) -> Vec<u8> {
    [header.as_bytes(), &vec![0; bytes]].concat()
}

pub(super) fn cases() -> Vec<Case> {
    let case = |name: &str, what, place: &str, bytes: Vec<u8>| {
        Case::of_file(&format!("pfm-{name}"), what, RUN, FILE, bytes, place)
    };
    let text = |name: &str, what, place: &str, header: &str| case(name, what, place, pfm(header, 24));
    let mut cases = vec![
        case("empty", "an empty file", "magic", Vec::new()),
        text("words", "plain text of another kind", "magic", "Dear rover, "),
        text("magic", "the magic of another format", "magic", "P6\n3 2\n255\n"),
        text("scale-0", "a scale of 0", "scale", "Pf\n3 2\n0\n"),
        text("scale-nan", "a scale that is not a number", "scale", "Pf\n3 2\nnan\n"),
        text("scale-infinite", "an infinite scale", "scale", "Pf\n3 2\n-inf\n"),
        text("scale-2", "a scale of 2", "scale", "Pf\n3 2\n-2.0\n"),
        text("scale-word", "a scale that is a word", "scale", "Pf\n3 2\nlittle\n"),
        text("scale-beyond", "a scale of 1e999", "scale", "Pf\n3 2\n1e999\n"),
        text("width-negative", "a negative width", "width", "Pf\n-3 2\n-1\n"),
        text("width-real", "a width of 3.0", "width", "Pf\n3.0 2\n-1\n"),
        text("width-plus", "a width with a sign", "width", "Pf\n+3 2\n-1\n"),
        text("width-beyond", "a width beyond 2^64", "width", "Pf\n99999999999999999999 2\n-1\n"),
        text(
            "width-long",
            "a width of a thousand digits",
            "width",
            &format!("Pf\n{} 2\n-1\n", "3".repeat(1000)),
        ),
        text("height-0", "no rows", "shape", "Pf\n3 0\n-1\n"),
        text("square", "2,000,000 x 2,000,000 cells", "shape", "Pf\n2000000 2000000\n-1\n"),
        text(
            "wraps",
            "2^32 x 2^32 cells, which are 0 in 64 bits",
            "shape",
            "PF\n4294967296 4294967296\n-1\n",
        ),
        text("colour", "three components with the bytes of one", "numbers", "PF\n3 2\n-1\n"),
        case("long", "one byte too many", "numbers", pfm("Pf\n3 2\n-1.0\n", 25)),
        case("blanks", "a hundred thousand blanks", "magic", vec![b' '; 100_000]),
        case("null", "null bytes in the header", "width", b"Pf\n\0\0\0 2\n-1\n".to_vec()),
        case("not-utf8", "a width that is not UTF-8", "width", b"Pf\n\xff\xfe 2\n-1\n".to_vec()),
        text("escape", "terminal escape codes", "width", "Pf\n\u{1b}[2J 2\n-1\n"),
        Case::new("pfm-folder", "a folder in place of the file", RUN, &[FILE]).item(FILE, Item::Folder),
        Case::new("pfm-pipe", "a pipe in place of the file", RUN, &[FILE, "not a regular file"])
            .item(FILE, Item::Pipe),
    ];
    let length = good().len();
    for at in cuts(length, &[1, 2, 4, 7, 11, 12, length - 1], 2) {
        cases.push(case(&format!("cut-at-{at}"), "a truncated good file", "", good()[..at].to_vec()));
    }
    cases
}
