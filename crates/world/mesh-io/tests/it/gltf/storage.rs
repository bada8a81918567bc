//! Accessors, views and buffers: numbers that are read from them, and faults that are refused before reading.

use base64::Engine;
use serde_json::{Value, json};

use super::*;
use raypencil_mesh_io::load_mesh;

#[test]
fn indices_of_every_width_and_none() {
    let expected = [[0, 1, 2], [0, 2, 3]];
    let list = [0_u32, 1, 2, 0, 2, 3];
    for (component, bytes) in [
        (5121, list.iter().map(|&index| index as u8).collect::<Vec<_>>()),
        (5123, list.iter().flat_map(|&index| (index as u16).to_le_bytes()).collect()),
        (5125, list.iter().flat_map(|index| index.to_le_bytes()).collect()),
    ] {
        let (mut json, _) = square();
        json["accessors"][1]["componentType"] = json!(component);
        json["bufferViews"][1]["byteLength"] = json!(bytes.len());
        json["buffers"][0]["byteLength"] = json!(48 + bytes.len());
        let bin = [reals(&SQUARE), bytes].concat();
        assert_eq!(parse(&json, &bin).unwrap().faces(), expected, "{component}");
    }
    // Without indices every three vertices are a triangle.
    let (mut json, _) = square();
    json["meshes"][0]["primitives"][0] = json!({"attributes": {"POSITION": 0}});
    json["accessors"][0]["count"] = json!(3);
    let mesh = parse(&json, &reals(&SQUARE)).map(|mesh| mesh.faces().to_vec());
    // The buffer claims 60 bytes.
    assert!(mesh.is_err());
    json["buffers"][0]["byteLength"] = json!(48);
    assert_eq!(parse(&json, &reals(&SQUARE)).unwrap().faces(), [[0, 1, 2]]);
}

#[test]
fn positions_beside_the_bounds_of_their_accessor_are_refused() {
    let with = |low: [f64; 3], high: [f64; 3]| {
        changed(|json| {
            json["accessors"][0]["min"] = json!(low);
            json["accessors"][0]["max"] = json!(high);
        })
    };
    // The square is flat and 1 wide. Bounds that are a little off, or too wide, say of the same mesh.
    for (low, high) in
        [([0.0, 0.0, -1.0], [1.0, 0.0, 0.0]), ([0.2, -1e-7, -0.9], [0.9, -1e-7, -0.1]), ([-5.0; 3], [5.0; 3])]
    {
        with(low, high).expect("a mesh");
    }
    let message = with([5.0; 3], [6.0; 3]).unwrap_err();
    assert!(message.contains("accessor 0: positions in [0.0, 0.0, -1.0] to [1.0, 0.0, 0.0], "), "{message}");
    assert!(message.contains("beside min [5.0, 5.0, 5.0] and max [6.0, 6.0, 6.0]; expected"), "{message}");
    for axis in 0..3 {
        let (mut low, mut high) = ([-2.0; 3], [2.0; 3]);
        (low[axis], high[axis]) = (-4.0, -3.0);
        with(low, high).unwrap_err();
        (low[axis], high[axis]) = (2.0, 3.0);
        with(low, high).unwrap_err();
    }
    // Bounds of normalised numbers are those before the division.
    let quantized = changed(|json| {
        json["accessors"][0]["normalized"] = json!(true);
        json["accessors"][0]["min"] = json!([5, 5, 5]);
        json["accessors"][0]["max"] = json!([6, 6, 6]);
    });
    assert!(quantized.is_ok(), "{quantized:?}");
}

#[test]
fn indices_of_16_bits_are_unsigned() {
    // Component type 5123 is UNSIGNED_SHORT (glTF 2.0, §5.1.3): the indices of the square after 39996 other vertices have
    // their highest bit set.
    const BEFORE: usize = 39_996;
    let vertices = [reals(&vec![0.0; 3 * BEFORE]), reals(&SQUARE)].concat();
    let first = BEFORE as u16;
    let indices: Vec<u8> =
        [0, 1, 2, 0, 2, 3].iter().flat_map(|corner| (first + corner).to_le_bytes()).collect();
    let (mut json, _) = square();
    json["accessors"][0]["count"] = json!(BEFORE + 4);
    json["bufferViews"] = json!([
        {"buffer": 0, "byteOffset": 0, "byteLength": vertices.len()},
        {"buffer": 0, "byteOffset": vertices.len(), "byteLength": 12},
    ]);
    json["buffers"][0]["byteLength"] = json!(vertices.len() + 12);
    let mesh = parse(&json, &[vertices, indices].concat()).unwrap();
    assert_eq!(mesh.faces(), [[39_996, 39_997, 39_998], [39_996, 39_998, 39_999]]);
}

#[test]
fn strips_and_fans_follow_the_specification() {
    // Strip (§3.7.2.1): i, i + (1 + i % 2), i + (2 - i % 2). Fan: i + 1, i + 2, 0.
    let strip = changed(|json| json["meshes"][0]["primitives"][0]["mode"] = json!(5)).unwrap();
    assert_eq!(strip.faces(), [[0, 1, 2], [1, 0, 2], [2, 0, 2], [0, 3, 2]].map(|f: [u32; 3]| f));
    let fan = changed(|json| {
        json["meshes"][0]["primitives"][0] = json!({"attributes": {"POSITION": 0}, "mode": 6});
    });
    assert_eq!(fan.unwrap().faces(), [[1, 2, 0], [2, 3, 0]]);
    // All triangles of a strip in the usual zigzag over a square look up.
    let zigzag = changed(|json| {
        json["meshes"][0]["primitives"][0] = json!({"attributes": {"POSITION": 0}, "mode": 5});
    });
    assert_eq!(zigzag.unwrap().faces(), [[0, 1, 2], [1, 3, 2]]);
}

#[test]
fn points_and_lines_are_skipped_but_not_alone() {
    for mode in 0..4 {
        let mixed = changed(|json| {
            let line = json!({"attributes": {"POSITION": 0}, "mode": mode});
            json["meshes"][0]["primitives"].as_array_mut().unwrap().insert(0, line);
        });
        assert_eq!(mixed.unwrap().faces(), [[0, 1, 2], [0, 2, 3]]);
        let alone = changed(|json| json["meshes"][0]["primitives"][0]["mode"] = json!(mode));
        refused(alone, "scene: no triangles; expected at least one");
    }
    let odd = changed(|json| json["meshes"][0]["primitives"][0]["mode"] = json!(7));
    refused(odd, "primitive: an unknown mode; expected 0 to 6");
}

#[test]
fn interleaved_vertices_and_shared_ones() {
    // Each vertex is followed by 8 bytes of something else; the last is not.
    let bytes: Vec<u8> = SQUARE.chunks(3).flat_map(|v| [reals(v), vec![0xaa; 8]].concat()).collect();
    let (mut json, _) = square();
    json["bufferViews"] = json!([{"buffer": 0, "byteOffset": 4, "byteLength": 72, "byteStride": 20}]);
    json["buffers"][0]["byteLength"] = json!(76);
    json["accessors"].as_array_mut().unwrap().truncate(1);
    let primitive = json!({"attributes": {"POSITION": 0}, "mode": 6});
    json["meshes"][0]["primitives"] = json!([primitive, primitive]);
    let mesh = parse(&json, &[vec![0; 4], bytes].concat()).unwrap();
    assert_eq!(mesh.faces(), [[1, 2, 0], [2, 3, 0], [1, 2, 0], [2, 3, 0]]);
    assert_eq!(mesh.vertices().len(), 4);
    assert_eq!(mesh.vertices()[2], [1., 1., 0.]);
    // The longest stride of the specification. (glTF 2.0, section 5.11.4)
    for (stride, is_read) in [(252, true), (256, false)] {
        let bytes: Vec<u8> =
            SQUARE.chunks(3).flat_map(|v| [reals(v), vec![0xaa; stride - 12]].concat()).collect();
        json["bufferViews"][0]["byteStride"] = json!(stride);
        json["bufferViews"][0]["byteLength"] = json!(bytes.len());
        json["buffers"][0]["byteLength"] = json!(4 + bytes.len());
        let found = parse(&json, &[vec![0; 4], bytes].concat());
        assert_eq!(found.map(|mesh| mesh.vertices()[2]).ok(), is_read.then_some([1., 1., 0.]), "{stride}");
    }
}

#[test]
fn buffers_in_data_uris_and_files() {
    let (mut json, bin) = square();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("test.gltf");
    let mut load = |uri: &str| {
        json["buffers"][0]["uri"] = json!(uri);
        std::fs::write(&path, json.to_string()).unwrap();
        load_mesh(&path).map(|mesh| mesh.faces().len()).map_err(|error| error.to_string())
    };
    let digits = base64::engine::general_purpose::STANDARD.encode(&bin);
    assert_eq!(load(&format!("data:application/octet-stream;base64,{digits}")), Ok(2));
    assert_eq!(load(&format!("data:;base64,{digits}")), Ok(2));
    let error = load(&format!("data:application/octet-stream,{digits}")).unwrap_err();
    assert!(error.contains("test.gltf: buffer 0: a data URI without base64; expected data:"), "{error}");
    let error = load("data:;base64,AA*A").unwrap_err();
    assert!(error.contains("buffer 0: a data URI: Invalid symbol"), "{error}");
    let error = load("data:;base64,AAAA").unwrap_err();
    assert!(error.ends_with("buffer 0: 3 bytes; expected the 60 bytes of its byteLength"), "{error}");

    std::fs::write(folder.path().join("a b.bin"), &bin).unwrap();
    std::fs::create_dir(folder.path().join("below")).unwrap();
    std::fs::write(folder.path().join("below/c.bin"), &bin).unwrap();
    assert_eq!(load("a%20b.bin"), Ok(2));
    assert_eq!(load("a b.bin"), Ok(2));
    assert_eq!(load("below/c.bin"), Ok(2));
    assert_eq!(load("./below/c.bin"), Ok(2));
    let outside = tempfile::tempdir().unwrap();
    std::fs::write(outside.path().join("secret.bin"), &bin).unwrap();
    let name = outside.path().file_name().unwrap().to_str().unwrap();
    for (uri, why) in [
        (format!("../{name}/secret.bin"), "has the part .., which is refused"),
        ("below/../a b.bin".into(), "has the part .., which is refused"),
        (format!("below/../../{name}/secret.bin"), "has the part .., which is refused"),
        (format!("%2e%2e/{name}/secret.bin"), "has the part .., which is refused"),
        (outside.path().join("secret.bin").to_str().unwrap().to_string(), "is absolute or names no file"),
        ("file:///secret.bin".into(), "has a scheme, a drive or a backslash"),
        ("https://example.org/x.bin".into(), "has a scheme, a drive or a backslash"),
        ("C:\\x.bin".into(), "has a scheme, a drive or a backslash"),
        ("..\\x.bin".into(), "has a scheme, a drive or a backslash"),
        ("a%2".into(), "has a broken % escape"),
        ("a%zz".into(), "has a broken % escape"),
        ("a%ff".into(), "has a broken % escape"),
        (String::new(), "is absolute or names no file"),
        ("no.bin".into(), "does not exist"),
        ("below".into(), "cannot be read: not a regular file"),
    ] {
        let error = load(&uri).unwrap_err();
        assert!(error.contains("test.gltf: buffer 0: uri") && error.contains(why), "{uri}: {error}");
        assert!(error.ends_with("expected a file in the folder of this one, or below it"), "{error}");
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(outside.path().join("secret.bin"), folder.path().join("link.bin"))
            .unwrap();
        assert!(load("link.bin").unwrap_err().contains("leads out of the folder by a link"));
    }
    json["buffers"][0].as_object_mut().unwrap().remove("uri");
    std::fs::write(&path, json.to_string()).unwrap();
    let error = load_mesh(&path).unwrap_err().to_string();
    assert!(
        error.ends_with("buffer 0: no uri; expected a uri, or buffer 0 of a GLB with a BIN chunk"),
        "{error}"
    );
}

#[test]
fn accessors_that_do_not_fit_are_refused_before_they_are_read() {
    let accessor = |index: usize, key: &'static str, value: Value| {
        changed(move |json| json["accessors"][index][key] = value)
    };
    let huge = 1_u64 << 40;
    // Beyond the limit of all files, and beyond this buffer.
    refused(
        accessor(1, "count", json!(3 * huge)),
        &format!("nodes: {huge} faces in all instances; expected at most 33554432"),
    );
    refused(
        accessor(0, "count", json!(huge)),
        &format!("nodes: {huge} vertices in all instances; expected at most 33554432"),
    );
    refused(
        accessor(0, "count", json!(u64::MAX)),
        "nodes: 18446744073709551615 vertices in all instances; expected at most 33554432",
    );
    refused(
        accessor(0, "count", json!(5)),
        "accessor 0: 5 elements of 12 bytes, 12 apart, from byte 0; expected 1 or more within buffer view 0 of 48 bytes",
    );
    refused(
        accessor(0, "count", json!(0)),
        "accessor 0: 0 elements of 12 bytes, 12 apart, from byte 0; expected 1 or more within buffer view 0 of 48 bytes",
    );
    refused(
        accessor(1, "count", json!(9)),
        "accessor 1: 9 elements of 2 bytes, 2 apart, from byte 0; expected 1 or more within buffer view 1 of 12 bytes",
    );
    refused(
        accessor(0, "byteOffset", json!(4)),
        "accessor 0: 4 elements of 12 bytes, 12 apart, from byte 4; expected 1 or more within buffer view 0 of 48 bytes",
    );
    refused(
        accessor(0, "byteOffset", json!(u64::MAX)),
        &format!(
            "accessor 0: 4 elements of 12 bytes, 12 apart, from byte {}; expected 1 or more within buffer view 0 of 48 bytes",
            u64::MAX
        ),
    );
    refused(accessor(1, "count", json!(5)), "accessor 1: 5 corners of triangles; expected a multiple of 3");
    refused(
        accessor(0, "componentType", json!(5123)),
        "accessor 0: POSITION of VEC3 of U16; expected VEC3 of F32; whole numbers need the extension KHR_mesh_quantization",
    );
    refused(
        accessor(0, "componentType", json!(5130)),
        "accessor 0: POSITION of VEC3 of unknown components; expected VEC3 of F32; whole numbers need the extension KHR_mesh_quantization",
    );
    refused(
        accessor(0, "type", json!("VEC2")),
        "accessor 0: POSITION of VEC2 of F32; expected VEC3 of F32; whole numbers need the extension KHR_mesh_quantization",
    );
    refused(
        accessor(1, "type", json!("VEC9")),
        "accessor 1: indices of an unknown type of U16; expected SCALAR of U8, U16 or U32",
    );
    refused(
        accessor(1, "componentType", json!(5126)),
        "accessor 1: indices of SCALAR of F32; expected SCALAR of U8, U16 or U32",
    );
    refused(accessor(0, "bufferView", json!(9)), "buffer view 9: does not exist; expected an index below 2");
    let view = |key: &'static str, value: Value| changed(move |json| json["bufferViews"][0][key] = value);
    refused(
        view("byteLength", json!(61)),
        "buffer view 0: 61 bytes from byte 0; expected a part of buffer 0 of 60 bytes",
    );
    refused(
        view("byteOffset", json!(u64::MAX)),
        &format!("buffer view 0: 48 bytes from byte {}; expected a part of buffer 0 of 60 bytes", u64::MAX),
    );
    refused(
        view("byteStride", json!(8)),
        "accessor 0: a stride of 8 bytes in buffer view 0; expected 12 to 252",
    );
    refused(
        view("byteStride", json!(1_000_000)),
        "accessor 0: a stride of 1000000 bytes in buffer view 0; expected 12 to 252",
    );
    refused(view("buffer", json!(1)), "buffer 1: does not exist; expected an index below 1");
    refused(
        changed(|json| json["buffers"][0]["byteLength"] = json!(64)),
        "buffer 0: 60 bytes; expected the 64 bytes of its byteLength",
    );
    refused(
        changed(|json| json["meshes"][0]["primitives"][0]["indices"] = json!(7)),
        "accessor 7: does not exist; expected an index below 2",
    );
    refused(
        changed(|json| json["meshes"][0]["primitives"][0]["attributes"] = json!({"NORMAL": 0})),
        "primitive: no POSITION; expected a POSITION accessor",
    );
    let short_strip = changed(|json| {
        json["meshes"][0]["primitives"][0]["mode"] = json!(5);
        json["accessors"][1]["count"] = json!(2);
    });
    refused(short_strip, "accessor 1: 2 corners of a strip or fan; expected 3 or more");
}

#[test]
fn a_small_file_cannot_ask_for_much_memory() {
    // 10,000 nodes with a mesh of 10,000 primitives with 2 faces each.
    let bomb = changed(|json| {
        let primitive = json["meshes"][0]["primitives"][0].clone();
        json["meshes"][0]["primitives"] = json!(vec![primitive; 10_000]);
        json["nodes"] = json!(vec![json!({"mesh": 0}); 10_000]);
        json["scenes"][0]["nodes"] = json!((0..10_000).collect::<Vec<_>>());
    });
    refused(bomb, "nodes: 200000000 faces in all instances; expected at most 33554432");
}

#[test]
fn wrong_numbers_name_the_accessor_and_the_index() {
    let (json, bin) = square();
    let mut nan = bin.clone();
    nan[28..32].copy_from_slice(&f32::NAN.to_le_bytes());
    refused(parse(&json, &nan), "accessor 0: vertex 2 is (1, NaN, -1); expected finite numbers");
    nan[28..32].copy_from_slice(&f32::NEG_INFINITY.to_le_bytes());
    refused(parse(&json, &nan), "accessor 0: vertex 2 is (1, -inf, -1); expected finite numbers");
    let mut index = bin;
    index[56..58].copy_from_slice(&4_u16.to_le_bytes());
    refused(parse(&json, &index), "accessor 1: index 4 is 4; expected a vertex below 4");
    let far = changed(|json| json["nodes"][0]["scale"] = json!([1_u64 << 44, 1, 1]));
    refused(
        far,
        "node 0 \"ground\": vertex 1 of accessor 0 lands at [17592186044416, 0, 0]; expected a place within 1e12 m",
    );
    let wide = changed(|json| json["nodes"][0]["scale"] = json!([1e8, 1, 1]));
    assert!(wide.unwrap_err().contains("within 1e7 m of the scene origin"));
}

#[test]
fn numbers_are_aligned_in_their_buffer_and_not_in_their_view() {
    // Two bytes before the view, and two in it before the numbers, make four: positions lie at a multiple of their size.
    let (mut json, bin) = square();
    json["buffers"][0]["byteLength"] = json!(bin.len() + 4);
    json["bufferViews"][0]["byteOffset"] = json!(2);
    json["bufferViews"][0]["byteLength"] = json!(50);
    json["bufferViews"][1]["byteOffset"] = json!(52);
    json["accessors"][0]["byteOffset"] = json!(2);
    let shifted = [vec![0; 4], bin].concat();
    assert_eq!(parse(&json, &shifted).unwrap().faces(), [[0, 1, 2], [0, 2, 3]]);
    // A view from byte 2 on, and its numbers from its first byte.
    json["accessors"][0]["byteOffset"] = json!(0);
    let message =
        "accessor 0: numbers of 4 bytes from byte 2 of their buffer, 12 apart; expected multiples of 4";
    refused(parse(&json, &shifted), message);
}
