//! SHA-256 of bytes and files.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use sha2::{Digest, Sha256};

/// A SHA-256.
pub type Sha = [u8; 32];

/// The SHA-256 of some bytes.
pub fn sha(bytes: &[u8]) -> Sha {
    Sha256::digest(bytes).into()
}

/// The size in bytes and the SHA-256, in hexadecimal digits, of a regular file of any size.
pub fn of_file(path: &Path) -> io::Result<(u64, String)> {
    sha_of_file(path).map(|(bytes, sha)| (bytes, hex(&sha)))
}

/// The size in bytes and the SHA-256 of a regular file of any size.
pub fn sha_of_file(path: &Path) -> io::Result<(u64, Sha)> {
    // Asked before the file is opened: opening a pipe waits for its writer.
    if !std::fs::metadata(path)?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "not a regular file"));
    }
    let mut file = File::open(path)?;
    let mut hash = Sha256::new();
    let mut part = vec![0; 1 << 16];
    let mut bytes = 0;
    loop {
        match file.read(&mut part)? {
            0 => return Ok((bytes, hash.finalize().into())),
            count => {
                hash.update(&part[..count]);
                bytes += count as u64;
            }
        }
    }
}

/// One digest for several parts: a single part's own (what `sha256sum` prints for that file), else the
/// SHA-256 of the parts' digests one after the other.
pub fn combine(parts: &[Sha]) -> String {
    match parts {
        [only] => hex(only),
        several => hex(&sha(several.as_flattened())),
    }
}

/// Lower-case hexadecimal digits.
pub fn hex(sha: &Sha) -> String {
    sha.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_part_has_its_own_digest() {
        // FIPS 180-4, the example "abc".
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(combine(&[sha(b"abc")]), abc);
        assert_ne!(combine(&[sha(b"abc"), sha(b"abc")]), abc);
    }
}
