//! Malformed GeoTIFF elevation models. (TIFF 6.0; BigTIFF; GeoTIFF 1.1, OGC 19-008r4)

use super::bytes::{bomb, cuts, zlib};
use super::case::{Case, Item};

const FILE: &str = "ground.tif";
const RUN: &str = "validate ground.tif -o out";

const WIDTH: u16 = 256;
const HEIGHT: u16 = 257;
const BITS: u16 = 258;
const COMPRESSION: u16 = 259;
const OFFSETS: u16 = 273;
const SAMPLES: u16 = 277;
const ROWS: u16 = 278;
const COUNTS: u16 = 279;
const FORMAT: u16 = 339;
const SCALE: u16 = 33550;
const TIEPOINT: u16 = 33922;
const GEO_KEYS: u16 = 34735;
const DEFLATE: u32 = 8;
const ZSTD: u32 = 50_000;

/// An entry of a directory: tag, type, number of values, and the bytes of the values.
type Entry = (u16, u16, u32, Vec<u8>);

/// A little-endian file of one strip and one directory with any entries. (The writer of well-formed files, with types,
/// codecs and tiles, is in `crates/world/mesh-io/tests/it/dem/write.rs`.)
#[derive(Clone)]
struct Tiff {
    entries: Vec<Entry>,
    strip: Vec<u8>,
    next: u32,
}

/// Offset of the strip in bytes: after the header.
const STRIP_OFFSET: u32 = 8;

impl Tiff {
    /// A well-formed file: 4 x 3 posts of single precision, 0.5 m apart.
    fn good() -> Self {
        let doubles =
            |numbers: &[f64]| numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>();
        let strip: Vec<u8> = (0..12_u8).flat_map(|post| (f32::from(post) / 8.0).to_le_bytes()).collect();
        let plain = [
            (WIDTH, 4),
            (HEIGHT, 3),
            (BITS, 32),
            (COMPRESSION, 1),
            (262, 1),
            (OFFSETS, STRIP_OFFSET),
            (SAMPLES, 1),
            (ROWS, 3),
            (COUNTS, strip.len() as u32),
            (FORMAT, 3),
        ];
        let mut entries: Vec<Entry> =
            plain.into_iter().map(|(tag, value)| (tag, 4, 1, value.to_le_bytes().to_vec())).collect();
        entries.push((SCALE, 12, 3, doubles(&[0.5, 0.5, 0.0])));
        entries.push((TIEPOINT, 12, 6, doubles(&[0.0, 0.0, 0.0, 100.0, 200.0, 0.0])));
        Self { entries, strip, next: 0 }
    }

    /// Sets an entry to one 32-bit integer.
    fn with(mut self, tag: u16, value: u32) -> Self {
        self.entries.retain(|entry| entry.0 != tag);
        self.entry((tag, 4, 1, value.to_le_bytes().to_vec()))
    }

    /// Sets an entry.
    fn entry(mut self, entry: Entry) -> Self {
        self.entries.retain(|known| known.0 != entry.0);
        self.entries.push(entry);
        self.entries.sort_by_key(|entry| entry.0);
        self
    }

    /// Removes an entry.
    fn without(mut self, tag: u16) -> Self {
        self.entries.retain(|entry| entry.0 != tag);
        self
    }

    /// Sets the bytes of the strip and their count.
    fn strip(mut self, bytes: Vec<u8>) -> Self {
        self.strip = bytes;
        let count = self.strip.len() as u32;
        self.with(COUNTS, count)
    }

    /// The bytes of the file.
    fn bytes(&self) -> Vec<u8> {
        let directory = (STRIP_OFFSET as usize + self.strip.len()).next_multiple_of(2);
        let mut bytes = b"II\x2a\0".to_vec();
        bytes.extend((directory as u32).to_le_bytes());
        bytes.extend(&self.strip);
        bytes.resize(directory, 0);
        let mut elsewhere = directory + 2 + 12 * self.entries.len() + 4;
        let mut far: Vec<u8> = Vec::new();
        bytes.extend((self.entries.len() as u16).to_le_bytes());
        for (tag, kind, count, value) in &self.entries {
            bytes.extend(tag.to_le_bytes());
            bytes.extend(kind.to_le_bytes());
            bytes.extend(count.to_le_bytes());
            if value.len() > 4 {
                bytes.extend((elsewhere as u32).to_le_bytes());
                elsewhere += value.len();
                far.extend(value);
            } else {
                let mut word = value.clone();
                word.resize(4, 0);
                bytes.extend(word);
            }
        }
        bytes.extend(self.next.to_le_bytes());
        bytes.extend(far);
        bytes
    }
}

/// The malformed TIFFs.
pub fn tiffs() -> Vec<Case> {
    let good = Tiff::good;
    let case = |name: &str, what, place: &'static str, bytes: Vec<u8>| {
        Case::new(format!("tiff-{name}"), what, RUN, &[FILE, place]).file(FILE, bytes)
    };
    let doubles =
        |numbers: &[f64]| numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>();
    let directory = 8 + good().strip.len();
    let mut big = b"II\x2b\0\x08\0\0\0".to_vec();
    big.extend(u64::MAX.to_le_bytes());
    let mut endless = good();
    endless.next = directory as u32;
    let mut cases = vec![
        case("empty", "an empty file", "first bytes", Vec::new()),
        case("words", "plain text of another kind", "first bytes", b"Dear rover,".to_vec()),
        case("magic", "an unknown magic number", "first bytes", [b"II\x2c\0", &good().bytes()[4..]].concat()),
        case("order", "a mixed byte order", "first bytes", [b"IM\x2a\0", &good().bytes()[4..]].concat()),
        case("directory-0", "a directory at byte 0", "directory at byte 0", b"II\x2a\0\0\0\0\0".to_vec()),
        case(
            "directory-beyond",
            "a directory beyond the file",
            "directory at byte 4294967295",
            b"II\x2a\0\xff\xff\xff\xff".to_vec(),
        ),
        case(
            "big-beyond",
            "a BigTIFF directory at byte 2^64 - 1",
            "directory at byte 18446744073709551615",
            big,
        ),
        case("endless", "a directory that names itself as the next", "ImageWidth: missing", {
            // Without a width, so that a reader of the first directory alone refuses it too.
            Tiff { entries: good().without(WIDTH).entries, ..endless }.bytes()
        }),
        case("entries", "a directory of 65535 entries in a few bytes", "directory at byte 56: 65535 tags", {
            let mut bytes = good().bytes();
            bytes[directory..directory + 2].fill(255);
            bytes
        }),
        case("no-width", "no width", "ImageWidth: missing", good().without(WIDTH).bytes()),
        case("width-0", "a width of 0", "ImageWidth: 0", good().with(WIDTH, 0).bytes()),
        case(
            "square",
            "2,000,000 x 2,000,000 posts in a few hundred bytes",
            "2000000 x 2000000 posts",
            good().with(WIDTH, 2_000_000).with(HEIGHT, 2_000_000).with(ROWS, 2_000_000).bytes(),
        ),
        case("square-deflate", "the same size, compressed", "2000000 x 2000000 posts", {
            good()
                .with(WIDTH, 2_000_000)
                .with(HEIGHT, 2_000_000)
                .with(ROWS, 2_000_000)
                .with(COMPRESSION, DEFLATE)
                .strip(zlib(&[0; 48]))
                .bytes()
        }),
        case(
            "wraps",
            "2^32 - 1 posts along each side, whose bytes overflow 64 bits",
            "ImageWidth: 4294967295",
            good().with(WIDTH, u32::MAX).with(HEIGHT, u32::MAX).bytes(),
        ),
        case("rows-0", "strips of no rows", "RowsPerStrip: 0", good().with(ROWS, 0).bytes()),
        case(
            "tiles-0",
            "tiles of 0 x 0",
            "TileWidth: 0",
            good().with(322, 0).with(323, 0).with(324, 8).with(325, 48).bytes(),
        ),
        case(
            "tiles-top",
            "tiles of 2^32 - 1",
            "TileWidth: 4294967295",
            good().with(322, u32::MAX).with(323, u32::MAX).with(324, 8).with(325, 48).bytes(),
        ),
        case(
            "strip-beyond",
            "a strip beyond the file",
            "strip 0: 48 bytes from byte 4294967295",
            good().with(OFFSETS, u32::MAX).bytes(),
        ),
        case("strip-short", "a strip of too few posts", "strip 0: 40 bytes", good().with(COUNTS, 40).bytes()),
        case(
            "strip-long",
            "a strip of 2^32 - 1 bytes",
            "strip 0: 4294967295 bytes",
            good().with(COUNTS, u32::MAX).bytes(),
        ),
        case(
            "strips-many",
            "2^32 - 1 strips",
            "StripOffsets: 4294967295 values",
            good().entry((OFFSETS, 4, u32::MAX, vec![8; 8])).bytes(),
        ),
        case("tiles-equal", "tiles of 4 MB at the same place in the file: 5 GB out of 20 kB", "tile 1: ", {
            let list = |value: u32| value.to_le_bytes().repeat(1250);
            let tile = zlib(&vec![0; 4 << 20]);
            let bytes = tile.len() as u32;
            good()
                .strip(tile)
                .without(OFFSETS)
                .without(COUNTS)
                .without(ROWS)
                .with(WIDTH, 16)
                .with(HEIGHT, 20_000)
                .with(COMPRESSION, DEFLATE)
                .with(322, 1 << 16)
                .with(323, 16)
                .entry((324, 4, 1250, list(STRIP_OFFSET)))
                .entry((325, 4, 1250, list(bytes)))
                .bytes()
        }),
        case("strips-overlap", "strips that share a byte", "strip 1: 16 bytes from byte 39", {
            let pair = |a: u32, b: u32| [a.to_le_bytes(), b.to_le_bytes()].concat();
            good()
                .with(ROWS, 2)
                .entry((OFFSETS, 4, 2, pair(8, 39)))
                .entry((COUNTS, 4, 2, pair(32, 16)))
                .bytes()
        }),
        case(
            "bomb",
            "a deflate stream of 16 kB that expands to 16 MB, where the header promises 64 MB",
            "strip 0",
            good()
                .with(WIDTH, 4000)
                .with(HEIGHT, 4000)
                .with(ROWS, 4000)
                .with(COMPRESSION, DEFLATE)
                .strip(bomb(0, 1 << 24))
                .bytes(),
        ),
        case(
            "deflate-garbage",
            "a strip that is not a deflate stream",
            "strip 0: corrupt deflate",
            good().with(COMPRESSION, DEFLATE).strip(vec![0x5a; 40]).bytes(),
        ),
        case(
            "deflate-short",
            "a deflate stream with too few posts",
            "strip 0",
            good().with(COMPRESSION, DEFLATE).strip(zlib(&[0; 12])).bytes(),
        ),
        case(
            "lzw-garbage",
            "a strip that is not an LZW stream",
            "strip 0: invalid code",
            good().with(COMPRESSION, 5).strip(vec![0xff; 40]).bytes(),
        ),
        case(
            "zstd-garbage",
            "a strip that is not a ZSTD stream",
            "strip 0: ",
            good().with(COMPRESSION, ZSTD).strip(vec![0x5a; 40]).bytes(),
        ),
        case(
            "zstd-segment",
            "a ZSTD stream of 40 bytes that promises 2^32 - 1",
            "4294967295 bytes in place of 48",
            {
                let mut stream = vec![0x28, 0xb5, 0x2f, 0xfd, 0xa0, 0xff, 0xff, 0xff, 0xff];
                stream.resize(40, 0);
                good().with(COMPRESSION, ZSTD).strip(stream).bytes()
            },
        ),
        case(
            "zstd-bomb",
            "a ZSTD stream of 0.5 kB that expands to 16 MB, where the header promises 64 MB",
            "strip 0",
            {
                // Blocks of one byte, which is repeated 128 Ki times.
                let blocks = [2, 0, 0x10, 0].repeat(128);
                good()
                    .with(WIDTH, 4000)
                    .with(HEIGHT, 4000)
                    .with(ROWS, 4000)
                    .with(COMPRESSION, ZSTD)
                    .strip([vec![0x28, 0xb5, 0x2f, 0xfd, 0, 0x88], blocks].concat())
                    .bytes()
            },
        ),
        case("lerc", "a compression that is not read", "Compression: 34887 (LERC)", {
            good().with(COMPRESSION, 34_887).bytes()
        }),
        case("map-unknown", "a code of a map that EPSG does not have", "1500, whose unit is not known", {
            let keys = [1, 1, 0, 1, 3072, 0, 1, 1500_u16].map(u16::to_le_bytes).concat();
            good().entry((GEO_KEYS, 3, 8, keys)).bytes()
        }),
        case("keys-cut", "geo keys that are cut off", "GeoKeyDirectoryTag: ", {
            let keys = [1, 1, 0, 900, 3072, 0, 1, 32632_u16].map(u16::to_le_bytes).concat();
            good().entry((GEO_KEYS, 3, 8, keys)).bytes()
        }),
        case(
            "compression",
            "an unknown compression",
            "Compression: 60000",
            good().with(COMPRESSION, 60_000).bytes(),
        ),
        case(
            "samples",
            "65535 samples for each post",
            "SamplesPerPixel: 65535",
            good().with(SAMPLES, 65_535).bytes(),
        ),
        case("bits-0", "posts of 0 bits", "BitsPerSample: 0", good().with(BITS, 0).bytes()),
        case("complex", "complex posts", "SampleFormat: 6", good().with(FORMAT, 6).bytes()),
        case(
            "value-type",
            "a width of an unknown type",
            "ImageWidth: missing",
            good().entry((WIDTH, 99, 1, vec![4, 0, 0, 0])).bytes(),
        ),
        case(
            "scale-0",
            "posts 0 m apart",
            "ModelPixelScaleTag: [0.0, 0.0, 0.0]",
            good().entry((SCALE, 12, 3, doubles(&[0.0, 0.0, 0.0]))).bytes(),
        ),
        case(
            "scale-nan",
            "a spacing of posts that is not a number",
            "ModelPixelScaleTag: [NaN, 0.5, 0.0]",
            good().entry((SCALE, 12, 3, doubles(&[f64::NAN, 0.5, 0.0]))).bytes(),
        ),
        case(
            "scale-many",
            "2^31 scales",
            "ModelPixelScaleTag: 2147483648 values",
            good().entry((SCALE, 12, 1 << 31, vec![0; 8])).bytes(),
        ),
        case(
            "tiepoint-far",
            "a corner at 1e300 m",
            "pixel (0, 0)",
            good().entry((TIEPOINT, 12, 6, doubles(&[0.0, 0.0, 0.0, 1e300, 0.0, 0.0]))).bytes(),
        ),
        case("all-nan", "posts that are all not a number", "12 of 12 posts not known", {
            good().strip([f32::NAN; 12].iter().flat_map(|post| post.to_le_bytes()).collect()).bytes()
        }),
        Case::new("tiff-folder", "a folder in place of the file", RUN, &[FILE, "a folder"])
            .item(FILE, Item::Folder),
        Case::new("tiff-pipe", "a pipe in place of the file", RUN, &[FILE, "not a regular file"])
            .item(FILE, Item::Pipe),
    ];
    let length = good().bytes().len();
    // Two arrays of 3 and 6 doubles come last.
    let values_at = length - 8 * (3 + 6);
    for at in cuts(length, &[2, 4, 8, 56, 58, length - 1], 3) {
        // Header; strip and directory; values that the directory refers to.
        let place = match at {
            0..8 => "first bytes",
            _ if at < values_at => "directory at byte 56",
            _ => "values within the file",
        };
        cases.push(case(
            &format!("cut-at-{at}"),
            "a truncated good file",
            place,
            good().bytes()[..at].to_vec(),
        ));
    }
    cases
}
