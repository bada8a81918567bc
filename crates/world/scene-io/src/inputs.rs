//! The files whose bytes decide a scene: by them a result that was kept is known to be still that of the scene.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use raypencil_files::{FileError, Sha256Digest, file_sha256, hex_digits, sha256};
use raypencil_mesh_io::terrain_files;
use serde::{Deserialize, Serialize};

use crate::digest::NamedDigest;
use crate::ground::terrain_file;
use crate::load::text_of;
use crate::parse::kind::Kind;
use crate::parse::scene::parse;
use crate::parse::source::Source;
use crate::plan::{DemPart, MeshPart, Terrain};
use crate::resolved::read::parse_resolved;
use crate::scene_error::SceneIoError;
use crate::scene_source::{MESH_ENDINGS, SceneSource};
use crate::settings::{Setting, changed};

/// A file whose bytes decide a result.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InputFile {
    /// As it is named: in the scene file, in a glTF file or in a command.
    pub name: String,
    /// SHA-256 of its bytes, in hexadecimal digits.
    pub sha256: String,
}

/// Finds the files that decide scenes. No ground is made, and none of its numbers are read.
///
/// A ground's file is taken to stay as it is while this value lives: many scenes on one ground cost one digest of it.
///
/// ```
/// use raypencil_scene_io::{SceneInputs, Setting};
///
/// let folder = tempfile::tempdir()?;
/// let (scene, ground) = (folder.path().join("scene.toml"), folder.path().join("g.obj"));
/// std::fs::write(&scene, "version = 1\n")?;
/// let files = |set: &[Setting]| SceneInputs::new().of(&scene.display().to_string(), set);
/// // A scene on a built-in ground is decided by its own text.
/// assert_eq!(files(&[])?.len(), 1);
/// // A ground that a setting names decides, too, and a change of it is another scene.
/// let set = [Setting::parse("terrain.file=g.obj")?];
/// std::fs::write(&ground, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")?;
/// let before = files(&set)?;
/// assert_eq!(before[1].name, "g.obj");
/// std::fs::write(&ground, "v 0 0 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")?;
/// assert_ne!(files(&set)?, before);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Default)]
pub struct SceneInputs {
    /// Files of the grounds that were looked at, by the path of the first.
    grounds: Mutex<BTreeMap<PathBuf, Vec<NamedDigest>>>,
}

impl SceneInputs {
    /// Nothing was looked at yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// The files that decide a scene with these settings, in the order in which they are named: the scene file, calibrations,
    /// kernels, rays, poses and times, and last those of the ground, with the buffers beside a glTF file. Materials beside an
    /// OBJ file decide nothing.
    ///
    /// # Errors
    /// Those of [`load`](crate::load()), for what the text alone decides; a file that cannot be read.
    pub fn of(&self, source: &str, settings: &[Setting]) -> Result<Vec<InputFile>, SceneIoError> {
        let source = SceneSource::parse(source)?;
        let (path, text) = text_of(&source)?;
        let mut found: Vec<NamedDigest> = Vec::new();
        if let SceneSource::Toml(path) = &source {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            found.push((name, sha256(text.as_bytes())));
        }
        let changed = if settings.is_empty() { None } else { changed(&text, settings)? };
        let file = Source::changed(&path, &text, changed.as_ref());
        match file.kind()? {
            Kind::Rig => {
                let plan = parse(&file)?;
                found.extend(plan.named_files().cloned());
                let ground = match &plan.terrain {
                    Terrain::File(MeshPart { file: ground, .. }) => {
                        Some(terrain_file(&file, "file", &MESH_ENDINGS, ground, &plan.terrain_span)?)
                    }
                    Terrain::Dem(DemPart { file: ground, .. }) => {
                        Some(terrain_file(&file, "dem", &["tif", "tiff"], ground, &plan.terrain_span)?)
                    }
                    Terrain::Mars { coarse: Some((ground, span)), .. } => {
                        Some(terrain_file(&file, "generate.coarse", &["tif", "tiff"], ground, span)?)
                    }
                    Terrain::Builtin(_) | Terrain::Generate { .. } | Terrain::Mars { coarse: None, .. } => {
                        None
                    }
                };
                if let Some(ground) = ground {
                    found.extend(self.of_ground(&file, &ground)?);
                }
            }
            Kind::Resolved => {
                let resolved = parse_resolved(&file)?;
                let (ground, span) = (Path::new(resolved.file.get_ref()), resolved.file.span());
                let ground = terrain_file(&file, "file", &["glb", "gltf"], ground, &span)?;
                found.extend(self.of_ground(&file, &ground)?);
            }
        }
        let input = |(name, digest): NamedDigest| InputFile { name, sha256: hex_digits(&digest) };
        Ok(found.into_iter().map(input).collect())
    }

    /// The files of a ground, named from the folder of the scene file.
    fn of_ground(&self, scene: &Source, ground: &Path) -> Result<Vec<NamedDigest>, SceneIoError> {
        let mut grounds = self.grounds.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = grounds.get(ground) {
            return Ok(known.clone());
        }
        let is_dem = ground
            .extension()
            .is_some_and(|end| ["tif", "tiff"].iter().any(|dem| end.eq_ignore_ascii_case(dem)));
        let read: Vec<(PathBuf, Sha256Digest)> = match is_dem {
            true => {
                let (_, digest) =
                    file_sha256(ground).map_err(|error| FileError::io(ground, "read", error))?;
                vec![(ground.to_path_buf(), digest)]
            }
            false => terrain_files(ground)?,
        };
        let folder = scene.file.parent().unwrap_or(Path::new(""));
        let name = |path: &Path| path.strip_prefix(folder).unwrap_or(path).to_string_lossy().into_owned();
        let named: Vec<NamedDigest> = read.iter().map(|(path, digest)| (name(path), *digest)).collect();
        grounds.insert(ground.to_path_buf(), named.clone());
        Ok(named)
    }
}
