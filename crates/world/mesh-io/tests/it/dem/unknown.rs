//! Constants that nobody declared, in files of every type.

use super::write::{Double, Short, Text, Tiff};
use super::{assert_names, read, read_with, refusal};
use raypencil_mesh_io::{DemOptions, HeightUnit, NoData};

/// 24 x 24 pixels of 1 m, between 100 and 112, with a hole of 4 x 4 in them.
fn with_hole(format: [u16; 2], value: f64) -> Tiff {
    let mut tiff = Tiff::plain().tag(33550, Double(vec![1.0, 1.0, 0.0]));
    (tiff.size, tiff.block, tiff.format) = ([24, 24], vec![24], format);
    tiff.with(|column, row| match (column, row) {
        (5..9, 5..9) => value,
        _ => 100.0 + ((column * 7 + row * 11) % 120) as f64 / 10.0,
    })
}

fn options(nodata: &str) -> DemOptions {
    DemOptions { nodata: NoData::parse(nodata).unwrap(), ..Default::default() }
}

#[test]
fn a_constant_far_from_all_others_is_refused_with_its_count() {
    for (format, value, written) in [
        ([3, 32], -9999.0, "-9999"),
        ([3, 64], -9999.0, "-9999"),
        ([2, 16], -32768.0, "-32768"),
        ([2, 16], 32767.0, "32767"),
        ([1, 16], 65535.0, "65535"),
        ([1, 16], 0.0, "0"),
        ([1, 8], 255.0, "255"),
        ([3, 32], -1.5, "-1.5"),
        ([3, 32], f64::from(-123_456.79_f32), "-123456.79"),
        ([2, 32], -999.0, "-999"),
    ] {
        let tiff = with_hole(format, value);
        assert_names(
            &refusal(&tiff, None),
            &[
                &format!("dem.tif: samples: {written} in 16 of 576 posts, "),
                &format!("`--nodata {written}` says that it stands for unknown heights"),
                "`--nodata none` that it is a height",
                "`dem_nodata` of a scene file",
            ],
        );
        let dem = read_with(&tiff, &options(written)).unwrap();
        assert_eq!((dem.unknown, dem.nodata, dem.given_nodata.len()), (16, None, 1), "{written}");
        let kept = read_with(&tiff, &options("none")).unwrap();
        assert_eq!((kept.unknown, kept.posts.heights[24 * 16 + 6]), (0, value), "{written}");
        assert_eq!(kept.spikes().map(|spikes| spikes.count), Some(16), "{written}");
        // What the file declares needs no word.
        let declared = read(&tiff.tag(42113, Text(written)), None).unwrap();
        assert_eq!((declared.unknown, declared.nodata), (16, written.parse().ok()), "{written}");
    }
}

#[test]
fn samples_that_are_no_heights_are_named_as_the_file_writes_them() {
    for (format, value, written) in [
        ([3, 32], f64::from(f32::MIN), "-3.4028235e38"),
        ([3, 32], f64::from(-3.4e38_f32), "-3.4e38"),
        ([3, 32], f64::from(1e20_f32), "1e20"),
        ([3, 64], 1e20, "1e20"),
        ([3, 64], f64::MIN, "-1.7976931348623157e308"),
        ([3, 32], f64::INFINITY, "inf"),
        ([2, 32], f64::from(i32::MIN), "-2.147483648e9"),
    ] {
        let tiff = with_hole(format, value);
        assert_names(
            &refusal(&tiff, None),
            &[
                &format!("dem.tif: pixel (5, 5): {written}, and the same in 15 more"),
                "expected a height within 1e7 m",
                &format!("`--nodata {written}`"),
            ],
        );
        // A pixel is that of the file, whatever window is read.
        let of_window = refusal(&tiff, Some([13.0, -10.0, 8.0, 10.0]));
        assert_names(&of_window, &[&format!("dem.tif: pixel (5, 5): {written}")]);
        assert_eq!(read_with(&tiff, &options(written)).unwrap().unknown, 16, "{written}");
        assert_names(&read_with(&tiff, &options("none")).unwrap_err().to_string(), &["pixel (5, 5)"]);
    }
}

#[test]
fn a_second_constant_keeps_the_first() {
    let mut tiff = with_hole([3, 32], -9999.0);
    tiff.samples[3] = 32767.0_f32.to_le_bytes().to_vec();
    tiff.samples[4] = 32767.0_f32.to_le_bytes().to_vec();
    let message = read_with(&tiff, &options("-9999")).unwrap_err().to_string();
    assert_names(
        &message,
        &["samples: 32767 in 2 of 576", "`--nodata -9999,32767`", "`--nodata -9999,none`"],
    );
    assert_eq!(read_with(&tiff, &options("-9999,32767")).unwrap().unknown, 18);
    let kept = read_with(&tiff, &options("-9999, none")).unwrap();
    assert_eq!((kept.unknown, kept.spikes().unwrap().count), (16, 2));
    for wrong in ["", "-9999;0", "nothing", "none,-x"] {
        assert!(NoData::parse(wrong).unwrap_err().contains("such as -9999, or none"), "{wrong}");
    }
}

#[test]
fn the_rule_holds_in_feet_and_for_depths() {
    let foot = DemOptions { z_unit: Some(HeightUnit::parse("ft").unwrap()), ..Default::default() };
    // 100 ft to 112 ft, in metres.
    let message = read_with(&with_hole([3, 32], -9999.0), &foot).unwrap_err().to_string();
    assert_names(&message, &["-9999 in 16 of 576 posts, 3078.2 m below the others, which span 3.6 m"]);
    let depth = DemOptions { z_unit: Some(HeightUnit::parse("-m").unwrap()), ..Default::default() };
    let message = read_with(&with_hole([3, 32], -9999.0), &depth).unwrap_err().to_string();
    assert_names(&message, &["-9999 in 16 of 576 posts, 10099.0 m above the others, which span 11.9 m"]);
    // A strip that was never written is unknown by a word of the caller as well.
    let mut absent = with_hole([3, 32], 105.0).tag(278, Short(vec![12]));
    (absent.block, absent.absent) = (vec![12], vec![1]);
    assert_names(&refusal(&absent, None), &["strip 1: no bytes"]);
    assert_eq!(read_with(&absent, &options("-1")).unwrap().unknown, 288);
}
