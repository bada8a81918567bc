//! Nodes that do not form a tree, and invalid transforms.

use serde_json::{Value, json};

use super::changes::{FILE, changed, numbers, set};
use crate::glb::square;
use crate::malformed::case::Case;

pub(super) fn cases() -> Vec<Case> {
    let nodes = |name: &str, what, nodes: Value, place: &str| set(name, what, "/nodes", nodes, place);
    let tower: Vec<Value> =
        (0..5000).map(|level| json!({"children": [level + 1]})).chain([json!({"mesh": 0})]).collect();
    let matrix = |last: f64| json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, last]);
    vec![
        nodes("own-child", "a node that is its own child", json!([{"children": [0]}]), "node 0"),
        nodes(
            "cycle",
            "two nodes that are children of each other",
            json!([{"children": [1]}, {"children": [0]}]),
            "node",
        ),
        nodes(
            "cycle-aside",
            "a cycle outside every scene",
            json!([{"mesh": 0}, {"children": [2]}, {"children": [1]}]),
            "node 1",
        ),
        nodes(
            "two-parents",
            "a node with two parents",
            json!([{"children": [1, 2]}, {"children": [2]}, {"mesh": 0}]),
            "node 2",
        ),
        nodes("child-twice", "a duplicate child", json!([{"children": [1, 1]}, {"mesh": 0}]), "node 1"),
        nodes("child-missing", "a missing child", json!([{"children": [9]}]), "node 0"),
        nodes("tower", "five thousand levels of nodes", Value::Array(tower), "levels"),
        nodes(
            "overflow",
            "scales whose product overflows",
            json!([{"children": [1], "scale": [1e38, 1e38, 1e38]}, {"mesh": 0, "scale": [1e38, 1e38, 1e38]}]),
            "node 1",
        ),
        set("root-missing", "a missing root", "/scenes/0/nodes", json!([5]), "scene 0"),
        set("root-negative", "a root of index -1", "/scenes/0/nodes", json!([-1]), "JSON"),
        set("matrix-short", "a matrix of 15 numbers", "/nodes/0/matrix", json!(vec![1.0; 15]), "JSON"),
        set(
            "matrix-infinite",
            "a matrix of 1e39, too large for single precision",
            "/nodes/0/matrix",
            json!(vec![1e39; 16]),
            "JSON",
        ),
        set(
            "matrix-beyond",
            "a translation of 1e400, too large for a double",
            "/nodes/0/translation",
            Value::Null,
            "JSON",
        )
        .file(FILE, {
            square().0.to_string().replace(r#""mesh":0"#, r#""mesh":0,"translation":[1e400,0,0]"#)
        }),
        set("projective", "a matrix that is not affine", "/nodes/0/matrix", matrix(2.0), "node 0"),
        set("rotation", "a rotation of length 2", "/nodes/0/rotation", json!([0, 0, 0, 2]), "node 0"),
        set("rotation-zero", "a rotation of length 0", "/nodes/0/rotation", json!([0, 0, 0, 0]), "node 0"),
        changed("matrix-and-scale", "a matrix beside a scale", "node 0", |json| {
            json["nodes"][0]["matrix"] = matrix(1.0);
            json["nodes"][0]["scale"] = json!([1, 1, 1]);
        }),
        numbers("vertex-nan", "a vertex that is not a number", "accessor 0", |bin| {
            bin[4..8].copy_from_slice(&f32::NAN.to_le_bytes())
        }),
        numbers("vertex-infinite", "a vertex at infinity", "accessor 0", |bin| {
            bin[0..4].copy_from_slice(&f32::NEG_INFINITY.to_le_bytes());
        }),
        numbers("vertex-far", "a vertex at 3e38 m", "node 0", |bin| {
            bin[0..4].copy_from_slice(&f32::MAX.to_le_bytes())
        }),
        numbers("index-beyond", "an index beyond the vertices", "accessor 1", |bin| {
            bin[58..60].copy_from_slice(&[4, 0])
        }),
        numbers(
            "index-restart",
            "an index of 65535, the restart value of other formats",
            "accessor 1",
            |bin| bin[58..60].fill(255),
        ),
    ]
}
