//! A candidate held to a pack.

use std::path::{Path, PathBuf};

use crate::blind::blind_scene;
use crate::manifest::{FileRole, Manifest, PackKind};
use crate::provenance::{ProvenanceError, note, precision_of};
use raypencil_files::{FileError, Limits, Storage, read_listed_channels};
use raypencil_judge::{Check, Item, Quantity, Recorded, RecordingError, Truth, check};
use raypencil_scene::Place;
use raypencil_scene::{Precision, Progress, Scene};
use raypencil_scene_io::{LoadedScene, SceneIoError, Subject, probe_command, scene_sha256};

/// Why a candidate could not be held to a pack.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckError {
    /// The pack; the message names the file.
    #[error(transparent)]
    Pack(#[from] FileError),
    /// The scene of the pack; the message names the file.
    #[error(transparent)]
    Scene(#[from] SceneIoError),
    /// The candidate; the message names the file, the channel and the cell.
    #[error(transparent)]
    Candidate(#[from] RecordingError),
    /// The note of what made the candidate.
    #[error(transparent)]
    Note(#[from] ProvenanceError),
    /// The pack's answers.
    #[error("{}: {found}; expected {expected}", pack.display())]
    Answers {
        /// The pack.
        pack: PathBuf,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
}

/// What came of it.
#[derive(Debug)]
pub struct Checked {
    /// The scene of the pack, with the words that show a ray of it again.
    pub subject: Subject,
    /// The candidate.
    pub recorded: Recorded,
    /// What is right and wrong in it.
    pub check: Check,
    /// Whether the answers were made from a seed.
    pub is_blind: bool,
}

impl Checked {
    /// The command that shows everything about a ray.
    pub fn repro(&self, place: Place) -> String {
        probe_command(&self.subject, place)
    }
}

/// Holds a candidate to a pack. Its arithmetic is as fine as `precision` says; if nothing is said, as its own
/// `candidate.json` does, and else that of doubles.
///
/// # Errors
/// A pack that is not complete and unchanged; a candidate that breaks the conventions, or that its `candidate.json`
/// says is of another scene.
pub fn check_pack(
    pack: &Path,
    candidate: &Path,
    precision: Option<Precision>,
    progress: &dyn Progress,
) -> Result<Checked, CheckError> {
    progress.stage("reading the pack");
    let manifest = Manifest::read_verified(pack)?;
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
    // The candidate before the truth: what is wrong with it is said soon.
    progress.stage("reading the candidate");
    let note = note(candidate, &scene)?;
    let own = note.map(|note| precision_of(note.arithmetic));
    let precision = precision.or(own).unwrap_or(Precision::F64);
    let recorded = Recorded::read(candidate, &scene, precision)?;

    let truth = match (manifest.kind, manifest.blind_seed) {
        (PackKind::Blind, Some(seed)) => {
            let own = blind_scene(seed)?;
            if scene_sha256(&own) != sha256 {
                let found = format!("its scene is not the one that seed {seed} makes");
                let version = format!("a blind pack of this version, {}", env!("CARGO_PKG_VERSION"));
                return Err(answers(found, &version));
            }
            Truth::certified(&scene, progress)
        }
        _ => {
            progress.stage("reading the answers");
            read_answers(pack, &manifest, &scene)?
        }
    };
    if let Some(not_ours) = truth.first_not_ours() {
        let found = format!("its answer to {}, {}, is not the referee's", not_ours.place, not_ours.quantity);
        return Err(answers(found, "correctly rounded answers, as this version finds them"));
    }
    let check = check(&truth, &recorded, progress);
    drop(truth);
    let subject = Subject {
        name: manifest.scene.name,
        arguments: raypencil_scene_io::quoted(&scene_file.to_string_lossy()),
        sha256,
        scene,
    };
    Ok(Checked { subject, recorded, check, is_blind: manifest.kind == PackKind::Blind })
}

/// The answers of a pack that holds them, in f64.
fn read_answers<'s>(pack: &Path, manifest: &Manifest, scene: &'s Scene) -> Result<Truth<'s>, CheckError> {
    // What is not listed is none of the pack's.
    let answers = manifest.files.iter().filter(|file| file.role == FileRole::Answers);
    let channels = read_listed_channels(pack, answers.map(|file| file.path.as_str()), &Limits::default())?;
    let name = manifest.scene.name.clone();
    let recorded = Recorded::of_channels(name, pack, scene, Precision::F64, &channels)?;
    for sensor in scene.sensors() {
        for quantity in Quantity::ALL.into_iter().filter(|one| one.is_of(sensor) && *one != Quantity::Hit) {
            let own: Vec<Item> = match quantity {
                Quantity::PixelFlux => (0..scene.beams().len()).map(Item::of_image).collect(),
                _ => vec![quantity.into()],
            };
            let is_flux = matches!(quantity, Quantity::PencilFlux | Quantity::PixelFlux);
            let others = own.iter().filter(|_| is_flux).map(|item| Item { is_other_model: true, ..*item });
            for item in own.iter().copied().chain(others) {
                let storage = recorded.storage.get(&(sensor, item));
                if !matches!(storage, Some(Storage::F64 | Storage::Whole)) {
                    return Err(CheckError::Answers {
                        pack: pack.to_path_buf(),
                        found: format!("no {quantity} of {sensor} in double precision"),
                        expected: "every quantity".into(),
                    });
                }
            }
        }
    }
    Ok(Truth::of_answers(scene, recorded.answers))
}
