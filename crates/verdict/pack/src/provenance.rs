//! `candidate.json`, the optional note of a recording: which program made it, and of which scene.
//! `docs/formats/files.md` describes it.

use std::path::{Path, PathBuf};

use raypencil_files::{DeclaredChannel, Fault, FileError, bytes, shortened};
use raypencil_scene::{Precision, Scene};
use raypencil_scene_io::scene_sha256;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::manifest::ManifestScene;
use crate::note_values::{ChannelNames, MissNumber};

/// The note's file name.
const FILE_NAME: &str = "candidate.json";

const FORMAT: u64 = 1;

/// Maximum size of a note: 1 MiB.
const MAX_NOTE_BYTES: u64 = 1 << 20;

/// Maximum length of a text that reports show, bytes.
const MAX_TEXT_BYTES: usize = 1 << 10;

/// Maximum length of a digest, bytes.
const MAX_DIGEST_BYTES: usize = 64;

/// Content of `candidate.json`. Other keys, such as versions and seeds, are for people and are ignored.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Provenance {
    /// Name of the program that made the recording, with its version if it gives one.
    #[serde(default)]
    pub program: Option<String>,
    /// Arithmetic that the program computes in; without it f64.
    #[serde(default)]
    pub arithmetic: Option<Arithmetic>,
    /// The scene that the recording belongs to, if the program knows it.
    #[serde(default)]
    pub scene: Option<ManifestScene>,
    /// Total fluxes of Monte Carlo images.
    #[serde(default)]
    pub totals: Vec<MonteCarloTotal>,
    /// The channels of the recording's files that are maps of another name.
    #[serde(default)]
    pub channels: ChannelNames,
    /// Metres that a unit of whole numbers in maps of lengths stands for.
    #[serde(default)]
    pub scale: Option<f64>,
    /// A number that means "no hit".
    #[serde(default)]
    pub miss: Option<MissNumber>,
    /// Whether the channel of faces is left out.
    #[serde(default)]
    pub no_faces: bool,
}

/// Arithmetic that a program computes in, whichever type it stores.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Arithmetic {
    /// IEEE 754 single precision.
    F32,
    /// IEEE 754 double precision.
    F64,
}

/// Total flux of a Monte Carlo image, summed over its pixels.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct MonteCarloTotal {
    /// The integrator, which is the first word of the image's name: `direct` for `direct.mean.beam0`.
    #[serde(rename = "way")]
    pub integrator: String,
    /// Index of the beam whose light the image shows.
    pub beam: usize,
    /// Mean, watts.
    pub mean: f64,
    /// Standard error of the mean, watts.
    pub error: f64,
}

/// Why the note of a recording cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProvenanceError {
    /// The file; the message names it.
    #[error(transparent)]
    File(#[from] FileError),
    /// The recording belongs to another scene.
    #[error(
        "{}: its candidate.json is of the scene {theirs}; expected {ours}, the resolved scene that it is compared with",
        folder.display()
    )]
    OtherScene {
        /// Folder of the recording.
        folder: PathBuf,
        /// Digest that the note names.
        theirs: String,
        /// Digest of the scene to compare with.
        ours: String,
    },
}

impl Arithmetic {
    /// Its name in files and on the command line.
    pub fn word(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }
}

impl Provenance {
    /// Reads the note of the recording in `folder`. `None`: the recording has no note.
    ///
    /// # Errors
    /// Names the file, the place in it, what was found and what was expected.
    pub fn read(folder: impl AsRef<Path>) -> Result<Option<Self>, FileError> {
        let path = folder.as_ref().join(FILE_NAME);
        if !path.exists() {
            return Ok(None);
        }
        let text =
            bytes::read_file(&path, MAX_NOTE_BYTES).map_err(|error| FileError::io(&path, "read", error))?;
        Self::from_bytes(&text, &path).map(Some)
    }

    /// Parses the bytes of a note. `file` is the path that messages name.
    ///
    /// ```
    /// use std::path::Path;
    ///
    /// use raypencil_pack::{Arithmetic, Provenance, precision_of};
    /// use raypencil_scene::Precision;
    ///
    /// let json = br#"{"format": 1, "program": "mine 2.1", "arithmetic": "f32",
    ///     "scene": {"name": "pyramids", "sha256": "00ff"}, "seed": 5}"#;
    /// let note = Provenance::from_bytes(json, Path::new("candidate.json"))?;
    /// // f32 has a unit roundoff of 2^-24. The key `seed` is for people.
    /// assert_eq!(note.arithmetic, Some(Arithmetic::F32));
    /// assert_eq!(precision_of(Arithmetic::F32), Precision::F32);
    /// # Ok::<(), raypencil_files::FileError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Provenance::read`].
    pub fn from_bytes(bytes: &[u8], file: &Path) -> Result<Self, FileError> {
        let refuse = |fault: Fault| FileError::Recording(fault.in_file(file));
        let invalid = |error: serde_json::Error| {
            refuse(Fault::new("JSON", error.to_string(), "what docs/formats/files.md describes"))
        };
        // A mark of UTF-8, as editors of Windows write it.
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let written: Value = serde_json::from_slice(bytes).map_err(invalid)?;
        if let Some(fault) = other_kind(&written) {
            return Err(refuse(fault));
        }
        let (_, read): (Format, Self) = (
            serde_json::from_slice(bytes).map_err(invalid)?,
            serde_json::from_slice(bytes).map_err(invalid)?,
        );
        let of_scene = read.scene.iter().flat_map(|scene| {
            [("scene.name", &scene.name, MAX_TEXT_BYTES), ("scene.sha256", &scene.sha256, MAX_DIGEST_BYTES)]
        });
        let of_program = read.program.iter().map(|program| ("program", program, MAX_TEXT_BYTES));
        for (place, text, most) in of_scene.chain(of_program) {
            if text.len() > most {
                return Err(refuse(Fault::new(
                    place,
                    format!("{} bytes", text.len()),
                    format!("at most {most}"),
                )));
            }
        }
        for (map, channel) in &read.channels.0 {
            if let Err(fault) = DeclaredChannel::new(map, channel) {
                return Err(refuse(Fault::new("channels", format!("{map:?}: {channel:?}"), fault)));
            }
        }
        if let Some(scale) = read.scale.filter(|scale| !(*scale > 0.0)) {
            return Err(refuse(Fault::new(
                "scale",
                scale.to_string(),
                "metres for each unit, such as 0.001",
            )));
        }
        let is_flux = |value: f64| value.is_finite() && value >= 0.0;
        if let Some(index) =
            read.totals.iter().position(|total| !is_flux(total.mean) || !is_flux(total.error))
        {
            let MonteCarloTotal { mean, error, .. } = &read.totals[index];
            let found = format!("mean {mean}, error {error}");
            return Err(refuse(Fault::new(
                format!("totals[{index}]"),
                found,
                "two finite numbers, not negative",
            )));
        }
        Ok(read)
    }
}

/// The number of the format, which nothing else reads: it may be there once only.
#[derive(Deserialize)]
struct Format {
    #[serde(rename = "format")]
    _format: IgnoredAny,
}

/// What the value of a key has to be, in words, and whether a value is that.
type Kind = (&'static str, &'static str, fn(&Value) -> bool);

/// The keys that are read, and what they have to be. The number of the format is first: a newer one is refused by it, not by a key.
const KINDS: [Kind; 8] = [
    ("format", "1", |value| value.as_u64() == Some(FORMAT)),
    ("program", "the name of the program, in quotes", Value::is_string),
    ("arithmetic", "\"f32\" or \"f64\"", |value| matches!(value.as_str(), Some("f32" | "f64"))),
    ("totals", "a list of totals, each with way, beam, mean and error", Value::is_array),
    ("channels", "a map of names of maps and channels", |value| {
        value.as_object().is_some_and(|names| names.values().all(Value::is_string))
    }),
    ("scale", "metres for each unit, such as 0.001", Value::is_number),
    ("miss", "a number or \"nan\"", |value| {
        value.is_number() || value.as_str().is_some_and(|text| text.eq_ignore_ascii_case("nan"))
    }),
    ("no_faces", "true or false", Value::is_boolean),
];

/// The first value of a note that is not what its key takes.
fn other_kind(note: &Value) -> Option<Fault> {
    let told = |value: &Value| shortened(value.to_string());
    let Some(keys) = note.as_object() else {
        return Some(Fault::new(
            "JSON",
            told(note),
            "a note of keys, such as {\"format\": 1, \"arithmetic\": \"f32\"}",
        ));
    };
    if !keys.contains_key("format") {
        return Some(Fault::new("format", "not there", FORMAT.to_string()));
    }
    for (key, expected, is_so) in KINDS {
        let value = keys.get(key).filter(|value| !value.is_null() || key == "format");
        if let Some(value) = value.filter(|value| !is_so(value)) {
            return Some(Fault::new(key, told(value), expected));
        }
    }
    let scene = keys.get("scene").filter(|scene| !scene.is_null())?;
    let of_scene = [
        ("name", "the scene's name, in quotes, beside its sha256"),
        (
            "sha256",
            "the SHA-256 of the resolved scene, in quotes, as in the pack's manifest.json: or leave `scene` out",
        ),
    ];
    of_scene.into_iter().find_map(|(key, expected)| match scene.get(key) {
        Some(value) if value.is_string() => None,
        Some(value) => Some(Fault::new(format!("scene.{key}"), told(value), expected)),
        None => Some(Fault::new(format!("scene.{key}"), "not there", expected)),
    })
}

/// The precision of an arithmetic.
pub fn precision_of(arithmetic: Arithmetic) -> Precision {
    match arithmetic {
        Arithmetic::F32 => Precision::F32,
        Arithmetic::F64 => Precision::F64,
    }
}

/// Reads the note of the recording in `folder`, and checks that it belongs to `scene`, if it names one. `None`: there is no
/// note.
///
/// # Errors
/// A note that cannot be read, or that belongs to another scene.
pub fn note(folder: &Path, scene: &Scene) -> Result<Option<Provenance>, ProvenanceError> {
    let note = Provenance::read(folder)?;
    let ours = scene_sha256(scene);
    match note.as_ref().and_then(|note| note.scene.as_ref()) {
        Some(scene) if scene.sha256 != ours => {
            let theirs = scene.sha256.clone();
            Err(ProvenanceError::OtherScene { folder: folder.to_path_buf(), theirs, ours })
        }
        _ => Ok(note),
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
        assert_eq!((note.program.as_deref(), note.arithmetic), (Some("P 1"), Some(Arithmetic::F32)));
        assert_eq!((note.totals[0].beam, note.totals[0].mean), (1, 2e-9));
        assert_eq!(note.scene.expect("a scene").sha256, "ab");
    }

    #[test]
    fn a_note_may_leave_its_scene_out() {
        let scene = r#", "scene": {"name": "s", "sha256": "ab"}"#;
        assert!(GOOD.contains(scene));
        let note = read(&GOOD.replace(scene, "")).expect("a note").expect("one that is there");
        assert_eq!((note.scene, note.arithmetic), (None, Some(Arithmetic::F32)));
        // Half a scene is none.
        let message = read(&GOOD.replace(r#", "sha256": "ab""#, "")).expect_err("half a scene").to_string();
        assert!(
            message.contains("scene.sha256: not there; expected the SHA-256 of the resolved scene"),
            "{message}"
        );
    }

    #[test]
    fn a_note_may_say_one_thing_alone_and_begin_with_a_mark_of_utf_8() {
        let note = |text: &str| read(text).expect("a note").expect("one that is there");
        let alone = note("\u{feff}{\"format\": 1, \"arithmetic\": \"f32\"}");
        assert_eq!((alone.program, alone.arithmetic), (None, Some(Arithmetic::F32)));
        let alone = note(r#"{"format": 1, "program": "P", "scene": null, "miss": null}"#);
        assert_eq!((alone.program.as_deref(), alone.arithmetic), (Some("P"), None));
    }

    #[test]
    fn a_note_of_another_scene_is_refused_and_one_without_a_scene_is_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let loaded = raypencil_scene_io::load("pyramids", &Default::default()).expect("a built-in scene");
        let of = |text: &str| {
            std::fs::write(folder.path().join(FILE_NAME), text).expect("a file");
            note(folder.path(), &loaded.scene)
        };
        let message = of(GOOD).expect_err("another scene").to_string();
        assert!(message.contains("of the scene ab; expected"), "{message}");
        let alone = r#"{"format": 1, "program": "ann", "arithmetic": "f32"}"#;
        assert_eq!(
            of(alone).expect("no scene, no other scene").expect("a note").program.as_deref(),
            Some("ann")
        );
    }

    /// The note with one key more.
    fn with(key: &str) -> String {
        GOOD.replacen('{', &format!("{{{key}, "), 1)
    }

    #[test]
    fn a_note_remembers_what_is_declared() {
        let keys = r#""channels": {"depth.Z": "ViewLayer.Depth.Z", "camera/range.T": "Y"}, "scale": 0.001, "miss": "nan",
            "no_faces": true"#;
        let note = read(&with(keys)).expect("a note").expect("one that is there");
        let names = [("depth.Z", "ViewLayer.Depth.Z"), ("camera/range.T", "Y")];
        assert_eq!(note.channels.0, names.map(|(map, channel)| (map.to_string(), channel.to_string())));
        assert_eq!((note.scale, note.no_faces), (Some(0.001), true));
        assert!(note.miss.expect("a number").0.is_nan());
        let note = read(&with(r#""miss": -1"#)).expect("a note").expect("one that is there");
        assert_eq!((note.miss, note.scale, note.no_faces), (Some(MissNumber(-1.0)), None, false));
    }

    #[test]
    fn texts_have_as_many_bytes_as_there_is_room_for() {
        for (text, most) in [("P 1", MAX_TEXT_BYTES), (r#""s""#, MAX_TEXT_BYTES), ("ab", MAX_DIGEST_BYTES)] {
            let of = |bytes: usize| {
                let long = "x".repeat(bytes);
                let long = if text.starts_with('"') { format!("\"{long}\"") } else { long };
                assert_eq!(GOOD.matches(text).count(), 1, "{text}");
                read(&GOOD.replace(text, &long))
            };
            assert!(of(most).is_ok_and(|note| note.is_some()), "{text}");
            let message = of(most + 1).expect_err(text).to_string();
            assert!(message.ends_with(&format!("{} bytes; expected at most {most}", most + 1)), "{message}");
        }
    }

    #[test]
    fn the_word_of_an_arithmetic_is_the_one_that_a_note_has() {
        for word in ["f32", "f64"] {
            let note = read(&GOOD.replace("f32", word)).expect("a note").expect("one that is there");
            assert_eq!(note.arithmetic.expect("an arithmetic").word(), word);
        }
    }

    #[test]
    fn invalid_notes_are_refused_with_the_place() {
        for (text, words) in [
            ("{", vec!["candidate.json", "JSON"]),
            (r#"{"format": 2}"#, vec!["candidate.json", "format", "2", "1"]),
            (r#"{"program": "P"}"#, vec!["format: not there; expected 1"]),
            ("[1]", vec!["JSON: [1]; expected a note of keys"]),
            (
                r#"{"format": 1, "program": 7}"#,
                vec!["program: 7; expected the name of the program, in quotes"],
            ),
            (r#"{"format": 1, "arithmetic": 32}"#, vec!["arithmetic: 32; expected \"f32\" or \"f64\""]),
            (&with(r#""no_faces": "yes""#), vec!["no_faces: \"yes\"; expected true or false"]),
            (&with(r#""miss": [0]"#), vec!["miss: [0]; expected a number or \"nan\""]),
            (&with(r#""channels": {"depth.Z": 3}"#), vec!["channels", "a map of names of maps and channels"]),
            (&GOOD.replace("f32", "f16"), vec!["f16"]),
            (&GOOD.replace("3e-12", "-3e-12"), vec!["totals[0]", "error -0.000000000003"]),
            (
                &with(r#""channels": {"depth.Z": "Z", "depth.Z": "Y"}"#),
                vec!["JSON", "depth.Z is there twice"],
            ),
            (&with(r#""channels": {"depth.Z": ""}"#), vec!["channels", "expected the name of a channel"]),
            (&with(r#""channels": ["depth.Z=Z"]"#), vec!["a map of names of maps and channels"]),
            (&with(r#""scale": 0"#), vec!["scale: 0; expected metres for each unit"]),
            (&with(r#""miss": "inf""#), vec!["a number or \"nan\""]),
        ] {
            let message = read(text).expect_err(text).to_string();
            for word in words {
                assert!(message.contains(word), "{message} has no {word}");
            }
        }
    }
}
