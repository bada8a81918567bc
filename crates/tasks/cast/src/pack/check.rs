//! A candidate against a pack of rays.

use std::path::Path;

use raypencil_files::{Fault, FileError, RayArray, quoted, ray_rows};
use raypencil_mesh_io::is_cloud_file;
use raypencil_referee::ExactCast;
use raypencil_scene::{Precision, Progress};

use super::candidate::{CandidateConventions, read_candidate};
use super::clouds::{CloudFacts, of_cloud, read_cloud_of};
use super::lengths::lengths;
use super::mistakes::{Trial, explain};
use super::read::RayPack;
use crate::answers::{Answers, Questions, cast_with};
use crate::comparison::{Comparison, Stated, compare_with};

/// A candidate, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct RayPackChecked {
    /// The candidate's name: that of its folder.
    pub name: String,
    /// The folder of the pack, as it was given.
    pub pack: String,
    /// SHA-256 of its `raypack.json`, which has the digest of every other file.
    pub pack_sha256: String,
    /// What became of its rays.
    pub comparison: Comparison,
    /// What explains why it is wrong, as one sentence. It changes no verdict.
    pub why: Option<String>,
    /// The rays of the pack.
    pub rays: RayArray,
    /// The exact answers.
    pub answers: Answers,
    /// What the candidate says.
    pub stated: Stated,
    /// Whether only fronts of faces are asked for.
    pub fronts_only: bool,
    /// What was read of a point cloud; `None`: the candidate is a folder of arrays.
    pub cloud: Option<CloudFacts>,
}

impl RayPackChecked {
    /// Whether no ray is wrong, and some ray meets something, and each point of a cloud belongs to a ray by
    /// all that the cloud says of it.
    pub fn passes(&self) -> bool {
        self.comparison.passes()
            && self.cloud.as_ref().is_none_or(|cloud| cloud.strays.is_empty() && cloud.wrong_keys.is_empty())
    }

    /// The command that shows everything about the ray with this index.
    pub fn ray_command(&self, index: usize) -> String {
        let (_, numbers) = ray_rows(&self.rays.rays[index..=index]);
        let numbers: Vec<String> = numbers.iter().map(f64::to_string).collect();
        let fronts = if self.fronts_only { " --fronts-only" } else { "" };
        format!("raypencil cast {} --ray={}{fronts} --all --margins", quoted(&self.pack), numbers.join(","))
    }
}

/// Checks a candidate against a pack of rays: a folder of arrays, or a point cloud, PCD or PLY. The answers are computed again: only the question is read
/// from the pack.
///
/// ```
/// use raypencil_cast::{
///     CandidateConventions, CastSource, check_ray_pack, rays_from_bytes, write_ray_pack,
/// };
/// use raypencil_scene::{Precision, Sides, Silent, Triangles};
///
/// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let mesh = Triangles::new(corners, vec![[0, 1, 2]])?;
/// let rays = rays_from_bytes(b"0.25,0.25,1,0,0,-1\n2,2,1,0,0,-1", "here".as_ref())?;
/// let source = CastSource { mesh: "mine".into(), rays: "mine".into(), ..CastSource::default() };
/// let folder = tempfile::tempdir()?;
/// let counts = write_ray_pack(folder.path(), (&mesh, &rays, Sides::Both), &source, &Silent)?;
/// assert_eq!((counts.hits, counts.misses, counts.t_min), (1, 1, 0));
/// // A pack is a candidate that is right.
/// let conventions = CandidateConventions::default();
/// let checked = check_ray_pack(folder.path(), folder.path(), Precision::F64, conventions, &Silent)?;
/// assert!(checked.passes());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A pack whose files are not those that it lists, or whose first hits are not the exact ones; an array that cannot be read or has another shape; a candidate that
/// does not say which rays hit; a cloud that cannot be read, or whose points cannot be laid on the rays.
pub fn check_ray_pack(
    pack: &Path,
    candidate: &Path,
    precision: Precision,
    conventions: CandidateConventions,
    progress: &dyn Progress,
) -> Result<RayPackChecked, FileError> {
    progress.stage(&format!("{}: reading", pack.display()));
    let RayPack { mesh, rays, sides, scan, sha256: pack_sha256 } = RayPack::read(pack)?;
    let case = match is_cloud_file(candidate) {
        true => Some(read_cloud_of(candidate, (&rays.shape, &rays.rays), scan.as_ref(), conventions)?),
        false => None,
    };
    let stated = match &case {
        Some(case) => case.stated(),
        None => read_candidate(candidate, &rays.shape, conventions)?,
    };
    let exact = ExactCast::new(&mesh);
    progress.stage(&format!("comparing {} rays", rays.rays.len()));
    let comparison = compare_with(&exact, &mesh, &rays.rays, sides, &stated, precision);
    let wrong: Vec<usize> = comparison.wrong().map(|(index, _)| index).collect();
    let why = (!wrong.is_empty()).then(|| {
        progress.stage("looking for a mistake that explains the wrong rays");
        let of_cloud = case.as_ref().map(|case| of_cloud(case, &exact, sides));
        let stated = (&stated, of_cloud.as_ref());
        let lengths = |trial: &Trial| lengths(trial, &exact, sides);
        explain(&exact, &mesh, (&rays.rays, sides), stated, &lengths, precision, &wrong)
    });
    let answers = cast_with(&exact, &rays.rays, sides, Questions::default(), progress);
    refuse_other_answers(pack, &rays, &Stated::of(&answers))?;
    let name = candidate.file_name().map_or_else(|| ".".into(), |name| name.to_string_lossy().into_owned());
    let cloud = case.map(|case| case.facts);
    let of_keys = cloud.as_ref().and_then(|cloud| cloud.keys_why.clone());
    let why = match why {
        Some(explanation) => explanation.map(|explanation| explanation.sentence()),
        None => of_keys.map(|words| format!("100.0000 % agree if {words}")),
    };
    Ok(RayPackChecked {
        name,
        pack: pack.display().to_string(),
        pack_sha256,
        why,
        fronts_only: sides == raypencil_scene::Sides::Fronts,
        cloud,
        comparison,
        rays,
        answers,
        stated,
    })
}

/// Refuses a pack whose own first hits are not the exact ones: anyone can change an answer and write its digest anew.
fn refuse_other_answers(pack: &Path, rays: &RayArray, exact: &Stated) -> Result<(), FileError> {
    let kept = read_candidate(pack, &rays.shape, CandidateConventions::default())?;
    let bits = |numbers: &Option<Vec<f64>>| -> Option<Vec<u64>> {
        numbers.as_ref().map(|numbers| numbers.iter().map(|number| number.to_bits()).collect())
    };
    let faces = |stated: &Stated| -> Option<Vec<u64>> {
        let number = |face: &Option<raypencil_scene::FaceId>| face.map_or(u64::MAX, |face| u64::from(face.0));
        stated.face.as_ref().map(|faces| faces.iter().map(number).collect())
    };
    let pairs = [
        ("face.npy", faces(&kept), faces(exact)),
        ("t.npy", bits(&kept.t), bits(&exact.t)),
        ("range.npy", bits(&kept.range), bits(&exact.range)),
    ];
    for (name, kept, exact) in pairs {
        let (Some(kept), Some(exact)) = (kept, exact) else { continue };
        if let Some(ray) = kept.iter().zip(&exact).position(|(kept, exact)| kept != exact) {
            let fault = Fault::new(
                format!("ray {ray}"),
                "another answer than the exact one",
                "the answers that `raypencil pack --rays` writes: make the pack again",
            );
            return Err(FileError::Array(fault.in_file(&pack.join(name))));
        }
    }
    Ok(())
}
