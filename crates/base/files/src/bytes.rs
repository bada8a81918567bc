//! Reading a whole file or stream, up to a size that is sane for its kind.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use crate::limits::part_of_memory;

/// The bytes of a regular file of at most `max_bytes` bytes.
///
/// # Errors
/// The file system's error. A pipe or a device is refused, since it might never end. So is a file that is larger than
/// `max_bytes`, or grows beyond it while it is read.
pub fn read_file(path: &Path, max_bytes: u64) -> io::Result<Vec<u8>> {
    // Asked before the file is opened: opening a pipe waits for its writer.
    let metadata = std::fs::metadata(path)?;
    if !metadata.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "not a regular file"));
    }
    let memory = part_of_memory(1);
    if metadata.len() > memory {
        let words = format!(
            "{} bytes; expected at most {memory}, the memory that there is for it (--max-memory)",
            metadata.len()
        );
        return Err(io::Error::new(io::ErrorKind::OutOfMemory, words));
    }
    let too_large = || io::Error::new(io::ErrorKind::InvalidData, format!("larger than {max_bytes} bytes"));
    if metadata.len() > max_bytes {
        return Err(too_large());
    }
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len()).map_err(|_| too_large())?);
    read_to_end(File::open(path)?, &mut bytes, max_bytes)?;
    Ok(bytes)
}

/// All bytes of a stream, such as standard input, if there are at most `max_bytes`.
///
/// # Errors
/// The stream's error, or that it is longer.
pub fn read_stream(stream: impl Read, max_bytes: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    read_to_end(stream, &mut bytes, max_bytes)?;
    Ok(bytes)
}

fn read_to_end(stream: impl Read, bytes: &mut Vec<u8>, max_bytes: u64) -> io::Result<()> {
    stream.take(max_bytes + 1).read_to_end(bytes)?;
    if bytes.len() as u64 > max_bytes {
        return Err(io::Error::new(io::ErrorKind::InvalidData, format!("longer than {max_bytes} bytes")));
    }
    Ok(())
}
