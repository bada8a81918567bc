//! Compressions of samples by their names, and the one that the `tiff` crate does not decode: Zstandard.

use std::io::{Cursor, Read};

use raypencil_files::Fault;
use ruzstd::decoding::StreamingDecoder;
use tiff::decoder::{Decoder, DecodingResult, Limits};

use crate::dem::tags::tag_name;

/// Number of Zstandard in tag 259, as GDAL and LibTIFF write it.
const ZSTD: u64 = 50000;

/// First bytes of a frame. (RFC 8878, section 3.1.1)
const ZSTD_MAGIC: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];

/// Compression of the samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Codec {
    Plain,
    Lzw,
    Deflate,
    PackBits,
    Zstd,
}

impl Codec {
    /// The codec of a value of tag 259.
    pub fn of(compression: u64) -> Result<Self, Fault> {
        match compression {
            1 => Ok(Self::Plain),
            5 => Ok(Self::Lzw),
            8 | 32946 => Ok(Self::Deflate),
            32773 => Ok(Self::PackBits),
            ZSTD => Ok(Self::Zstd),
            other => {
                let found = format!("{other} ({})", name(other).unwrap_or("of no known name"));
                let expected = "none, LZW, deflate, PackBits or ZSTD (1, 5, 8 or 32946, 32773, 50000): \
                                gdal_translate -co COMPRESS=DEFLATE IN.tif OUT.tif writes such a file";
                Err(Fault::new(tag_name(259), found, expected))
            }
        }
    }

    /// Maximum number of bytes that one byte of the file can decode to.
    ///
    /// A deflate code of two bits stands for at most 258 bytes: 1032. An LZW code of at least nine bits stands for at most as
    /// many bytes as there are codes: below 4096. PackBits makes 128 bytes of two: 64. A block of ZSTD has at least four bytes
    /// and makes at most 128 KiB: 32768.
    pub fn expansion(self) -> u64 {
        match self {
            Self::Plain => 1,
            Self::PackBits => 64,
            Self::Deflate => 1032,
            Self::Lzw => 4096,
            Self::Zstd => 1 << 15,
        }
    }
}

/// Name of a compression that is not read. (TIFF 6.0; tiff.h of LibTIFF)
fn name(compression: u64) -> Option<&'static str> {
    Some(match compression {
        2 => "CCITT modified Huffman",
        3 => "CCITT T.4",
        4 => "CCITT T.6",
        6 => "JPEG of TIFF 6.0",
        7 => "JPEG",
        9 => "JBIG T.85",
        10 => "JBIG T.43",
        32766 => "NeXT",
        32771 => "CCITT RLEW",
        32809 => "ThunderScan",
        32895 => "IT8 CT with padding",
        32896 => "IT8 linework",
        32897 => "IT8 monochrome",
        32898 => "IT8 binary line art",
        32908 => "Pixar companded, 10 bits",
        32909 => "Pixar companded, 11 bits",
        32947 => "Kodak DCS",
        33003 | 33005 => "JPEG 2000 of Aperio",
        33004 | 33007 => "JPEG of Aperio",
        34661 => "JBIG",
        34676 => "SGI log luminance",
        34677 => "SGI log, 24 bits",
        34712 => "JPEG 2000",
        34887 => "LERC",
        34892 => "lossy JPEG of DNG",
        34925 => "LZMA",
        34933 => "PNG",
        34934 | 22610 => "JPEG XR",
        50001 => "WebP",
        50002 | 52546 => "JPEG XL",
        _ => return None,
    })
}

/// The bytes of a ZSTD stream, which are exactly `length`.
pub(super) fn unpack_zstd(packed: &[u8], length: u64) -> Result<Vec<u8>, String> {
    if let Some(size) = size_of_segment(packed).filter(|size| *size != length) {
        return Err(format!("a ZSTD stream of {size} bytes in place of {length}"));
    }
    let packed = with_small_window(packed, length);
    let decoder = StreamingDecoder::new(packed.as_slice()).map_err(|error| error.to_string())?;
    let mut bytes = Vec::new();
    // One more than there may be, so that a longer stream is seen.
    decoder.take(length + 1).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    match bytes.len() as u64 {
        found if found == length => Ok(bytes),
        found if found < length => Err(format!("a ZSTD stream of {found} bytes in place of {length}")),
        _ => Err(format!("a ZSTD stream of more than {length} bytes")),
    }
}

/// The size that a frame of a single segment states: its decoder takes that much memory at once. (RFC 8878, section 3.1.1.1)
fn size_of_segment(packed: &[u8]) -> Option<u64> {
    let flags = *packed.get(4).filter(|_| packed.starts_with(&ZSTD_MAGIC))?;
    // The number of a dictionary lies before the size.
    let at = 5 + [0, 1, 2, 4][usize::from(flags & 3)];
    let length = [1, 2, 4, 8][usize::from(flags >> 6)];
    let bytes = packed.get(at..at + length).filter(|_| flags & 0x20 != 0)?;
    let size = bytes.iter().rev().fold(0, |size, byte| size << 8 | u64::from(*byte));
    Some(if length == 2 { size + 256 } else { size })
}

/// A stream whose frame asks for no larger window than all of its bytes. The window bounds how far back a copy reaches, which
/// is never before the first byte. Level 22 asks for 128 MiB, whatever is packed.
fn with_small_window(packed: &[u8], length: u64) -> Vec<u8> {
    let mut packed = packed.to_vec();
    // Bit 5: a single segment, which has no window of its own. (RFC 8878, section 3.1.1.1)
    let has_window = packed.starts_with(&ZSTD_MAGIC) && packed.get(4).is_some_and(|flags| flags & 0x20 == 0);
    if let Some(window) = packed.get_mut(5).filter(|_| has_window) {
        // 2^(10 + exponent) bytes, with a mantissa of zero. A smaller window stays as it is.
        let exponent = (0..=31_u8).find(|exponent| length <= 1 << (10 + exponent)).unwrap_or(31);
        *window = (*window).min(exponent << 3);
    }
    packed
}

/// Samples of a block that is unpacked already: the `tiff` crate undoes the predictor and forms the numbers, as it does for the
/// codecs that it knows, from a picture of one plain strip.
pub(super) fn samples_of_bytes(
    bytes: &[u8],
    [width, rows]: [u64; 2],
    [format, bits]: [u64; 2],
    predictor: u64,
    is_big_endian: bool,
    limits: Limits,
) -> Result<DecodingResult, String> {
    let numbers: [(u16, u64); 10] = [
        (256, width),
        (257, rows),
        (258, bits),
        (259, 1),
        (262, 1),
        // Behind the eight bytes of the head, the tags and the place of the next picture.
        (273, 8 + 2 + 10 * 12 + 4),
        (278, rows),
        (279, bytes.len() as u64),
        (317, predictor),
        (339, format),
    ];
    let mut file = if is_big_endian { b"MM".to_vec() } else { b"II".to_vec() };
    let word = |file: &mut Vec<u8>, value: u64, size: usize| match is_big_endian {
        true => file.extend(&value.to_be_bytes()[8 - size..]),
        false => file.extend(&value.to_le_bytes()[..size]),
    };
    word(&mut file, 42, 2);
    word(&mut file, 8, 4);
    word(&mut file, numbers.len() as u64, 2);
    for (tag, value) in numbers {
        word(&mut file, tag.into(), 2);
        // Type 4: one whole number of four bytes.
        word(&mut file, 4, 2);
        word(&mut file, 1, 4);
        word(&mut file, value, 4);
    }
    word(&mut file, 0, 4);
    file.extend(bytes);
    let decoder = Decoder::new(Cursor::new(file)).map_err(|error| error.to_string())?;
    decoder.with_limits(limits).read_chunk(0).map_err(|error| error.to_string())
}

#[cfg(test)]
#[path = "../../tests/unit/codec.rs"]
mod tests;
