//! Checks a candidate, another program's recording, against the answers of a pack.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use raypencil_diagnosis::{Diagnosis, diagnose};
use raypencil_files::{
    FileError, Limits, Storage, file_sha256_hex, has_maps, has_ray_sets, read_listed_channels,
};
use raypencil_judge::{
    Answers, Check, Class, DifferingRay, GroundTruth, Item, JudgeShare, Quantity, Recorded, RecordingError,
    SensorResult, UncertifiedAnswer, check,
};
use raypencil_referee::Referee;
use raypencil_scene::{Place, Precision, Progress, Scene, SensorId};
use raypencil_scene_io::{LoadedScene, SceneIoError, Subject, probe_command, quoted, scene_sha256};

use crate::bench::Edition;
use crate::blind::blind_scene_of;
use crate::check_report::BundleFindings;
use crate::claims::{Found, check_facts, check_numbers};
use crate::declarations::Declarations;
use crate::labels::check_labels;
use crate::manifest::{
    FileRole, FileType, MANIFEST_NAME, Manifest, ManifestFile, ManifestSharpness, PackKind, pack_fault,
};
use crate::provenance::{ProvenanceError, note};
use crate::published::{PackIdentity, PublishedPack};
use crate::rays::{rays_name, rays_sha256};
use crate::verification::{DRAWN, Verification, drawn_places, seed_anew};

/// Why a candidate could not be checked against a pack.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckError {
    /// A file of the pack; the message names it.
    #[error(transparent)]
    Pack(#[from] FileError),
    /// The scene of the pack; the message names the file.
    #[error(transparent)]
    Scene(#[from] SceneIoError),
    /// A file of the candidate; the message names it, the channel and the cell.
    #[error(transparent)]
    Candidate(#[from] RecordingError),
    /// The note of the candidate.
    #[error(transparent)]
    Note(#[from] ProvenanceError),
    /// The answers of the pack, or its scene.
    #[error("{}: {found}; expected {expected}", pack.display())]
    Answers {
        /// Folder of the pack.
        pack: PathBuf,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
}

impl CheckError {
    /// What to declare so that the candidate is understood, if that may help.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Candidate(error) => error.help(),
            _ => None,
        }
    }
}

/// A candidate and its check against a pack.
#[derive(Debug)]
pub struct Checked {
    /// The pack's scene, with the arguments that select it on the command line.
    pub subject: Subject,
    /// The candidate.
    pub recorded: Recorded,
    /// Classes and errors of the candidate's rays.
    pub check: Check,
    /// The mistakes that explain why rays of the candidate are wrong, sensor by sensor. They change no verdict.
    pub diagnosis: Option<Diagnosis>,
    /// The exact answers of the pack.
    pub exact: Answers,
    /// Whether the pack is blind: its answers were computed from its seed.
    pub is_blind: bool,
    /// Whether the answers were read from the pack.
    pub has_answers: bool,
    /// Which pack it is.
    pub pack: PackIdentity,
    /// What of the pack was found to be what the scene gives.
    pub verified: Verified,
    /// What was declared about the candidate, by its note, too.
    pub declared: Declarations,
    /// How large a tolerance of each clause the pack notices, by its manifest.
    pub sharpness: Vec<ManifestSharpness>,
    /// The sets of rays of the pack, which are checked apart; empty if it has none, or if nobody asked. One without items is not
    /// given.
    pub ray_sets: Vec<BundleFindings>,
}

/// What of a pack was verified. Anyone can change an answer and write the digests anew; the scene alone decides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Verified {
    /// Number of rays whose answers are the referee's, bit for bit.
    pub answers: u64,
    /// Number of rays.
    pub of: u64,
    /// Number of arrays of rays that are those of the scene, bit for bit.
    pub rays: u64,
    /// Seed by which answers, counts or sizes were drawn, if any were.
    pub seed: Option<u64>,
    /// Numbers of rays that decide a clause, and that are those of the scene.
    pub clauses: Found,
    /// Sizes of tolerances that are the smallest which the bench notices.
    pub sizes: Found,
}

impl Checked {
    /// The diagnosis as one sentence, if there is one.
    pub fn why(&self) -> Option<String> {
        self.diagnosis.as_ref().map(Diagnosis::sentence)
    }

    /// The `raypencil probe` command that shows everything about a ray.
    pub fn repro(&self, place: Place) -> String {
        probe_command(&self.subject, place)
    }
}

/// Checks a candidate against a pack.
///
/// `precision` is that of the candidate's arithmetic. `None`: `candidate.json` states it; without that file it is f64.
///
/// ```
/// use std::path::Path;
///
/// use raypencil_judge::Class;
/// use raypencil_pack::check_pack;
/// use raypencil_scene::Silent;
///
/// // A pack is a perfect candidate: each ray has exactly the value of the answer.
/// let pack = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/packs/pyramids");
/// let checked = check_pack(&pack, &pack, None, &Silent)?;
/// assert!(checked.passes());
/// assert_eq!(checked.check.of(Class::Agree), checked.check.compared());
/// # Ok::<(), raypencil_pack::CheckError>(())
/// ```
///
/// # Errors
/// A pack that is not complete and unchanged; a candidate that breaks the conventions of `docs/formats/files.md`, or
/// whose `candidate.json` names another scene.
pub fn check_pack(
    pack: &Path,
    candidate: &Path,
    precision: Option<Precision>,
    progress: &dyn Progress,
) -> Result<Checked, CheckError> {
    let declarations = Declarations { precision, ..Declarations::default() };
    check_pack_by(pack, candidate, &declarations, Verification::Drawn { seed: None }, progress)
}

/// The same for a candidate about which more is declared: conventions that differ from those of `docs/formats/files.md`, and
/// which of its channels is which map. Its `candidate.json` may declare the same. `share` is that of the pack's answers which
/// are compared with the referee's: each answer by which the candidate is wrong always is, and the rays are always compared
/// with those of the scene. A published pack is known by its digest: of it a small sample is compared, unless all are asked for.
///
/// ```
/// use std::path::Path;
///
/// use raypencil_files::write_npy;
/// use raypencil_pack::{Declarations, Verification, check_pack_by};
/// use raypencil_scene::{Image, Silent};
///
/// // Ranges of -1 everywhere. As a declared "no hit" they are read, and wrong where something is hit.
/// let pack = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/packs/pyramids");
/// let folder = tempfile::tempdir()?;
/// std::fs::create_dir(folder.path().join("camera"))?;
/// write_npy(folder.path().join("camera/mine.npy"), &[&Image::filled(96, 72, -1.0)])?;
/// let declared = Declarations {
///     miss: Some(-1.0),
///     channels: vec!["range.T=mine".parse()?],
///     ..Declarations::default()
/// };
/// let share = Verification::Drawn { seed: None };
/// let checked = check_pack_by(&pack, folder.path(), &declared, share, &Silent)?;
/// assert!(!checked.passes());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`check_pack`]; something declared that is not so; answers that are not the referee's.
pub fn check_pack_by(
    pack: &Path,
    candidate: &Path,
    declarations: &Declarations,
    share: Verification,
    progress: &dyn Progress,
) -> Result<Checked, CheckError> {
    progress.stage("reading the pack");
    let manifest = Manifest::read_verified(pack)?;
    let manifest_file = pack.join(MANIFEST_NAME);
    let (_, manifest_sha256) =
        file_sha256_hex(&manifest_file).map_err(|error| FileError::io(&manifest_file, "read", error))?;
    let identity = PackIdentity::new(manifest_sha256, &manifest.scene.name, manifest.label());
    let scene_file = pack.join("scene.toml");
    let LoadedScene { scene, .. } = manifest.load_scene(pack)?;
    let sha256 = scene_sha256(&scene);
    let answers = |found: String, expected: &str| CheckError::Answers {
        pack: pack.to_path_buf(),
        found,
        expected: expected.into(),
    };
    if sha256 != manifest.scene.sha256 {
        let found = format!("scene.toml and terrain.glb have the digest {sha256}");
        return Err(answers(found, &format!("the manifest's {}", manifest.scene.sha256)));
    }
    let is_known = identity.is_published();
    if let Some(published) =
        identity.of_that_name.filter(|one| identity.label.version.as_deref() == Some(one.version))
        && !is_known
    {
        let PublishedPack { name, version, sha256 } = published;
        return Err(answers(
            format!(
                "its {MANIFEST_NAME} says that it is {name} {version}, and has the digest {}",
                identity.sha256
            ),
            &format!("{sha256}, as it is published, or another version"),
        ));
    }
    let refused = |fault| CheckError::from(pack_fault(&manifest_file, fault));
    check_facts(&manifest, &scene).map_err(refused)?;
    if !is_known {
        check_labels(&manifest).map_err(refused)?;
    }
    // The candidate before the answers, so that its faults are reported soon.
    progress.stage("reading the candidate");
    let declared = declarations.clone().with_note(note(candidate, &scene)?.as_ref());
    let has_sets = manifest.files.iter().any(|file| file.role == FileRole::RaySet);
    let recorded = if has_sets && has_ray_sets(candidate)? && !has_maps(candidate)? {
        // It answers nothing but sets of rays.
        Recorded::without_maps(candidate, &scene, declared.precision())
    } else {
        // The channels go once they are taken over: else the check would take half as much memory again.
        let channels = Recorded::channels(candidate, &scene, &declared.declared())?;
        Recorded::of_folder(candidate, &scene, declared.precision(), &channels, declared.conventions())?
    };

    let truth = match (manifest.kind, manifest.blind_seed) {
        (PackKind::Blind, Some(seed)) => {
            let is_of_seed = |edition| -> Result<bool, CheckError> {
                Ok(scene_sha256(&blind_scene_of(seed, edition)?) == sha256)
            };
            if !is_of_seed(Edition::Second)? && !is_of_seed(Edition::First)? {
                let found = format!("its scene differs from that of seed {seed}");
                let expected = format!("a blind pack of this version, {}", env!("CARGO_PKG_VERSION"));
                return Err(answers(found, &expected));
            }
            GroundTruth::certified(&scene, progress)
        }
        (PackKind::Questions, _) => GroundTruth::certified(&scene, progress),
        _ => {
            progress.stage("reading the answers");
            read_answers(pack, &manifest, &scene, is_known)?
        }
    };
    let uncertified = |found: UncertifiedAnswer| {
        answers(
            format!("its answer to {}, {}, is not the referee's", found.place, found.part),
            "correctly rounded answers, as this version computes them",
        )
    };
    progress.stage("comparing the pack with its scene");
    let rays = verify_rays(pack, &manifest, &scene)?;
    let computed = matches!(manifest.kind, PackKind::Blind | PackKind::Questions);
    let of =
        scene.sensors().filter_map(|sensor| scene.size(sensor)).map(|(w, h)| u64::from(w) * u64::from(h));
    let of: u64 = of.sum();
    let is_drawn = !computed && !is_known && share.draws_of(of);
    let seed = match share {
        Verification::Drawn { seed: Some(seed) } => seed,
        _ => seed_anew(),
    };
    // Answers that the referee has just given need not be asked again.
    let (found, answered) = match share {
        _ if computed => (None, of),
        Verification::Drawn { .. } if is_known || is_drawn => {
            // Sums of pixels, too.
            let (found, asked) = truth.first_uncertified(JudgeShare::Sample);
            let drawn = if is_drawn { drawn_places(&scene, DRAWN, seed) } else { Vec::new() };
            let of_drawn =
                || drawn.iter().find_map(|(sensor, places)| truth.uncertified_among(*sensor, places));
            (found.or_else(of_drawn), if is_drawn { DRAWN } else { asked })
        }
        _ => truth.first_uncertified(JudgeShare::All),
    };
    if let Some(found) = found {
        return Err(uncertified(found));
    }
    let [clauses, sizes] = match is_known {
        true => [Found::default(); 2],
        false => check_numbers(&manifest, &scene, (share, seed), progress).map_err(refused)?,
    };
    let check = check(&truth, &recorded, progress);
    if !computed {
        progress.stage("comparing the answers to wrong rays with the referee's");
        if let Some(found) = first_wrong_answer(&truth, &check) {
            return Err(uncertified(found));
        }
    }
    let seed = (is_drawn || clauses.is_partial() || sizes.is_partial()).then_some(seed);
    let verified = Verified { answers: answered, of, rays, seed, clauses, sizes };
    let diagnosis = if check.passes() {
        None
    } else {
        progress.stage("looking for a mistake that explains the wrong rays");
        diagnose(&truth, &recorded, &check)
    };
    let exact = truth.into_answers();
    let subject = Subject {
        name: manifest.scene.name,
        arguments: quoted(&scene_file.to_string_lossy()),
        sha256,
        scene,
        vehicle: None,
        file_facts: Default::default(),
    };
    let is_blind = manifest.kind == PackKind::Blind;
    let has_answers = manifest.kind == PackKind::Answers;
    let ray_sets = Vec::new();
    Ok(Checked {
        subject,
        recorded,
        check,
        diagnosis,
        exact,
        is_blind,
        has_answers,
        pack: identity,
        verified,
        declared,
        sharpness: manifest.sharpness,
        ray_sets,
    })
}

/// The first answer by which the candidate is wrong and which is itself not the referee's.
///
/// The flux of a pixel is a sum over pencils. Of a candidate that gives pencils, a wrong answer to a pencil shows there; one that
/// gives none is wrong by any pencil of the beam, so all are compared.
fn first_wrong_answer(truth: &GroundTruth<'_>, check: &Check) -> Option<UncertifiedAnswer> {
    let wrong = |sensor: &SensorResult| -> Vec<DifferingRay> {
        sensor.differing.iter().filter(|ray| ray.class == Class::Defect).copied().collect()
    };
    let is_wrong_in_flux = check
        .sensors
        .iter()
        .filter(|sensor| sensor.sensor == SensorId::Camera)
        .flat_map(wrong)
        .any(|ray| ray.item.quantity == Quantity::PixelFlux);
    check.sensors.iter().find_map(|result| {
        let sensor = result.sensor;
        let place = |i, j| Place { sensor, i, j };
        let gives_flux = result
            .items
            .iter()
            .any(|(item, tally)| item.quantity == Quantity::PencilFlux && tally.compared() > 0);
        let places: Vec<Place> = match truth.scene().size(sensor) {
            Some((width, height)) if sensor != SensorId::Camera && is_wrong_in_flux && !gives_flux => {
                (0..height).flat_map(|j| (0..width).map(move |i| place(i, j))).collect()
            }
            _ => wrong(result).into_iter().map(|ray| place(ray.i, ray.j)).collect(),
        };
        truth.uncertified_among(sensor, &places)
    })
}

/// Compares the arrays of rays of a pack with the rays of its scene, bit for bit; returns how many there are.
fn verify_rays(pack: &Path, manifest: &Manifest, scene: &Scene) -> Result<u64, CheckError> {
    let referee = Referee::new(scene);
    let mut verified = 0;
    for sensor in scene.sensors() {
        let name = rays_name(sensor);
        let Some(entry) = manifest.files.iter().find(|file| file.role == FileRole::Rays && file.path == name)
        else {
            continue;
        };
        let (_, own) = rays_sha256(&referee, scene, sensor)?;
        if entry.sha256 != own {
            return Err(CheckError::Answers {
                pack: pack.to_path_buf(),
                found: format!("{name} does not have the rays of {sensor} in scene.toml"),
                expected: "origin and direction of each ray, correctly rounded".into(),
            });
        }
        verified += 1;
    }
    Ok(verified)
}

/// Reads the answers of a pack that holds them, in f64.
fn read_answers<'s>(
    pack: &Path,
    manifest: &Manifest,
    scene: &'s Scene,
    is_known: bool,
) -> Result<GroundTruth<'s>, CheckError> {
    // Only listed files belong to the pack.
    let answers = || manifest.files.iter().filter(|file| file.role == FileRole::Answers);
    let read = |is_read: &dyn Fn(&ManifestFile) -> bool| -> Result<Recorded, CheckError> {
        let paths = answers().filter(|file| is_read(file)).map(|file| file.path.as_str());
        let channels = read_listed_channels(pack, paths, &Limits::default())?;
        Ok(Recorded::of_channels(manifest.scene.name.clone(), pack, scene, Precision::F64, &channels)?)
    };
    if !is_known && !answers().any(|file| file.kind == Some(FileType::Exr)) {
        return Err(CheckError::Answers {
            pack: pack.to_path_buf(),
            found: format!("no EXR file with answers that {MANIFEST_NAME} lists"),
            expected: "every quantity in an EXR file of its sensor, beside the arrays in double precision"
                .into(),
        });
    }
    // Each answer stands twice, as NPY and rounded as EXR. Where both are there they were compared when they were read.
    let singles: BTreeSet<(SensorId, Item)> = match is_known {
        true => BTreeSet::new(),
        false => read(&|file| file.kind == Some(FileType::Exr))?.storage.into_keys().collect(),
    };
    let recorded = read(&|_| true)?;
    for sensor in scene.sensors() {
        for quantity in Quantity::ALL.into_iter().filter(|one| one.is_of(sensor) && *one != Quantity::Hit) {
            let items: Vec<Item> = match quantity {
                Quantity::PixelFlux => (0..scene.beams().len()).map(Item::of_image).collect(),
                _ => vec![quantity.into()],
            };
            let is_flux = matches!(quantity, Quantity::PencilFlux | Quantity::PixelFlux);
            let others = items.iter().filter(|_| is_flux).map(|item| Item { is_other_model: true, ..*item });
            for item in items.iter().copied().chain(others) {
                if !is_known && !singles.contains(&(sensor, item)) {
                    return Err(CheckError::Answers {
                        pack: pack.to_path_buf(),
                        found: format!("no {quantity} of {sensor} in an EXR file that {MANIFEST_NAME} lists"),
                        expected: format!(
                            "every quantity in {sensor}.exr, beside the arrays in double precision"
                        ),
                    });
                }
                let storage = recorded.storage.get(&(sensor, item));
                if !matches!(storage, Some(Storage::F64 | Storage::Whole)) {
                    return Err(CheckError::Answers {
                        pack: pack.to_path_buf(),
                        found: format!("no {quantity} of {sensor} in double precision"),
                        expected: "every quantity, in double precision".into(),
                    });
                }
            }
        }
    }
    Ok(GroundTruth::of_answers(scene, recorded.answers))
}

#[cfg(test)]
#[path = "../tests/unit/check.rs"]
mod tests;
