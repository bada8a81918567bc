//! LZF, by which PCD files are compressed. (Marc Lehmann, liblzf; Point Cloud Library, `lzf_decompress`)

use raypencil_files::{Fault, MAX_EXPANSION, MAX_INFLATED_BYTES};

/// Longest part that two or three bytes stand for.
const MAX_COPY: u64 = 264;

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
