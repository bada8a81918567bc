//! Tests of the public functions: scenes from files and names, drives, resolved scenes, and files that are wrong.

mod bad_scenes;
mod camera_info;
mod cameras;
mod dem;
mod drives;
mod inputs;
mod meshes;
mod rays;
mod resolved;
mod scenes;
mod settings;
/// The writer of elevation models that the tests of their reader use.
#[allow(dead_code, reason = "these tests need a part of it")]
#[path = "../../../mesh-io/tests/it/dem/write.rs"]
mod tiff;

use std::path::Path;

use raypencil_scene_io::{LoadedScene, Overrides, SceneIoError, load};

fn load_path(path: &Path, overrides: &Overrides) -> Result<LoadedScene, SceneIoError> {
    load(path.to_str().expect("a path in UTF-8"), overrides)
}
