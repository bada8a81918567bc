//! GLB: malformed chunks of the container, and truncated files.

use super::bytes::cuts;
use super::case::Case;
use crate::glb::{container, glb, square};

const FILE: &str = "ground.glb";
const RUN: &str = "validate ground.glb -o out";

/// The well-formed square.
pub(super) fn good() -> Vec<u8> {
    let (json, bin) = square();
    glb(&json, &bin)
}

pub(super) fn cases() -> Vec<Case> {
    let case = |name: &str, what, place: &str, bytes: Vec<u8>| {
        Case::of_file(&format!("glb-{name}"), what, RUN, FILE, bytes, place)
    };
    // The good file with one 32-bit word replaced.
    let word = |name: &str, what, at: usize, word: u32, place: &str| {
        let mut bytes = good();
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        case(name, what, place, bytes)
    };
    let (json, bin) = square();
    let json = json.to_string().into_bytes();
    let length = good().len();
    let json_length = u32::from_le_bytes(good()[12..16].try_into().expect("four bytes")) as usize;
    let bin_at = 20 + json_length;
    let mut cases = vec![
        word("version-1", "GLB 1", 4, 1, "GLB header"),
        word("version-top", "a version of 2^32 - 1", 4, u32::MAX, "GLB header"),
        word("length-0", "a length of 0", 8, 0, "GLB header"),
        word("length-11", "a length that ends within the header", 8, 11, "GLB header"),
        word("length-top", "a length of 2^32 - 1", 8, u32::MAX, "GLB header"),
        word("length-short", "a length that ends within the last chunk", 8, length as u32 - 4, "GLB header"),
        word("chunk-top", "a first chunk of 2^32 - 1 bytes", 12, u32::MAX, "GLB chunk 0"),
        word("chunk-wraps", "a chunk whose end overflows 32 bits", 12, u32::MAX - 19, "GLB chunk 0"),
        word("chunk-0", "a JSON chunk of no bytes", 12, 0, "GLB chunk"),
        word("chunk-short", "a JSON chunk that ends within a word", 12, 3, "GLB chunk"),
        word("bin-top", "a second chunk of 2^32 - 1 bytes", bin_at, u32::MAX, "GLB chunk 1"),
        case(
            "bin-first",
            "the binary chunk before the JSON chunk",
            "GLB chunk 0",
            container(&[(b"BIN\0", &bin), (b"JSON", &json)]),
        ),
        case(
            "json-twice",
            "two JSON chunks",
            "GLB chunk 1",
            container(&[(b"JSON", &json), (b"JSON", &json)]),
        ),
        case(
            "bin-twice",
            "two binary chunks",
            "GLB chunk 2",
            container(&[(b"JSON", &json), (b"BIN\0", &bin), (b"BIN\0", &bin)]),
        ),
        case("no-chunk", "no chunks", "GLB chunk 0", container(&[])),
        case("no-bin", "no binary chunk", "buffer 0", container(&[(b"JSON", &json)])),
        case("trailing", "three bytes after the last chunk", "GLB chunk 2", {
            let mut bytes = good();
            bytes.extend([0; 3]);
            bytes[8..12].copy_from_slice(&(length as u32 + 3).to_le_bytes());
            bytes
        }),
        case("nulls", "a JSON chunk of null bytes", "JSON", container(&[(b"JSON", &[0; 64])])),
    ];
    for at in cuts(length, &[0, 1, 4, 11, 12, 16, 19, 20, bin_at, bin_at + 7, length - 1], 5) {
        let place = if at < 4 { "first bytes" } else { "GLB header" };
        cases.push(case(&format!("cut-at-{at}"), "a truncated good file", place, good()[..at].to_vec()));
    }
    cases
}
