//! Every kind of sample, layout and compression gives the same posts.

use proptest::prelude::*;
use tiff::encoder::{Compression, Predictor, TiffEncoder, colortype};
use tiff::tags::Tag;

use super::read;
use super::write::{Codec, Double, Short, Text, Tiff, plain_sample};
use super::{assert_names, refusal};
use raypencil_mesh_io::read_dem;

/// Samples in the order of posts, whose row 0 is the last of the file: for 4 x 3 pixels 200, 201, ...; 100, ...; 0, ...
fn from_the_south(sample: impl Fn(usize, usize) -> f64, [width, height]: [usize; 2]) -> Vec<f64> {
    let rows = (0..height).rev();
    rows.flat_map(|row| (0..width).map(move |column| (column, row))).map(|(c, r)| sample(c, r)).collect()
}

#[test]
fn every_type_of_sample_layout_and_order() {
    for format in [[1, 8], [2, 8], [1, 16], [2, 16], [1, 32], [2, 32], [3, 32], [3, 64]] {
        for (codec, predictor) in [
            (Codec::Plain, 1),
            (Codec::PackBits, 1),
            (Codec::Deflate, 1),
            (Codec::Lzw, 1),
            (Codec::Deflate, 2),
            (Codec::Lzw, 2),
            (Codec::Deflate, 3),
            (Codec::Lzw, 3),
            (Codec::Zstd, 1),
            (Codec::Zstd, 2),
            (Codec::Zstd, 3),
        ] {
            if predictor == 3 && format[0] != 3 {
                continue;
            }
            for block in [vec![1], vec![2], vec![70], vec![16, 16], vec![32, 16]] {
                for (is_big_endian, is_big) in [(false, false), (true, false), (false, true), (true, true)] {
                    // Fractions need floating point, signs a signed type; 21 columns and 35 rows are several tiles,
                    // with padding on both sides.
                    let sample = |column: usize, row: usize| {
                        let value = (column * 3 + row) as f64;
                        match format {
                            [3, _] => value / 2.0 - 20.0,
                            [2, _] => value - 50.0,
                            _ => value,
                        }
                    };
                    let mut tiff = Tiff::plain();
                    (tiff.format, tiff.codec, tiff.predictor) = (format, codec, predictor);
                    (tiff.block, tiff.is_big_endian, tiff.is_big) = (block.clone(), is_big_endian, is_big);
                    tiff.size = [21, 35];
                    let tiff = tiff.with(sample);
                    let what = format!("{format:?} {codec:?} {predictor} {block:?} {is_big_endian} {is_big}");
                    let dem = read(&tiff, None).unwrap_or_else(|error| panic!("{what}: {error}"));
                    assert_eq!(dem.posts.heights, from_the_south(sample, [21, 35]), "{what}");
                }
            }
        }
    }
}

#[test]
fn strips_of_an_encoder() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("encoded.tiff");
    let samples: Vec<i16> = (0..30 * 20).map(|k| (k * 7 % 1000 - 500) as i16).collect();
    for compression in [
        Compression::Uncompressed,
        Compression::Packbits,
        Compression::Lzw,
        Compression::Deflate(Default::default()),
    ] {
        for predictor in [Predictor::None, Predictor::Horizontal] {
            let mut encoder = TiffEncoder::new(std::fs::File::create(&path).unwrap())
                .unwrap()
                .with_compression(compression)
                .with_predictor(predictor);
            let mut image = encoder.new_image::<colortype::GrayI16>(30, 20).unwrap();
            image.rows_per_strip(7).unwrap();
            let tags = image.encoder();
            tags.write_tag(Tag::ModelPixelScaleTag, &[2.0, 2.0, 0.0][..]).unwrap();
            tags.write_tag(Tag::ModelTiepointTag, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0][..]).unwrap();
            image.write_data(&samples).unwrap();
            let heights = read_dem(&path, None).unwrap().posts.heights;
            assert_eq!(heights, from_the_south(|c, r| f64::from(samples[30 * r + c]), [30, 20]), "rows of 7");
        }
    }
}

#[test]
fn unknown_heights_are_nan() {
    // -9999 by the tag, whose decimals are rounded to the sample's type; NaN without a tag too.
    let holes = |value: f64| {
        Tiff::plain().with(move |c, r| if (c, r) == (1, 1) { value } else { plain_sample(c, r) })
    };
    for (value, text) in [
        (-9999.0, "-9999"),
        (-9999.0, " -9999.0 "),
        (f64::from(f32::MIN), "-3.4028234663852886e+38"),
        (f64::from(0.1_f32), "0.1"),
        (f64::NAN, "nan"),
        (f64::NAN, "-9999"),
    ] {
        let dem = read(&holes(value).tag(42113, Text(text)), None).unwrap();
        // Pixel (1, 1) is post 5 of the second row from the south as well.
        assert!(dem.posts.heights[5].is_nan(), "{text}");
        assert_eq!(dem.unknown, 1);
    }
    assert_eq!(read(&holes(f64::NAN), None).unwrap().unknown, 1);
    // Without the tag one such sample is a height, or too high to be one; infinities are never heights.
    assert_eq!(read(&holes(-9999.0), None).unwrap().posts.heights[5], -9999.0);
    for value in [f64::from(f32::MIN), f64::INFINITY, 1.1e7] {
        assert_names(
            &refusal(&holes(value), None),
            &["dem.tif: pixel (1, 1): ", "expected a height within 1e7 m", "42113"],
        );
    }
    let message = refusal(&holes(0.0).tag(42113, Text("none")), None);
    assert_names(&message, &["tag 42113 GDAL_NODATA", "\"none\"", "-9999"]);
}

#[test]
fn blocks_of_no_bytes_have_unknown_heights() {
    // Strips of two rows: the second strip has only the last row, which is row 0 of the posts.
    let mut tiff = Tiff::plain();
    tiff.absent = vec![1];
    let message = refusal(&tiff, None);
    assert_names(&message, &["strip 1", "no bytes", "GDAL_NODATA"]);
    let dem = read(&tiff.clone().tag(42113, Text("-1")), None).unwrap();
    assert_eq!(dem.unknown, 4);
    assert!(dem.posts.heights[..4].iter().all(|height| height.is_nan()) && dem.posts.heights[4] == 100.5);
    tiff.absent = vec![0, 1];
    assert_names(&refusal(&tiff.tag(42113, Text("-1")), None), &["StripByteCounts", "no bytes in any strip"]);
}

#[test]
fn samples_that_cannot_be_heights_are_refused() {
    let plain = Tiff::plain;
    for (tiff, words) in [
        (plain().tag(277, Short(vec![3])), ["tag 277 SamplesPerPixel: 3", "one band"]),
        (plain().tag(262, Short(vec![0])), ["tag 262 PhotometricInterpretation: 0", "BlackIsZero"]),
        (plain().tag(259, Short(vec![7])), ["tag 259 Compression: 7 (JPEG)", "deflate"]),
        (plain().tag(258, Short(vec![12])), ["tag 258 BitsPerSample: 12", "8, 16, 32 or 64"]),
        (plain().tag(258, Short(vec![16])), ["BitsPerSample and tag 339", "format 3 and 16 bits"]),
        (plain().tag(339, Short(vec![6])), ["tag 339 SampleFormat: 6", "floating point"]),
        (plain().tag(317, Short(vec![9])), ["tag 317 Predictor: 9", "horizontal"]),
        (plain().tag(266, Short(vec![2])), ["tag 266 FillOrder: 2", "highest bit"]),
        (plain().tag(274, Short(vec![3])), ["tag 274 Orientation: 3", "first row on top"]),
        (
            plain().tag(42112, Text("<GDALMetadata>\n<Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.1</Item></GDALMetadata>")),
            ["tag 42112 GDAL_METADATA: a scale of \"0.1\"", "gdal_translate -unscale"],
        ),
        (
            plain().tag(42112, Text("<Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">feet</Item>")),
            ["heights in \"feet\"", "--z-unit"],
        ),
    ] {
        let message = refusal(&tiff, None);
        assert_names(&message, &words);
        assert_names(&message, &["dem.tif: ", "expected "]);
    }
    let harmless =
        "<Item name=\"OFFSET\" sample=\"0\" role=\"offset\">0</Item><Item role=\"unittype\">Metre</Item>";
    assert!(read(&plain().tag(42112, Text(harmless)), None).is_ok());
    assert!(read(&plain().tag(33550, Double(vec![0.5, 2.0, 1.0])), None).is_ok());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..Default::default() })]

    /// A window gives the same heights as all posts cut to it, whatever the blocks.
    #[test]
    fn a_window_is_a_part(
        x in 5.0..25.0,
        y in -90.0..10.0,
        width in 0.1..15.0,
        height in 0.1..90.0,
        block in prop_oneof![Just(vec![1]), Just(vec![7]), Just(vec![16, 16]), Just(vec![32, 16])],
    ) {
        let mut tiff = Tiff::plain();
        (tiff.size, tiff.block) = ([25, 40], block);
        let tiff = tiff.with(plain_sample);
        let all = read(&tiff, None).unwrap().posts;
        let low = glam::DVec2::new(x, y);
        let expected = all.crop(low, low + glam::DVec2::new(width, height));
        match (expected, read(&tiff, Some([x, y, width, height]))) {
            (Some(expected), Ok(part)) => prop_assert_eq!(part.posts, expected),
            (None, Err(error)) => {
                let message = error.to_string();
                prop_assert!(message.contains("window: no post in x") && message.contains("posts of x 10.25 to 22.25"), "{}", message);
            }
            (Some(few), Err(error)) => prop_assert!(few.columns == 1 || few.rows == 1, "{error}"),
            (expected, got) => prop_assert!(false, "{expected:?} and {got:?}"),
        }
    }
}
