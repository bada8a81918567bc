//! glTF and GLB: transforms, storage and hierarchies by derived numbers; each malformed file by its message.

use std::path::Path;

use base64::Engine;
use raypencil_scene::Mesh;
use raypencil_scene_io::{DEFAULT_REFLECTIVITY, load_mesh, mesh_from_bytes};
use serde_json::{Value, json};

/// A GLB from its JSON and binary chunk.
fn glb(json: &Value, bin: &[u8]) -> Vec<u8> {
    let mut json = json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bin = bin.to_vec();
    bin.resize(bin.len().next_multiple_of(4), 0);
    let mut file = b"glTF\x02\0\0\0".to_vec();
    let length = 12 + 8 + json.len() + 8 + bin.len();
    file.extend((length as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &bin)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    file
}

fn reals(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// Four corners of a unit square in the plane y = 0 of the file: in the global frame (0, 0), (1, 0), (1, 1),
/// (0, 1) at z = 0, because y is -z.
const SQUARE: [f32; 12] = [0., 0., 0., 1., 0., 0., 1., 0., -1., 0., 0., -1.];

/// The square with u16 indices as two triangles; tests change the JSON.
fn square() -> (Value, Vec<u8>) {
    let mut bin = reals(&SQUARE);
    bin.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
    let json = json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "ground", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 12},
        ],
        "buffers": [{"byteLength": 60}],
    });
    (json, bin)
}

fn parse(json: &Value, bin: &[u8]) -> Result<Mesh, String> {
    let parsed = mesh_from_bytes(&glb(json, bin), Path::new("test.glb"), DEFAULT_REFLECTIVITY);
    parsed.map_err(|error| error.to_string())
}

/// The square after a change of its JSON.
fn changed(change: impl FnOnce(&mut Value)) -> Result<Mesh, String> {
    let (mut json, bin) = square();
    change(&mut json);
    parse(&json, &bin)
}

/// The vertices of a mesh that has those of the square under some transforms.
fn vertices(mesh: &Mesh) -> Vec<[f32; 3]> {
    mesh.vertices().to_vec()
}

fn refused(result: Result<Mesh, String>, message: &str) {
    let error = result.expect_err(message);
    assert_eq!(error, format!("test.glb: {message}"));
}

#[test]
fn y_up_becomes_z_up_and_identity_changes_no_number() {
    // (x, y, z) -> (x, -z, y), for numbers that no decimal fraction hits.
    let (mut json, _) = square();
    let numbers: Vec<f32> = (0..12).map(|i| f32::from_bits(0x3f12_3457 + 77_777 * i)).collect();
    let mut bin = reals(&numbers);
    bin.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
    let expected: Vec<[f32; 3]> = numbers.chunks(3).map(|v| [v[0], -v[2], v[1]]).collect();
    let bits =
        |vertices: &[[f32; 3]]| vertices.as_flattened().iter().map(|c| c.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(parse(&json, &bin).unwrap().vertices()), bits(&expected));
    // The same through transforms that are written out but do nothing.
    json["nodes"] = json!([
        {"children": [1], "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
        {"children": [2], "translation": [0, 0, 0]},
        {"children": [3], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]},
        {"mesh": 0},
    ]);
    assert_eq!(bits(parse(&json, &bin).unwrap().vertices()), bits(&expected));
}

#[test]
fn faces_keep_their_order_and_look_up() {
    let mesh = changed(|_| {}).unwrap();
    assert_eq!(vertices(&mesh), [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]]);
    assert_eq!(mesh.faces(), [[0, 1, 2], [0, 2, 3]]);
    // No negative zeros.
    assert!(mesh.vertices().as_flattened().iter().all(|c| c.to_bits() != (-0.0_f32).to_bits()));
}

#[test]
fn translation_rotation_and_scale_apply_from_the_right() {
    // T R S: (1, 0, 0) is scaled by 2, turned by 90 degrees about y (x -> -z), moved by (10, 20, 30):
    // (10, 20, 28), which is (10, -28, 20) globally. Halves under the root: the quaternion in f32 is a unit
    // only to 1e-8, which the division by its square repairs.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let mesh = changed(|json| {
        json["nodes"][0] = json!({"mesh": 0, "translation": [10, 20, 30], "rotation": [0, half, 0, half], "scale": [2, 3, 4]});
    });
    let mesh = mesh.unwrap();
    assert_eq!(vertices(&mesh)[0], [10., -30., 20.]);
    assert_eq!(vertices(&mesh)[1], [10., -28., 20.]);
    // (0, 0, -1) -> (0, 0, -4) -> (-4, 0, 0) -> (6, 20, 30).
    assert_eq!(vertices(&mesh)[3], [6., -30., 20.]);
}

#[test]
fn hierarchies_compose_from_the_root() {
    // The parent's matrix (column by column) scales by 2 and moves by (100, 0, 0); the child moves by
    // (0, 5, 0) first: (1, 0, 0) -> (1, 5, 0) -> (102, 10, 0), globally (102, 0, 10).
    let mesh = changed(|json| {
        json["nodes"] = json!([
            {"matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 100, 0, 0, 1], "children": [1]},
            {"mesh": 0, "translation": [0, 5, 0]},
        ]);
    });
    assert_eq!(vertices(&mesh.unwrap())[1], [102., 0., 10.]);
}

#[test]
fn a_hierarchy_is_composed_in_double_precision() {
    // 2^24 + 1 is no f32: the sum of two translations is rounded only after the scene origin is taken off.
    let mesh = changed(|json| {
        json["nodes"] = json!([
            {"translation": [16_777_216, 0, 0], "children": [1]},
            {"mesh": 0, "translation": [0.25, 0, 0]},
        ]);
    });
    let mesh = mesh.unwrap();
    // The box is 2^24 + 0.25 .. + 1.25 in x: the origin is 2^24 + 1 (0.75 rounded) and -0 .. in y 0.5 -> 1.
    assert_eq!(mesh.origin().to_array(), [16_777_217.0, 1.0, 0.0]);
    assert_eq!(vertices(&mesh)[0], [-0.75, -1., 0.]);
    assert_eq!(vertices(&mesh)[1], [0.25, -1., 0.]);
}

#[test]
fn instances_stand_side_by_side_in_document_order() {
    let mesh = changed(|json| {
        json["nodes"] = json!([
            {"children": [3, 1], "mesh": 0},
            {"mesh": 0, "translation": [1, 0, 0]},
            {"mesh": 0, "translation": [9, 0, 0]},
            {"mesh": 0, "translation": [3, 0, 0]},
        ]);
        json["scenes"] = json!([{"nodes": [2, 0]}]);
    });
    let mesh = mesh.unwrap();
    // Node 2 first, then 0, then its children in their order: 3, 1.
    let first_corners: Vec<f32> = mesh.faces().iter().map(|f| mesh.vertices()[f[0] as usize][0]).collect();
    assert_eq!(first_corners, [9., 9., 0., 0., 3., 3., 1., 1.]);
    assert_eq!(mesh.vertices().len(), 16);
}

#[test]
fn mirrors_keep_the_outside_out() {
    for scale in [[-1, 1, 1], [1, 1, -1], [-1, -1, -1], [-1, 1, -1]] {
        let mesh = changed(|json| json["nodes"][0]["scale"] = json!(scale)).unwrap();
        let [a, b, c] = mesh.faces()[0].map(|v| mesh.vertices()[v as usize]);
        // z of (b - a) x (c - a): the square still looks up, unless y was mirrored an odd number of times
        // along with an odd number of the others: an upside-down square looks down.
        let z = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let expected = if scale[1] < 0 { -1.0 } else { 1.0 };
        assert_eq!(z, expected, "{scale:?}");
    }
    // Mirrored twice, by parent and child, it is not mirrored.
    let twice = changed(|json| {
        json["nodes"] = json!([{"scale": [-1, 1, 1], "children": [1]}, {"mesh": 0, "scale": [-1, 1, 1]}]);
    });
    assert_eq!(twice.unwrap().faces()[0], [0, 1, 2]);
}

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
    // Without indices vertices are corners, three by three.
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
fn strips_and_fans_follow_the_specification() {
    // Strip (§3.7.2.1): i, i + (1 + i % 2), i + (2 - i % 2). Fan: i + 1, i + 2, 0.
    let strip = changed(|json| json["meshes"][0]["primitives"][0]["mode"] = json!(5)).unwrap();
    assert_eq!(strip.faces(), [[0, 1, 2], [1, 0, 2], [2, 0, 2], [0, 3, 2]].map(|f: [u32; 3]| f));
    let fan = changed(|json| {
        json["meshes"][0]["primitives"][0] = json!({"attributes": {"POSITION": 0}, "mode": 6});
    });
    assert_eq!(fan.unwrap().faces(), [[1, 2, 0], [2, 3, 0]]);
    // A strip over a square in the usual zigzag looks up throughout.
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
}

#[test]
fn materials_bring_their_reflectivity() {
    let with = |materials: Value, material: Value| {
        changed(|json| {
            json["materials"] = materials;
            json["meshes"][0]["primitives"][0]["material"] = material;
            let bare = json!({"attributes": {"POSITION": 0}, "indices": 1});
            json["meshes"][0]["primitives"].as_array_mut().unwrap().push(bare);
        })
    };
    let kinds =
        json!([{"name": "chalk", "extras": {"reflectivity": 0.75, "more": [1, {}]}}, {}, {"extras": [0.5]}]);
    let mesh = with(kinds.clone(), json!(0)).unwrap();
    let names: Vec<_> = mesh.materials().iter().map(|m| (m.name.as_str(), m.reflectivity)).collect();
    assert_eq!(names, [("chalk", 0.75), ("material 1", 0.25), ("material 2", 0.25), ("no material", 0.25)]);
    assert_eq!(mesh.face_materials(), [0, 0, 3, 3]);
    refused(with(kinds, json!(3)), "material 3: does not exist; expected an index below 3");
    for (value, text) in
        [(json!(1.5), "1.5"), (json!(-0.1), "-0.1"), (json!("0.5"), "\"0.5\""), (json!([1]), "[1]")]
    {
        let kinds = json!([{"name": "snow", "extras": {"reflectivity": value}}]);
        refused(
            with(kinds, json!(0)),
            &format!("material 0 \"snow\": {text}; expected extras.reflectivity from 0 to 1"),
        );
    }
}

#[test]
fn scenes_default_all_or_none() {
    let two = json!([{"mesh": 0}, {"mesh": 0, "translation": [5, 0, 0]}]);
    let faces = |change: &dyn Fn(&mut Value)| {
        let mesh = changed(|json| {
            json["nodes"] = two.clone();
            change(json);
        });
        mesh.map(|mesh| mesh.faces().len())
    };
    let scenes = json!([{"nodes": [0]}, {"nodes": [1, 0]}]);
    assert_eq!(faces(&|json| json["scenes"] = scenes.clone()), Ok(2));
    // No default scene: the roots of all, each once.
    let all = |json: &mut Value| {
        json["scenes"] = scenes.clone();
        json.as_object_mut().unwrap().remove("scene");
    };
    assert_eq!(faces(&all), Ok(4));
    // No scene at all: all nodes without a parent.
    let none = |json: &mut Value| {
        json.as_object_mut().unwrap().remove("scene");
        json.as_object_mut().unwrap().remove("scenes");
    };
    assert_eq!(faces(&none), Ok(4));
    refused(changed(|json| json["scene"] = json!(1)), "scene 1: does not exist; expected an index below 1");
    refused(
        changed(|json| json["scenes"][0]["nodes"] = json!([4])),
        "scene 0: root node 4; expected an index below 1",
    );
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
        (format!("../{name}/secret.bin"), "is absolute, leads out of the folder or names no file"),
        (format!("below/../../{name}/secret.bin"), "is absolute, leads out of the folder or names no file"),
        (format!("%2e%2e/{name}/secret.bin"), "is absolute, leads out of the folder or names no file"),
        (
            outside.path().join("secret.bin").to_str().unwrap().to_string(),
            "is absolute, leads out of the folder or names no file",
        ),
        ("file:///secret.bin".into(), "has a scheme, a drive or a backslash"),
        ("https://example.org/x.bin".into(), "has a scheme, a drive or a backslash"),
        ("C:\\x.bin".into(), "has a scheme, a drive or a backslash"),
        ("..\\x.bin".into(), "has a scheme, a drive or a backslash"),
        ("a%2".into(), "has a broken % escape"),
        ("a%zz".into(), "has a broken % escape"),
        ("a%ff".into(), "has a broken % escape"),
        (String::new(), "is absolute, leads out of the folder or names no file"),
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
    // Beyond what any file may hold, and beyond this buffer.
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
        "accessor 0: POSITION of VEC3 of U16; expected VEC3 of F32",
    );
    refused(
        accessor(0, "componentType", json!(5130)),
        "accessor 0: POSITION of VEC3 of unknown components; expected VEC3 of F32",
    );
    refused(accessor(0, "type", json!("VEC2")), "accessor 0: POSITION of VEC2 of F32; expected VEC3 of F32");
    refused(
        accessor(1, "type", json!("VEC9")),
        "accessor 1: indices of an unknown type of U16; expected SCALAR of U8, U16 or U32",
    );
    refused(
        accessor(1, "componentType", json!(5126)),
        "accessor 1: indices of SCALAR of F32; expected SCALAR of U8, U16 or U32",
    );
    let sparse =
        json!({"count": 1, "indices": {"bufferView": 0, "componentType": 5121}, "values": {"bufferView": 0}});
    refused(
        accessor(0, "sparse", sparse),
        "accessor 0: sparse storage; expected plain storage: sparse is not supported",
    );
    refused(
        accessor(0, "bufferView", Value::Null),
        "accessor 0: no buffer view; expected a buffer view with its data",
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
    refused(parse(&json, &nan), "accessor 0: vertex 2 is (1, NaN, -1); expected three finite numbers");
    nan[28..32].copy_from_slice(&f32::NEG_INFINITY.to_le_bytes());
    refused(parse(&json, &nan), "accessor 0: vertex 2 is (1, -inf, -1); expected three finite numbers");
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
fn hierarchies_that_are_no_trees_are_refused() {
    let nodes = |nodes: Value| changed(move |json| json["nodes"] = nodes);
    refused(
        nodes(json!([{"mesh": 0, "children": [0]}])),
        "node 0: in or below a cycle of nodes; expected a tree",
    );
    refused(
        nodes(json!([{"mesh": 0}, {"children": [2]}, {"name": "b", "children": [1]}])),
        "node 1: in or below a cycle of nodes; expected a tree",
    );
    refused(
        nodes(json!([{"children": [2]}, {"children": [2]}, {"name": "rock", "mesh": 0}])),
        "node 2 \"rock\": a child of node 0 and of node 1; expected at most one parent",
    );
    refused(
        nodes(json!([{"children": [1, 1]}, {"mesh": 0}])),
        "node 1: a child of node 0 and of node 0; expected at most one parent",
    );
    refused(nodes(json!([{"mesh": 0, "children": [5]}])), "node 0: child 5; expected an index below 1");
    refused(nodes(json!([{"mesh": 1}])), "node 0: mesh 1: does not exist; expected an index below 1");
    let child_root = changed(|json| {
        json["nodes"] = json!([{"mesh": 0}, {"children": [0]}]);
    });
    refused(child_root, "scene 0: root node 0, a child of node 1; expected roots without a parent");
    // A chain of 1024 nodes is fine, of 1025 it is not.
    let chain = |length: usize| {
        let node = |index: usize| match index + 1 < length {
            true => json!({"children": [index + 1]}),
            false => json!({"mesh": 0}),
        };
        nodes((0..length).map(node).collect())
    };
    assert_eq!(chain(1024).unwrap().faces().len(), 2);
    refused(chain(1025), "node 1024: 1025 levels deep; expected at most 1024 levels");
}

#[test]
fn transforms_that_are_none_are_refused() {
    let node = |key: &'static str, value: Value| changed(move |json| json["nodes"][0][key] = value);
    let perspective = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.5, 0, 0, 0, 1]);
    refused(
        node("matrix", perspective),
        "node 0 \"ground\": a matrix with the last row [0.0, 0.0, 0.5, 1.0]; expected [0, 0, 0, 1]",
    );
    refused(
        node("translation", json!([1e39, 0, 0])),
        "node 0 \"ground\": translation [inf, 0.0, 0.0]; expected finite numbers",
    );
    refused(
        node("rotation", json!([0, 0, 0, 0])),
        "node 0 \"ground\": rotation [0.0, 0.0, 0.0, 0.0]; expected a unit quaternion",
    );
    refused(
        node("skin", json!(0)),
        "node 0 \"ground\": a skin; expected a rigid mesh: skins are not supported",
    );
    refused(
        node("weights", json!([0, 0.5])),
        "node 0 \"ground\": morph weights; expected a rigid mesh: morph targets are not supported",
    );
    assert!(node("weights", json!([0, 0])).is_ok());
    let both = changed(|json| {
        json["nodes"][0]["matrix"] = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
        json["nodes"][0]["scale"] = json!([1, 1, 1]);
    });
    refused(
        both,
        "node 0 \"ground\": a matrix beside translation, rotation or scale; expected one or the other",
    );
}

#[test]
fn extensions_that_move_vertices_are_refused_by_name() {
    for name in ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_mesh_quantization", "X_new"] {
        let message = format!(
            "extensionsRequired: \"{name}\"; expected plain buffers and nodes; extensions are known only for materials, textures and lights"
        );
        refused(changed(|json| json["extensionsRequired"] = json!(["KHR_materials_unlit", name])), &message);
        // Used but not required: there is plain data as well.
        assert!(changed(|json| json["extensionsUsed"] = json!([name])).is_ok());
    }
    assert!(changed(|json| json["extensionsRequired"] = json!(["KHR_texture_transform"])).is_ok());
    let instancing = changed(|json| json["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]));
    refused(instancing, "extensionsUsed: \"EXT_mesh_gpu_instancing\"; expected a node for each instance");
    let old = changed(|json| json["asset"]["version"] = json!("1.0"));
    refused(old, "asset: version \"1.0\", minVersion None; expected glTF 2.0");
    let newer = changed(|json| json["asset"]["minVersion"] = json!("2.1"));
    refused(newer, "asset: version \"2.0\", minVersion Some(\"2.1\"); expected glTF 2.0");
}

fn bytes_refused(bytes: &[u8], message: &str) {
    let error = mesh_from_bytes(bytes, Path::new("test.glb"), 0.25).unwrap_err().to_string();
    assert_eq!(error, format!("test.glb: {message}"));
}

#[test]
fn containers_that_are_broken_are_refused() {
    let (json, bin) = square();
    let good = glb(&json, &bin);
    let with = |at: usize, word: u32| {
        let mut file = good.clone();
        file[at..at + 4].copy_from_slice(&word.to_le_bytes());
        file
    };
    let length = good.len();
    bytes_refused(b"", "first bytes: []; expected the magic \"glTF\" of a GLB, or a JSON object");
    bytes_refused(
        b"\x89PNG",
        "first bytes: [89, 50, 4e, 47]; expected the magic \"glTF\" of a GLB, or a JSON object",
    );
    bytes_refused(b"glTF\x02", "GLB header: 5 bytes; expected 12 bytes");
    bytes_refused(&with(4, 1), "GLB header: version 1; expected version 2");
    bytes_refused(
        &with(8, 11),
        &format!(
            "GLB header: a length of 11 in a file of {length} bytes; expected the length of the file (is it cut off?)"
        ),
    );
    bytes_refused(
        &good[..length - 4],
        &format!(
            "GLB header: a length of {length} in a file of {} bytes; expected the length of the file (is it cut off?)",
            length - 4
        ),
    );
    bytes_refused(
        &with(12, u32::MAX),
        &format!(
            "GLB chunk 0: a length of 4294967295 with {} bytes left; expected a chunk that ends within the file",
            length - 20
        ),
    );
    bytes_refused(
        &with(16, 0),
        "GLB chunk 0: type \"\\x00\\x00\\x00\\x00\"; expected first JSON, then at most one BIN, then other types",
    );
    bytes_refused(&with(8, 12)[..12], "GLB chunk 0: nothing; expected a JSON chunk");
    bytes_refused(&with(8, 16), "GLB chunk 0: 4 bytes left; expected 8 bytes of a chunk header");
    // What follows the declared length, and chunks of unknown types, are skipped.
    let mut longer = good.clone();
    longer.extend(b"\x04\0\0\0XTRAabcd");
    assert!(mesh_from_bytes(&longer, Path::new("x"), 0.25).is_ok());
    longer[8..12].copy_from_slice(&(length as u32 + 12).to_le_bytes());
    assert!(mesh_from_bytes(&longer, Path::new("x"), 0.25).is_ok());
    longer[length + 4..length + 8].copy_from_slice(b"BIN\0");
    bytes_refused(
        &longer,
        "GLB chunk 2: type \"BIN\\x00\"; expected first JSON, then at most one BIN, then other types",
    );
}

#[test]
fn json_that_is_none_names_line_and_column() {
    bytes_refused(b"{\n \"asset\": }", "JSON: expected value at line 2 column 11; expected a glTF 2.0 asset");
    bytes_refused(b"{}", "JSON: missing field `asset` at line 1 column 2; expected a glTF 2.0 asset");
    let error = changed(|json| json["nodes"][0]["mesh"] = json!("first")).unwrap_err();
    assert!(error.contains("JSON: invalid type: string \"first\", expected index"), "{error}");
}

#[test]
fn deep_json_ends_in_an_error_or_is_skipped() {
    let (json, bin) = square();
    let deep = |key: &str, open: &str, close: &str| {
        let nested = format!("{}{}", open.repeat(300_000), close.repeat(300_000));
        let text = json.to_string().replacen('{', &format!("{{\"{key}\": {nested}, "), 1);
        let digits = base64::engine::general_purpose::STANDARD.encode(&bin);
        let uri = format!("\"uri\": \"data:;base64,{digits}\", \"byteLength\"");
        let text = text.replace("\"buffers\":[{\"byteLength\"", &format!("\"buffers\":[{{{uri}"));
        mesh_from_bytes(text.as_bytes(), Path::new("test.gltf"), 0.25).map_err(|error| error.to_string())
    };
    // Unknown keys and extras are skipped without recursion.
    assert!(deep("unknown", "[", "]").is_ok());
    assert!(deep("extras", "[", "]").is_ok());
    // Lists where a list of objects belongs, and numbers of any shape.
    assert!(deep("nodes", "[", "]").is_err());
    assert!(deep("animations", "[", "]").is_err());
    let error = changed(|json| {
        let mut nested = json!(0.5);
        for _ in 0..200 {
            nested = json!([nested]);
        }
        json["materials"] = json!([{"extras": {"reflectivity": nested}}]);
    });
    assert!(error.unwrap_err().contains("material 0 \"\": recursion limit exceeded"));
    let error = changed(|json| {
        let mut nested = json!(0.5);
        for _ in 0..200 {
            nested = json!([nested]);
        }
        json["accessors"][0]["min"] = nested;
    });
    assert!(error.unwrap_err().contains("JSON: recursion limit exceeded"));
}

mod any_bytes {
    use super::*;
    use proptest::prelude::*;

    /// A file with a hierarchy, two materials, several primitives and both kinds of buffer.
    fn rich() -> Vec<u8> {
        let (mut json, bin) = square();
        let digits = base64::engine::general_purpose::STANDARD.encode(&bin);
        json["buffers"]
            .as_array_mut()
            .unwrap()
            .push(json!({"byteLength": 60, "uri": format!("data:;base64,{digits}")}));
        json["bufferViews"]
            .as_array_mut()
            .unwrap()
            .push(json!({"buffer": 1, "byteLength": 48, "byteStride": 12}));
        let view = json!({"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC3"});
        json["accessors"].as_array_mut().unwrap().push(view);
        json["materials"] = json!([{"name": "a", "extras": {"reflectivity": 0.5}}, {}]);
        json["nodes"] = json!([
            {"children": [1, 2]},
            {"mesh": 0, "rotation": [0, 0.6, 0, 0.8], "translation": [1, 2, 3]},
            {"mesh": 0, "matrix": [0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 5, 6, 7, 1], "children": [3]},
            {"mesh": 0, "scale": [-1, 2, 1]},
        ]);
        json["meshes"][0]["primitives"] = json!([
            {"attributes": {"POSITION": 0}, "indices": 1, "material": 1},
            {"attributes": {"POSITION": 2}, "mode": 5, "material": 0},
            {"attributes": {"POSITION": 2}, "mode": 6},
            {"attributes": {"POSITION": 0}, "mode": 3},
        ]);
        glb(&json, &bin)
    }

    /// Ok or Err; a panic fails the test.
    fn survives(bytes: &[u8]) {
        let _ = mesh_from_bytes(bytes, Path::new("no/such/folder/test.glb"), 0.25);
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn changed_bytes_never_panic(
            changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
            end in prop::option::of(any::<prop::sample::Index>()),
        ) {
            let mut bytes = rich();
            for (at, byte) in changes {
                let at = at.index(bytes.len());
                bytes[at] = byte;
            }
            if let Some(end) = end {
                bytes.truncate(end.index(bytes.len()));
            }
            survives(&bytes);
        }

        // Most changed bytes break the JSON. Changed digits keep it whole and break what it says.
        #[test]
        fn changed_digits_never_panic(
            changes in prop::collection::vec((any::<prop::sample::Index>(), b'0'..=b'9'), 1..6),
        ) {
            let mut bytes = rich();
            let digits: Vec<usize> = (20..bytes.len()).filter(|&at| bytes[at].is_ascii_digit()).collect();
            for (at, digit) in changes {
                bytes[digits[at.index(digits.len())]] = digit;
            }
            survives(&bytes);
        }
    }

    #[test]
    fn the_unchanged_file_is_fine() {
        let mesh = mesh_from_bytes(&rich(), Path::new("test.glb"), 0.25).unwrap();
        // Three instances of 2 + 2 + 2 faces, of 4 + 4 vertices.
        assert_eq!((mesh.faces().len(), mesh.vertices().len()), (18, 24));
    }

    #[test]
    fn cut_anywhere_it_is_refused() {
        let bytes = rich();
        for end in 0..bytes.len() {
            assert!(mesh_from_bytes(&bytes[..end], Path::new("test.glb"), 0.25).is_err(), "{end}");
        }
    }
}

#[test]
fn a_real_yard() {
    let Some(folder) = std::env::var_os("RAYPENCIL_EXTRA_DATA") else {
        eprintln!("skipped: RAYPENCIL_EXTRA_DATA names no folder");
        return;
    };
    let path = Path::new(&folder).join("marsyard2021.glb");
    if !path.exists() {
        eprintln!("skipped: no marsyard2021.glb in RAYPENCIL_EXTRA_DATA");
        return;
    }
    let mesh = load_mesh(&path).unwrap();
    // 498,002 of ground and 6,510 of rocks.
    assert_eq!(mesh.faces().len(), 504_512);
    let [low, high] = mesh.bounds().unwrap();
    assert!((low.z + 0.984).abs() < 5e-4 && (high.z - 5.591).abs() < 5e-4, "{low} {high}");
    let loaded = raypencil_scene_io::load(path.to_str().unwrap(), &Default::default()).unwrap();
    assert_eq!(loaded.name, "marsyard2021");
    eprintln!(
        "{} vertices, {} zero-area faces, {:?}",
        mesh.vertices().len(),
        mesh.zero_area_faces(),
        mesh.materials()
    );
    eprintln!("vehicle at {}", loaded.vehicle.position);
}
