//! The records of an MCAP file, one after the other, whatever their chunks are compressed with.

use std::io::Read;

use mcap::McapError;
use mcap::records::{Record, op};
use mcap::sans_io::decompressor::{DecompressResult, Decompressor};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use raypencil_files::Fault;
use ruzstd::decoding::FrameDecoder;

/// Maximum length of a record, bytes: an image of 64 million pixels has as much.
const MAX_RECORD_BYTES: u64 = 1 << 28;

/// How often a record that is compressed may be as long as the whole file. A byte of LZ4 stands for 255 at most; of Zstandard, which knows no
/// such limit, tuned.
const MAX_EXPANSION: u64 = 256;

/// How many topics or series an error lists.
pub(crate) const MAX_LISTED: usize = 8;

/// Hands over the records of an MCAP file, those of chunks one by one.
pub(crate) fn each_record(
    mut stream: impl Read,
    length: u64,
    mut take: impl FnMut(Record<'_>) -> Result<(), Fault>,
) -> Result<(), Fault> {
    let broken =
        |error: McapError| Fault::new("file", error.to_string(), "a whole MCAP file, as rosbag2 writes it");
    let most = length.saturating_mul(MAX_EXPANSION).min(MAX_RECORD_BYTES) as usize;
    let options =
        LinearReaderOptions::default().with_validate_chunk_crcs(true).with_record_length_limit(most);
    let mut reader = LinearReader::new_with_options(options);
    reader.add_decompressor(Zstandard::default()).map_err(broken)?;
    while let Some(event) = reader.next_event() {
        match event.map_err(broken)? {
            LinearReadEvent::ReadRequest(wanted) => {
                let read = stream.read(reader.insert(wanted));
                reader.notify_read(read.map_err(|error| broken(McapError::Io(error)))?);
            }
            LinearReadEvent::Record { data, opcode }
                if matches!(opcode, op::SCHEMA | op::CHANNEL | op::MESSAGE) =>
            {
                if !has_its_texts(opcode, data) {
                    return Err(broken(McapError::UnexpectedEof));
                }
                take(mcap::parse_record(opcode, data).map_err(broken)?)?;
            }
            LinearReadEvent::Record { .. } => {}
        }
    }
    Ok(())
}

/// Whether the texts of a schema or of a channel are as long as they say: `mcap` makes room for what one claims, up to 4 GB, before it
/// looks at what there is.
fn has_its_texts(opcode: u8, data: &[u8]) -> bool {
    let after_text = |bytes: &[u8]| -> Option<(usize, usize)> {
        let length = u32::from_le_bytes(*bytes.first_chunk()?) as usize;
        (length <= bytes.len() - 4).then_some((4, 4 + length))
    };
    // Numbers; name, encoding and contents. The metadata of a channel are texts again.
    let numbers = match opcode {
        op::SCHEMA => 2,
        op::CHANNEL => 4,
        _ => return true,
    };
    let Some(mut rest) = data.get(numbers..) else { return false };
    let mut last: &[u8] = &[];
    for _ in 0..3 {
        let Some((begin, end)) = after_text(rest) else { return false };
        (last, rest) = (&rest[begin..end], &rest[end..]);
    }
    while opcode == op::CHANNEL && !last.is_empty() {
        let Some((_, end)) = after_text(last) else { return false };
        last = &last[end..];
    }
    true
}

/// Decompressor of chunks with Zstandard.
#[derive(Default)]
struct Zstandard(FrameDecoder);

impl Decompressor for Zstandard {
    fn next_read_size(&self) -> usize {
        0
    }

    fn decompress(&mut self, source: &[u8], target: &mut [u8]) -> Result<DecompressResult, McapError> {
        let (consumed, wrote) = self
            .0
            .decode_from_to(source, target)
            .map_err(|error| McapError::DecompressionError(error.to_string()))?;
        Ok(DecompressResult { consumed, wrote })
    }

    fn reset(&mut self) -> Result<(), McapError> {
        self.0 = FrameDecoder::new();
        Ok(())
    }

    fn name(&self) -> &'static str {
        "zstd"
    }
}
