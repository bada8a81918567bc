//! Tags of a TIFF, checked against the length of the file before memory is allocated. (TIFF 6.0, section 2; BigTIFF)
//!
//! The `tiff` crate decodes the samples. It would read these tags too, but it trusts their numbers in sums and
//! products, and its errors name neither the tag nor the place of the fault.

use std::collections::BTreeMap;
use std::io::{Read, Seek, SeekFrom};

use raypencil_files::Fault;

/// Maximum number of tags in a directory.
const MAX_TAGS: u64 = 4096;

/// Maximum number of values, or characters, of a tag that is read as a whole.
const MAX_VALUES: u64 = 1 << 20;

/// Size of a value by its type, bytes; 0 for undefined types. (TIFF 6.0, page 15; BigTIFF: 16 to 18)
const TYPE_BYTES: [u8; 19] = [0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0, 0, 8, 8, 8];

/// Number and name of a tag, for messages.
pub(super) fn tag_name(tag: u16) -> String {
    let name = match tag {
        254 => "NewSubfileType",
        256 => "ImageWidth",
        257 => "ImageLength",
        258 => "BitsPerSample",
        259 => "Compression",
        262 => "PhotometricInterpretation",
        266 => "FillOrder",
        273 => "StripOffsets",
        274 => "Orientation",
        277 => "SamplesPerPixel",
        278 => "RowsPerStrip",
        279 => "StripByteCounts",
        317 => "Predictor",
        322 => "TileWidth",
        323 => "TileLength",
        324 => "TileOffsets",
        325 => "TileByteCounts",
        339 => "SampleFormat",
        33550 => "ModelPixelScaleTag",
        33922 => "ModelTiepointTag",
        34264 => "ModelTransformationTag",
        34735 => "GeoKeyDirectoryTag",
        34736 => "GeoDoubleParamsTag",
        34737 => "GeoAsciiParamsTag",
        42112 => "GDAL_METADATA",
        42113 => "GDAL_NODATA",
        _ => return format!("tag {tag}"),
    };
    format!("tag {tag} {name}")
}

/// Type, number and place of a tag's values.
#[derive(Debug, Clone, Copy)]
struct Entry {
    kind: u16,
    count: u64,
    /// Byte of the file at which the first value begins.
    at: u64,
}

impl Entry {
    fn size(self) -> u64 {
        u64::from(TYPE_BYTES[usize::from(self.kind)])
    }
}

/// Tags of one image. All their values lie within the file.
pub(super) struct Tags {
    is_big_endian: bool,
    is_big: bool,
    length: u64,
    entries: BTreeMap<u16, Entry>,
    /// Byte of the file at which the next image's tags begin; 0 if there is no other image.
    pub next: u64,
}

impl Tags {
    /// The tags of the first image in a file of `length` bytes.
    pub fn first(file: &mut (impl Read + Seek), length: u64) -> Result<Self, Fault> {
        let wanted = "a TIFF: II or MM, then 42 (or 43, BigTIFF)";
        let cut = || Fault::new("first bytes", format!("a file of {length} bytes"), wanted);
        let head: [u8; 4] = bytes(file, 0, 4).ok().and_then(|head| head.try_into().ok()).ok_or_else(cut)?;
        let (is_big_endian, is_big) = match &head {
            b"II*\0" => (false, false),
            b"MM\0*" => (true, false),
            b"II+\0" => (false, true),
            b"MM\0+" => (true, true),
            other => return Err(Fault::new("first bytes", format!("{other:02x?}"), wanted)),
        };
        let empty = Self { is_big_endian, is_big, length, entries: BTreeMap::new(), next: 0 };
        let at = match is_big {
            false => empty.number(&bytes(file, 4, 4).map_err(|_| cut())?),
            true => {
                let rest = bytes(file, 4, 12).map_err(|_| cut())?;
                if [empty.number(&rest[..2]), empty.number(&rest[2..4])] != [8, 0] {
                    return Err(Fault::new(
                        "first bytes",
                        format!("{rest:02x?}"),
                        "a BigTIFF of 8-byte offsets",
                    ));
                }
                empty.number(&rest[4..])
            }
        };
        empty.directory(file, at)
    }

    /// The tags at `at` in the same file.
    pub fn directory(&self, file: &mut (impl Read + Seek), at: u64) -> Result<Self, Fault> {
        let place = format!("directory at byte {at}");
        let cut = |_| {
            Fault::new(&place, format!("an end of the file at byte {}", self.length), "a directory of tags")
        };
        let (count_size, entry_size, word) = if self.is_big { (8, 20, 8) } else { (2, 12, 4) };
        let count = self.number(&bytes(file, at, count_size).map_err(cut)?);
        if !(1..=MAX_TAGS).contains(&count) {
            return Err(Fault::new(&place, format!("{count} tags"), format!("1 to {MAX_TAGS}")));
        }
        let entries_at = at + count_size;
        let all = bytes(file, entries_at, count * entry_size + word).map_err(cut)?;
        let (all, next) = all.split_at((count * entry_size) as usize);
        let mut entries = BTreeMap::new();
        for (index, entry) in all.chunks_exact(entry_size as usize).enumerate() {
            let [tag, kind] = [self.number(&entry[..2]) as u16, self.number(&entry[2..4]) as u16];
            // Undefined types are skipped. (TIFF 6.0, page 16)
            let Some(size) = TYPE_BYTES.get(usize::from(kind)).copied().filter(|size| *size > 0) else {
                continue;
            };
            let (count, value) = entry[4..].split_at(word as usize);
            let count = self.number(count);
            let length = count.saturating_mul(u64::from(size));
            let at = match length <= word {
                true => entries_at + index as u64 * entry_size + 4 + word,
                false => self.number(value),
            };
            if at.checked_add(length).is_none_or(|end| end > self.length) {
                let found = format!("{count} values of {size} bytes from byte {at}");
                return Err(Fault::new(
                    tag_name(tag),
                    found,
                    format!("values within the file of {} bytes", self.length),
                ));
            }
            entries.insert(tag, Entry { kind, count, at });
        }
        let Self { is_big_endian, is_big, length, .. } = *self;
        Ok(Self { is_big_endian, is_big, length, entries, next: self.number(next) })
    }

    /// Whether numbers begin with their highest byte.
    pub fn is_big_endian(&self) -> bool {
        self.is_big_endian
    }

    /// `count` bytes of the file from byte `at` on.
    pub fn bytes(&self, file: &mut (impl Read + Seek), at: u64, count: u64) -> std::io::Result<Vec<u8>> {
        bytes(file, at, count)
    }

    /// Number of a tag's values; 0 without the tag.
    pub fn count(&self, tag: u16) -> u64 {
        self.entries.get(&tag).map_or(0, |entry| entry.count)
    }

    /// `count` whole numbers of a tag, from its value `first` on.
    ///
    /// # Errors
    /// The tag is missing, is of another type or has fewer values.
    pub fn run(
        &self,
        file: &mut (impl Read + Seek),
        tag: u16,
        first: u64,
        count: u64,
    ) -> Result<Vec<u64>, Fault> {
        let Some(entry) = self.entries.get(&tag) else {
            return Err(Fault::new(tag_name(tag), "missing", "it is there"));
        };
        if !matches!(entry.kind, 1 | 3 | 4 | 13 | 16 | 18) {
            return Err(Fault::new(tag_name(tag), format!("values of type {}", entry.kind), "whole numbers"));
        }
        if first.checked_add(count).is_none_or(|end| end > entry.count) {
            return Err(Fault::new(
                tag_name(tag),
                format!("{} values", entry.count),
                format!("{}", first + count),
            ));
        }
        let bytes = self.values(file, tag, entry.at + first * entry.size(), count * entry.size())?;
        Ok(bytes.chunks_exact(entry.size() as usize).map(|value| self.number(value)).collect())
    }

    /// All whole numbers of a tag; `None` without the tag.
    pub fn integers(&self, file: &mut (impl Read + Seek), tag: u16) -> Result<Option<Vec<u64>>, Fault> {
        match self.bounded_count(tag)? {
            Some(count) => self.run(file, tag, 0, count).map(Some),
            None => Ok(None),
        }
    }

    /// The only whole number of a tag; `None` without the tag.
    pub fn integer(&self, file: &mut (impl Read + Seek), tag: u16) -> Result<Option<u64>, Fault> {
        match self.integers(file, tag)?.as_deref() {
            None => Ok(None),
            Some(&[value]) => Ok(Some(value)),
            Some(values) => Err(Fault::new(tag_name(tag), format!("{} values", values.len()), "one")),
        }
    }

    /// All doubles of a tag, which may be infinite or NaN; `None` without the tag.
    pub fn reals(&self, file: &mut (impl Read + Seek), tag: u16) -> Result<Option<Vec<f64>>, Fault> {
        let Some(count) = self.bounded_count(tag)? else { return Ok(None) };
        let entry = self.entries[&tag];
        if entry.kind != 12 {
            return Err(Fault::new(
                tag_name(tag),
                format!("values of type {}", entry.kind),
                "doubles, type 12",
            ));
        }
        let bytes = self.values(file, tag, entry.at, 8 * count)?;
        Ok(Some(bytes.chunks_exact(8).map(|value| f64::from_bits(self.number(value))).collect()))
    }

    /// Text of a tag up to its null byte; `None` without the tag. Bytes that are not UTF-8 are replaced.
    pub fn text(&self, file: &mut (impl Read + Seek), tag: u16) -> Result<Option<String>, Fault> {
        let Some(count) = self.bounded_count(tag)? else { return Ok(None) };
        let entry = self.entries[&tag];
        if entry.kind != 2 {
            return Err(Fault::new(tag_name(tag), format!("values of type {}", entry.kind), "text, type 2"));
        }
        let bytes = self.values(file, tag, entry.at, count)?;
        let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
        Ok(Some(String::from_utf8_lossy(&bytes[..end]).into_owned()))
    }

    /// Number of the values of a tag that is read as a whole.
    fn bounded_count(&self, tag: u16) -> Result<Option<u64>, Fault> {
        match self.entries.get(&tag) {
            None => Ok(None),
            Some(entry) if entry.count <= MAX_VALUES => Ok(Some(entry.count)),
            Some(entry) => Err(Fault::new(
                tag_name(tag),
                format!("{} values", entry.count),
                format!("at most {MAX_VALUES}"),
            )),
        }
    }

    /// Bytes of values, which lie within the file.
    fn values(&self, file: &mut (impl Read + Seek), tag: u16, at: u64, count: u64) -> Result<Vec<u8>, Fault> {
        bytes(file, at, count)
            .map_err(|error| Fault::new(tag_name(tag), format!("unreadable: {error}"), "readable values"))
    }

    /// A whole number of up to 8 bytes, in the byte order of the file.
    fn number(&self, bytes: &[u8]) -> u64 {
        let add = |number: u64, byte: &u8| number << 8 | u64::from(*byte);
        match self.is_big_endian {
            true => bytes.iter().fold(0, add),
            false => bytes.iter().rev().fold(0, add),
        }
    }
}

/// `count` bytes of the file from byte `at` on. The memory grows only with bytes that exist.
fn bytes(file: &mut (impl Read + Seek), at: u64, count: u64) -> std::io::Result<Vec<u8>> {
    file.seek(SeekFrom::Start(at))?;
    let mut bytes = Vec::new();
    file.take(count).read_to_end(&mut bytes)?;
    match bytes.len() as u64 == count {
        true => Ok(bytes),
        false => Err(std::io::ErrorKind::UnexpectedEof.into()),
    }
}
