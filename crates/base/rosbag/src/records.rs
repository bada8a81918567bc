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
    stream: impl Read,
    length: u64,
    mut take: impl FnMut(Record<'_>) -> Result<(), Fault>,
) -> Result<(), Fault> {
    let most = length.saturating_mul(MAX_EXPANSION).min(MAX_RECORD_BYTES) as usize;
    let options =
        LinearReaderOptions::default().with_validate_chunk_crcs(true).with_record_length_limit(most);
    each_of(stream, options.clone().with_emit_chunks(true), &mut |opcode, data| match opcode {
        op::CHUNK => {
            if !has_its_records(data)? {
                return Err(broken("a record of a chunk is longer than the chunk"));
            }
            // The chunk alone, as a file.
            let head = [&[op::CHUNK][..], &(data.len() as u64).to_le_bytes()].concat();
            let alone = options.clone().with_skip_start_magic(true).with_skip_end_magic(true);
            each_of(head.chain(data), alone, &mut |opcode, data| taken(opcode, data, &mut take))
        }
        opcode => taken(opcode, data, &mut take),
    })
}

fn broken(found: impl std::fmt::Display) -> Fault {
    Fault::new("file", found.to_string(), "a whole MCAP file, as rosbag2 writes it")
}

/// Gets the kind of a record, and its bytes.
type TakeRecord<'t> = dyn FnMut(u8, &[u8]) -> Result<(), Fault> + 't;

/// Hands over the records that a reader with these options finds.
fn each_of(
    mut stream: impl Read,
    options: LinearReaderOptions,
    take: &mut TakeRecord<'_>,
) -> Result<(), Fault> {
    let mut reader = LinearReader::new_with_options(options);
    reader.add_decompressor(Zstandard::default()).map_err(broken)?;
    while let Some(event) = reader.next_event() {
        match event.map_err(broken)? {
            LinearReadEvent::ReadRequest(wanted) => {
                let read = stream.read(reader.insert(wanted));
                reader.notify_read(read.map_err(|error| broken(McapError::Io(error)))?);
            }
            LinearReadEvent::Record { data, opcode } => take(opcode, data)?,
        }
    }
    Ok(())
}

/// Hands over a record if it is of a kind that bags are read by.
fn taken(
    opcode: u8,
    data: &[u8],
    take: &mut impl FnMut(Record<'_>) -> Result<(), Fault>,
) -> Result<(), Fault> {
    if !matches!(opcode, op::SCHEMA | op::CHANNEL | op::MESSAGE) {
        return Ok(());
    }
    if !has_its_texts(opcode, data) {
        return Err(broken(McapError::UnexpectedEof));
    }
    take(mcap::parse_record(opcode, data).map_err(broken)?)
}

/// Whether each record of a chunk that is not compressed lies within it: `mcap` goes on behind the chunk, or panics, if one says that it is
/// longer.
fn has_its_records(chunk: &[u8]) -> Result<bool, Fault> {
    let Record::Chunk { header, data } = mcap::parse_record(op::CHUNK, chunk).map_err(broken)? else {
        return Ok(false);
    };
    let mut rest = &data[..];
    while header.compression.is_empty() && !rest.is_empty() {
        // One byte of kind, eight of length.
        let length =
            rest.get(1..).and_then(|rest| rest.first_chunk()).map(|bytes| u64::from_le_bytes(*bytes));
        let after = length.and_then(|length| usize::try_from(length).ok()?.checked_add(9));
        let Some(after) = after.and_then(|after| rest.get(after..)) else { return Ok(false) };
        rest = after;
    }
    Ok(true)
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
