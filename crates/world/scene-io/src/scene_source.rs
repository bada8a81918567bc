//! Sources of scenes: built-in names and files.

use std::path::PathBuf;

use raypencil_terrain::BUILTIN_NAMES;

use crate::scene_error::SceneIoError;

/// Endings of the files that hold a mesh.
pub const MESH_ENDINGS: [&str; 5] = ["glb", "gltf", "stl", "obj", "ply"];

/// Maximum length of a scene's name.
const MAX_NAME_CHARS: usize = 64;

/// Source of a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SceneSource {
    /// A built-in ground under the default rig.
    Builtin(String),
    /// A scene file.
    Toml(PathBuf),
    /// A terrain under the default rig: glTF, STL, OBJ or PLY.
    Mesh(PathBuf),
    /// An elevation model under the default rig.
    Dem(PathBuf),
}

impl SceneSource {
    /// Tells a built-in name, a `.toml`, a mesh (`.glb`, `.gltf`, `.stl`, `.obj`, `.ply`) and a `.tif` or `.tiff` apart. A
    /// built-in name wins over a file.
    ///
    /// # Errors
    /// Lists the built-in names and the extensions if it is none of them, or if there is no such file.
    pub fn parse(source: &str) -> Result<Self, SceneIoError> {
        if BUILTIN_NAMES.contains(&source) {
            return Ok(Self::Builtin(source.to_string()));
        }
        let refuse = |problem: &str| SceneIoError::Source {
            given: source.to_string(),
            problem: problem.to_string(),
            expected: format!(
                "a built-in name ({}) or a file that ends in .toml, .{}, .tif or .tiff",
                BUILTIN_NAMES.join(", "),
                MESH_ENDINGS.join(", .")
            ),
        };
        let path = PathBuf::from(source);
        if path.is_dir() {
            return Err(refuse("is a folder"));
        }
        let known = |end: &str| path.extension().is_some_and(|given| given.eq_ignore_ascii_case(end));
        let exists = path.exists();
        let kind: Option<fn(PathBuf) -> Self> = if known("toml") {
            Some(Self::Toml)
        } else if MESH_ENDINGS.iter().any(|end| known(end)) {
            Some(Self::Mesh)
        } else if known("tif") || known("tiff") {
            Some(Self::Dem)
        } else {
            None
        };
        match kind {
            Some(kind) if exists => Ok(kind(path)),
            Some(_) => Err(refuse("does not exist")),
            None if exists => Err(refuse("is a file of an unknown kind")),
            None => Err(refuse("is neither a built-in name nor a file")),
        }
    }

    /// The source in messages: its name or its path.
    pub(crate) fn origin(&self) -> String {
        match self {
            Self::Builtin(name) => name.clone(),
            Self::Toml(path) | Self::Mesh(path) | Self::Dem(path) => path.display().to_string(),
        }
    }

    /// The source's name as the name of a folder. Characters other than letters, digits, `.`, `-` and `_` become `-`;
    /// leading dots are left out.
    pub(crate) fn folder_name(&self) -> String {
        let stem = match self {
            Self::Builtin(name) => name.clone(),
            Self::Toml(path) | Self::Mesh(path) | Self::Dem(path) => {
                path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
            }
        };
        let plain = |c: char| if c.is_ascii_alphanumeric() || "._-".contains(c) { c } else { '-' };
        let name: String = stem.trim_start_matches('.').chars().map(plain).take(MAX_NAME_CHARS).collect();
        if name.is_empty() { "scene".to_string() } else { name }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_fit_for_folders() {
        let name = |path: &str| SceneSource::Toml(path.into()).folder_name();
        assert_eq!(name("a/b/My Scene (2).v1.toml"), "My-Scene--2-.v1");
        assert_eq!(name("..toml"), "scene");
        assert_eq!(name(&format!("{}.toml", "x".repeat(100))).len(), 64);
    }
}
