//! Packs of scenes that have sets of rays.
//!
//! Each set becomes a pack of rays in `rays/NAME` of the scene's pack, with the terrain in the scene frame. The manifest
//! lists its `raypack.json`, which has the digests of the set's files: a set that is missing or changed is found.

use std::path::{Path, PathBuf};

use raypencil_cast::{
    CandidateConventions, RayPackChecked, RayPackCounts, check_ray_pack, ray_pack_len, write_ray_pack,
};
use raypencil_files::{FileError, RayArray};
use raypencil_pack::{BundleFindings, FileRole, Manifest, ManifestFile, PackError, PackLabel, write_pack};
use raypencil_scene::{NamedRaySet, Precision, Progress, Triangles};
use raypencil_scene_io::Subject;

use crate::candidate::refuse_other_sets;
use crate::ray_sets::source_of;

/// Name of the file of a pack of rays that a manifest lists.
const RAY_PACK: &str = "raypack.json";

/// A set of rays in a pack.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PackedRaySet {
    /// Name of the set.
    pub name: String,
    /// What its rays test.
    pub counts: RayPackCounts,
}

/// A set of rays of a pack, and what a candidate answers to it.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckedRaySet {
    /// Name of the set.
    pub name: String,
    /// Number of its rays.
    pub rays: u64,
    /// The check; `None`: the candidate has no folder `rays/NAME`.
    pub checked: Option<RayPackChecked>,
}

impl CheckedRaySet {
    /// What became of it, as a bundle. What a candidate does not give is no mistake.
    pub fn bundle(&self) -> BundleFindings {
        let name = format!("rays/{}", self.name);
        match &self.checked {
            Some(checked) => checked.bundle(&name),
            None => BundleFindings::not_given(name, self.rays),
        }
    }
}

/// Writes the pack of a scene as [`write_pack`] does, and one of each of its sets of rays.
///
/// # Errors
/// As [`write_pack`].
pub fn write_pack_with_ray_sets(
    subject: &Subject,
    blind_seed: Option<u64>,
    label: &PackLabel,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<(Manifest, Vec<PackedRaySet>), PackError> {
    let mut manifest = write_pack(subject, blind_seed, label, folder, progress)?;
    let sets = subject.scene.ray_sets();
    if sets.is_empty() {
        return Ok((manifest, Vec::new()));
    }
    // Until all sets are there, no manifest calls the pack complete.
    Manifest::withdraw(folder)?;
    let mesh = Triangles::from(subject.scene.mesh().as_ref());
    let write = |set: &NamedRaySet| {
        progress.stage(&format!("rays {}: answering", set.name));
        let rays = RayArray { shape: set.shape.clone(), rays: set.set.rays().to_vec() };
        let source = source_of(subject, set);
        let to = folder.join(path_of(&set.name));
        let counts = write_ray_pack(&to, (&mesh, &rays, set.set.sides()), &source, progress)?;
        let listed = format!("rays/{}/{RAY_PACK}", set.name);
        Ok((
            PackedRaySet { name: set.name.clone(), counts },
            ManifestFile::of(folder, listed, FileRole::RaySet)?,
        ))
    };
    let written: Vec<(PackedRaySet, ManifestFile)> =
        sets.iter().map(write).collect::<Result<_, PackError>>()?;
    let (sets, files): (Vec<_>, Vec<_>) = written.into_iter().unzip();
    manifest.files.extend(files);
    manifest.write(folder)?;
    Ok((manifest, sets))
}

/// Checks what a candidate answers to the sets of rays of a pack; one without a folder `rays` has none.
///
/// # Errors
/// A pack that is not complete; a set whose files are not those that it lists; an array of the candidate that cannot be
/// read.
pub(crate) fn check_packed_ray_sets(
    pack: &Path,
    candidate: &Path,
    precision: Precision,
    conventions: CandidateConventions<'_>,
    progress: &dyn Progress,
) -> Result<Vec<CheckedRaySet>, FileError> {
    // To verify a large pack takes seconds: not for one without sets.
    if !pack.join("rays").is_dir() {
        refuse_other_sets(candidate, std::iter::empty())?;
        return Ok(Vec::new());
    }
    let manifest = Manifest::read_verified(pack)?;
    let names = manifest.files.iter().filter(|file| file.role == FileRole::RaySet).filter_map(|file| {
        file.path.strip_prefix("rays/").and_then(|path| path.strip_suffix(RAY_PACK)?.strip_suffix('/'))
    });
    let names: Vec<&str> = names.collect();
    refuse_other_sets(candidate, names.iter().copied())?;
    let check = |name: &str| {
        let given = candidate.join(path_of(name));
        let checked = given
            .is_dir()
            .then(|| check_ray_pack(&pack.join(path_of(name)), &given, precision, conventions, progress));
        let checked = checked.transpose()?;
        let rays = match &checked {
            Some(checked) => checked.rays.rays.len() as u64,
            None => ray_pack_len(&pack.join(path_of(name)))?,
        };
        Ok(CheckedRaySet { name: name.to_string(), rays, checked })
    };
    names.into_iter().map(check).collect()
}

/// Folder of a set in a pack and in a candidate.
fn path_of(name: &str) -> PathBuf {
    Path::new("rays").join(name)
}
