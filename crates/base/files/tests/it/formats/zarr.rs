//! Zarr: what this crate writes is read back, and stores of other programs in several chunks.

use std::fs;
use std::path::Path;

use raypencil_files::{
    ArrayData, Limits, NamedArray, Values, ZarrArray, read_channels, read_zarr, write_zarr,
};

fn array(name: &str, shape: &[u64], data: ArrayData) -> NamedArray {
    let names = ["row", "column", "axis"];
    let shape = shape.iter().zip(names).map(|(&length, name)| (name, length)).collect();
    NamedArray { name: name.into(), unit: "m", meaning: "a test", shape, data }
}

fn refusal(store: &Path) -> String {
    let error = read_zarr(store, &Limits::default()).expect_err("a refusal").to_string();
    error.replace(&format!("{}/", store.display()), "")
}

#[test]
fn a_written_store_is_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let numbers: Vec<f64> = (0..12).map(|k| f64::from(k) / 3.0).collect();
    let camera = vec![
        array("range.T", &[3, 4], ArrayData::F64(numbers.clone())),
        array("P", &[2, 2, 3], ArrayData::F64(numbers.clone())),
    ];
    let beam = vec![
        array("face.I", &[1, 2], ArrayData::U32(vec![7, u32::MAX])),
        array("visible.V", &[1, 2], ArrayData::U8(vec![0, 1])),
    ];
    let groups = [("camera".to_string(), camera), ("beam-0".to_string(), beam)];
    write_zarr(&folder.path().join("maps.zarr"), &[], &groups).unwrap();
    let read = read_zarr(folder.path().join("maps.zarr"), &Limits::default()).unwrap();
    let names: Vec<String> = read.iter().map(|one| format!("{}/{}", one.group, one.name)).collect();
    assert_eq!(names, ["beam-0/face.I", "beam-0/visible.V", "camera/P", "camera/range.T"]);
    let reals = |one: &ZarrArray, plane: usize| match &one.array.planes[plane] {
        Values::Reals(image) => image.cells().to_vec(),
        Values::Wholes(_) => panic!("reals"),
    };
    assert_eq!(reals(&read[3], 0), numbers);
    assert_eq!(read[3].array.planes[0].size(), (4, 3));
    assert_eq!(reals(&read[2], 1), [1.0, 4.0, 7.0, 10.0].map(|k| k / 3.0));
    assert_eq!((read[0].array.planes[0].real(1), read[1].array.planes[0].real(1)), (4_294_967_295.0, 1.0));
}

#[test]
fn limits_hold_for_all_arrays_of_a_store_together() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("maps.zarr");
    let arrays = ["a", "b"].map(|name| array(name, &[3, 4], ArrayData::F64(vec![0.5; 12]))).to_vec();
    write_zarr(&store, &[], &[("camera".to_string(), arrays)]).unwrap();
    let read = |bytes: u64| read_zarr(&store, &Limits { bytes, ..Limits::default() });
    // 96 bytes each, and what is before them in the form in which they are read.
    assert_eq!(read(400).unwrap().len(), 2);
    let error = read(150).unwrap_err().to_string();
    assert!(error.contains("camera/b: shape: [3, 4] in chunks of [3, 4]; expected 1 to"), "{error}");
}

/// An array of 3 x 5 numbers of 16 bits, 0 to 14, in chunks of 2 x 2, in the byte order of the description.
fn chunked(folder: &Path, change: impl Fn(String) -> String) {
    let array = folder.join("s.zarr/depth");
    let group = r#"{"zarr_format": 3, "node_type": "group", "attributes": {}}"#;
    fs::create_dir_all(array.join("c/0")).unwrap();
    fs::create_dir_all(array.join("c/1")).unwrap();
    fs::write(folder.join("s.zarr/zarr.json"), group).unwrap();
    let document = r#"{"zarr_format": 3, "node_type": "array", "shape": [3, 5], "data_type": "uint16",
        "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [2, 2]}},
        "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}}, "fill_value": 0,
        "codecs": [{"name": "bytes", "configuration": {"endian": "big"}}], "attributes": {}}"#;
    fs::write(array.join("zarr.json"), change(document.into())).unwrap();
    for (row, column) in (0..2_u16).flat_map(|row| (0..3_u16).map(move |column| (row, column))) {
        let mut bytes = Vec::new();
        for (j, i) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let (j, i) = (2 * row + j, 2 * column + i);
            // Behind the border of the array there may be anything.
            let number: u16 = if j < 3 && i < 5 { 5 * j + i } else { 999 };
            bytes.extend(number.to_be_bytes());
        }
        fs::write(array.join(format!("c/{row}/{column}")), bytes).unwrap();
    }
}

#[test]
fn chunks_are_put_together() {
    let folder = tempfile::tempdir().unwrap();
    chunked(folder.path(), |document| document);
    let read = read_zarr(folder.path().join("s.zarr"), &Limits::default()).unwrap();
    let [one] = read.as_slice() else { panic!("one array") };
    assert_eq!((one.group.as_str(), one.name.as_str()), ("", "depth"));
    let Values::Wholes(image) = &one.array.planes[0] else { panic!("wholes") };
    assert_eq!((image.width(), image.height()), (5, 3));
    assert_eq!(image.cells(), (0..15).collect::<Vec<u32>>());
}

#[test]
fn what_is_not_read_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("s.zarr");
    let with = |from: &str, to: &str| {
        chunked(folder.path(), |document| {
            assert!(document.contains(from));
            document.replace(from, to)
        });
        refusal(&store)
    };
    let bytes = r#"{"name": "bytes", "configuration": {"endian": "big"}}"#;
    let zstd = format!(r#"{bytes}, {{"name": "zstd", "configuration": {{"level": 0, "checksum": false}}}}"#);
    assert_eq!(
        with(bytes, &zstd),
        "depth: codecs: bytes, zstd; expected bytes alone: write the store without compression"
    );
    assert!(with("uint16", "complex64").contains("data_type: \"complex64\"; expected bool, an integer"));
    assert!(with("[2, 2]", "[2, 0]").contains("chunk_shape: [2, 0]"));
    assert!(with("[3, 5]", "[4294967296, 4294967296]").contains("shape: [4294967296, 4294967296]"));
    // 2^66 numbers of a chunk.
    let large = with("[2, 2]", "[8589934592, 8589934592]");
    assert!(large.contains("shape: [3, 5] in chunks of [8589934592, 8589934592]; expected 1 to"), "{large}");
    assert!(with("[3, 5]", "[9, 5]").contains("chunk c/2/0: not there; expected a file for every chunk"));
    assert!(with("\"shape\"", "\"form\"").contains("zarr.json: missing field `shape`"));
    // What the specification requires. Without it the order of bytes would be guessed.
    let bare = r#"{"name": "bytes"}"#;
    assert!(with(bytes, bare).contains("depth: codecs, endian: not there; expected little or big"));
    assert!(with("\"fill_value\": 0,", "").contains("depth: fill_value: not there; expected a number"));
    let rubbish = with("\"fill_value\": 0", "\"fill_value\": \"rubbish\"");
    assert!(rubbish.contains("depth: fill_value: \"rubbish\"; expected a number, true or false, \"NaN\""));
    chunked(folder.path(), |document| document);
    fs::write(store.join("depth/c/1/2"), [0; 7]).unwrap();
    assert!(refusal(&store).contains("chunk c/1/2: 7 bytes; expected the 8 of its shape"));
    fs::remove_file(store.join("zarr.json")).unwrap();
    assert!(refusal(&store).contains("no zarr.json; expected a store of version 3 that is complete"));
    fs::write(store.join(".zgroup"), "{}").unwrap();
    assert!(refusal(&store).contains("a store of version 2; expected a store of version 3"));
}

/// What would change the numbers, or may: a reader that ignores it gives others than the writer meant.
#[test]
fn a_description_that_asks_not_to_be_read_so_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("s.zarr");
    let document = |more: &str| {
        chunked(folder.path(), |document| document.replace("\"attributes\": {}", more));
    };
    let attributes = |more: &str| format!("\"attributes\": {{{more}}}");
    for (more, words) in [
        (
            r#""foo": {"must_understand": true}"#.into(),
            "depth: zarr.json, key \"foo\": {\"must_understand\":true}; expected no extension but those that say",
        ),
        // Whatever does not say that it need not be understood must be.
        (r#""foo": {"name": "bar"}"#.into(), "key \"foo\": {\"name\":\"bar\"}; expected no extension but"),
        (r#""foo": false"#.into(), "key \"foo\": false; expected no extension but"),
        (
            r#""foo": {"must_understand": "false"}"#.into(),
            "key \"foo\": {\"must_understand\":\"false\"}; expected",
        ),
        (
            r#""storage_transformers": [{"name": "x"}]"#.into(),
            "depth: storage_transformers: {\"name\":\"x\"}; expected none",
        ),
        (
            attributes(r#""scale_factor": 0.001"#),
            "depth: attributes, scale_factor: 0.001; expected 1 or none",
        ),
        (attributes(r#""add_offset": 5"#), "depth: attributes, add_offset: 5; expected 0 or none"),
        (attributes(r#""scale_factor": "1""#), "depth: attributes, scale_factor: \"1\"; expected 1 or none"),
        (
            r#""dimension_names": ["column", "row"]"#.into(),
            "depth: dimension_names: column, row; expected row, column, axis",
        ),
        (
            r#""dimension_names": [null, "row"]"#.into(),
            "depth: dimension_names: ?, row; expected row, column",
        ),
        (
            r#""dimension_names": ["axis", null]"#.into(),
            "depth: dimension_names: axis, ?; expected row, column",
        ),
        (
            r#""dimension_names": ["Column", "Row"]"#.into(),
            "depth: dimension_names: Column, Row; expected row, column",
        ),
        (
            r#""dimension_names": ["row"]"#.into(),
            "depth: dimension_names: 1 names; expected 2, one for each length of shape",
        ),
        (
            attributes(r#""_ARRAY_DIMENSIONS": ["column", "row"]"#),
            "depth: _ARRAY_DIMENSIONS: column, row; expected row, column",
        ),
    ] {
        let more: String = more;
        document(&more);
        let message = refusal(&store);
        assert!(message.contains(words), "{message} has no {words}");
    }
    for more in [
        r#""foo": {"must_understand": false, "name": "bar"}"#.into(),
        r#""storage_transformers": []"#.into(),
        r#""dimension_names": null, "storage_transformers": null"#.into(),
        r#""dimension_names": ["y", "x"]"#.into(),
        r#""dimension_names": ["row", null]"#.into(),
        attributes(r#""scale_factor": 1, "add_offset": 0.0, "_FillValue": 7"#),
    ] {
        let more: String = more;
        document(&more);
        assert_eq!(read_zarr(&store, &Limits::default()).expect(&more).len(), 1);
    }
}

/// A group may be extended as well. An array that is left out is not asked.
#[test]
fn groups_say_what_must_be_understood_and_arrays_of_other_shapes_do_not() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("s.zarr");
    let group = |more: &str| {
        chunked(folder.path(), |document| document);
        let text = format!(r#"{{"zarr_format": 3, "node_type": "group", {more}}}"#);
        fs::write(store.join("zarr.json"), text).unwrap();
    };
    group(r#""foo": {"must_understand": true}"#);
    assert!(
        refusal(&store).contains("zarr.json, key \"foo\": {\"must_understand\":true}; expected no extension")
    );
    group(r#""attributes": {"scale_factor": 2}"#);
    assert!(refusal(&store).contains("attributes, scale_factor: 2; expected 1 or none"));
    group(r#""consolidated_metadata": {"kind": "inline", "must_understand": false, "metadata": {}}"#);
    assert_eq!(read_zarr(&store, &Limits::default()).unwrap().len(), 1);
    chunked(folder.path(), |document| {
        document.replace("[3, 5]", "[15]").replace("\"attributes\"", "\"foo\": 1, \"attributes\"")
    });
    assert!(read_zarr(&store, &Limits::default()).unwrap().is_empty());
}

#[test]
fn a_recording_may_be_a_store_or_have_one_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let keys = |path: &Path| -> Vec<String> {
        read_channels(path, &Limits::default()).unwrap().by_key.into_keys().collect()
    };
    for name in ["maps.zarr", "no-ending"] {
        let arrays = vec![array("range.T", &[1, 2], ArrayData::F64(vec![0.5, 1.5]))];
        write_zarr(&folder.path().join(name), &[], &[("camera".to_string(), arrays)]).unwrap();
        let [key] = keys(&folder.path().join(name)).try_into().unwrap();
        assert!(key.starts_with("camera/range"), "{key}");
        assert_eq!(keys(folder.path()), [key]);
        fs::remove_dir_all(folder.path().join(name)).unwrap();
    }
    // By its name alone it says to be one.
    fs::create_dir(folder.path().join("empty.ZARR")).unwrap();
    let error = read_channels(folder.path(), &Limits::default()).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("no zarr.json; expected a store of version 3"), "{error}");
}

#[test]
fn attributes_of_a_store_may_have_any_letters() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("maps.zarr");
    let value = "a \"quote\", C:\\path,\ttab, line\nend, \u{1}, µm";
    write_zarr(&store, &[("a \"name\"", value)], &[]).unwrap();
    let document: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(store.join("zarr.json")).unwrap()).unwrap();
    assert_eq!(document["attributes"]["a \"name\""], value);
}
