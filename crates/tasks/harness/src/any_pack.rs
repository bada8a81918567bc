//! A candidate against a pack of any form: sensors and their sets of rays, rays of no sensor, triangles.

use std::path::Path;

use raypencil_cast::{
    CandidateConventions, CloudConventions, RayPackChecked, check_ray_pack, is_cloud, is_ray_pack,
};
use raypencil_files::{Fault, FileError, FolderError};
use raypencil_pack::{
    CheckError, Checked, Declarations, InputChecked, PackForm, Provenance, ProvenanceError, Verification,
    check_input, check_pack_by, is_input_pack, write_document,
};
use raypencil_report::Document;
use raypencil_scene::Progress;

use crate::ray_set_packs::{CheckedRaySet, check_packed_ray_sets};

/// What a pack asks for, by the files that it has.
pub fn pack_form(pack: &Path) -> PackForm {
    if is_input_pack(pack) {
        PackForm::Triangles
    } else if is_ray_pack(pack) {
        PackForm::Rays
    } else {
        PackForm::Sensors
    }
}

/// A candidate, checked.
#[derive(Debug)]
pub enum CheckedPack {
    /// Rays of sensors, and of sets beside them.
    Sensors {
        /// The check of all.
        checked: Box<Checked>,
        /// Each set by itself, for its own page.
        sets: Vec<CheckedRaySet>,
    },
    /// Rays of no sensor.
    Rays(Box<RayPackChecked>),
    /// Triangles.
    Triangles(InputChecked),
}

/// Checks a candidate against a pack of any form. Its `candidate.json` may declare what `declarations` does not. `cloud` is declared of a point cloud, which a pack of rays takes too.
///
/// # Errors
/// As `check_pack_by`, `check_ray_pack` and `check_input`; a note of answers to rays that cannot be read, or speaks of channels.
pub fn check_any_pack(
    pack: &Path,
    candidate: &Path,
    (declarations, cloud): (&Declarations, CloudConventions<'_>),
    share: Verification,
    progress: &dyn Progress,
) -> Result<CheckedPack, CheckError> {
    let conventions = |declared: &Declarations| CandidateConventions {
        miss: declared.miss,
        ignores_faces: declared.ignores_faces,
        cloud,
    };
    let form = pack_form(pack);
    // A pack that is not there has its own words.
    if pack.exists() {
        refuse_exchanged(pack, candidate)?;
        refuse_other_kinds(form, candidate)?;
    }
    Ok(match form {
        PackForm::Triangles => CheckedPack::Triangles(check_input(pack, candidate)?),
        PackForm::Rays => {
            let declared = declarations.clone().with_note(note_of_rays(candidate)?.as_ref());
            let of_rays = conventions(&declared);
            let checked = check_ray_pack(pack, candidate, declared.precision(), of_rays, progress)?;
            CheckedPack::Rays(Box::new(checked))
        }
        PackForm::Sensors => {
            let mut checked = check_pack_by(pack, candidate, declarations, share, progress)?;
            let (precision, of_rays) = (checked.recorded.precision, conventions(&checked.declared));
            let sets = check_packed_ray_sets(pack, candidate, precision, of_rays, progress)?;
            checked.ray_sets = sets.iter().map(CheckedRaySet::bundle).collect();
            CheckedPack::Sensors { checked: Box::new(checked), sets }
        }
    })
}

/// Whether a folder has the list of a pack of any form.
fn is_any_pack(folder: &Path) -> bool {
    is_ray_pack(folder) || is_input_pack(folder) || folder.join("manifest.json").is_file()
}

/// Refuses a pack that is none beside a candidate that is one: the two are exchanged.
fn refuse_exchanged(pack: &Path, candidate: &Path) -> Result<(), CheckError> {
    if is_any_pack(pack) || !is_any_pack(candidate) {
        return Ok(());
    }
    let found = format!("no pack, and the candidate, {}, is one", candidate.display());
    let expected =
        "the pack first, then the candidate: `raypencil check PACK CANDIDATE` (are the two exchanged?)";
    Err(FileError::Recording(Fault::new("pack", found, expected).in_file(pack)).into())
}

/// Refuses a candidate that is of no use for a pack of this form, and says what it is.
fn refuse_other_kinds(form: PackForm, candidate: &Path) -> Result<(), CheckError> {
    let is_list = candidate.file_name().is_some_and(|name| name == "raypack.json") && candidate.is_file();
    let found = match form {
        PackForm::Rays if is_list => "the list of a pack of rays",
        PackForm::Rays if candidate.join("manifest.json").is_file() && !is_ray_pack(candidate) => {
            "a pack of a scene, or its input"
        }
        PackForm::Rays => return Ok(()),
        _ if is_cloud(candidate) && candidate.is_file() => "a point cloud",
        _ if is_list || is_ray_pack(candidate) => "a pack of rays",
        _ => return Ok(()),
    };
    let expected = match form {
        PackForm::Rays => {
            "a folder with face.npy, t.npy, range.npy or hit.npy, or a point cloud: this pack asks for rays"
        }
        PackForm::Sensors => {
            "maps of its sensors: this pack asks for those of a scene. Answers to rays and point clouds are held to a pack of rays: \
             of `pack MESH --rays RAYS`, or rays/NAME in a pack whose scene has sets of rays"
        }
        PackForm::Triangles => "triangles.npy: this pack asks for triangles",
    };
    let fault = Fault::new("candidate", found, expected).in_file(candidate);
    Err(FileError::Recording(fault).into())
}

/// The note of a folder of answers to a pack of rays; a cloud has none. What it says of channels of other names has no meaning there.
fn note_of_rays(candidate: &Path) -> Result<Option<Provenance>, CheckError> {
    let note = Provenance::read(candidate).map_err(ProvenanceError::from)?;
    let of_channels = |note: &Provenance| {
        let scale = note.scale.map(|scale| ("scale", scale.to_string()));
        let channel = note.channels.0.first().map(|(map, channel)| ("channels", format!("{map}: {channel}")));
        scale.or(channel)
    };
    if let Some((place, found)) = note.as_ref().and_then(of_channels) {
        let expected = "no channels and no scale: answers to a pack of rays are NPY files of fixed names";
        let fault = Fault::new(place, found, expected).in_file(&candidate.join("candidate.json"));
        return Err(ProvenanceError::from(FileError::Recording(fault)).into());
    }
    Ok(note)
}

impl CheckedPack {
    /// Whether nothing is wrong, and what was compared proves something.
    pub fn passes(&self) -> bool {
        match self {
            Self::Sensors { checked, .. } => checked.passes(),
            Self::Rays(checked) => checked.passes(),
            Self::Triangles(checked) => checked.passes(),
        }
    }

    /// The mistake that explains what is wrong, as one sentence without its full stop.
    pub fn why(&self) -> Option<String> {
        match self {
            Self::Sensors { checked, .. } => checked.why(),
            Self::Rays(checked) => checked.why.clone(),
            Self::Triangles(_) => None,
        }
    }

    /// The check for a screen and for programs.
    pub fn document(&self) -> Document {
        match self {
            Self::Sensors { checked, .. } => checked.document(),
            Self::Rays(checked) => checked.document(),
            Self::Triangles(checked) => checked.document(),
        }
    }

    /// Writes `report.html`, `junit.xml`, `summary.md` and last `check.json` into a folder; of each set of rays that the candidate
    /// gives the same into `rays/NAME`.
    ///
    /// # Errors
    /// Names the file or folder that could not be written, and why.
    pub fn write(&self, folder: &Path) -> Result<(), FolderError> {
        let (document, sets) = match self {
            Self::Sensors { checked, sets } => {
                let document = checked.document_with_pictures().map_err(|error| {
                    FileError::io(&folder.join("report.html"), "write", std::io::Error::other(error))
                })?;
                (document, sets.as_slice())
            }
            Self::Rays(checked) => (checked.document_with_pictures(), [].as_slice()),
            Self::Triangles(checked) => (checked.document(), [].as_slice()),
        };
        write_document(&document, folder)?;
        for CheckedRaySet { name, checked, .. } in sets {
            if let Some(checked) = checked {
                write_document(&checked.document_with_pictures(), &folder.join("rays").join(name))?;
            }
        }
        Ok(())
    }
}
