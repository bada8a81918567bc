//! `candidate.json`: what made a recording, and of which scene. Optional; `docs/formats/files.md` describes it.

use serde::Deserialize;
use std::path::Path;
use std::path::PathBuf;

use crate::manifest::ManifestScene;
use raypencil_files::bytes;
use raypencil_files::{Fault, FileError};
use raypencil_scene::{Precision, Scene};
use raypencil_scene_io::scene_sha256;

/// Why the note of a recording cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProvenanceError {
    /// The file itself; the message names it.
    #[error(transparent)]
    File(#[from] FileError),
    /// It answers another scene.
    #[error(
        "{}: its candidate.json is of the scene {theirs}; expected {ours}, the resolved scene that it is held to",
        folder.display()
    )]
    OtherScene {
        /// The recording.
        folder: PathBuf,
        /// The digest that it names.
        theirs: String,
        /// That of the scene at hand.
        ours: String,
    },
}

/// The resolution of an arithmetic.
pub fn precision_of(arithmetic: Arithmetic) -> Precision {
    match arithmetic {
        Arithmetic::F32 => Precision::F32,
        Arithmetic::F64 => Precision::F64,
    }
}

/// The note of a recording, if it has one, which must be of this scene.
pub fn note(folder: &Path, scene: &Scene) -> Result<Option<Provenance>, ProvenanceError> {
    let note = Provenance::read(folder)?;
    let ours = scene_sha256(scene);
    match note {
        Some(note) if note.scene.sha256 != ours => {
            Err(ProvenanceError::OtherScene { folder: folder.to_path_buf(), theirs: note.scene.sha256, ours })
        }
        note => Ok(note),
    }
}

/// The file's name in the folder of a recording.
const FILE_NAME: &str = "candidate.json";

/// The number of its form.
const FORMAT: u64 = 1;

/// A note larger than this is none: 1 MiB.
const LARGEST: u64 = 1 << 20;

/// The longest text that people are shown, bytes.
const LONGEST: usize = 1 << 10;

/// What a recording says of itself. Other keys, such as versions and seeds, are for people.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Provenance {
    /// The program that made it, with its version if it likes.
    pub program: String,
    /// How finely the program computes.
    pub arithmetic: Arithmetic,
    /// The scene that it answers.
    pub scene: ManifestScene,
    /// What images by chance add up to.
    #[serde(default)]
    pub totals: Vec<Total>,
}

/// The arithmetic that a program computes in, whatever it stores.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Arithmetic {
    /// IEEE 754 single precision.
    F32,
    /// IEEE 754 double precision.
    F64,
}

/// The sum over the pixels of an image by chance.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Total {
    /// The word before the image's name: `direct` of `direct.mean.beam0`.
    pub way: String,
    /// Which beam's light.
    pub beam: usize,
    /// The mean, watts.
    pub mean: f64,
    /// Its standard error, watts.
    pub error: f64,
}

impl Provenance {
    /// Reads the note of a recording in `folder`, if it has one.
    ///
    /// # Errors
    /// Names the file, the place in it, what was found and what was expected.
    pub fn read(folder: impl AsRef<Path>) -> Result<Option<Self>, FileError> {
        let path = folder.as_ref().join(FILE_NAME);
        if !path.exists() {
            return Ok(None);
        }
        let text = bytes::read_file(&path, LARGEST).map_err(|error| FileError::io(&path, "read", error))?;
        Self::from_bytes(&text, &path).map(Some)
    }

    /// A note from the bytes of its file; `file` is for messages.
    ///
    /// # Errors
    /// As [`Provenance::read`].
    pub fn from_bytes(bytes: &[u8], file: &Path) -> Result<Self, FileError> {
        let unfit = |fault: Fault| FileError::Recording(fault.in_file(file));
        let invalid = |error: serde_json::Error| {
            unfit(Fault::new("JSON", error.to_string(), "what docs/formats/files.md describes"))
        };
        // A newer format fails by its number and not by a key.
        #[derive(Deserialize)]
        struct Head {
            format: u64,
        }
        let Head { format } = serde_json::from_slice(bytes).map_err(invalid)?;
        if format != FORMAT {
            return Err(unfit(Fault::new("format", format.to_string(), FORMAT.to_string())));
        }
        let read: Self = serde_json::from_slice(bytes).map_err(invalid)?;
        let texts = [
            ("program", &read.program, LONGEST),
            ("scene.name", &read.scene.name, LONGEST),
            ("scene.sha256", &read.scene.sha256, 64),
        ];
        for (place, text, most) in texts {
            if text.len() > most {
                return Err(unfit(Fault::new(
                    place,
                    format!("{} bytes", text.len()),
                    format!("at most {most}"),
                )));
            }
        }
        let is_flux = |value: f64| value.is_finite() && value >= 0.0;
        if let Some(index) =
            read.totals.iter().position(|total| !is_flux(total.mean) || !is_flux(total.error))
        {
            let Total { mean, error, .. } = &read.totals[index];
            let found = format!("mean {mean}, error {error}");
            return Err(unfit(Fault::new(
                format!("totals[{index}]"),
                found,
                "two finite numbers, not negative",
            )));
        }
        Ok(read)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Option<Provenance>, FileError> {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join(FILE_NAME), text).expect("a file");
        Provenance::read(folder.path())
    }

    const GOOD: &str = r#"{"format": 1, "program": "P 1", "arithmetic": "f32", "scene": {"name": "s", "sha256": "ab"},
        "totals": [{"way": "direct", "beam": 1, "mean": 2e-9, "error": 3e-12}], "seeds": [1, 24]}"#;

    #[test]
    fn a_note_is_read_and_may_be_absent() {
        let empty = tempfile::tempdir().expect("a folder");
        assert_eq!(Provenance::read(empty.path()).expect("no note is fine"), None);
        let note = read(GOOD).expect("a note").expect("one that is there");
        assert_eq!((note.program.as_str(), note.arithmetic), ("P 1", Arithmetic::F32));
        assert_eq!((note.scene.sha256.as_str(), note.totals[0].beam, note.totals[0].mean), ("ab", 1, 2e-9));
    }

    #[test]
    fn what_is_no_note_is_refused_by_place() {
        for (text, words) in [
            ("{", vec!["candidate.json", "JSON"]),
            (r#"{"format": 2}"#, vec!["candidate.json", "format", "2", "1"]),
            (r#"{"format": 1, "program": "P"}"#, vec!["arithmetic"]),
            (&GOOD.replace("f32", "f16"), vec!["f16"]),
            (&GOOD.replace("3e-12", "-3e-12"), vec!["totals[0]", "error -0.000000000003"]),
        ] {
            let message = read(text).expect_err(text).to_string();
            for word in words {
                assert!(message.contains(word), "{message} has no {word}");
            }
        }
    }
}
