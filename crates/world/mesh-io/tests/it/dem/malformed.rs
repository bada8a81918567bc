//! Malformed files: whatever the bytes, a message, no panic, and no memory beyond the length of the file.

use proptest::prelude::*;

use super::super::memory::peak_bytes;
use super::read;
use super::write::{Codec, Long, Short, Text, Tiff};
use super::{assert_names, refusal};
use raypencil_mesh_io::{dem_from_bytes, read_dem};
use std::path::Path;

#[test]
fn a_header_alone_allocates_no_memory() {
    // A square of two million pixels a side in a few hundred bytes, as strips and as tiles, plain and compressed.
    for codec in [Codec::Plain, Codec::Deflate, Codec::Lzw, Codec::PackBits, Codec::Zstd] {
        let mut tiff = Tiff::plain();
        tiff.codec = codec;
        let sides = |tiff: Tiff, side: u32| tiff.tag(256, Long(vec![side])).tag(257, Long(vec![side]));
        // One strip for all rows.
        let whole = sides(tiff.clone(), 2_000_000)
            .tag(278, Long(vec![u32::MAX]))
            .tag(273, Long(vec![8]))
            .tag(279, Long(vec![48]));
        assert_names(&refusal(&whole, None), &["at most 16777216 cells", "window"]);
        // With a small window the strip is still too long.
        assert_names(
            &refusal(&whole, Some([10.0, 0.0, 4.0, 4.0])),
            &["strip 0: ", "bytes of samples", "at most 536870912"],
        );
        // A strip of an allowed size, for which the file has too few bytes.
        let large = sides(tiff.clone(), 4096)
            .tag(278, Long(vec![4096]))
            .tag(273, Long(vec![8]))
            .tag(279, Long(vec![48]));
        assert_names(&refusal(&large, None), &["strip 0: 48 bytes", "enough for 67108864 bytes"]);
        // Too few strips and tiles.
        assert_names(
            &refusal(&sides(tiff.clone(), 2_000_000), Some([10.0, 0.0, 4.0, 4.0])),
            &["StripOffsets", "1000000"],
        );
        tiff.block = vec![16, 16];
        assert_names(&refusal(&sides(tiff.clone(), 2_000_000), None), &["TileOffsets", "15625000000"]);
        assert_names(
            &refusal(&tiff.tag(322, Long(vec![1 << 20])), None),
            &["TileWidth: 1048576", "1 to 65536"],
        );
    }
    assert_names(&refusal(&Tiff::plain().tag(256, Long(vec![u32::MAX])), None), &["ImageWidth: 4294967295"]);
    assert_names(&refusal(&Tiff::plain().tag(257, Long(vec![0])), None), &["ImageLength: 0"]);
    assert_names(&refusal(&Tiff::plain().tag(278, Long(vec![0])), None), &["RowsPerStrip: 0"]);
    assert_names(
        &refusal(&Tiff::plain().tag(279, Long(vec![48, 99999])), None),
        &["strip 1: 99999 bytes from byte"],
    );
    assert_names(
        &refusal(&Tiff::plain().tag(279, Long(vec![31, 16])), None),
        &["strip 0: 31 bytes", "enough for 32"],
    );
    assert_names(&refusal(&Tiff::plain().tag(279, Text("no number")), None), &["StripByteCounts"]);
    assert_names(
        &refusal(&Tiff::plain().tag(256, Short(vec![4, 4])), None),
        &["ImageWidth: 2 values; expected one"],
    );
}

#[test]
fn a_file_cut_anywhere_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cut.tif");
    for mut tiff in
        [Tiff::plain(), Tiff { block: vec![16, 16], codec: Codec::Lzw, is_big: true, ..Tiff::plain() }]
    {
        tiff.tags.push((42113, Text("-9999")));
        let bytes = tiff.bytes();
        for length in 0..bytes.len() {
            std::fs::write(&path, &bytes[..length]).unwrap();
            let message = read_dem(&path, None).expect_err("a part of a file").to_string();
            assert_names(&message, &["cut.tif: ", "; expected "]);
        }
    }
}

#[test]
fn paths_without_a_tiff_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let message = read_dem(folder.path(), None).unwrap_err().to_string();
    assert_names(&message, &["cannot read", "not a regular file"]);
    assert_names(
        &read_dem(folder.path().join("no.tif"), None).unwrap_err().to_string(),
        &["no.tif: cannot read"],
    );
    let path = folder.path().join("picture.tif");
    std::fs::write(&path, b"\x89PNG\r\n\x1a\n").unwrap();
    assert_names(&read_dem(&path, None).unwrap_err().to_string(), &["first bytes", "a TIFF"]);
}

#[test]
fn a_mask_is_refused() {
    // A second directory, marked as a mask, of an overview too, after the end of the first.
    for (kind, is_refused) in [(4_u16, true), (1, false), (5, true), (2, false)] {
        let mut bytes = Tiff::plain().bytes();
        let at = bytes.len() as u32;
        let pointer = bytes.len() - 4;
        bytes[pointer..].copy_from_slice(&at.to_le_bytes());
        bytes.extend([1, 0, 254, 0, 3, 0, 1, 0, 0, 0, kind as u8, 0, 0, 0, 0, 0, 0, 0]);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("masked.tif");
        std::fs::write(&path, bytes).unwrap();
        let read = read_dem(&path, None);
        assert_eq!(read.is_err(), is_refused);
        if let Err(error) = read {
            assert_names(&error.to_string(), &["image 1: a mask", "-dstnodata"]);
        }
    }
}

#[test]
fn a_smaller_image_before_the_model_is_refused() {
    for (kind, is_refused) in [(1_u16, true), (0, false), (2, false)] {
        for is_followed in [true, false] {
            let mut bytes = Tiff::plain().tag(254, Short(vec![kind])).bytes();
            if is_followed {
                let at = bytes.len() as u32;
                let pointer = bytes.len() - 4;
                bytes[pointer..].copy_from_slice(&at.to_le_bytes());
                bytes.extend([1, 0, 254, 0, 3, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
            }
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("thumbnail.tif");
            std::fs::write(&path, bytes).unwrap();
            // By itself it is what the file has.
            match read_dem(&path, None) {
                Ok(_) => assert!(!is_refused || !is_followed, "{kind}"),
                Err(error) => {
                    assert!(is_refused && is_followed, "{kind}: {error}");
                    assert_names(&error.to_string(), &["image 0: a smaller image of another one"]);
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..Default::default() })]

    /// Bytes changed anywhere: a DEM or a message.
    #[test]
    fn changed_bytes_never_panic(
        tiled: bool,
        is_big: bool,
        is_big_endian: bool,
        codec in prop_oneof![Just(Codec::Plain), Just(Codec::Deflate), Just(Codec::Lzw), Just(Codec::PackBits), Just(Codec::Zstd)],
        predictor in 1_u16..4,
        changes in proptest::collection::vec((any::<proptest::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let block = if tiled { vec![16, 16] } else { vec![2] };
        let tiff = Tiff { block, is_big, is_big_endian, codec, predictor, ..Tiff::plain() };
        // The writer uses the byte order of the file for samples.
        let mut bytes = tiff.with(super::write::plain_sample).bytes();
        // Tags are at the end; half of the changes go there.
        for (k, (index, byte)) in changes.into_iter().enumerate() {
            let from = if k % 2 == 0 { bytes.len() / 2 } else { 0 };
            let at = from + index.index(bytes.len() - from);
            bytes[at] = byte;
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("any.tif");
        std::fs::write(&path, bytes).unwrap();
        match read_dem(&path, None) {
            Ok(dem) => prop_assert_eq!(dem.posts.heights.len() as u64, u64::from(dem.posts.columns) * u64::from(dem.posts.rows)),
            Err(error) => prop_assert!(error.to_string().contains("any.tif: "), "{}", error),
        }
    }
}

#[test]
fn the_unchanged_file_is_read() {
    assert!(read(&Tiff::plain(), None).is_ok());
}

#[test]
fn blocks_that_share_bytes_are_refused() {
    // Strips of 32 and 16 bytes, at bytes 8 and 40.
    let strips = |first: u32, second: u32| Tiff::plain().tag(273, Long(vec![first, second]));
    assert!(read(&strips(8, 40), None).is_ok());
    // Touching is not sharing; their order in the file is free.
    assert!(read(&strips(24, 8), None).is_ok());
    assert_names(
        &refusal(&strips(8, 39), None),
        &["strip 1: 16 bytes from byte 39; expected bytes of its own: strip 0 has 32 bytes from byte 8"],
    );
    assert_names(
        &refusal(&strips(23, 8), None),
        &["strip 0: 32 bytes from byte 23; expected bytes of its own: strip 1 has 16 bytes from byte 8"],
    );
    assert_names(&refusal(&strips(8, 8), None), &["strip 1: 16 bytes from byte 8"]);

    // A strip that is not asked for may share bytes. Its two rows are at y = 5 and 3, the other's row is at y = 1.
    let north = [10.0, 2.0, 4.0, 4.0];
    assert!(read(&strips(8, 8), Some(north)).is_ok());
}

#[test]
fn equal_offsets_take_neither_time_nor_memory() {
    // 2^18 strips of one row of 64 posts, all with the same 256 bytes: decoded, they would be 64 MB out of 2 MB.
    let count = 1 << 18;
    let mut tiff = Tiff::plain();
    tiff.size = [64, 1];
    tiff.block = vec![1];
    let tiff = tiff
        .with(|column, _| column as f64)
        .tag(257, Long(vec![count]))
        .tag(273, Long(vec![8; count as usize]))
        .tag(279, Long(vec![256; count as usize]));
    let bytes = tiff.bytes();
    assert!(bytes.len() > 2 << 20 && bytes.len() < 3 << 20);
    let (result, peak) = peak_bytes(|| dem_from_bytes(&bytes, Path::new("dem.tif"), None));
    let error = result.unwrap_err().to_string();
    assert_names(&error, &["dem.tif: strip 1: 256 bytes from byte 8; expected bytes of its own: strip 0"]);
    // 32 bytes for each strip that is checked, in a list that grows by doubling.
    assert!(peak < 16 * bytes.len(), "{peak}");
}

#[test]
fn as_many_strips_as_the_limit_are_read_and_no_more() {
    // Strips of one row, of which each third has the same bytes: no two neighbours share any.
    let of = |rows: usize| {
        let tiff = Tiff { block: vec![1], ..Tiff::plain() };
        let offsets = (0..rows).map(|row| 8 + 16 * (row % 3) as u16).collect();
        tiff.tag(257, Long(vec![rows as u32])).tag(273, Short(offsets)).tag(279, Short(vec![16; rows]))
    };
    // The two rows in the north, at y = 4 and 2.
    let north = Some([10.0, 1.5, 4.0, 3.0]);
    let read = read(&of(1 << 22), north).unwrap();
    assert_eq!(read.posts.heights, [100.5, 101.5, 102.5, 103.5, 0.5, 1.5, 2.5, 3.5]);
    assert_names(
        &refusal(&of((1 << 22) + 1), north),
        &[
            "StripOffsets: 4194305 values; expected 4194305, one for each strip, of which at most 4194304 are read",
        ],
    );
}
