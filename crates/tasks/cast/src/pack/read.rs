//! Reads a pack of rays.

use std::collections::BTreeMap;
use std::path::{Component, Path};

use raypencil_files::{Fault, FileError, RayArray, bytes, file_sha256_hex, hex_digits, read_rays, sha256};
use raypencil_mesh_io::load_triangles;
use raypencil_scene::pattern::{EchoLight, Returns};
use raypencil_scene::{Sides, Triangles};
use serde::Deserialize;

use super::scan::Scan;
use super::{PACK_FORMAT, PACK_NAME};
use crate::returns::keep_of_json;

/// The question of a pack. Its answers are computed again when a candidate is checked.
pub(super) struct RayPack {
    pub(super) mesh: Triangles,
    pub(super) rays: RayArray,
    pub(super) sides: Sides,
    /// What is known of a sensor's scan; `None`: the rays are of no set.
    pub(super) scan: Option<Scan>,
    /// How many rays test what, by its own word; empty if it does not say.
    pub(super) counts: BTreeMap<String, u64>,
    /// SHA-256 of `raypack.json`.
    pub(super) sha256: String,
}

/// What is read of `raypack.json`.
#[derive(Deserialize)]
struct Document {
    format: u64,
    kind: String,
    sides: String,
    #[serde(default)]
    counts: BTreeMap<String, u64>,
    scan: Option<ScanDocument>,
    files: Vec<PackFile>,
}

#[derive(Deserialize)]
struct ScanDocument {
    mounting: String,
    returns: Option<ReturnsDocument>,
    light: Option<LightDocument>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct ReturnsDocument {
    keep: serde_json::Value,
    separation_m: f64,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct LightDocument {
    reflectivity: f64,
    extinction_per_m: f64,
}

#[derive(Deserialize)]
struct PackFile {
    path: String,
    sha256: String,
}

/// Whether a folder is a pack of rays.
pub fn is_ray_pack(folder: &Path) -> bool {
    folder.join(PACK_NAME).is_file()
}

/// Number of rays of a pack.
///
/// # Errors
/// As `check_ray_pack`.
pub fn ray_pack_len(folder: &Path) -> Result<u64, FileError> {
    Ok(RayPack::read(folder)?.rays.rays.len() as u64)
}

fn fault(path: &Path, place: &str, found: impl Into<String>, expected: impl Into<String>) -> FileError {
    FileError::Array(Fault::new(place, found, expected).in_file(path))
}

impl RayPack {
    /// Reads a pack whose files are those that it lists.
    pub(super) fn read(folder: &Path) -> Result<Self, FileError> {
        let path = folder.join(PACK_NAME);
        let text = bytes::read_file(&path, 1 << 20).map_err(|error| FileError::io(&path, "read", error))?;
        let sha256 = hex_digits(&sha256(&text));
        let document: Document = serde_json::from_slice(&text).map_err(|error| {
            fault(&path, "document", error.to_string(), "what `raypencil pack --rays` writes")
        })?;
        if document.format != PACK_FORMAT {
            return Err(fault(&path, "format", document.format.to_string(), PACK_FORMAT.to_string()));
        }
        if document.kind != "rays" {
            return Err(fault(&path, "kind", document.kind, "rays"));
        }
        let sides = match document.sides.as_str() {
            "both" => Sides::Both,
            "fronts" => Sides::Fronts,
            other => return Err(fault(&path, "sides", other, "both or fronts")),
        };
        let listed = |name: &str| document.files.iter().any(|file| file.path == name);
        let mut questions = vec!["vertices.npy", "faces.npy", "rays.npy"];
        if document.scan.is_some() {
            questions.push("pose.npy");
            questions.extend(["time.npy", "elevation.npy"].into_iter().filter(|name| listed(name)));
        }
        let returns = document.scan.as_ref().and_then(|scan| scan.returns.as_ref());
        let light = document.scan.as_ref().and_then(|scan| scan.light.as_ref());
        let echo = light.map_or_else(EchoLight::default, |light| EchoLight {
            reflectivity: light.reflectivity,
            extinction_per_m: light.extinction_per_m,
        });
        let wanted = returns.map(|ReturnsDocument { keep, separation_m }| {
            let keep = keep_of_json(keep).ok_or_else(|| {
                fault(
                    &path,
                    "scan.returns.keep",
                    keep.to_string(),
                    "\"first\", \"strongest\", \"last\", or 1 to 16",
                )
            })?;
            Ok::<_, FileError>((Returns { keep, separation_m: *separation_m }, echo))
        });
        let wanted = wanted.transpose()?;
        if wanted.is_some() {
            questions.extend(["weight.npy", "return.number.npy", "return.ray.npy"]);
        }
        for question in questions {
            if !listed(question) {
                return Err(fault(&path, "files", format!("no {question}"), "its path and SHA-256"));
            }
        }
        // The answers too: who takes them for the truth relies on it.
        for (k, PackFile { path: name, sha256 }) in document.files.iter().enumerate() {
            if document.files[..k].iter().any(|other| other.path == *name) {
                return Err(fault(&path, "files", format!("{name} twice"), "each file once"));
            }
            let is_inside = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
            if !is_inside {
                return Err(fault(&path, "files", name.as_str(), "paths below the pack's folder"));
            }
            let file = folder.join(name);
            let (_, found) = file_sha256_hex(&file).map_err(|error| FileError::io(&file, "read", error))?;
            if found != *sha256 {
                return Err(fault(&file, "SHA-256", found, format!("{sha256}, as {PACK_NAME} says")));
            }
        }
        let rays = read_rays(&folder.join("rays.npy"))?;
        let scan = document
            .scan
            .as_ref()
            .map(|scan| Scan::read(folder, &rays.shape, (&scan.mounting, wanted), listed));
        let counts = document.counts;
        Ok(Self { mesh: load_triangles(folder)?, rays, sides, scan: scan.transpose()?, counts, sha256 })
    }
}
