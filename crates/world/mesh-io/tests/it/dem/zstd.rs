//! Files that GDAL 3.10 wrote with ZSTD, of 24 x 20 heights: 100 + column / 2 + row / 4.

use std::path::Path;

use super::assert_names;
use raypencil_mesh_io::dem_from_bytes;

const FILES: [(&str, &[u8]); 5] = [
    ("strip, f32", include_bytes!("zstd/strip-f32.tif")),
    ("level 22, f64", include_bytes!("zstd/level-22-f64.tif")),
    ("strips of 7 rows, horizontal differences, i16", include_bytes!("zstd/horizontal-i16.tif")),
    ("tiles, differences of bytes, f32", include_bytes!("zstd/tiles-floating-f32.tif")),
    ("big endian, differences of bytes, f64", include_bytes!("zstd/big-endian-floating-f64.tif")),
];

#[test]
fn files_of_gdal_have_their_heights() {
    for (name, bytes) in FILES {
        let dem = dem_from_bytes(bytes, Path::new("dem.tif"), None)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!((dem.posts.columns, dem.posts.rows, dem.unknown), (24, 20, 0), "{name}");
        for (place, &height) in dem.posts.heights.iter().enumerate() {
            let exact = 100.0 + 0.5 * (place % 24) as f64 + 0.25 * (19 - place / 24) as f64;
            let expected = if name.ends_with("i16") { exact.floor() } else { exact };
            assert_eq!(height, expected, "{name}, post {place}");
        }
    }
}

#[test]
fn a_part_is_read_from_the_blocks_that_it_touches() {
    for (name, bytes) in FILES {
        let all = dem_from_bytes(bytes, Path::new("dem.tif"), None).unwrap().posts;
        let window = [500_003.0, 4_999_985.0, 18.0, 9.0];
        let part = dem_from_bytes(bytes, Path::new("dem.tif"), Some(window)).unwrap().posts;
        let low = glam::DVec2::new(window[0], window[1]);
        assert_eq!(Some(part), all.crop(low, low + glam::DVec2::new(window[2], window[3])), "{name}");
    }
}

#[test]
fn a_broken_stream_is_refused_with_its_block() {
    for (name, bytes) in FILES {
        let magic = [0x28, 0xb5, 0x2f, 0xfd];
        let at = bytes.windows(4).position(|four| four == magic).unwrap();
        for wrong in [0, 4, 8] {
            let mut bytes = bytes.to_vec();
            bytes[at + wrong] ^= 0xff;
            let message = match dem_from_bytes(&bytes, Path::new("dem.tif"), None) {
                // A changed byte of a raw block is a changed height.
                Ok(_) if wrong == 8 => continue,
                Ok(_) => panic!("{name}, byte {wrong}"),
                Err(error) => error.to_string(),
            };
            assert_names(&message, &["dem.tif: ", " 0: ", "expected samples that can be decoded"]);
        }
    }
}
