//! Changes of a well-formed glTF square.

use serde_json::Value;

use crate::glb::{glb, square};
use crate::malformed::case::Case;

/// Name of the GLB file.
pub(super) const FILE: &str = "ground.glb";
/// Command that reads it.
pub(super) const RUN: &str = "validate ground.glb -o out";
/// Name of the text file.
const TEXT: &str = "ground.gltf";
/// Command that reads it.
const RUN_TEXT: &str = "validate ground.gltf -o out";

/// The square with changed JSON.
pub(super) fn changed(name: &str, what: &'static str, place: &str, change: impl FnOnce(&mut Value)) -> Case {
    let (mut json, bin) = square();
    change(&mut json);
    Case::of_file(&format!("gltf-{name}"), what, RUN, FILE, glb(&json, &bin), place)
}

/// The square with one value of its JSON set. The value may be a new key of an object.
pub(super) fn set(name: &str, what: &'static str, pointer: &str, value: Value, place: &str) -> Case {
    changed(name, what, place, |json| {
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        let parent = json.pointer_mut(parent).expect("a place in the square");
        match key.parse::<usize>() {
            Ok(index) => parent[index] = value,
            Err(_) => parent[key] = value,
        }
    })
}

/// The square with a changed buffer.
pub(super) fn numbers(
    name: &str,
    what: &'static str,
    place: &str,
    change: impl FnOnce(&mut Vec<u8>),
) -> Case {
    let (json, mut bin) = square();
    change(&mut bin);
    Case::of_file(&format!("gltf-{name}"), what, RUN, FILE, glb(&json, &bin), place)
}

/// A `.gltf` file of any bytes.
pub(super) fn text(name: &str, what: &'static str, place: &str, bytes: impl Into<Vec<u8>>) -> Case {
    Case::of_file(&format!("gltf-{name}"), what, RUN_TEXT, TEXT, bytes.into(), place)
}
