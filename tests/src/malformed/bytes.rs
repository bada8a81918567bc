//! Bytes for malformed files: truncation, deflate streams, digests, and files of a good pack.

use std::path::Path;

/// The lengths to truncate a file to: each of `places`, and `steps` - 1 evenly spaced ones, without duplicates and
/// below `length`.
pub fn cuts(length: usize, places: &[usize], steps: usize) -> Vec<usize> {
    let even = (1..steps).map(|step| step * length / steps);
    let mut all: Vec<usize> = places.iter().copied().chain(even).filter(|&at| at < length).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// `count` equal bytes as a zlib stream, about a thousandth as long.
pub fn bomb(byte: u8, count: usize) -> Vec<u8> {
    zlib(&vec![byte; count])
}

/// The bytes as a zlib stream.
pub fn zlib(bytes: &[u8]) -> Vec<u8> {
    miniz_oxide::deflate::compress_to_vec_zlib(bytes, 9)
}

/// The SHA-256 digest in hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    use sha2::Digest;
    sha2::Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A file of the committed pack `facets`. Read when a test asks for it, so that this crate is built without the repository around
/// it, too.
pub(super) fn of_good_pack(name: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/packs/facets").join(name);
    std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
