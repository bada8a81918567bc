//! One side of a comparison: a renderer and its output.

use crate::attribution::cause::Attributions;
use raypencil_scene::{Precision, RenderOutput};

/// One side of a comparison.
#[derive(Debug, Clone, Copy)]
pub struct Side<'a> {
    /// Name of the renderer.
    pub name: &'a str,
    /// Output of the renderer.
    pub output: &'a RenderOutput,
    /// Precision that the renderer declares.
    pub precision: Precision,
    /// Causes of the renderer's errors, if it follows the paper into some.
    pub attributions: Option<&'a Attributions>,
}
