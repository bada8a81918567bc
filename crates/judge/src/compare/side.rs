use crate::attribution::cause::Attributions;
use raypencil_scene::{Precision, RenderOutput};

/// One side of a comparison.
#[derive(Debug, Clone, Copy)]
pub struct Side<'a> {
    /// The renderer's name.
    pub name: &'a str,
    /// What it rendered.
    pub output: &'a RenderOutput,
    /// How finely it computes.
    pub precision: Precision,
    /// The causes of its errors, if it follows the paper into some.
    pub attributions: Option<&'a Attributions>,
}
