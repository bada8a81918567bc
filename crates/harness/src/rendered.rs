use std::time::Duration;

use raypencil_judge::{Attributions, Side};
use raypencil_scene::{Precision, RenderOutput, Switches};

/// What one renderer made of the scene.
#[derive(Debug)]
pub struct Rendered {
    /// The renderer's name.
    pub name: String,
    /// How finely it computes.
    pub precision: Precision,
    /// The paper's approximations that it makes.
    pub approximations: Switches,
    /// What they did.
    pub attributions: Attributions,
    /// Its maps.
    pub output: RenderOutput,
    /// Wall-clock time of the whole render.
    pub time: Duration,
}

impl Rendered {
    /// The renderer as one side of a comparison.
    pub fn side(&self) -> Side<'_> {
        Side {
            name: &self.name,
            output: &self.output,
            precision: self.precision,
            attributions: Some(&self.attributions),
        }
    }
}
