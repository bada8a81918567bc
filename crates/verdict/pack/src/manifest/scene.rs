//! Loads the scene of a pack, from files that the manifest lists and from no others.

use std::path::Path;

use raypencil_files::{Fault, bytes};
use raypencil_scene_io::{LoadedScene, MAX_TOML_BYTES, Overrides, SceneIoError, load};
use serde::Deserialize;

use crate::manifest::document::{MANIFEST_NAME, Manifest, pack_fault};

/// The scene's file name.
const SCENE_NAME: &str = "scene.toml";

/// The keys of a scene file that name the ground's file.
#[derive(Deserialize)]
struct SceneKeys {
    terrain: Option<TerrainKeys>,
}

#[derive(Deserialize)]
struct TerrainKeys {
    file: Option<String>,
}

impl Manifest {
    /// Loads the scene of the pack in `folder`, whose files were verified. The manifest must list both the scene file
    /// and its ground, since other files were not verified and may lie anywhere.
    ///
    /// # Errors
    /// Names the file, the place in it, what was found and what was expected.
    pub fn load_scene(&self, folder: impl AsRef<Path>) -> Result<LoadedScene, SceneIoError> {
        let folder = folder.as_ref();
        let lists = |path: &str| self.files.iter().any(|file| file.path == path);
        if !lists(SCENE_NAME) {
            let fault = Fault::new("files", format!("no {SCENE_NAME}"), "the scene's file");
            return Err(pack_fault(&folder.join(MANIFEST_NAME), fault).into());
        }
        let path = folder.join(SCENE_NAME);
        // A file that cannot be parsed is left to the loader, whose message names the place.
        let text = bytes::read_file(&path, MAX_TOML_BYTES).ok().and_then(|text| String::from_utf8(text).ok());
        let keys: Option<SceneKeys> = text.and_then(|text| toml::from_str(&text).ok());
        match keys.and_then(|keys| keys.terrain?.file) {
            Some(ground) if !lists(&ground) => {
                let expected = format!("a file that {MANIFEST_NAME} lists");
                Err(pack_fault(&path, Fault::new("terrain.file", format!("{ground:?}"), expected)).into())
            }
            _ => load(&path.to_string_lossy(), &Overrides::default()),
        }
    }
}
