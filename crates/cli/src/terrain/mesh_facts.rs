//! What a mesh file says about its unit and its axes, and what holds for them.

use std::path::Path;

use raypencil::io::UpAxis;
use serde_json::{Value, json};

/// The facts for programs. `up` and `scale` are those of the options.
pub(super) fn mesh_facts(file: &Path, up: Option<UpAxis>, scale: Option<f64>) -> Value {
    let is_gltf = file
        .extension()
        .is_some_and(|end| ["glb", "gltf"].iter().any(|known| end.eq_ignore_ascii_case(known)));
    let [unit, axis] = if is_gltf { [Some("metre"), Some("y")] } else { [None; 2] };
    json!({
        "up": up.map(|up| up.word()),
        "scale": scale.unwrap_or(1.0),
        "file_states": { "unit": unit, "up": axis },
        "scale_is_given": scale.is_some(),
    })
}

/// The facts for people, from those for programs.
pub(super) fn mesh_lines(report: &Value) -> Vec<(&'static str, String)> {
    let states = &report["file_states"];
    let up = match (report["up"].as_str(), states["up"].as_str()) {
        (Some(up), None) => format!("{up}, as --up says"),
        (Some(up), Some(stated)) => format!("{up}, as --up says; by glTF it is {stated}"),
        (None, Some(stated)) => format!("{stated}, as glTF says"),
        (None, None) => "z, by default: the file does not say".to_string(),
    };
    let scale = format!("{} m for each unit of the file", report["scale"]);
    let scale = match (report["scale_is_given"] == true, states["unit"].as_str()) {
        (true, None) => format!("{scale}, as --scale says"),
        (true, Some(stated)) => format!("{scale}, as --scale says; by glTF it is the {stated}"),
        (false, Some(stated)) => format!("{scale}: the {stated}, as glTF says"),
        (false, None) => format!("{scale}, by default: the file does not say"),
    };
    vec![("up axis", up), ("scale", scale)]
}
