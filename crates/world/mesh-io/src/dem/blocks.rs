//! Samples of a TIFF. Only the strips or tiles that are needed are read, and each is checked before it is decoded.

use std::io::{Read, Seek};
use std::ops::{Range, RangeInclusive};

use raypencil_files::Fault;
use tiff::decoder::{Decoder, DecodingResult, Limits};

use crate::dem::codec::{Codec, samples_of_bytes, unpack_zstd};
use crate::dem::tags::{Tags, tag_name};
use crate::dem::target::Target;

/// Maximum number of pixels along a side.
const MAX_SIDE_PX: u64 = 1 << 24;

/// Maximum number of strips or tiles of a file.
const MAX_BLOCKS: u64 = 1 << 22;

/// Maximum size of a decoded strip or tile. Some writers put a whole picture into one strip.
const MAX_BLOCK_BYTES: u64 = 1 << 29;

/// Bytes by which the decoded size of a compressed block may exceed the bound of its expansion.
const EXPANSION_SLACK_BYTES: u64 = 4096;

/// What is expected of a block.
const DECODABLE: &str = "samples that can be decoded";

/// Number type of a sample, with its bits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Sample {
    Unsigned(u64),
    Signed(u64),
    Float(u64),
}

impl Sample {
    fn bits(self) -> u64 {
        match self {
            Self::Unsigned(bits) | Self::Signed(bits) | Self::Float(bits) => bits,
        }
    }

    /// SampleFormat and BitsPerSample.
    fn tags(self) -> [u64; 2] {
        match self {
            Self::Unsigned(bits) => [1, bits],
            Self::Signed(bits) => [2, bits],
            Self::Float(bits) => [3, bits],
        }
    }

    /// Sample that a nodata value stands for: the decimal number of the tag, rounded to the type of the samples.
    fn nodata(self, value: f64) -> f64 {
        match self {
            Self::Float(32) => f64::from(value as f32),
            _ => value,
        }
    }
}

/// Layout of the pixels in strips or tiles.
pub(super) struct Blocks {
    pub width: u32,
    pub height: u32,
    sample: Sample,
    /// Name of a block in messages: "strip" or "tile".
    kind: &'static str,
    /// Pixels along the sides of a block. The last blocks may reach beyond the picture.
    block: [u64; 2],
    /// Number of blocks in a row of blocks.
    across: u64,
    /// Tag of the blocks' places in the file.
    offsets: u16,
    /// Tag of the blocks' sizes in the file.
    byte_counts: u16,
    codec: Codec,
    /// 1: none, 2: differences along a row, 3: those of the bytes of floating-point numbers.
    predictor: u64,
}

impl Blocks {
    /// Reads the layout from the tags and checks it. No sample is read yet.
    pub fn of(tags: &Tags, file: &mut (impl Read + Seek)) -> Result<Self, Fault> {
        let mut required = |tag: u16, range: RangeInclusive<u64>| match tags.integer(file, tag)? {
            Some(value) if range.contains(&value) => Ok(value),
            found => {
                let found = found.map_or("missing".to_string(), |value| value.to_string());
                Err(Fault::new(tag_name(tag), found, format!("{} to {}", range.start(), range.end())))
            }
        };
        let (width, height) = (required(256, 1..=MAX_SIDE_PX)?, required(257, 1..=MAX_SIDE_PX)?);
        let is_tiled = tags.count(322) > 0 || tags.count(324) > 0;
        let tile = match is_tiled {
            true => Some([required(322, 1..=1 << 16)?, required(323, 1..=1 << 16)?]),
            false => None,
        };
        required(262, 0..=u64::from(u16::MAX))?;

        let mut word = |tag: u16, default: u64, known: &[u64], meaning: &str| {
            let value = tags.integer(file, tag)?.unwrap_or(default);
            match known.contains(&value) {
                true => Ok(value),
                false => Err(Fault::new(tag_name(tag), value.to_string(), meaning)),
            }
        };
        word(277, 1, &[1], "1: one band, of heights (gdal_translate -b takes one out of several)")?;
        word(262, 1, &[1], "1 (BlackIsZero), whose samples are the heights themselves")?;
        word(266, 1, &[1], "1, the highest bit first")?;
        word(274, 1, &[1], "1, the first row on top")?;
        let predictor = word(317, 1, &[1, 2, 3], "1 (none), 2 (horizontal) or 3 (floating point)")?;
        let bits = word(258, 1, &[8, 16, 32, 64], "8, 16, 32 or 64")?;
        let sample = match (word(339, 1, &[1, 2, 3], "1 (unsigned), 2 (signed) or 3 (floating point)")?, bits)
        {
            (1, 8 | 16 | 32) => Sample::Unsigned(bits),
            (2, 8 | 16 | 32) => Sample::Signed(bits),
            (3, 32 | 64) => Sample::Float(bits),
            (format, _) => {
                let found = format!("samples of format {format} and {bits} bits");
                let expected = "whole numbers of 8, 16 or 32 bits, or floating point of 32 or 64";
                return Err(Fault::new(format!("{} and {}", tag_name(258), tag_name(339)), found, expected));
            }
        };
        if predictor == 3 && !matches!(sample, Sample::Float(_)) {
            return Err(Fault::new(
                tag_name(317),
                "3 (floating point)",
                "1 or 2: the samples are whole numbers",
            ));
        }

        let codec = Codec::of(tags.integer(file, 259)?.unwrap_or(1))?;

        let (kind, block, offsets, byte_counts) = match tile {
            Some(tile) => ("tile", tile, 324, 325),
            None => {
                let rows = tags.integer(file, 278)?.unwrap_or(height).min(height);
                if rows == 0 {
                    return Err(Fault::new(tag_name(278), "0", "one row or more"));
                }
                ("strip", [width, rows], 273, 279)
            }
        };
        let across = width.div_ceil(block[0]);
        let count = across * height.div_ceil(block[1]);
        for tag in [offsets, byte_counts] {
            if tags.count(tag) != count || count > MAX_BLOCKS {
                let found = format!("{} values", tags.count(tag));
                let expected =
                    format!("{count}, one for each {kind}, of which at most {MAX_BLOCKS} are read");
                return Err(Fault::new(tag_name(tag), found, expected));
            }
        }
        // Both are at most 2^24.
        let (width, height) = (width as u32, height as u32);
        Ok(Self { width, height, sample, kind, block, across, offsets, byte_counts, codec, predictor })
    }

    /// Places in the file of `count` blocks, from block `first` of the file on; of a block of 0 bytes, which was not
    /// written, `None`.
    ///
    /// # Errors
    /// A block that does not lie within the file, or is too short for its samples.
    fn places(
        &self,
        tags: &Tags,
        file: &mut (impl Read + Seek),
        length: u64,
        first: u64,
        count: u64,
    ) -> Result<Vec<Option<Range<u64>>>, Fault> {
        let offsets = tags.run(file, self.offsets, first, count)?;
        let byte_counts = tags.run(file, self.byte_counts, first, count)?;
        let mut places = Vec::new();
        for (index, (offset, bytes)) in (first..).zip(offsets.into_iter().zip(byte_counts)) {
            if bytes == 0 {
                places.push(None);
                continue;
            }
            let fault = |found: String, expected: String| Err(Fault::new(self.place(index), found, expected));
            if offset.checked_add(bytes).is_none_or(|end| end > length) {
                let found = format!("{bytes} bytes from byte {offset}");
                return fault(found, format!("bytes within the file of {length} bytes"));
            }
            // Sides are at most 2^24 and 2^16, or 2^24 both: no product overflows.
            let rows = self.block[1].min(u64::from(self.height) - index / self.across * self.block[1]);
            let needed = self.block[0] * rows * (self.sample.bits() / 8);
            if needed > MAX_BLOCK_BYTES {
                return fault(format!("{needed} bytes of samples"), format!("at most {MAX_BLOCK_BYTES}"));
            }
            let slack = if self.codec == Codec::Plain { 0 } else { EXPANSION_SLACK_BYTES };
            if needed > bytes.saturating_mul(self.codec.expansion()) + slack {
                return fault(format!("{bytes} bytes"), format!("enough for {needed} bytes of samples"));
            }
            places.push(Some(offset..offset + bytes));
        }
        Ok(places)
    }

    /// Refuses blocks that share bytes: then all blocks together have no more bytes than the file.
    ///
    /// CHOICE: a writer could store equal blocks once, but none is known to. A file of a megabyte could otherwise ask for the
    /// work of a terabyte.
    fn refuse_overlaps(&self, mut places: Vec<(u64, Range<u64>)>) -> Result<(), Fault> {
        places.sort_unstable_by_key(|(index, place)| (place.start, *index));
        for pair in places.windows(2) {
            let [(before, first), (index, second)] = pair else { continue };
            if second.start < first.end {
                let found = format!("{} bytes from byte {}", second.end - second.start, second.start);
                let expected = format!(
                    "bytes of its own: {} has {} bytes from byte {}",
                    self.place(*before),
                    first.end - first.start,
                    first.start
                );
                return Err(Fault::new(self.place(*index), found, expected));
            }
        }
        Ok(())
    }

    fn place(&self, index: u64) -> String {
        format!("{} {index}", self.kind)
    }

    /// Samples of the pixels in these columns and rows, row by row; NaN where the height is not known.
    ///
    /// Only the blocks that these pixels touch are read. Samples of one of the values in `nodata` are not known.
    pub fn read<R: Read + Seek>(
        &self,
        tags: &Tags,
        mut file: R,
        length: u64,
        [columns, rows]: [RangeInclusive<u32>; 2],
        nodata: &[f64],
    ) -> Result<Vec<f64>, Fault> {
        let part = |range: &RangeInclusive<u32>, axis: usize| {
            (u64::from(*range.start()) / self.block[axis], u64::from(*range.end()) / self.block[axis])
        };
        let ((left, right), (top, bottom)) = (part(&columns, 0), part(&rows, 1));
        let count = right - left + 1;
        // All blocks are checked before memory is allocated for their samples.
        let mut written = Vec::new();
        for down in top..=bottom {
            let first = down * self.across + left;
            let places = self.places(tags, &mut file, length, first, count)?;
            if let Some(absent) = places.iter().position(Option::is_none).filter(|_| nodata.is_empty()) {
                let expected = "samples, or a value in tag 42113 GDAL_NODATA that stands for them";
                return Err(Fault::new(self.place(first + absent as u64), "no bytes", expected));
            }
            written.extend((first..).zip(places).filter_map(|(index, place)| Some((index, place?))));
        }
        if written.is_empty() {
            let found = format!("no bytes in any {} that is asked for", self.kind);
            return Err(Fault::new(tag_name(self.byte_counts), found, "some heights"));
        }
        self.refuse_overlaps(written.clone())?;

        let mut target = Target {
            nodata: nodata.iter().map(|&value| self.sample.nodata(value)).collect(),
            heights: vec![f64::NAN; columns.clone().count() * rows.clone().count()],
            columns,
            rows,
        };
        if self.codec == Codec::Zstd {
            for (index, place) in written {
                let samples = self
                    .unpacked(tags, &mut file, index, place)
                    .map_err(|found| Fault::new(self.place(index), found, DECODABLE))?;
                // Of a tile, what lies beyond the picture is in its rows.
                self.deliver(&mut target, index, self.block[0], samples)?;
            }
            return Ok(target.heights);
        }
        let unfit =
            |place: String| move |error: tiff::TiffError| Fault::new(place, error.to_string(), DECODABLE);
        file.rewind().map_err(|error| Fault::new("first bytes", error.to_string(), "a readable file"))?;
        let mut decoder = Decoder::new(file).map_err(unfit("tags".to_string()))?.with_limits(limits());
        for (index, _) in written {
            let samples = decoder.read_chunk(index as u32).map_err(unfit(self.place(index)))?;
            let width = self.inside(index)[0];
            self.deliver(&mut target, index, width, samples)?;
        }
        Ok(target.heights)
    }

    /// Samples of a block that the `tiff` crate cannot decompress.
    fn unpacked(
        &self,
        tags: &Tags,
        file: &mut (impl Read + Seek),
        index: u64,
        place: Range<u64>,
    ) -> Result<DecodingResult, String> {
        let rows = if self.kind == "tile" { self.block[1] } else { self.inside(index)[1] };
        let packed =
            tags.bytes(file, place.start, place.end - place.start).map_err(|error| error.to_string())?;
        let bytes = unpack_zstd(&packed, self.block[0] * rows * (self.sample.bits() / 8))?;
        let size = [self.block[0], rows];
        samples_of_bytes(&bytes, size, self.sample.tags(), self.predictor, tags.is_big_endian(), limits())
    }

    /// Columns and rows of a block that lie in the picture.
    fn inside(&self, index: u64) -> [u64; 2] {
        [
            self.block[0].min(u64::from(self.width) - index % self.across * self.block[0]),
            self.block[1].min(u64::from(self.height) - index / self.across * self.block[1]),
        ]
    }

    /// Copies the requested pixels of a block, whose rows have `width` samples.
    fn deliver(
        &self,
        target: &mut Target,
        index: u64,
        width: u64,
        samples: DecodingResult,
    ) -> Result<(), Fault> {
        let corner = [index % self.across * self.block[0], index / self.across * self.block[1]];
        let size = self.inside(index);
        match samples {
            DecodingResult::U8(samples) => target.take(corner, size, width, &samples),
            DecodingResult::I8(samples) => target.take(corner, size, width, &samples),
            DecodingResult::U16(samples) => target.take(corner, size, width, &samples),
            DecodingResult::I16(samples) => target.take(corner, size, width, &samples),
            DecodingResult::U32(samples) => target.take(corner, size, width, &samples),
            DecodingResult::I32(samples) => target.take(corner, size, width, &samples),
            DecodingResult::F32(samples) => target.take(corner, size, width, &samples),
            DecodingResult::F64(samples) => target.take(corner, size, width, &samples),
            _ => Err(Fault::new(self.place(index), "other samples", "those of the tags")),
        }
    }

    /// A sample as the file's own type writes it: the fewest digits that give it back.
    pub fn decimal(&self, sample: f64) -> String {
        match self.sample {
            Sample::Float(32) => short(
                f64::from(sample as f32),
                &format!("{}", sample as f32),
                &format!("{:e}", sample as f32),
            ),
            _ => short(sample, &format!("{sample}"), &format!("{sample:e}")),
        }
    }
}

/// The decimal number, or the one with an exponent where it would be long.
fn short(sample: f64, decimal: &str, with_exponent: &str) -> String {
    let is_usual = sample == 0.0 || (1e-6..1e7).contains(&sample.abs());
    if is_usual { decimal.to_string() } else { with_exponent.to_string() }
}

/// Limits of the memory for a block.
fn limits() -> Limits {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = MAX_BLOCK_BYTES as usize;
    limits.intermediate_buffer_size = MAX_BLOCK_BYTES as usize;
    limits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_decoder_may_take_as_much_as_a_block_may_have() {
        // 512 MiB, as the page says; what a block claims is held against it before.
        let Limits { decoding_buffer_size, intermediate_buffer_size, .. } = limits();
        assert_eq!([decoding_buffer_size, intermediate_buffer_size], [512 << 20; 2]);
    }
}
