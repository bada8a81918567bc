//! OpenEXR files that would take gigabytes of memory: they are refused before anything is decoded.

use std::path::Path;

use raypencil_files::{ExrMap, FileError, Limits, exr_from_bytes};

use super::memory::peak_bytes;

/// Compressions by their numbers in a file, and number types.
const ZIP: u8 = 3;
const HALF: i32 = 1;
const FLOAT: i32 = 2;

/// Bytes of a header with these channels, and so many more attributes of one byte.
fn header([columns, rows]: [i32; 2], kind: i32, channels: usize, more: usize) -> Vec<u8> {
    let words = |numbers: &[i32]| numbers.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>();
    let mut list: Vec<u8> = Vec::new();
    for channel in 0..channels {
        list.extend(format!("c{channel:07}\0").bytes());
        list.extend(words(&[kind, 0, 1, 1]));
    }
    list.push(0);
    let window = words(&[0, 0, columns - 1, rows - 1]);
    let mut bytes = vec![0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
    let mut attribute = |name: &str, kind: &str, value: &[u8]| {
        bytes.extend([name.as_bytes(), b"\0", kind.as_bytes(), b"\0"].concat());
        bytes.extend((value.len() as i32).to_le_bytes());
        bytes.extend(value);
    };
    attribute("channels", "chlist", &list);
    attribute("compression", "compression", &[ZIP]);
    attribute("dataWindow", "box2i", &window);
    attribute("displayWindow", "box2i", &window);
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("pixelAspectRatio", "float", &1_f32.to_le_bytes());
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &1_f32.to_le_bytes());
    for number in 0..more {
        attribute(&format!("a{number:07}"), "string", b"x");
    }
    bytes.push(0);
    bytes
}

/// A well-formed file of zeros: every block of sixteen lines is the same deflate stream, a thousandth of its cells.
fn zeros([columns, rows]: [i32; 2], kind: i32, channels: usize) -> Vec<u8> {
    let cell = if kind == HALF { 2 } else { 4 };
    let block = vec![0; 16 * columns as usize * channels * cell];
    let block = miniz_oxide::deflate::compress_to_vec_zlib(&block, 9);
    let mut bytes = header([columns, rows], kind, channels, 0);
    let blocks = rows as usize / 16;
    let mut at = bytes.len() + 8 * blocks;
    for _ in 0..blocks {
        bytes.extend((at as u64).to_le_bytes());
        at += 8 + block.len();
    }
    for index in 0..blocks {
        bytes.extend((16 * index as i32).to_le_bytes());
        bytes.extend((block.len() as i32).to_le_bytes());
        bytes.extend(&block);
    }
    bytes
}

fn read(bytes: &[u8]) -> (Result<ExrMap, FileError>, usize) {
    peak_bytes(|| exr_from_bytes(bytes, Path::new("map.exr"), &Limits::default()))
}

/// Refuses a file with these words, within 64 kB of memory.
fn assert_refused(bytes: &[u8], words: &str) {
    let (result, peak) = read(bytes);
    let error = result.expect_err("a refusal").to_string();
    assert!(error.contains(words), "{error}");
    assert!(peak < 1 << 16, "{peak} bytes for a file of {}", bytes.len());
}

#[test]
fn a_header_of_many_attributes_is_refused() {
    // 20 MB of a million attributes, each of which would take over a kilobyte.
    assert_refused(
        &header([4, 16], FLOAT, 1, 1_000_000),
        "header: 1025 attributes or more; expected at most 1024",
    );
    // Eight attributes are required; so many more are read.
    let mut most = header([4, 16], FLOAT, 1, 1016);
    let block = miniz_oxide::deflate::compress_to_vec_zlib(&[0; 256], 9);
    most.extend((most.len() as u64 + 8).to_le_bytes());
    most.extend([0, block.len() as i32].map(i32::to_le_bytes).as_flattened());
    most.extend(block);
    let map = read(&most).0.unwrap();
    // Eight of the 1024 are not texts.
    assert_eq!(map.attributes.len(), 1016);
}

#[test]
fn a_header_of_many_channels_or_bytes_is_refused() {
    assert_refused(
        &header([4, 16], FLOAT, 500_000, 0),
        "header: 1025 channels or more; expected at most 1024",
    );
    let mut long = header([4, 16], FLOAT, 1, 0);
    long.pop();
    long.extend(b"names\0string\0");
    long.extend((1_i32 << 24).to_le_bytes());
    long.resize(long.len() + (1 << 24), b'n');
    long.push(0);
    assert_refused(&long, "bytes or more; expected at most 16777216");
}

#[test]
fn parts_are_counted_before_they_are_read() {
    // The flag of several parts, and as many headers that repeat the first; an empty one ends the list.
    let parts = |count: usize, channels: usize, more: usize| {
        let one = header([4, 16], FLOAT, channels, more);
        let mut all = [&one[..8], &one[8..].repeat(count)[..], &[0]].concat();
        all[5] = 1 << 4;
        all
    };
    assert_refused(&parts(65, 1, 0), "header: 65 parts or more; expected at most 64");
    // Attributes and channels count in all parts together.
    assert_refused(&parts(40, 1, 18), "header: 1025 attributes or more; expected at most 1024");
    assert_refused(&parts(2, 513, 0), "header: 1025 channels or more; expected at most 1024");
}

#[test]
fn small_files_of_many_zeros_are_refused_and_maps_of_a_usual_size_are_read() {
    // Four channels in half precision of 2^16 x 1024 cells: 512 MB after decoding, 2 GB as doubles.
    let bytes = zeros([1 << 16, 1024], HALF, 4);
    assert!(bytes.len() < 600_000, "{} bytes", bytes.len());
    assert_refused(
        &bytes,
        "data window: 65536 x 1024 cells of 4 channels, 2147483648 bytes as doubles, in a file",
    );

    // A camera that sees nothing: 1024 x 1024 cells of ten quantities, a thousand times smaller as a file.
    let bytes = zeros([1024, 1024], FLOAT, 10);
    assert!(bytes.len() < 50_000, "{} bytes", bytes.len());
    let (map, peak) = read(&bytes);
    assert_eq!(map.unwrap().channels.len(), 10);
    // 40 MB of samples, and blocks on their way.
    assert!(peak < 60_000_000, "{peak}");
}

#[test]
fn a_channel_that_is_there_twice_is_refused_by_its_name() {
    let mut bytes = zeros([4, 16], FLOAT, 2);
    let name = b"c0000001\0";
    let at = bytes.windows(name.len()).position(|window| window == name).unwrap();
    bytes[at + 7] = b'0';
    let error = read(&bytes).0.unwrap_err().to_string();
    assert_eq!(error, "map.exr: channel \"c0000000\": there twice; expected each channel once");
}

/// A claim that equals its limits passes: only what comes after the header is missing here.
#[test]
fn a_claim_may_equal_its_limit() {
    let too_short = "a size that the file can hold (is it cut off?)";
    // 2^26 cells, which are 2^29 bytes as doubles; and a line more.
    assert_refused(&header([8192, 8192], HALF, 1, 0), too_short);
    assert_refused(&header([8192, 8193], HALF, 1, 0), "expected 1 to 67108864 cells");
    assert_refused(&header([4096, 8192], HALF, 2, 0), too_short);
    assert_refused(&header([4096, 8193], HALF, 2, 0), "as doubles, in a file");
    // 64 cells of two bytes.
    let limits = Limits { bytes: 128, cells: 64, size: None };
    let of = |rows: i32| {
        exr_from_bytes(&zeros([4, rows], HALF, 1), Path::new("map.exr"), &limits).map(|map| map.height).ok()
    };
    assert_eq!((of(16), of(32)), (Some(16), None));
}
