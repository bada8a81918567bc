//! LZF, by which PCD files are compressed. (Marc Lehmann, liblzf; Point Cloud Library, `lzf_compress`, `lzf_decompress`)

use raypencil_files::{Fault, MAX_EXPANSION, MAX_INFLATED_BYTES};

/// Longest part that two or three bytes stand for.
const MAX_COPY: u64 = 264;

/// Most bytes that follow as they are behind one byte that says so.
const MAX_LITERAL: usize = 32;

/// How far back a copy reaches.
const MAX_BACK: usize = 1 << 13;

/// Entries of the table of places at which three bytes stood last.
const TABLE: usize = 1 << 16;

/// The bytes compressed. What is copied is the same three bytes or more where they stood last; the same bytes give the same result.
///
/// ```
/// use raypencil_mesh_io::lzf_compressed;
///
/// // One byte as it is, then the 99 of which each is the one before it.
/// assert_eq!(lzf_compressed(&[7; 100]), [0, 7, 7 << 5, 99 - 2 - 7, 0]);
/// ```
pub fn compressed(bytes: &[u8]) -> Vec<u8> {
    let mut last = vec![usize::MAX; TABLE];
    let entry = |at: usize| {
        let three = u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], 0]);
        (three.wrapping_mul(0x9e37_79b1) >> 16) as usize
    };
    let mut packed = Vec::with_capacity(bytes.len() / 2);
    // From where on bytes are not written yet.
    let mut waiting = 0;
    let mut at = 0;
    while at + 3 <= bytes.len() {
        let from = std::mem::replace(&mut last[entry(at)], at);
        let is_near = from < at && at - from <= MAX_BACK;
        if !is_near || bytes[from..from + 3] != bytes[at..at + 3] {
            at += 1;
            continue;
        }
        let most = (bytes.len() - at).min(MAX_COPY as usize);
        let length = (3..most).find(|&k| bytes[from + k] != bytes[at + k]).unwrap_or(most);
        put_literals(&bytes[waiting..at], &mut packed);
        let (count, back) = (length - 2, at - from - 1);
        match count {
            1..7 => packed.push((count << 5 | back >> 8) as u8),
            _ => packed.extend([(7 << 5 | back >> 8) as u8, (count - 7) as u8]),
        }
        packed.push(back as u8);
        for inside in at + 1..(at + length).min(bytes.len().saturating_sub(2)) {
            last[entry(inside)] = inside;
        }
        at += length;
        waiting = at;
    }
    put_literals(&bytes[waiting..], &mut packed);
    packed
}

fn put_literals(bytes: &[u8], packed: &mut Vec<u8>) {
    for literal in bytes.chunks(MAX_LITERAL) {
        packed.push((literal.len() - 1) as u8);
        packed.extend_from_slice(literal);
    }
}

/// The bytes that were compressed, of which there are `length`.
pub(super) fn inflated(packed: &[u8], length: u64) -> Result<Vec<u8>, Fault> {
    let place = |at: usize| format!("compressed byte {at}");
    // Before memory is asked for: no byte stands for more than this.
    if length > (packed.len() as u64).saturating_mul(MAX_COPY) {
        let found = format!("{length} bytes of {} compressed ones", packed.len());
        return Err(Fault::new("size", found, format!("at most {MAX_COPY} of each")));
    }
    let most = MAX_INFLATED_BYTES.max((packed.len() as u64).saturating_mul(MAX_EXPANSION));
    if length > most {
        let found = format!("{length} bytes of {} compressed ones", packed.len());
        return Err(Fault::new(
            "size",
            found,
            format!("at most {most}: 512 MiB, or {MAX_EXPANSION} of each"),
        ));
    }
    let mut bytes = Vec::with_capacity(length as usize);
    let mut at = 0;
    let next = |at: &mut usize| {
        let byte = packed.get(*at).copied();
        *at += 1;
        byte.map(usize::from)
            .ok_or_else(|| Fault::new(place(*at - 1), "the end", "more bytes (is it cut off?)"))
    };
    while at < packed.len() {
        let begin = at;
        let control = next(&mut at)?;
        if control < 32 {
            let end = at + control + 1;
            let Some(literal) = packed.get(at..end) else {
                return Err(Fault::new(
                    place(begin),
                    "the end",
                    format!("{} bytes as they are", control + 1),
                ));
            };
            bytes.extend_from_slice(literal);
            at = end;
        } else {
            let mut count = control >> 5;
            if count == 7 {
                count += next(&mut at)?;
            }
            let back = ((control & 31) << 8) + next(&mut at)? + 1;
            let Some(from) = bytes.len().checked_sub(back) else {
                let found = format!("{back} bytes back, with {} before it", bytes.len());
                return Err(Fault::new(place(begin), found, "bytes that are there"));
            };
            // What is copied may reach into itself.
            for k in from..from + count + 2 {
                bytes.push(bytes[k]);
            }
        }
        if bytes.len() as u64 > length {
            return Err(Fault::new(
                place(begin),
                format!("more than {length} bytes"),
                "as many as the file says",
            ));
        }
    }
    if bytes.len() as u64 != length {
        return Err(Fault::new(
            "size",
            format!("{} bytes", bytes.len()),
            format!("{length}, as the file says"),
        ));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_small_file_asks_for_much_memory() {
        // Three million bytes could stand for 792 million, and may for 512 MiB.
        let packed = vec![0xff; 3_000_000];
        let message = inflated(&packed, 1 << 29 | 1).unwrap_err().to_string();
        assert!(
            message.contains("536870913 bytes of 3000000 compressed ones; expected at most 536870912"),
            "{message}"
        );
    }

    #[test]
    fn what_is_compressed_comes_back() {
        let mut state = 1_u32;
        let mut random = |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % below
        };
        for length in (0..70).chain([263, 264, 265, 266, 267, 530, 8190, 8200, 30_000]) {
            for letters in [1, 2, 5, 256] {
                let bytes: Vec<u8> = (0..length).map(|_| random(letters) as u8).collect();
                let packed = compressed(&bytes);
                assert_eq!(inflated(&packed, length).unwrap(), bytes, "{length} of {letters} letters");
                assert!(packed.len() as u64 <= length + length.div_ceil(32));
            }
        }
        // The same 100 bytes, just within reach of a copy and just beyond it.
        let word: Vec<u8> = (0..100).map(|_| random(256) as u8).collect();
        for gap in [8091_usize, 8092, 8093, 8094] {
            let between: Vec<u8> = (0..gap).map(|_| random(256) as u8).collect();
            let bytes = [&word[..], &between, &word].concat();
            assert_eq!(inflated(&compressed(&bytes), bytes.len() as u64).unwrap(), bytes);
        }
        let zeros = vec![0; 1 << 20];
        assert!(compressed(&zeros).len() < zeros.len() / 80);
    }

    #[test]
    fn literals_and_copies_come_back() {
        // "abc" as it is; then 5 + 2 = 7 bytes from three back; then a long copy of 7 + 1 + 2 = 10 bytes from one back.
        let packed = [2, b'a', b'b', b'c', 5 << 5, 2, 7 << 5, 1, 0];
        assert_eq!(inflated(&packed, 20).unwrap(), b"abcabcabcaaaaaaaaaaa");
        for (packed, length, words) in [
            (&packed[..], 19, "more than 19"),
            (&packed[..], 21, "20 bytes; expected 21"),
            (&packed[..3], 3, "expected 3 bytes as they are"),
            (&packed[..5], 9, "cut off"),
            (&[1 << 5, 0][..], 3, "1 bytes back, with 0 before it"),
            (&[0, 0][..], 1 << 40, "at most 264 of each"),
        ] {
            let message = inflated(packed, length).unwrap_err().to_string();
            assert!(message.contains(words), "{message}");
        }
    }
}
