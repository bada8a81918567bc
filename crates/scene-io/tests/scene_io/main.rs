//! Tests of the public functions: scenes from files and names, drives, resolved scenes, and files that are wrong.

mod bad_scenes;
mod drives;
mod resolved;
mod scenes;

use std::path::Path;

use raypencil_scene_io::{LoadedScene, Overrides, SceneIoError, load};

fn load_path(path: &Path, overrides: &Overrides) -> Result<LoadedScene, SceneIoError> {
    load(path.to_str().expect("a path in UTF-8"), overrides)
}
