//! One's own scenes, or terrains under one's own rig, in place of random ones.

use std::path::{Path, PathBuf};

use raypencil_files::{FileError, file_sha256_hex, hex_digits, sha256};
use raypencil_scene_io::{LoadedScene, Overrides, SceneInputs, SceneIoError, Setting, load, quoted};
use serde::{Deserialize, Serialize};

use crate::error::CampaignError;

/// Endings of the files that are scenes.
const ENDINGS: [&str; 8] = ["toml", "glb", "gltf", "stl", "obj", "ply", "tif", "tiff"];

/// Scenes of a folder. Two are equal if their files, and the files that these name, have the same names and contents, wherever
/// they lie.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OwnScenes {
    /// Each file's name with a SHA-256 of it and of all files that decide its scene, in hexadecimal digits, sorted.
    files: Vec<(String, String)>,
    /// SHA-256 of the scene file whose rig stands on each terrain.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    rig_sha256: Option<String>,
    #[serde(skip, default = "somewhere")]
    folder: PathBuf,
    #[serde(skip)]
    rig: Option<PathBuf>,
}

/// Stands for the folder of scenes that come from a record.
fn somewhere() -> PathBuf {
    "SCENES".into()
}

impl PartialEq for OwnScenes {
    fn eq(&self, other: &Self) -> bool {
        self.files == other.files && self.rig_sha256 == other.rig_sha256
    }
}

impl Eq for OwnScenes {}

impl OwnScenes {
    /// The scene files, terrains and elevation models of a folder, by name; with the rig of a scene file, its terrains and
    /// elevation models under that rig.
    ///
    /// # Errors
    /// A folder or file that cannot be read, a folder without scenes.
    pub fn read(folder: &Path, rig: Option<&Path>) -> Result<Self, CampaignError> {
        let io = |path: &Path, source| FileError::Io { path: path.to_path_buf(), action: "read", source };
        for path in std::iter::once(folder).chain(rig) {
            if path.to_str().is_none() {
                return Err(CampaignError::Shards {
                    found: format!("{}: the name is not UTF-8", path.display()),
                    expected: "one that is".into(),
                });
            }
        }
        let endings = if rig.is_some() { &ENDINGS[1..] } else { &ENDINGS[..] };
        let mut names = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(|error| io(folder, error))? {
            let path = entry.map_err(|error| io(folder, error))?.path();
            let is_scene = |end: &&str| path.extension().is_some_and(|given| given.eq_ignore_ascii_case(end));
            if !path.is_file() || !endings.iter().any(is_scene) {
                continue;
            }
            let Some(name) = path.file_name().and_then(|name| name.to_str()) else { continue };
            names.push(name.to_string());
        }
        names.sort();
        if names.is_empty() {
            return Err(CampaignError::Shards {
                found: format!("{}: no scene is there", folder.display()),
                expected: format!("files that end in .{}", endings.join(", .")),
            });
        }
        let rig_sha256 = match rig {
            Some(rig) => Some(file_sha256_hex(rig).map_err(|error| io(rig, error))?.1),
            None => None,
        };
        let files = names.into_iter().map(|name| (name, String::new())).collect();
        let mut scenes = Self { files, rig_sha256, folder: folder.into(), rig: rig.map(PathBuf::from) };
        let inputs = SceneInputs::new();
        let all: Vec<String> = (0..scenes.len() as u64)
            .map(|terrain| scenes.files_sha256(terrain, &inputs))
            .collect::<Result<_, _>>()
            .map_err(|error| CampaignError::Scene(Box::new(error)))?;
        scenes.files.iter_mut().zip(all).for_each(|((_, sha256), found)| *sha256 = found);
        Ok(scenes)
    }

    /// SHA-256 of the digests of all files that decide a scene.
    fn files_sha256(&self, terrain: u64, inputs: &SceneInputs) -> Result<String, SceneIoError> {
        let file = self.folder.join(self.name(terrain));
        let found = match &self.rig {
            Some(rig) => inputs.of(&rig.to_string_lossy(), &[self.ground_setting(&file)?])?,
            None => inputs.of(&file.to_string_lossy(), &[])?,
        };
        // Digests alone: the folder may lie anywhere.
        let digests: Vec<&str> = found.iter().map(|input| input.sha256.as_str()).collect();
        Ok(hex_digits(&sha256(digests.join(" ").as_bytes())))
    }

    /// SHA-256 of all that decides a scene.
    pub(crate) fn sha256(&self, terrain: u64) -> &str {
        usize::try_from(terrain).ok().and_then(|at| self.files.get(at)).map_or("", |(_, sha256)| sha256)
    }

    /// The same names, whatever the files hold.
    pub(crate) fn without_bytes(&self) -> Self {
        let files = self.files.iter().map(|(name, _)| (name.clone(), String::new())).collect();
        Self { files, rig_sha256: self.rig_sha256.as_ref().map(|_| String::new()), ..self.clone() }
    }

    /// Number of scenes.
    pub fn len(&self) -> usize {
        self.files.len()
    }

    /// Whether there is no scene; never so for scenes that were read.
    pub fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// Name of a scene's file.
    pub fn name(&self, terrain: u64) -> &str {
        usize::try_from(terrain).ok().and_then(|at| self.files.get(at)).map_or("", |(name, _)| name)
    }

    pub(crate) fn names(&self) -> String {
        let names: Vec<&str> = self.files.iter().map(|(name, _)| name.as_str()).collect();
        names.join(", ")
    }

    /// Options of the command that give these scenes.
    pub(crate) fn options(&self) -> String {
        let rig = match (&self.rig, &self.rig_sha256) {
            (Some(rig), _) => format!(" --rig {}", quoted(&rig.to_string_lossy())),
            (None, Some(_)) => " --rig RIG.toml".into(),
            (None, None) => String::new(),
        };
        format!("--scenes {}{rig}", quoted(&self.folder.to_string_lossy()))
    }

    /// Loads a scene.
    ///
    /// # Errors
    /// A file that is no scene, or that is not there.
    pub(crate) fn load(&self, terrain: u64) -> Result<LoadedScene, CampaignError> {
        let file = self.folder.join(self.name(terrain));
        let refused = |error| CampaignError::Scene(Box::new(error));
        let Some(rig) = &self.rig else {
            return load(&file.to_string_lossy(), &Overrides::default()).map_err(refused);
        };
        let setting = self.ground_setting(&file).map_err(refused)?;
        load(&rig.to_string_lossy(), &Overrides { settings: vec![setting], ..Overrides::default() })
            .map_err(refused)
    }

    /// Words after `raypencil probe` that give a scene.
    pub(crate) fn arguments(&self, terrain: u64) -> String {
        let file = self.folder.join(self.name(terrain));
        let rig = match (&self.rig, &self.rig_sha256) {
            (Some(rig), _) => quoted(&rig.to_string_lossy()),
            (None, Some(_)) => "RIG.toml".into(),
            (None, None) => return quoted(&file.to_string_lossy()),
        };
        match self.ground_setting(&file) {
            Ok(setting) => format!("{rig} --set {}", quoted(&setting.to_string())),
            Err(_) => rig,
        }
    }

    /// The setting that puts a terrain under the rig.
    fn ground_setting(&self, file: &Path) -> Result<Setting, SceneIoError> {
        let is_dem =
            file.extension().is_some_and(|end| end.to_string_lossy().to_lowercase().starts_with("tif"));
        // A path of a scene file is relative to that file; this one may lie anywhere.
        let whole = std::path::absolute(file).unwrap_or_else(|_| file.to_path_buf());
        Setting::new(if is_dem { "terrain.dem" } else { "terrain.file" }, &whole.to_string_lossy())
    }
}
