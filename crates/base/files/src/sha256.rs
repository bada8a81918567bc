//! SHA-256 of bytes and of files. (FIPS 180-4)

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use sha2::{Digest, Sha256};

/// A SHA-256 digest.
pub type Sha256Digest = [u8; 32];

/// Digest of `bytes`.
///
/// ```
/// use raypencil_files::{hex_digits, sha256};
///
/// // FIPS 180-4, the example "abc".
/// let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
/// assert_eq!(hex_digits(&sha256(b"abc")), abc);
/// ```
pub fn sha256(bytes: &[u8]) -> Sha256Digest {
    Sha256::digest(bytes).into()
}

/// Size in bytes of a regular file of any size, and its digest in hexadecimal digits.
///
/// # Errors
/// As [`file_sha256`].
pub fn file_sha256_hex(path: &Path) -> io::Result<(u64, String)> {
    file_sha256(path).map(|(bytes, digest)| (bytes, hex_digits(&digest)))
}

/// Size in bytes of a regular file of any size, and its digest.
///
/// # Errors
/// The file system's error. A pipe or a device is refused.
pub fn file_sha256(path: &Path) -> io::Result<(u64, Sha256Digest)> {
    // Asked before the file is opened: opening a pipe waits for its writer.
    if !std::fs::metadata(path)?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "not a regular file"));
    }
    let mut file = File::open(path)?;
    let mut hash = Sha256::new();
    let mut buffer = vec![0; 1 << 16];
    let mut bytes = 0;
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok((bytes, hash.finalize().into())),
            count => {
                hash.update(&buffer[..count]);
                bytes += count as u64;
            }
        }
    }
}

/// One digest for several parts, in hexadecimal digits.
///
/// A single part keeps its own digest, which is what `sha256sum` prints for that file. Several parts have the SHA-256
/// of their digests one after the other.
pub fn combined_sha256_hex(parts: &[Sha256Digest]) -> String {
    match parts {
        [only] => hex_digits(only),
        several => hex_digits(&sha256(several.as_flattened())),
    }
}

/// Lower-case hexadecimal digits of a digest, 64 of them.
pub fn hex_digits(digest: &Sha256Digest) -> String {
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_part_has_its_own_digest() {
        // FIPS 180-4, the example "abc".
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(combined_sha256_hex(&[sha256(b"abc")]), abc);
        assert_ne!(combined_sha256_hex(&[sha256(b"abc"), sha256(b"abc")]), abc);
    }

    #[test]
    fn each_of_several_parts_and_their_order_count() {
        let parts = [sha256(b"1"), sha256(b"2"), sha256(b"3")];
        let [first, second, third] = parts;
        assert_eq!(combined_sha256_hex(&parts), hex_digits(&sha256(&[first, second, third].concat())));
        assert_ne!(combined_sha256_hex(&[second, first, third]), combined_sha256_hex(&parts));
        assert_ne!(combined_sha256_hex(&parts[..2]), combined_sha256_hex(&parts));
    }

    #[test]
    fn a_file_of_several_pieces_has_the_size_and_the_digest_of_all() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("large");
        // Two buffers and a bit.
        let bytes: Vec<u8> = (0..(1_u32 << 17) + 5).map(|k| (k % 251) as u8).collect();
        std::fs::write(&path, &bytes).unwrap();
        assert_eq!(file_sha256(&path).unwrap(), ((1 << 17) + 5, sha256(&bytes)));
    }
}
