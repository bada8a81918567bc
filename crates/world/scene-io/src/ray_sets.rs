//! Files that have ray sets and nothing else.

use serde::Deserialize;
use std::path::Path;
use toml::Spanned;

use raypencil_files::{combined_sha256_hex, hex_digits, sha256};
use raypencil_scene::{HeadSweep, NamedRaySet};

use crate::digest::NamedDigest;
use crate::load::read_toml;
use crate::parse::key::Key;
use crate::parse::rays::RaysKeys;
use crate::parse::source::Source;
use crate::scene_error::SceneIoError;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileKeys {
    version: Key<i64>,
    rays: Option<Vec<Spanned<RaysKeys>>>,
}

/// Ray sets and the digest of what defines them.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedRaySets {
    /// The sets, in the order of the file: at least one.
    pub sets: Vec<NamedRaySet>,
    /// SHA-256 in hexadecimal: of the TOML file, or, if it names other files, of their digests one after the other, its own
    /// first.
    pub sha256: String,
}

/// Reads a TOML file that has tables `[[rays]]` and nothing else.
///
/// # Errors
/// Names the file, the place in it, the value found and the values expected.
pub fn read_ray_sets(path: &Path) -> Result<LoadedRaySets, SceneIoError> {
    let text = read_toml(path)?;
    ray_sets_from_text(&text, path)
}

/// Reads the text of such a file. `file` is its name in messages; paths in the text are relative to it.
///
/// ```
/// use raypencil_scene_io::ray_sets_from_text;
///
/// let text = "[[rays]]\nname = \"roof\"\nspinning = { preset = \"vlp-16\" }\nposition_m = [0, 0, 1.2]\n";
/// let loaded = ray_sets_from_text(text, "roof.toml".as_ref())?;
/// assert_eq!((loaded.sets[0].name.as_str(), &loaded.sets[0].shape[..]), ("roof", &[1808, 16][..]));
/// # Ok::<(), raypencil_scene_io::SceneIoError>(())
/// ```
///
/// # Errors
/// As [`read_ray_sets`].
pub fn ray_sets_from_text(text: &str, file: &Path) -> Result<LoadedRaySets, SceneIoError> {
    let source = Source::unchanged(file, text);
    let (sets, of_files) = source.ray_sets(&tables(&source)?)?;
    Ok(LoadedRaySets { sets, sha256: digest(text, of_files) })
}

/// The sets of spinning heads, whose rays are made when they are asked for, and the digest of what defines them.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedSweeps {
    /// The sets, in the order of the file: at least one.
    pub sweeps: Vec<HeadSweep>,
    /// As [`LoadedRaySets::sha256`].
    pub sha256: String,
}

/// Reads a file as [`read_ray_sets`] does, and makes no rays.
///
/// # Errors
/// As [`read_ray_sets`], and names a set that is of no spinning head.
pub fn read_sweeps(path: &Path) -> Result<LoadedSweeps, SceneIoError> {
    let text = read_toml(path)?;
    let source = Source::unchanged(path, &text);
    let (sweeps, of_files) = source.sweeps(&tables(&source)?)?;
    Ok(LoadedSweeps { sweeps, sha256: digest(&text, of_files) })
}

/// The tables of a file that has nothing else.
fn tables(source: &Source<'_>) -> Result<Vec<Spanned<RaysKeys>>, SceneIoError> {
    let keys: FileKeys = source.deserialize()?;
    if let Some(version) = keys.version.filter(|version| *version.get_ref() != 1) {
        let message = format!("`version` is {}; expected 1, the only version there is", version.get_ref());
        return Err(source.error(version.span(), message));
    }
    let tables = keys.rays.unwrap_or_default();
    if tables.is_empty() {
        return Err(source.error(0..0, "there is no table `[[rays]]`; expected at least one"));
    }
    Ok(tables)
}

/// SHA-256 in hexadecimal of a file's text and of the files that it names.
fn digest(text: &str, of_files: Vec<NamedDigest>) -> String {
    let own = sha256(text.as_bytes());
    match of_files.len() {
        0 => hex_digits(&own),
        _ => {
            let of_files = of_files.into_iter().map(|(_, digest)| digest);
            combined_sha256_hex(&std::iter::once(own).chain(of_files).collect::<Vec<_>>())
        }
    }
}
