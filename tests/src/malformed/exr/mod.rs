//! Malformed OpenEXR files: headers, offset tables, blocks. (OpenEXR file layout, openexr.com)

mod write;

use super::bytes::{bomb, cuts, zlib};
use super::case::{Case, Item};
use write::{B44, Exr, NONE, PIZ, RLE, ZIP, channels, words};

const FILE: &str = "map.exr";
const RUN: &str = "diff map.exr map.exr -o out";

pub(super) fn good() -> Vec<u8> {
    Exr::small().bytes()
}

/// A file of 4 x 2 cells in one compressed block.
fn packed(compression: u8, data: Vec<u8>) -> Vec<u8> {
    Exr::new(4, 2, compression).block(0, data).bytes()
}

pub(super) fn cases() -> Vec<Case> {
    let case = |name: &str, what, place: &str, bytes: Vec<u8>| {
        Case::of_file(&format!("exr-{name}"), what, RUN, FILE, bytes, place)
    };
    [headers(&case), windows(&case), tables(&case), blocks(&case), cut(&case)].concat()
}

/// Makes a case from its name, its defect, the place in the message and the bytes.
type Make<'a> = &'a dyn Fn(&str, &'static str, &str, Vec<u8>) -> Case;

fn headers(case: Make<'_>) -> Vec<Case> {
    let small = Exr::small;
    let version = |flags: [u8; 4]| Exr { version: flags, ..small() }.bytes();
    let list = |list: &[(&str, i32, i32)]| small().with("channels", channels(list)).bytes();
    // A file with another length of the attribute `compression` in its header.
    let sized = |length: i32| {
        let mut bytes = good();
        let name = b"compression\0compression\0";
        let at = bytes.windows(name.len()).position(|part| part == name).expect("the attribute") + name.len();
        bytes[at..at + 4].copy_from_slice(&length.to_le_bytes());
        bytes
    };
    vec![
        case("empty", "an empty file", "header", Vec::new()),
        case("words", "plain text of another kind", "header", b"Dear rover, this is no picture.".to_vec()),
        case("version-99", "an unknown version", "header", version([99, 0, 0, 0])),
        case("flags", "every flag of the version set", "header", version([2, 255, 255, 255])),
        case("deep", "the flag of deep data", "header", version([2, 8, 0, 0])),
        case("multi-part", "the flag of several parts, without parts", "header", version([2, 16, 0, 0])),
        case("no-end", "an unterminated header", "header", small().header()[..250].to_vec()),
        case("no-channels", "no list of channels", "header", small().without("channels").bytes()),
        case("no-window", "no data window", "header", small().without("dataWindow").bytes()),
        case("no-compression", "no compression", "header", small().without("compression").bytes()),
        case("channels-none", "an empty list of channels", "header", list(&[])),
        case("channel-twice", "two channels with the same name", "", list(&[("Z", 2, 1), ("Z", 2, 1)])),
        case("channel-type", "a channel of an unknown type", "header", list(&[("Z", 7, 1)])),
        case("step-0", "a sample every 0 cells", "", list(&[("Z", 2, 0)])),
        case("step-2", "a sample every 2 cells", "", list(&[("Z", 2, 2)])),
        case("step-negative", "a sample every -1 cells", "", list(&[("Z", 2, -1)])),
        case(
            "channel-open",
            "an unterminated list of channels",
            "header",
            small().with("channels", b"range.T\0\x02\0".to_vec()).bytes(),
        ),
        case("channels-many", "ten thousand channels and no cells", "", {
            let names: Vec<String> = (0..10_000).map(|index| format!("c{index:05}")).collect();
            let all: Vec<(&str, i32, i32)> = names.iter().map(|name| (name.as_str(), 2, 1)).collect();
            small().with("channels", channels(&all)).bytes()
        }),
        case("attributes-many", "a hundred thousand attributes", "attributes", {
            let attribute = |number| (format!("a{number}"), "string".to_string(), b"x".to_vec());
            let many = (0..100_000).map(attribute);
            Exr { attributes: small().attributes.into_iter().chain(many).collect(), ..small() }.bytes()
        }),
        case("parts-many", "ten thousand parts", "header", {
            let header = Exr { version: [2, 16, 0, 0], ..small() }.header();
            [&header[..8], &header[8..].repeat(10_000), &[0]].concat()
        }),
        case("attribute-negative", "an attribute of -1 bytes", "header", sized(-1)),
        case("attribute-top", "an attribute of 2^31 - 1 bytes", "header", sized(i32::MAX)),
        case(
            "compression-99",
            "an unknown compression",
            "header",
            small().with("compression", vec![99]).bytes(),
        ),
        case("lossy", "a lossy compression", "header", packed(B44, vec![0; 16])),
        case("line-order", "an unknown order of lines", "header", small().with("lineOrder", vec![9]).bytes()),
        case(
            "long-name",
            "an attribute with a name of a thousand letters",
            "header",
            small().more(&"n".repeat(1000), "string", vec![0]).bytes(),
        ),
        case(
            "preview",
            "a preview of 2^31 x 2^31 in no bytes",
            "header",
            small().more("preview", "preview", words(&[-1, -1])).bytes(),
        ),
        case(
            "preview-wraps",
            "a preview of 2^30 x 4, whose bytes overflow",
            "header",
            small().more("preview", "preview", words(&[1 << 30, 4])).bytes(),
        ),
        case(
            "strings",
            "a list of strings with one of 2^31 - 1 bytes",
            "header",
            small().more("t", "stringvector", words(&[i32::MAX])).bytes(),
        ),
        case("tiles-0", "tiles of 0 x 0", "header", tiled([0, 0], 0)),
        case("tiles-top", "tiles of 2^32 - 1 cells across", "", tiled([u32::MAX, u32::MAX], 0)),
        case("tiles-mode", "tiles of an unknown mode", "header", tiled([2, 2], 0x77)),
    ]
}

fn tiled([columns, rows]: [u32; 2], mode: u8) -> Vec<u8> {
    let tiles = [&columns.to_le_bytes()[..], &rows.to_le_bytes(), &[mode]].concat();
    Exr { version: [2, 2, 0, 0], ..Exr::small() }.more("tiles", "tiledesc", tiles).bytes()
}

fn windows(case: Make<'_>) -> Vec<Case> {
    let side = 2_000_000;
    let square = |compression| Exr::new(side, side, compression).block(0, zlib(&[0; 64])).bytes();
    let window = |numbers: [i32; 4]| Exr::small().windows(numbers).bytes();
    vec![
        case("square", "2,000,000 x 2,000,000 cells in a few hundred bytes", "", square(NONE)),
        case("square-zip", "the same size, compressed", "", square(ZIP)),
        case("square-piz", "the same size, as wavelets", "", square(PIZ)),
        case("wide", "one row of 2^26 cells", "", Exr::new(1 << 26, 1, ZIP).block(0, zlib(&[0; 64])).bytes()),
        case("tall", "2^26 rows of one cell", "", Exr::new(1, 1 << 26, ZIP).block(0, zlib(&[0; 64])).bytes()),
        case("window-back", "a window whose end is before its start", "", window([3, 1, 0, 0])),
        case("window-empty", "a window of no cells", "", window([0, 0, -1, -1])),
        case(
            "window-ends",
            "a window from -2^31 to 2^31 - 1",
            "",
            window([i32::MIN, i32::MIN, i32::MAX, i32::MAX]),
        ),
        case("window-top", "a window at 2^31 - 1", "", window([i32::MAX, i32::MAX, i32::MAX, i32::MAX])),
        case(
            "crop",
            "a data window smaller than the display window",
            "data window",
            Exr::small().with("displayWindow", words(&[0, 0, 7, 7])).bytes(),
        ),
    ]
}

fn tables(case: Make<'_>) -> Vec<Case> {
    let first = (Exr::small().header().len() + 16) as u64;
    let table = |offsets: [u64; 2]| Exr::small().offsets(&offsets).bytes();
    vec![
        case("offset-0", "blocks at byte 0", "pixels", table([0, 0])),
        case("offset-beyond", "blocks beyond the file", "pixels", table([1 << 40, 1 << 41])),
        case("offset-top", "blocks at byte 2^64 - 1", "pixels", table([u64::MAX; 2])),
        case("offset-twice", "two blocks at the same offset", "pixels", table([first; 2])),
    ]
}

fn blocks(case: Make<'_>) -> Vec<Case> {
    let lines = |first: i32, second: i32| {
        Exr::new(4, 2, NONE).block(first, vec![0; 16]).block(second, vec![0; 16]).bytes()
    };
    // A file with another size of the second block in its header.
    let sized = |size: i32| {
        let mut bytes = good();
        let at = bytes.len() - 20;
        bytes[at..at + 4].copy_from_slice(&size.to_le_bytes());
        bytes
    };
    let garbage: Vec<u8> = (0..40_u32).map(|byte| (byte * 97 + 13) as u8).collect();
    vec![
        case("line-99", "a block for a line outside the image", "pixels", lines(0, 99)),
        case("line-negative", "a block for line -2^31", "pixels", lines(0, i32::MIN)),
        case("line-twice", "two blocks for the same line", "pixels", lines(0, 0)),
        case(
            "line-between",
            "a block of sixteen lines that starts at the second",
            "pixels",
            Exr::new(4, 2, ZIP).block(1, zlib(&[0; 32])).bytes(),
        ),
        case(
            "line-before",
            "a block of sixteen lines that starts a line above the image",
            "pixels",
            Exr::new(4, 2, ZIP).block(-1, zlib(&[0; 32])).bytes(),
        ),
        case("block-negative", "a block of -1 bytes", "pixels", sized(-1)),
        case("block-top", "a block of 2^31 - 1 bytes", "pixels", sized(i32::MAX)),
        case("block-0", "a block of no bytes", "pixels", sized(0)),
        case("block-short", "a block of too few cells", "pixels", sized(12)),
        case(
            "zip-garbage",
            "a block that is not a deflate stream",
            "pixels",
            packed(ZIP, garbage[..31].to_vec()),
        ),
        case("zip-short", "a deflate stream with too few cells", "pixels", packed(ZIP, zlib(&[0; 12]))),
        case(
            "zip-bomb",
            "a deflate stream of 16 kB that expands to 16 MB",
            "pixels",
            packed(ZIP, bomb(0, 1 << 24)),
        ),
        case(
            "zip-bomb-large",
            "a deflate stream of 256 kB that expands to 256 MB",
            "pixels",
            packed(ZIP, bomb(0, 1 << 28)),
        ),
        case(
            "zeros",
            "half a gigabyte of well-formed zeros in half a megabyte, two as doubles",
            "data window",
            {
                let list = channels(&["a", "b", "c", "d"].map(|name| (name, 1, 1)));
                let block = zlib(&vec![0; 16 * (4 * 2) * (1 << 16)]);
                let blocks = (0..64).map(|index| (16 * index, block.clone()));
                let header = Exr::new(1 << 16, 1024, ZIP).with("channels", list);
                Exr { blocks: blocks.collect(), ..header }.bytes()
            },
        ),
        case("zip-cut", "a truncated deflate stream", "pixels", packed(ZIP, zlib(&[7; 32])[..6].to_vec())),
        case("rle-garbage", "invalid run-length codes", "pixels", packed(RLE, vec![127, 0, 200])),
        case(
            "rle-bomb",
            "run-length codes of far too many bytes",
            "pixels",
            packed(RLE, [127, 0].repeat(15)),
        ),
        case("piz-garbage", "a wavelet block of noise", "pixels", packed(PIZ, garbage[..31].to_vec())),
        case("piz-range", "a wavelet block with values out of range", "pixels", packed(PIZ, vec![255; 31])),
        Case::new("exr-folder", "a folder in place of the file", RUN, &["map.exr"]).item(FILE, Item::Folder),
        Case::new("exr-pipe", "a pipe in place of the file", RUN, &["map.exr", "not a regular file"])
            .item(FILE, Item::Pipe),
    ]
}

fn cut(case: Make<'_>) -> Vec<Case> {
    let length = good().len();
    let header = Exr::small().header().len();
    let places = [3, 4, 7, 8, 9, header - 1, header, header + 8, header + 16, header + 23, length - 1];
    let cut = |at: usize| {
        let place = if at <= header { "" } else { "EXR" };
        case(&format!("cut-at-{at}"), "a truncated good file", place, good()[..at].to_vec())
    };
    cuts(length, &places, 6).into_iter().map(cut).collect()
}

/// A well-formed file of one channel of zeros. Every block of sixteen lines is `block`.
pub(super) fn zeros(columns: i32, rows: i32, block: &[u8]) -> Vec<u8> {
    let blocks = (0..rows / 16).map(|index| (16 * index, block.to_vec()));
    Exr { blocks: blocks.collect(), ..Exr::new(columns, rows, ZIP) }.bytes()
}
