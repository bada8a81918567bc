//! Scenes, hierarchies and materials; and one real terrain.

use serde_json::{Value, json};
use std::path::Path;

use super::*;
use raypencil_mesh_io::load_mesh;

#[test]
fn materials_state_their_reflectivity() {
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
fn colours_give_a_reflectivity_too() {
    let with = |material: Value| {
        let mesh = changed(|json| {
            json["materials"] = json!([material]);
            json["meshes"][0]["primitives"][0]["material"] = json!(0);
        });
        mesh.map(|mesh| mesh.materials()[0].reflectivity)
    };
    let coloured =
        |factor: Value| with(json!({"name": "dust", "pbrMetallicRoughness": {"baseColorFactor": factor}}));
    // 0.2126 R + 0.7152 G + 0.0722 B = 0.12756 + 0.21456 + 0.00722 = 0.34934; alpha does not count.
    let dust = coloured(json!([0.6, 0.3, 0.1, 0.5])).unwrap();
    assert!((dust - 0.34934).abs() < 1e-15, "{dust}");
    // A grey is its own luminance, white is 1, the primaries are their weights.
    for grey in [0.0, 0.1, 0.3, 0.7, 1.0] {
        assert_eq!(coloured(json!([grey, grey, grey, 1])), Ok(grey));
    }
    for (factor, weight) in [([1, 0, 0, 1], 0.2126), ([0, 1, 0, 1], 0.7152), ([0, 0, 1, 1], 0.0722)] {
        assert!((coloured(json!(factor)).unwrap() - weight).abs() < 1e-15);
    }
    // A material without a colour, or with a textured one, is not white.
    assert_eq!(with(json!({"pbrMetallicRoughness": {"metallicFactor": 0}})), Ok(0.25));
    let textured =
        json!({"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1], "baseColorTexture": {"index": 0}}});
    assert_eq!(with(textured), Ok(0.25));
    // A stated reflectivity has precedence.
    let both =
        json!({"extras": {"reflectivity": 0.5}, "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1]}});
    assert_eq!(with(both), Ok(0.5));
    for wrong in [json!([1.5, 0, 0, 1]), json!([-0.1, 0, 0, 1]), json!([0.5, 0.5, 0.5, 7])] {
        let refusal = coloured(wrong).unwrap_err();
        assert!(refusal.contains("material 0 \"dust\": ["), "{refusal}");
        assert!(refusal.contains("expected baseColorFactor of four numbers from 0 to 1"), "{refusal}");
    }
    for wrong in [json!([0.5, 0.5]), json!("red"), json!(["a", 0, 0, 1]), json!([null, 0, 0, 1])] {
        assert!(coloured(wrong).unwrap_err().contains(": JSON: "));
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
    eprintln!(
        "{} vertices, {} zero-area faces, {:?}",
        mesh.vertices().len(),
        mesh.zero_area_faces(),
        mesh.materials()
    );
}
