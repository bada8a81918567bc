//! What the file of a terrain says of itself, and what holds where it says nothing.

use serde_json::{Value, json};

use crate::dem::DemFacts;
use crate::file_frame::FileFrame;
use crate::triangles::PolygonFacts;

/// What was found out about the file of a terrain beside its faces. A ground that has no file has no facts.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FileFacts {
    /// Units and axes.
    pub units: Option<FileUnits>,
    /// Its polygons that are no triangles.
    pub polygons: PolygonFacts,
}

/// Units and axes of the file of a terrain.
#[derive(Debug, Clone, PartialEq)]
pub enum FileUnits {
    /// Those of a mesh.
    Mesh {
        /// Whether it is glTF, which is in metres with y up. STL, OBJ and PLY state neither.
        is_gltf: bool,
        /// What the caller says.
        frame: FileFrame,
    },
    /// Those of an elevation model.
    Dem(Box<DemFacts>),
}

impl From<DemFacts> for FileFacts {
    fn from(facts: DemFacts) -> Self {
        Self { units: Some(FileUnits::Dem(Box::new(facts))), polygons: PolygonFacts::default() }
    }
}

impl FileFacts {
    /// The elevation model's facts, of an elevation model.
    pub fn dem(&self) -> Option<&DemFacts> {
        match &self.units {
            Some(FileUnits::Dem(facts)) => Some(facts),
            _ => None,
        }
    }
}

impl FileUnits {
    /// The facts for programs, an object.
    ///
    /// ```
    /// use raypencil_mesh_io::{FileFrame, FileUnits};
    ///
    /// let units = FileUnits::Mesh { is_gltf: true, frame: FileFrame::default() };
    /// assert_eq!(units.to_json()["file_states"]["unit"], "metre");
    /// assert_eq!(units.lines()[0], ("up axis", "y, as glTF says".to_string()));
    /// let units = FileUnits::Mesh { is_gltf: false, frame: FileFrame { scale: 0.001, ..FileFrame::default() } };
    /// assert_eq!(units.lines()[1], ("scale", "0.001 m for each unit of the file, as is given".to_string()));
    /// ```
    pub fn to_json(&self) -> Value {
        match self {
            Self::Dem(facts) => facts.to_json(),
            Self::Mesh { is_gltf, frame } => {
                let [unit, axis] = stated(*is_gltf);
                json!({
                    "up": frame.up.map(|up| up.word()),
                    "scale": frame.scale,
                    "file_states": { "unit": unit, "up": axis },
                })
            }
        }
    }

    /// Units and axes in one line.
    pub fn words(&self) -> String {
        match self {
            Self::Dem(facts) => facts.words(),
            Self::Mesh { .. } => self
                .lines()
                .into_iter()
                .map(|(name, words)| format!("{name} {words}"))
                .collect::<Vec<_>>()
                .join("; "),
        }
    }

    /// The facts for people: names of lines, and their words.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        match self {
            Self::Dem(facts) => facts.lines(),
            Self::Mesh { is_gltf, frame } => {
                let [unit, axis] = stated(*is_gltf);
                let up = match (frame.up.map(|up| up.word()), axis) {
                    (Some(up), None) => format!("{up}, as is given"),
                    (Some(up), Some(stated)) => format!("{up}, as is given; by glTF it is {stated}"),
                    (None, Some(stated)) => format!("{stated}, as glTF says"),
                    (None, None) => "z, by default: the file does not say".to_string(),
                };
                let scale = format!("{} m for each unit of the file", frame.scale);
                let scale = match (frame.scale != 1.0, unit) {
                    (true, None) => format!("{scale}, as is given"),
                    (true, Some(stated)) => format!("{scale}, as is given; by glTF it is the {stated}"),
                    (false, Some(stated)) => format!("{scale}: the {stated}, as glTF says"),
                    (false, None) => format!("{scale}: the file does not say"),
                };
                vec![("up axis", up), ("scale", scale)]
            }
        }
    }
}

/// The unit and the axis that points up, as far as the format states them.
fn stated(is_gltf: bool) -> [Option<&'static str>; 2] {
    if is_gltf { [Some("metre"), Some("y")] } else { [None; 2] }
}
