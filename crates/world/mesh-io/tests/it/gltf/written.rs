//! GLB files that are written: valid, the same bytes for the same mesh, and read back to the last bit.

use glam::DVec3;
use serde_json::{Value, json};

use super::*;
use raypencil_mesh_io::gltf::{Vertices, read_mesh};
use raypencil_mesh_io::{DEFAULT_REFLECTIVITY, glb_bytes, load_mesh, write_glb, write_terrain_glb};
use raypencil_scene::{Material, Mesh};

/// Two materials in three runs of faces, an unused vertex and zeros of both signs.
fn mesh(origin: DVec3) -> Mesh {
    let kind = |name: &str, reflectivity| Material { name: name.into(), reflectivity };
    let vertices = vec![
        [-0.0, -0.0, -0.0],
        [1.1, 0.0, -0.0],
        [1.25, 1.5e-40, 0.5],
        [0.0, 3.3, f32::MIN_POSITIVE],
        [9.0, -7.5, 2.0],
    ];
    // Neither reflectivity has a short decimal; one is the double after 0.3.
    let kinds = vec![kind("chalk \"white\"", 0.1 + 0.2), kind("", 1.0 / 3.0), kind("unused", -0.0)];
    let faces = vec![[0, 1, 2], [0, 2, 3], [3, 2, 1], [1, 1, 2]];
    Mesh::new(origin, vertices, faces, vec![1, 1, 0, 1], kinds).unwrap()
}

fn same(a: &Mesh, b: &Mesh) {
    let bits = |mesh: &Mesh| mesh.vertices().as_flattened().iter().map(|c| c.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(a), bits(b));
    assert_eq!((a.faces(), a.face_materials(), a.origin()), (b.faces(), b.face_materials(), b.origin()));
    assert_eq!(a.materials(), b.materials());
    let bits = |mesh: &Mesh| mesh.materials().iter().map(|m| m.reflectivity.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(a), bits(b));
}

/// The JSON and the binary chunk, by the layout of the specification alone.
fn chunks(file: &[u8]) -> (Value, &[u8]) {
    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&file[..4], word(4), word(8)), (&b"glTF"[..], 2, file.len()));
    let json = word(12);
    assert_eq!((json % 4, &file[16..20]), (0, &b"JSON"[..]));
    let bin = 20 + json;
    assert_eq!((word(bin) % 4, &file[bin + 4..bin + 8]), (0, &b"BIN\0"[..]));
    assert_eq!(bin + 8 + word(bin), file.len());
    (serde_json::from_slice(&file[20..bin]).unwrap(), &file[bin + 8..])
}

#[test]
fn a_mesh_comes_back_to_the_last_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("terrain.glb");
    for origin in [DVec3::ZERO, DVec3::new(1e6, -2.5e6, 0.1)] {
        let mesh = mesh(origin);
        write_glb(&path, &mesh).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), glb_bytes(&mesh));
        let (back, _) = read_mesh(&path, DEFAULT_REFLECTIVITY, Vertices::OffsetsFrom(origin)).unwrap();
        same(&back, &mesh);
        // Read as global vertices it is at the origin; a zero of y has lost its sign.
        let global = load_mesh(&path).unwrap();
        assert_eq!((global.origin(), global.vertices()), (DVec3::ZERO, mesh.vertices()));
        assert_eq!(global.vertices()[0][1].to_bits(), 0);
        assert_eq!((global.faces(), global.face_materials()), (mesh.faces(), mesh.face_materials()));
    }
}

#[test]
fn the_file_is_as_the_specification_asks() {
    let file = glb_bytes(&mesh(DVec3::new(1e6, -2.5e6, 0.1)));
    let (json, bin) = chunks(&file);
    assert_eq!(json["asset"]["version"], "2.0");
    assert_eq!(json["asset"]["generator"], concat!("raypencil ", env!("CARGO_PKG_VERSION")));
    assert_eq!(json["asset"]["extras"]["originM"], json!([1e6, -2.5e6, 0.1]));
    // 5 vertices and 4 faces of 12 bytes each.
    assert_eq!(json["buffers"], json!([{"byteLength": 108}]));
    assert_eq!(bin.len(), 108);
    assert_eq!(
        json["bufferViews"][0],
        json!({"buffer": 0, "byteOffset": 0, "byteLength": 60, "target": 34962})
    );
    assert_eq!(
        json["bufferViews"][1],
        json!({"buffer": 0, "byteOffset": 60, "byteLength": 48, "target": 34963})
    );
    // Scene (9, -7.5, 2) is (9, 2, 7.5) in the file.
    let vertex: Vec<f32> =
        bin[48..60].chunks(4).map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap())).collect();
    assert_eq!(vertex, [9.0, 2.0, 7.5]);
    // The bounds that are written are those of the numbers in the file, exactly.
    let bound = |name: &str| -> Vec<f32> {
        json["accessors"][0][name].as_array().unwrap().iter().map(|n| n.as_f64().unwrap() as f32).collect()
    };
    assert_eq!((bound("min"), bound("max")), (vec![0.0, 0.0, -3.3], vec![9.0, 2.0, 7.5]));
    // Runs of 2, 1 and 1 faces.
    let primitives = json["meshes"][0]["primitives"].as_array().unwrap();
    let runs = [(1, 0, 6, 1), (2, 24, 3, 0), (3, 36, 3, 1)];
    assert_eq!(primitives.len(), runs.len());
    for (primitive, (accessor, offset, count, material)) in primitives.iter().zip(runs) {
        assert_eq!(
            primitive,
            &json!({"attributes": {"POSITION": 0}, "indices": accessor, "material": material, "mode": 4})
        );
        let expected = json!({"bufferView": 1, "byteOffset": offset, "componentType": 5125, "type": "SCALAR", "count": count});
        assert_eq!(json["accessors"][accessor], expected);
    }
}

#[test]
fn the_gltf_crate_validates_the_file() {
    // The validation of the `gltf` crate, which our reader does not use.
    let file = gltf::Gltf::from_slice(&glb_bytes(&mesh(DVec3::ZERO))).unwrap();
    let mesh = file.default_scene().unwrap().nodes().next().unwrap().mesh().unwrap();
    let primitives: Vec<_> = mesh.primitives().collect();
    let counts: Vec<_> = primitives.iter().map(|part| part.indices().unwrap().count()).collect();
    assert_eq!((counts, primitives[0].bounding_box().max), (vec![6, 3, 3], [9.0, 2.0, 7.5]));
    assert_eq!(primitives[1].material().name(), Some("chalk \"white\""));
}

#[test]
fn meshes_that_no_file_can_hold_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("none.glb");
    let bare = Mesh::new(DVec3::ZERO, vec![[0.0; 3]], vec![], vec![], vec![]).unwrap();
    let message = write_glb(&path, &bare).unwrap_err().to_string();
    assert!(message.ends_with("none.glb: mesh: no faces; expected at least one: glTF has no empty meshes"));
    assert!(!path.exists());
    let kinds = vec![Material { name: String::new(), reflectivity: 0.5 }; 65_535];
    let many = Mesh::new(DVec3::ZERO, vec![[0.0; 3]], vec![[0; 3]], vec![65_534], kinds).unwrap();
    let message = write_glb(&path, &many).unwrap_err().to_string();
    assert!(message.ends_with("mesh: 65535 materials; expected at most 65534"), "{message}");
    // The bytes alone are an asset without a mesh: valid, and refused when it is read.
    let error = mesh_from_bytes(&glb_bytes(&bare), Path::new("test.glb"), 0.25).map_err(|e| e.to_string());
    refused(error, "scene: no triangles; expected at least one");
}

#[test]
fn the_node_of_a_far_ground_is_at_its_origin() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("far.glb");
    let kinds = || vec![Material { name: "dust".into(), reflectivity: 0.3 }];
    // The middle of x is 1000000.5 up to rounding: the single precision of the offsets may lead to the next
    // whole metre. The file states which.
    for far in [0.0, 1e3, 1e6, -1e6, 8e6] {
        for width in [0.9, 1.3, 1.1] {
            let low = far + 0.5 - width / 2.0;
            let corner = |x: f64, y: f64, z: f64| DVec3::new(low + x, -far + y, z);
            let vertices = [corner(0.0, -0.05, -0.0), corner(width, 0.0, 0.1), corner(0.0, 0.95, 1e-9)];
            let mesh = Mesh::from_global(&vertices, vec![[0, 1, 2]], vec![0], kinds()).unwrap();
            write_terrain_glb(&path, &mesh, &json!({"source": "dem.tif"})).unwrap();
            let back = load_mesh(&path).unwrap();
            let bits =
                |mesh: &Mesh| mesh.vertices().as_flattened().iter().map(|c| c.to_bits()).collect::<Vec<_>>();
            assert_eq!((&back, bits(&back)), (&mesh, bits(&mesh)), "{far} {width}");
            // Programs that ignore the extras find the place of the ground in the node.
            let bytes = std::fs::read(&path).unwrap();
            let glb = gltf::Gltf::from_slice(&bytes).unwrap();
            let node = glb.nodes().next().unwrap();
            let origin = mesh.origin();
            let translation = [origin.x as f32, origin.z as f32, -origin.y as f32];
            assert_eq!(node.transform().decomposed().0, translation);
            assert_eq!(node.extras().as_ref().unwrap().get(), "{\"source\":\"dem.tif\"}");
            assert!(glb.as_json().asset.extras.as_ref().unwrap().get().contains("\"units\":\"metre\""));
        }
    }
    // f32 cannot hold 2^24 + 1.
    let far = DVec3::new(16_777_217.0, 0.0, 0.0);
    let vertices = [far, far + DVec3::X, far + DVec3::Y].map(|v| v - DVec3::new(0.5, 0.5, 0.0));
    let mesh = Mesh::from_global(&vertices, vec![[0, 1, 2]], vec![0], kinds()).unwrap();
    assert_eq!(mesh.origin().x, 16_777_217.0);
    let message = write_terrain_glb(&path, &mesh, &json!({})).unwrap_err().to_string();
    assert!(
        message.contains("a scene origin of [16777217, 0, 0]") && message.contains("below 16777216"),
        "{message}"
    );
}

#[test]
fn a_stated_origin_that_contradicts_the_vertices_is_ignored() {
    // Offsets around 5000 m from the stated origin: the origin that follows from the vertices is used.
    let mut mesh = Mesh::new(
        DVec3::new(2e6, 0.0, 0.0),
        vec![[5000.0, 0.0, 0.0], [5001.0, 0.0, 0.0], [5000.0, 1.0, 0.0]],
        vec![[0, 1, 2]],
        vec![0],
        vec![Material { name: "dust".into(), reflectivity: 0.3 }],
    )
    .unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("far.glb");
    write_terrain_glb(&path, &mesh, &json!({})).unwrap();
    mesh = load_mesh(&path).unwrap();
    // Halves round away from zero: x 2005000.5, y 0.5.
    assert_eq!(mesh.origin(), DVec3::new(2_005_001.0, 1.0, 0.0));
    assert_eq!(mesh.vertices()[0], [-1.0, -1.0, 0.0]);
}
