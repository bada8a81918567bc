//! Axes and unit of a mesh file.

use std::ops::RangeInclusive;

use glam::DVec3;
use raypencil_scene::{SceneError, Triangles};

/// Allowed range of a scale: from micrometres to thousands of kilometres.
pub const SCALE_RANGE: RangeInclusive<f64> = 1e-6..=1e6;

/// Axis of a mesh file that points up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UpAxis {
    /// y, as in glTF: (x, y, z) of the file is (x, -z, y) of the global frame.
    Y,
    /// z, as in the global frame.
    Z,
}

impl UpAxis {
    /// All axes, each with its word in files and on the command line.
    pub const WORDS: [(&str, Self); 2] = [("y", Self::Y), ("z", Self::Z)];

    /// Its word: `y` or `z`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Y => "y",
            Self::Z => "z",
        }
    }
}

/// Axes and unit of a mesh file. STL, OBJ and PLY state neither.
///
/// ```
/// use raypencil_mesh_io::{FileFrame, UpAxis};
///
/// // Millimetres with y up: first the axes are turned, then each coordinate is multiplied.
/// let frame = FileFrame { up: Some(UpAxis::Y), scale: 0.001 };
/// assert_eq!(frame.global([1000.0, 2000.0, 3000.0], UpAxis::Z).to_array(), [1.0, -3.0, 2.0]);
/// // By default the axis is that of the format, and the unit is the metre.
/// assert_eq!(FileFrame::default().global([1.0, 2.0, 3.0], UpAxis::Z).to_array(), [1.0, 2.0, 3.0]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FileFrame {
    /// Axis that points up; `None`: y in glTF, as its specification says, and z in the other formats.
    pub up: Option<UpAxis>,
    /// Metres for each unit of the file: 0.001 for millimetres. Coordinates are multiplied by it in double precision. It lies
    /// in [`SCALE_RANGE`].
    pub scale: f64,
}

impl Default for FileFrame {
    fn default() -> Self {
        Self { up: None, scale: 1.0 }
    }
}

impl FileFrame {
    /// A vertex of the file in the global frame, metres. `usual` is the axis that points up if none is given.
    pub fn global(&self, [x, y, z]: [f64; 3], usual: UpAxis) -> DVec3 {
        let turned = match self.up.unwrap_or(usual) {
            // Adding zero turns -0 into +0.
            UpAxis::Y => DVec3::new(x, -z + 0.0, y),
            UpAxis::Z => DVec3::new(x, y, z),
        };
        turned * self.scale
    }

    /// Triangles of a file with the axes and the unit that are given. With neither they are not changed: no axis is turned, whatever
    /// the format says. Each coordinate is rounded once, by its multiplication.
    ///
    /// # Errors
    /// A coordinate that becomes too large.
    pub fn triangles(&self, triangles: Triangles) -> Result<Triangles, SceneError> {
        if *self == Self::default() {
            return Ok(triangles);
        }
        let vertices = triangles.vertices().iter().map(|&vertex| self.global(vertex, UpAxis::Z).to_array());
        Triangles::new(vertices.collect(), triangles.faces().to_vec())
    }

    /// Whether a glTF file is taken as its specification says: y up, in metres.
    pub(crate) fn is_of_gltf(&self) -> bool {
        self.up != Some(UpAxis::Z) && self.scale == 1.0
    }
}
