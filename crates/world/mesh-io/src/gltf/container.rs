//! Container of a glTF file: the chunks of a GLB, or plain JSON. (glTF 2.0, §4.4)

use raypencil_files::Fault;

/// Parts of a GLB or glTF file.
pub(super) struct Container<'a> {
    pub json: &'a [u8],
    pub bin: Option<&'a [u8]>,
}

/// Splits a file into its JSON and, in a GLB, its binary chunk. Every length is checked; no memory is allocated.
pub(super) fn split(file: &[u8]) -> Result<Container<'_>, Fault> {
    if !file.starts_with(b"glTF") {
        // A text file starts with its JSON object.
        return match file.iter().find(|byte| !byte.is_ascii_whitespace()) {
            Some(b'{') => Ok(Container { json: file, bin: None }),
            _ => Err(Fault::new(
                "first bytes",
                format!("{:02x?}", &file[..file.len().min(4)]),
                "the magic \"glTF\" of a GLB, or a JSON object",
            )),
        };
    }
    let word = |at: usize| -> Option<u32> {
        Some(u32::from_le_bytes(file.get(at..at.checked_add(4)?)?.try_into().ok()?))
    };
    let header = || Fault::new("GLB header", format!("{} bytes", file.len()), "12 bytes");
    let (version, length) = (word(4).ok_or_else(header)?, word(8).ok_or_else(header)?);
    if version != 2 {
        return Err(Fault::new("GLB header", format!("version {version}"), "version 2"));
    }
    let length = length as usize;
    // Bytes behind that length say that the file was put together, or that another one lies below it.
    if length < 12 || length != file.len() {
        let found = format!("a length of {length} in a file of {} bytes", file.len());
        let why = if length > file.len() { " (is it cut off?)" } else { "" };
        return Err(Fault::new("GLB header", found, format!("the length of the file{why}")));
    }
    let mut container = Container { json: &[], bin: None };
    let mut at = 12;
    let mut index = 0;
    while at < length {
        let place = format!("GLB chunk {index}");
        let cut = || Fault::new(&place, format!("{} bytes left", length - at), "8 bytes of a chunk header");
        if length - at < 8 {
            return Err(cut());
        }
        let size = word(at).ok_or_else(cut)? as usize;
        let kind = &file[at + 4..at + 8];
        let start = at + 8;
        if size > length - start {
            let found = format!("a length of {size} with {} bytes left", length - start);
            return Err(Fault::new(&place, found, "a chunk that ends within the file"));
        }
        let data = &file[start..start + size];
        match (index, kind) {
            (0, b"JSON") => container.json = data,
            (1, b"BIN\0") => container.bin = Some(data),
            (0, _) | (_, b"JSON" | b"BIN\0") => {
                let found = format!("type \"{}\"", kind.escape_ascii());
                return Err(Fault::new(&place, found, "first JSON, then at most one BIN, then other types"));
            }
            // Chunks of other types belong to extensions and are skipped, as the specification asks.
            _ => {}
        }
        at = start + size;
        index += 1;
    }
    if index == 0 {
        return Err(Fault::new("GLB chunk 0", "nothing", "a JSON chunk"));
    }
    Ok(container)
}
