//! Writes a pack: a scene, its rays, and every answer correctly rounded.
//!
//! ```text
//! DIR/scene.toml, terrain.glb         the resolved scene: exactly the numbers that the answers belong to
//! DIR/rays-camera.npy, rays-beam-N    origin and direction of each ray, for programs that read no scene
//! DIR/camera/, beam-N/                every quantity as f64 arrays
//! DIR/camera.exr, beam-N.exr          every quantity in f32, rounded from the exact numbers and not from the f64
//! DIR/manifest.json                   written last: each file's size, digest, channels and units
//! ```
//!
//! The same scene gives the same bytes on any machine, for any number of threads and any optimisation level.

use std::path::Path;

use raypencil_files::{Attributes, FileError, FolderError, TemporaryFolder, create_folder, put_in_place};
use raypencil_judge::Certified;
use raypencil_referee::{Format, Referee};
use raypencil_scene::{Precision, Progress, Scene, SceneError, SensorId};
use raypencil_scene_io::{Subject, scene_sha256, write_resolved};

use crate::arrays::ArrayWriter;
use crate::bench::{has_bench, with_bench};
use crate::clauses::{MIN_RAYS_PER_CLAUSE, can_count_clauses, clause_rays};
use crate::exr_map::write_exr_map;
use crate::manifest::{
    FileRole, MANIFEST_FORMAT, Manifest, ManifestClause, ManifestFile, ManifestScene, ManifestSensor,
    ManifestSharpness, PackKind,
};
use crate::margins::SensorMargins;
use crate::published::PackLabel;
use crate::rays::write_rays;
use crate::sharpness::{Sharpness, sharpness};

/// Why a pack could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PackError {
    /// A folder, or a file in it; the message names it.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A file; the message names it.
    #[error(transparent)]
    File(#[from] FileError),
    /// A scene with no room for a bench.
    #[error("{name}: no bench can be added ({source}); expected room for its beams, or --no-bench")]
    NoBench {
        /// Name of the scene.
        name: String,
        /// What does not fit.
        source: SceneError,
    },
    /// A blind pack that leaves clauses of the contract untested.
    #[error(
        "{name}: fewer than {MIN_RAYS_PER_CLAUSE} rays decide {}; expected each clause of the contract to decide as many. Choose another seed",
        untested.join(", ")
    )]
    Untested {
        /// Name of the scene.
        name: String,
        /// Keys of the clauses.
        untested: Vec<String>,
    },
    /// A blind pack whose bench lets too large tolerances pass.
    #[error(
        "{name}: these tolerances of a renderer are not noticed at {}; expected a bench that notices smaller ones. Choose another seed",
        blunt.join(", ")
    )]
    Blunt {
        /// Name of the scene.
        name: String,
        /// Key and size of each.
        blunt: Vec<String>,
    },
    /// Values that the referee could not round within its limit of 2048 bits.
    #[error(
        "{name}: {count} values could not be rounded, since 2048 bits do not tell on which side of a midpoint they lie; expected only values that are certain"
    )]
    Undecided {
        /// Name of the scene.
        name: String,
        /// Number of such values.
        count: usize,
    },
}

/// A subject whose scene has a bench, with the digest of that scene.
///
/// # Errors
/// As [`with_bench`](crate::with_bench).
pub fn benched(subject: Subject) -> Result<Subject, PackError> {
    let scene = with_bench(&subject.scene)
        .map_err(|source| PackError::NoBench { name: subject.name.clone(), source })?;
    Ok(Subject { sha256: scene_sha256(&scene), scene, ..subject })
}

/// Writes the pack of a scene into `folder`: with all answers, or without any if `blind_seed` is given. Returns its
/// manifest.
///
/// The `label` is the version and the licence of the pack itself.
///
/// The manifest says how many rays decide each clause of the contract. A blind seed that leaves one untested is refused.
/// For a scene with answers they are counted where that takes less than a minute
/// ([`can_count_clauses`](crate::can_count_clauses)); few clauses decide any ray of a scene without a
/// [bench](crate::with_bench).
///
/// An earlier pack is removed first, beginning with its manifest. So a manifest always marks a complete pack, even if
/// writing was interrupted, and no answer stays beside a scene that it does not belong to.
///
/// ```no_run
/// use raypencil_pack::{FileRole, Manifest, PackKind, PackLabel, blind_subject, write_pack};
/// use raypencil_scene::Silent;
///
/// # let folder = tempfile::tempdir()?;
/// # let folder = folder.path();
/// let subject = blind_subject(7)?;
/// write_pack(&subject, Some(7), &PackLabel::NONE, folder, &Silent)?;
/// let manifest = Manifest::read_verified(folder)?;
/// // Scene, terrain, and the rays of the camera and ten beams: 13 files, none with answers.
/// assert_eq!((manifest.kind, manifest.files.len()), (PackKind::Blind, 13));
/// // Each clause of the contract is tested.
/// assert!(manifest.clauses.iter().all(|clause| clause.rays >= raypencil_pack::MIN_RAYS_PER_CLAUSE));
/// assert!(manifest.files.iter().all(|file| file.role != FileRole::Answers));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A file or folder that could not be written; values that could not be rounded; a blind pack that leaves a clause
/// untested.
pub fn write_pack(
    subject: &Subject,
    blind_seed: Option<u64>,
    label: &PackLabel,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<Manifest, PackError> {
    write_measured(subject, blind_seed, label, folder, (true, progress))
}

/// Writes a pack with answers that shows one ray again. It says nothing of how large a tolerance it notices, which takes seconds to measure.
///
/// # Errors
/// As [`write_pack`].
pub fn write_pack_of_ray(
    subject: &Subject,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<Manifest, PackError> {
    write_measured(subject, None, &PackLabel::NONE, folder, (false, progress))
}

fn write_measured(
    subject: &Subject,
    blind_seed: Option<u64>,
    label: &PackLabel,
    folder: &Path,
    (is_measured, progress): (bool, &dyn Progress),
) -> Result<Manifest, PackError> {
    let scene = &subject.scene;
    // Find the answers first: nothing is written unless all are certain.
    let certified = blind_seed.is_none().then(|| Certified::new(scene, progress));
    if let Some(count) = certified.as_ref().map(Certified::undecided).filter(|count| *count > 0) {
        return Err(PackError::Undecided { name: subject.name.clone(), count });
    }

    let is_blind = blind_seed.is_some();
    let is_counted = is_blind || can_count_clauses(scene);
    let clauses = if is_counted { clause_rays(scene, progress) } else { Vec::new() };
    let untested = clauses.iter().filter(|one| one.rays < MIN_RAYS_PER_CLAUSE);
    let untested: Vec<String> = untested.map(|one| one.clause.key().to_string()).collect();
    if is_blind && !untested.is_empty() {
        return Err(PackError::Untested { name: subject.name.clone(), untested });
    }

    let sharpness = if is_counted && is_measured { measured(scene, progress)? } else { Vec::new() };
    let blunt = blunt(&sharpness);
    if is_blind && !blunt.is_empty() {
        return Err(PackError::Blunt { name: subject.name.clone(), blunt });
    }

    let kind = if is_blind { PackKind::Blind } else { PackKind::Answers };
    let clauses = clauses
        .iter()
        .map(|one| ManifestClause { clause: one.clause.key().into(), rays: one.rays })
        .collect();
    write_files(subject, folder, progress, certified.as_ref(), |manifest| Manifest {
        kind,
        version: label.version.clone(),
        licence: label.licence.clone(),
        blind_seed,
        clauses,
        sharpness: sharpness.iter().map(|(double, single)| ManifestSharpness::new(double, single)).collect(),
        ..manifest
    })
}

/// The tolerances that a bench does not notice soon enough in double precision, each with the size from which on it does.
fn blunt(sharpness: &[(Sharpness, Sharpness)]) -> Vec<String> {
    let blunt = sharpness.iter().filter(|(double, _)| !double.suffices());
    let words = |(double, _): &(Sharpness, Sharpness)| {
        let size = double.noticed.map_or("any size".into(), |size| format!("{size:e}"));
        format!("{} ({size} {})", double.slack.key(), double.slack.unit().words())
    };
    blunt.map(words).collect()
}

/// The sharpness of a scene's bench in both precisions; nothing for a scene without one.
fn measured(scene: &Scene, progress: &dyn Progress) -> Result<Vec<(Sharpness, Sharpness)>, PackError> {
    if !has_bench(scene) {
        return Ok(Vec::new());
    }
    let of = |precision: Precision| {
        sharpness(scene, precision, progress)
            .map_err(|source| PackError::NoBench { name: "the bench".into(), source })
    };
    Ok(of(Precision::F64)?.into_iter().zip(of(Precision::F32)?).collect())
}

/// Writes scene, terrain and rays, and no answers. Unlike a blind pack it may be of any scene, and a check computes the answers
/// from the scene.
///
/// # Errors
/// A file or folder that could not be written.
pub fn write_questions(
    subject: &Subject,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<Manifest, PackError> {
    write_files(subject, folder, progress, None, |manifest| manifest)
}

/// Writes the files of a pack, its manifest last.
fn write_files(
    subject: &Subject,
    folder: &Path,
    progress: &dyn Progress,
    certified: Option<&Certified>,
    completed: impl FnOnce(Manifest) -> Manifest,
) -> Result<Manifest, PackError> {
    let scene = &subject.scene;
    create_folder(folder)?;
    // Written beside: an earlier pack stays whole until this one is.
    let beside = TemporaryFolder::create_in(folder).map_err(|error| FileError::io(folder, "write", error))?;
    let (place, folder) = (folder, beside.path());
    progress.stage("writing the scene");
    write_resolved(folder.join("scene.toml"), scene, "terrain.glb")?;
    let mut files = vec![
        ManifestFile::of(folder, "scene.toml", FileRole::Scene)?,
        ManifestFile::of(folder, "terrain.glb", FileRole::Terrain)?,
    ];
    let referee = Referee::new(scene);
    for sensor in scene.sensors() {
        progress.stage(&format!("{sensor}: rays"));
        files.push(write_rays(&referee, scene, sensor, folder)?);
    }
    if let Some(certified) = certified {
        files.extend(write_answers(certified, &referee, scene, folder, progress)?);
    }

    let sensor = |sensor: SensorId| {
        let (columns, rows) = scene.size(sensor).expect("a sensor of this scene");
        ManifestSensor { name: sensor.to_string(), columns, rows }
    };
    let manifest = completed(Manifest {
        format: MANIFEST_FORMAT,
        kind: PackKind::Questions,
        raypencil_version: env!("CARGO_PKG_VERSION").into(),
        version: None,
        licence: None,
        scene: ManifestScene { name: subject.name.clone(), sha256: scene_sha256(scene) },
        flux_model: scene.flux_model(),
        blind_seed: None,
        sensors: scene.sensors().map(sensor).collect(),
        clauses: Vec::new(),
        sharpness: Vec::new(),
        files,
    });
    progress.stage("putting the pack in its place");
    Manifest::remove_pack(place)?;
    for file in &manifest.files {
        let to = place.join(&file.path);
        if let Some(parent) = to.parent() {
            create_folder(parent)?;
        }
        put_in_place(&folder.join(&file.path), &to)?;
    }
    manifest.write(place)?;
    Ok(manifest)
}

/// Writes every quantity and every margin of every sensor, in f64 and in f32.
fn write_answers(
    certified: &Certified,
    referee: &Referee<'_>,
    scene: &Scene,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<Vec<ManifestFile>, PackError> {
    let model = scene.flux_model();
    let [doubles, singles] =
        [Format::Double, Format::Single].map(|format| certified.in_format(format, model));
    let attributes =
        Attributes { renderer: "referee".into(), scene_sha256: scene_sha256(scene), extra: Vec::new() };
    let margins = |sensor: SensorId| {
        progress.stage(&format!("{sensor}: margins"));
        SensorMargins::find(referee, scene, sensor)
    };
    let write = |sensor: SensorId, margins: &SensorMargins| -> Result<Vec<ManifestFile>, PackError> {
        create_folder(&folder.join(sensor.to_string()))?;
        let (arrays, map) = rayon::join(
            || ArrayWriter::new(folder, sensor).write(&doubles, margins, model),
            || write_exr_map(&singles, margins, model, &attributes, sensor, folder),
        );
        let mut files = arrays?;
        files.push(map?);
        Ok(files)
    };
    // A sensor's files are written while the margins of the next are found.
    let mut files = Vec::new();
    let mut found: Option<(SensorId, SensorMargins)> = None;
    for next in scene.sensors().map(Some).chain([None]) {
        let (of_next, written) = rayon::join(
            || next.map(|sensor| (sensor, margins(sensor))),
            || found.take().map_or(Ok(Vec::new()), |(sensor, margins)| write(sensor, &margins)),
        );
        files.extend(written?);
        found = of_next;
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use raypencil_naive::Slack;

    use super::*;

    #[test]
    fn a_bench_is_blunt_by_what_it_notices_later_than_it_has_to_in_double_precision() {
        let of = |slack: Slack, noticed: Option<f64>| {
            (Sharpness { slack, noticed, excused: false }, Sharpness { slack, noticed: None, excused: false })
        };
        // At the limits themselves a bench is sharp enough.
        let sharp = [
            of(Slack::ShadowStartsAway, Some(1e-9)),
            of(Slack::ShiftRight, Some(1e-7)),
            of(Slack::LandsLeft, Some(1e-7)),
            of(Slack::DepthScaled, Some(1e-6)),
        ];
        assert_eq!(blunt(&sharp), Vec::<String>::new());
        let later = [
            of(Slack::ShadowStopsShort, Some(2e-9)),
            sharp[1],
            of(Slack::ShiftDown, Some(2e-7)),
            of(Slack::LandsRight, Some(2e-7)),
            of(Slack::RangeScaled, None),
        ];
        let words = [
            "shadow-stops-short (2e-9 as a share)",
            "shift-down (2e-7 of a cell)",
            "lands-right (2e-7 of a pixel)",
            "range-scaled (any size as a share)",
        ];
        assert_eq!(blunt(&later), words);
    }
}
