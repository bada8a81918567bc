//! Streams of ZSTD by hand, and names of codecs.

use super::*;

/// A frame of raw blocks with a window. (RFC 8878, section 3.1.1)
fn frame(window: u8, content: &[u8]) -> Vec<u8> {
    let mut stream = [&ZSTD_MAGIC[..], &[0, window]].concat();
    let header = (content.len() as u32) << 3 | 1;
    stream.extend(&header.to_le_bytes()[..3]);
    stream.extend(content);
    stream
}

/// A frame of one segment, whose size is in one byte.
fn segment(size: u8, content: &[u8]) -> Vec<u8> {
    let mut stream = frame(0, content);
    (stream[4], stream[5]) = (0x20, size);
    stream
}

#[test]
fn streams_have_the_length_that_is_expected() {
    let content: Vec<u8> = (0..200).collect();
    assert_eq!(unpack_zstd(&frame(0, &content), 200), Ok(content.clone()));
    assert_eq!(unpack_zstd(&segment(200, &content), 200), Ok(content.clone()));
    assert_eq!(
        unpack_zstd(&frame(0, &content), 201),
        Err("a ZSTD stream of 200 bytes in place of 201".into())
    );
    assert_eq!(unpack_zstd(&frame(0, &content), 199), Err("a ZSTD stream of more than 199 bytes".into()));
    assert_eq!(
        unpack_zstd(&segment(200, &content), 99),
        Err("a ZSTD stream of 200 bytes in place of 99".into())
    );
    for length in 0..frame(0, &content).len() {
        assert!(unpack_zstd(&frame(0, &content)[..length], 200).is_err(), "{length}");
    }
    assert!(unpack_zstd(b"no stream at all", 200).is_err());
}

#[test]
fn a_window_takes_no_more_memory_than_the_samples() {
    // Exponent 17: 128 MiB, as level 22 asks for. Of 200 bytes the least, 1 KiB, is enough.
    let content = [7; 200];
    let large = frame(17 << 3, &content);
    assert_eq!(with_small_window(&large, 200)[5], 0);
    assert_eq!(with_small_window(&large, 1025)[5], 1 << 3);
    assert_eq!(with_small_window(&large, 1 << 20)[5], 10 << 3);
    assert_eq!(with_small_window(&large, 1 << 40)[5], 17 << 3);
    assert_eq!(unpack_zstd(&large, 200), Ok(content.to_vec()));
    // Nothing of a segment is changed.
    assert_eq!(with_small_window(&segment(200, &content), 200), segment(200, &content));
}

#[test]
fn every_compression_that_is_refused_has_a_name() {
    for (number, name) in [
        (2, "CCITT modified Huffman"),
        (3, "CCITT T.4"),
        (4, "CCITT T.6"),
        (6, "JPEG of TIFF 6.0"),
        (7, "JPEG"),
        (9, "JBIG T.85"),
        (10, "JBIG T.43"),
        (32766, "NeXT"),
        (32771, "CCITT RLEW"),
        (32809, "ThunderScan"),
        (32895, "IT8 CT with padding"),
        (32896, "IT8 linework"),
        (32897, "IT8 monochrome"),
        (32898, "IT8 binary line art"),
        (32908, "Pixar companded, 10 bits"),
        (32909, "Pixar companded, 11 bits"),
        (32947, "Kodak DCS"),
        (33003, "JPEG 2000 of Aperio"),
        (33005, "JPEG 2000 of Aperio"),
        (33004, "JPEG of Aperio"),
        (33007, "JPEG of Aperio"),
        (34661, "JBIG"),
        (34676, "SGI log luminance"),
        (34677, "SGI log, 24 bits"),
        (34712, "JPEG 2000"),
        (34887, "LERC"),
        (34892, "lossy JPEG of DNG"),
        (34925, "LZMA"),
        (34933, "PNG"),
        (34934, "JPEG XR"),
        (22610, "JPEG XR"),
        (50001, "WebP"),
        (50002, "JPEG XL"),
        (52546, "JPEG XL"),
        (60000, "of no known name"),
    ] {
        let message = Codec::of(number).unwrap_err().to_string();
        assert!(message.starts_with(&format!("tag 259 Compression: {number} ({name}); ")), "{message}");
        assert!(message.contains("gdal_translate -co COMPRESS=DEFLATE"), "{message}");
    }
    for (number, codec) in [
        (1, Codec::Plain),
        (5, Codec::Lzw),
        (8, Codec::Deflate),
        (32946, Codec::Deflate),
        (32773, Codec::PackBits),
        (50000, Codec::Zstd),
    ] {
        assert_eq!(Codec::of(number).ok(), Some(codec));
        assert_eq!(name(number), None);
    }
}

/// RFC 8878, section 3.1.1: two bits say how long the size is, one that there is a single segment, two how long a number before it is.
#[test]
fn a_frame_of_a_single_segment_states_its_size() {
    let stated = |flags: u8, rest: &[u8]| size_of_segment(&[&ZSTD_MAGIC[..], &[flags], rest].concat());
    assert_eq!(stated(0x20, &[7]), Some(7));
    // Of two bytes the size is 256 less.
    assert_eq!(stated(0x60, &[1, 2]), Some(0x0201 + 256));
    assert_eq!(stated(0xa0, &[1, 2, 3, 4]), Some(0x0403_0201));
    assert_eq!(stated(0xe0, &[1, 2, 3, 4, 5, 6, 7, 8]), Some(0x0807_0605_0403_0201));
    // Behind the number of a dictionary.
    for (flags, number) in [(0x21, vec![9]), (0x22, vec![9; 2]), (0x23, vec![9; 4])] {
        assert_eq!(stated(flags, &[number, vec![7]].concat()), Some(7));
    }
    // Cut off, or of several segments.
    assert_eq!((stated(0x60, &[1]), stated(0x00, &[7])), (None, None));
}
