//! The scene of a pack, from the files that belong to it and from no others.

use serde::Deserialize;
use std::path::Path;

use crate::manifest::{FILE_NAME, Manifest, unfit};
use raypencil_files::Fault;
use raypencil_files::bytes;
use raypencil_scene_io::{LoadedScene, MAX_TOML_BYTES, Overrides, SceneIoError, load};

/// The scene's name in its folder.
const SCENE: &str = "scene.toml";

/// What a scene file says of its ground's file.
#[derive(Deserialize)]
struct SceneKeys {
    terrain: Option<TerrainKeys>,
}

#[derive(Deserialize)]
struct TerrainKeys {
    file: Option<String>,
}

impl Manifest {
    /// Loads the scene of the pack in `folder`, whose files were verified. Both the scene file and its ground must be
    /// listed: what is not was never verified, and may be anywhere.
    ///
    /// # Errors
    /// Names the file, the place in it, what was found and what was expected.
    pub fn load_scene(&self, folder: impl AsRef<Path>) -> Result<LoadedScene, SceneIoError> {
        let folder = folder.as_ref();
        let lists = |path: &str| self.files.iter().any(|file| file.path == path);
        if !lists(SCENE) {
            let fault = Fault::new("files", format!("no {SCENE}"), "the scene's file");
            return Err(unfit(&folder.join(FILE_NAME), fault).into());
        }
        let path = folder.join(SCENE);
        // What is no scene file is said by the loader, with its place.
        let text = bytes::read_file(&path, MAX_TOML_BYTES).ok().and_then(|text| String::from_utf8(text).ok());
        let keys: Option<SceneKeys> = text.and_then(|text| toml::from_str(&text).ok());
        match keys.and_then(|keys| keys.terrain?.file) {
            Some(ground) if !lists(&ground) => {
                let expected = format!("a file that {FILE_NAME} lists");
                Err(unfit(&path, Fault::new("terrain.file", format!("{ground:?}"), expected)).into())
            }
            _ => load(&path.to_string_lossy(), &Overrides::default()),
        }
    }
}
