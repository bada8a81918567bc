//! What an elevation model and a mesh say of themselves, in words and for programs.

use super::write::{Double, Short, Text, Tiff};
use super::{read, read_with};
use raypencil_mesh_io::{
    DemOptions, FileFacts, FileFrame, FileUnits, HeightUnit, LengthUnit, NoData, UnitSource, UpAxis,
};
use serde_json::json;

/// 12 x 9 pixels of 0.5 m and 2 m with the tie point at (10, 5): a slope of 1 m, and a post of 900 m in column 7 and row 1.
fn with_a_spike() -> Tiff {
    let mut tiff = Tiff::plain();
    tiff.size = [12, 9];
    tiff.with(|column, row| match (column, row) {
        (7, 1) => 900.0,
        _ => (column + row) as f64 / 16.0,
    })
}

#[test]
fn the_worst_spike_is_told_with_its_place() {
    let dem = read(&with_a_spike(), None).unwrap();
    let spikes = dem.facts().spikes.unwrap();
    // The centre of the pixel: 10 + 7.5 * 0.5, and 5 - 1.5 * 2. The rest spans (11 + 8) / 16 m.
    assert_eq!((spikes.count, spikes.worst), (1, [13.75, 2.0, 900.0]));
    assert_eq!((spikes.stands_out, spikes.rest), (900.0 - 1.1875, 1.1875));
    let words =
        "1 of the posts stands out: the worst, at (13.75, 2), is 898.8 m above all others, which span 1.2 m";
    assert_eq!(spikes.words(), words);
    assert_eq!(dem.facts().lines().last().unwrap(), &("warning", words.to_string()));
    assert_eq!(
        dem.facts().to_json()["spikes"],
        json!({"count": 1, "worst_m": [13.75, 2.0, 900.0], "stands_out_m": 898.8125, "rest_m": 1.1875})
    );
}

#[test]
fn posts_that_are_nearer_than_a_survey_has_them_are_told() {
    let of = |spacing: [f64; 2]| {
        let [x, y] = spacing;
        read(&Tiff::plain().tag(33550, Double(vec![x, y, 0.0])), None).unwrap().facts()
    };
    for spacing in [[0.01, 0.01], [0.5, 2.0]] {
        assert_eq!((of(spacing).dense, of(spacing).dense_words()), (None, None));
    }
    for spacing in [[0.0001, 0.0001], [0.009, 2.0], [2.0, 0.009]] {
        assert_eq!(of(spacing).dense, Some(spacing));
        let [x, y] = spacing;
        let words = format!(
            "the posts are {x} x {y} m apart: are the coordinates degrees, which are taken as metres?"
        );
        assert_eq!(of(spacing).lines().last().unwrap(), &("warning", words));
    }
}

#[test]
fn systems_that_the_file_does_not_name_are_said_once() {
    let keys = |more: &[u16]| [&[1, 1, 0, 1 + more.len() as u16 / 4, 1025, 0, 1, 1], more].concat();
    let words = |more: &[u16]| {
        let dem = read(&Tiff::plain().tag(34735, Short(keys(more))), None).unwrap();
        FileFacts::from(dem.facts()).units.unwrap().words()
    };
    assert!(words(&[]).ends_with("; the file names no coordinate system"), "{}", words(&[]));
    let map = words(&[3072, 0, 1, 32633]);
    assert!(map.contains("32633") && map.ends_with("; the file names no system of the heights"), "{map}");
}

#[test]
fn units_are_told_with_what_says_them() {
    let words =
        [UnitSource::System, UnitSource::Key, UnitSource::Option, UnitSource::Default].map(UnitSource::word);
    assert_eq!(words, ["system", "key", "option", "default"]);
    let dem = read(&Tiff::plain(), None).unwrap();
    let facts = FileFacts::from(dem.facts());
    assert_eq!(facts.dem(), Some(&dem.facts()));
    let by_default = "metre (EPSG:9001), by default: the file does not say";
    let units = facts.units.unwrap();
    assert_eq!(
        units.words(),
        format!("map in {by_default}, heights in {by_default}; the file names no coordinate system")
    );
    assert_eq!(units.to_json()["map"]["unit_from"], json!("default"));
    assert_eq!(units.lines()[1], ("unit", by_default.to_string()));
    // Feet by a key, and depths in fathoms by the caller's word.
    let keys = Tiff::plain().tag(34735, Short(vec![1, 1, 0, 2, 3072, 0, 1, 32767, 3076, 0, 1, 9002]));
    let z_unit = Some(HeightUnit { unit: LengthUnit::parse("fathom").unwrap(), is_depth: true });
    let facts = read_with(&keys, &DemOptions { z_unit, ..DemOptions::default() }).unwrap().facts();
    let lines = facts.lines();
    assert_eq!(lines[1], ("unit", "foot (EPSG:9002), 0.3048 m".to_string()));
    let depths = "fathom (EPSG:9014), 1.8288 m, as is given; depths, which became heights by their sign";
    assert_eq!(lines[3], ("z unit", depths.to_string()));
}

#[test]
fn unknown_posts_are_told_with_what_says_so() {
    let tiff = Tiff::plain().tag(42113, Text("3.5"));
    let given =
        DemOptions { nodata: NoData { values: vec![100.5], is_complete: false }, ..DemOptions::default() };
    let facts = read_with(&tiff, &given).unwrap().facts();
    assert_eq!(
        facts.lines()[4],
        ("unknown posts", "2 (NaN; 3.5 as the file says; 100.5 as is given)".to_string())
    );
}

#[test]
fn axes_and_unit_of_a_mesh_are_told_with_what_says_them() {
    let words = |is_gltf: bool, up: Option<UpAxis>, scale: f64| {
        FileUnits::Mesh { is_gltf, frame: FileFrame { up, scale } }.words()
    };
    for (is_gltf, up, scale, expected) in [
        (
            false,
            None,
            1.0,
            "up axis z, by default: the file does not say; scale 1 m for each unit of the file: the file does not say",
        ),
        (
            false,
            Some(UpAxis::Y),
            0.5,
            "up axis y, as is given; scale 0.5 m for each unit of the file, as is given",
        ),
        (
            true,
            None,
            1.0,
            "up axis y, as glTF says; scale 1 m for each unit of the file: the metre, as glTF says",
        ),
        (
            true,
            Some(UpAxis::Z),
            2.0,
            "up axis z, as is given; by glTF it is y; scale 2 m for each unit of the file, as is given; by glTF it is the metre",
        ),
    ] {
        assert_eq!(words(is_gltf, up, scale), expected);
    }
    let stated = |is_gltf: bool| {
        FileUnits::Mesh { is_gltf, frame: FileFrame::default() }.to_json()["file_states"].clone()
    };
    assert_eq!(stated(true), json!({"unit": "metre", "up": "y"}));
    assert_eq!(stated(false), json!({"unit": null, "up": null}));
}
