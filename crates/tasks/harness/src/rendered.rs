//! The output of one renderer.

use std::time::Duration;

use raypencil_judge::{Attributions, Side};
use raypencil_scene::{Precision, RenderOutput, SensorId, Switches};

/// The output of one renderer for the scene, and how it was computed.
#[derive(Debug)]
pub struct Rendered {
    /// The renderer's name.
    pub name: String,
    /// The precision of its arithmetic.
    pub precision: Precision,
    /// The paper's approximations that it makes.
    pub approximations: Switches,
    /// The errors that these approximations caused.
    pub attributions: Attributions,
    /// The maps and images.
    pub output: RenderOutput,
    /// Wall-clock time of the whole render.
    pub time: Duration,
}

impl Rendered {
    /// Path of the map of `sensor`, relative to the folder of the validation.
    pub(crate) fn map_file(&self, sensor: SensorId) -> String {
        format!("{}/{sensor}.exr", self.name)
    }

    /// This output as one side of a comparison.
    pub fn side(&self) -> Side<'_> {
        Side {
            name: &self.name,
            output: &self.output,
            precision: self.precision,
            attributions: Some(&self.attributions),
        }
    }
}
