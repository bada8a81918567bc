//! What somebody declares about a recording: by options, and once for all in its `candidate.json`.

use std::path::Path;

use raypencil_files::{Declared, DeclaredChannel, FileError};
use raypencil_judge::Conventions;
use raypencil_scene::Precision;
use raypencil_scene_io::quoted;

use crate::provenance::{Provenance, precision_of};

/// What is declared about a recording, whichever way.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Declarations {
    /// The precision of its arithmetic. Default: f64.
    pub precision: Option<Precision>,
    /// A number that means "no hit" in every channel of numbers; it may be NaN. Of whole numbers that are scaled, as the
    /// file has it.
    pub miss: Option<f64>,
    /// Whether the channel of faces is left out.
    pub ignores_faces: bool,
    /// The channels of its files that are maps of another name.
    pub channels: Vec<DeclaredChannel>,
    /// Metres that a unit of whole numbers in maps of lengths stands for; 0 then means "no hit".
    pub scale: Option<f64>,
}

impl Declarations {
    /// The same with what the recording's note remembers. What is declared now counts, where both speak of the same map.
    pub fn with_note(mut self, note: Option<&Provenance>) -> Self {
        let Some(note) = note else { return self };
        self.precision = self.precision.or(note.arithmetic.map(precision_of));
        self.miss = self.miss.or(note.miss.map(|miss| miss.0));
        self.ignores_faces |= note.no_faces;
        self.scale = self.scale.or(note.scale);
        for (map, channel) in &note.channels.0 {
            if self.channels.iter().all(|one| one.map != *map) {
                self.channels.push(DeclaredChannel { map: map.clone(), channel: channel.clone() });
            }
        }
        self
    }

    /// The same with what the note in `folder` remembers, whatever scene it is of.
    ///
    /// # Errors
    /// A note that cannot be read.
    pub fn with_note_of(self, folder: &Path) -> Result<Self, FileError> {
        Ok(self.with_note(Provenance::read(folder)?.as_ref()))
    }

    /// What concerns the channels of files.
    pub fn declared(&self) -> Declared {
        Declared { channels: self.channels.clone(), scale: self.scale, miss: self.miss, may_be_absent: false }
    }

    /// What concerns the meaning of their numbers.
    pub fn conventions(&self) -> Conventions {
        Conventions { miss: self.miss, ignores_faces: self.ignores_faces }
    }

    /// The channels and the scale as they are typed, each with a blank before it; empty if none is declared.
    pub fn typed(&self) -> String {
        let channels = self.channels.iter().map(|one| quoted(&format!("{}={}", one.map, one.channel)));
        let channels = channels.map(|words| format!(" --channel {words}"));
        channels.chain(self.scale.map(|scale| format!(" --scale {scale}"))).collect()
    }

    /// The precision, f64 if nobody says another.
    pub fn precision(&self) -> Precision {
        self.precision.unwrap_or(Precision::F64)
    }
}
