//! Buffers of a glTF file: its binary chunk, data URIs and files beside it. (glTF 2.0, §3.6.1)

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf::json::Root;
use raypencil_files::{Fault, Sha256Digest, bytes, sha256};

use crate::gltf::limits::MAX_BUFFER_FILES_BYTES;

/// Buffers, loaded when they are first needed; those of textures and animations never are.
pub(super) struct Buffers<'a> {
    root: &'a Root,
    folder: &'a Path,
    bin: Option<&'a [u8]>,
    loaded: BTreeMap<usize, Loaded<'a>>,
    /// Files of buffers by their real paths, each read once.
    files: BTreeMap<PathBuf, BufferFile>,
    /// Bytes of these files.
    file_bytes: u64,
}

/// Where the bytes of a buffer are.
enum Loaded<'a> {
    /// In the binary chunk.
    Chunk(&'a [u8]),
    /// Decoded from a data URI.
    Data(Vec<u8>),
    /// In a file, which other buffers may name too.
    File(PathBuf),
}

struct BufferFile {
    bytes: Vec<u8>,
    digest: Sha256Digest,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(root: &'a Root, folder: &'a Path, bin: Option<&'a [u8]>) -> Self {
        Self { root, folder, bin, loaded: BTreeMap::new(), files: BTreeMap::new(), file_bytes: 0 }
    }

    /// Digests of the files that were read, in the order of their buffers: one for each buffer in a file.
    pub(super) fn digests(&self) -> impl Iterator<Item = Sha256Digest> + '_ {
        self.loaded.values().filter_map(|loaded| match loaded {
            Loaded::File(path) => self.files.get(path).map(|file| file.digest),
            Loaded::Chunk(_) | Loaded::Data(_) => None,
        })
    }

    /// The files that the buffers name, as they are named, each once, with their digests. One that cannot be read is left out.
    pub(super) fn files(mut self) -> Vec<(PathBuf, Sha256Digest)> {
        let mut found: Vec<(PathBuf, Sha256Digest)> = Vec::new();
        let root = self.root;
        for (index, buffer) in root.buffers.iter().enumerate() {
            let Some(uri) = buffer.uri.as_ref().filter(|uri| !uri.starts_with("data:")) else { continue };
            let Ok(real) = self.external(index, uri) else { continue };
            let name = self.folder.join(percent_decoded(uri).unwrap_or_default());
            let digest = self.files.get(&real).map(|file| file.digest);
            found.extend(
                digest.filter(|_| found.iter().all(|(own, _)| *own != name)).map(|digest| (name, digest)),
            );
        }
        found
    }

    /// Bytes of a buffer view.
    ///
    /// # Errors
    /// The view does not lie within its buffer, or the buffer not within its bytes.
    pub(super) fn view(&mut self, index: usize) -> Result<&[u8], Fault> {
        let place = || format!("buffer view {index}");
        let count = self.root.buffer_views.len();
        let view = self.root.buffer_views.get(index).ok_or_else(|| missing_reference(place(), count))?;
        let (offset, length) = (view.byte_offset.map_or(0, |offset| offset.0), view.byte_length.0);
        let buffer = self.buffer(view.buffer.value())?;
        let range = offset
            .checked_add(length)
            .and_then(|end| Some(usize::try_from(offset).ok()?..usize::try_from(end).ok()?));
        range.and_then(|range| buffer.get(range)).ok_or_else(|| {
            let found = format!("{length} bytes from byte {offset}");
            let buffer_index = view.buffer.value();
            Fault::new(place(), found, format!("a part of buffer {buffer_index} of {} bytes", buffer.len()))
        })
    }

    fn buffer(&mut self, index: usize) -> Result<&[u8], Fault> {
        let place = || format!("buffer {index}");
        let count = self.root.buffers.len();
        let buffer = self.root.buffers.get(index).ok_or_else(|| missing_reference(place(), count))?;
        if !self.loaded.contains_key(&index) {
            let bytes = match &buffer.uri {
                Some(uri) => match uri.strip_prefix("data:") {
                    Some(data) => Loaded::Data(data_uri(data, &place())?),
                    None => Loaded::File(self.external(index, uri)?),
                },
                None => match (index, self.bin) {
                    (0, Some(bin)) => Loaded::Chunk(bin),
                    _ => {
                        return Err(Fault::new(
                            place(),
                            "no uri",
                            "a uri, or buffer 0 of a GLB with a BIN chunk",
                        ));
                    }
                },
            };
            self.loaded.insert(index, bytes);
        }
        let bytes: &[u8] = match self.loaded.get(&index) {
            Some(Loaded::Chunk(bytes)) => bytes,
            Some(Loaded::Data(bytes)) => bytes,
            Some(Loaded::File(path)) => self.files.get(path).map_or(&[], |file| &file.bytes),
            None => &[],
        };
        // A BIN chunk may be longer than its buffer, by its padding.
        usize::try_from(buffer.byte_length.0).ok().and_then(|length| bytes.get(..length)).ok_or_else(|| {
            let found = format!("{} bytes", bytes.len());
            Fault::new(place(), found, format!("the {} bytes of its byteLength", buffer.byte_length.0))
        })
    }

    /// Reads a file in the folder of the glTF file, or below it, unless another buffer named it before. Returns its real
    /// path.
    fn external(&mut self, index: usize, uri: &str) -> Result<PathBuf, Fault> {
        let place = format!("buffer {index}");
        let quoted: String = uri.chars().take(80).collect();
        let refuse = |why: &str| {
            Fault::new(
                &place,
                format!("uri \"{}\" {why}", quoted.escape_debug()),
                "a file in the folder of this one, or below it",
            )
        };
        let relative = percent_decoded(uri).ok_or_else(|| refuse("has a broken % escape"))?;
        // Backslashes and colons have a meaning on some systems: folders, drives, schemes, streams.
        if relative.contains([':', '\\', '\0']) {
            return Err(refuse("has a scheme, a drive or a backslash"));
        }
        // Also where it comes back into the folder: what `..` means depends on links.
        if relative.split('/').any(|part| part == "..") {
            return Err(refuse("has the part .., which is refused"));
        }
        if relative.is_empty() || relative.split('/').any(str::is_empty) {
            return Err(refuse("is absolute or names no file"));
        }
        let path = self.folder.join(PathBuf::from(&relative));
        // A symbolic link may lead out of the folder where the name does not.
        let folder = if self.folder.as_os_str().is_empty() { Path::new(".") } else { self.folder };
        let real = path.canonicalize().and_then(|path| Ok((path, folder.canonicalize()?)));
        let Ok((path, folder)) = real else { return Err(refuse("does not exist")) };
        if !path.starts_with(folder) {
            return Err(refuse("leads out of the folder by a link"));
        }
        if !self.files.contains_key(&path) {
            let left = MAX_BUFFER_FILES_BYTES - self.file_bytes;
            if let Some(length) =
                std::fs::metadata(&path).ok().map(|file| file.len()).filter(|length| *length > left)
            {
                let found = format!("a file of {length} bytes after {} bytes of others", self.file_bytes);
                let expected = format!("at most {MAX_BUFFER_FILES_BYTES} bytes in all files of buffers");
                return Err(Fault::new(&place, found, expected));
            }
            let bytes =
                bytes::read_file(&path, left).map_err(|error| refuse(&format!("cannot be read: {error}")))?;
            self.file_bytes += bytes.len() as u64;
            let digest = sha256(&bytes);
            self.files.insert(path.clone(), BufferFile { bytes, digest });
        }
        Ok(path)
    }
}

/// A fault of a reference to one of `count` things, which the file does not have.
pub(super) fn missing_reference(place: String, count: usize) -> Fault {
    Fault::new(place, "does not exist", format!("an index below {count}"))
}

/// Bytes of a data URI `data:[<type>];base64,<digits>`; `data` is its part after `data:`.
fn data_uri(data: &str, place: &str) -> Result<Vec<u8>, Fault> {
    let digits = data
        .split_once(',')
        .filter(|(head, _)| head.ends_with(";base64"))
        .map(|(_, digits)| digits)
        .ok_or_else(|| {
            Fault::new(place, "a data URI without base64", "data:application/octet-stream;base64,...")
        })?;
    STANDARD
        .decode(digits)
        .map_err(|error| Fault::new(place, format!("a data URI: {error}"), "base64 with padding (RFC 4648)"))
}

/// `a%20b` as `a b`; `None` if an escape is broken or the result is not UTF-8.
fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'%' => {
                let mut digit = || char::from(rest.next()?).to_digit(16);
                u8::try_from(digit()? * 16 + digit()?).ok()?
            }
            plain => plain,
        });
    }
    String::from_utf8(bytes).ok()
}
