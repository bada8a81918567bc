//! What a renderer is: anything that turns a scene into a frame.

use crate::{RenderOutput, Request, Scene};

/// A program, or the recording of one, that renders the maps of a scene's sensors.
///
/// A render does no IO and cannot fail: a [`Scene`] is valid by construction. What a renderer does not
/// compute it leaves out of the frame.
pub trait Renderer: Sync {
    /// A short name, fit for a folder.
    fn name(&self) -> &str;

    /// How fine the renderer's arithmetic is; the bounds it is judged by follow from this.
    fn precision(&self) -> Precision;

    /// Renders what `request` asks for.
    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput;
}

/// How finely a renderer computes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Precision {
    /// Unit roundoff u of its arithmetic: the largest relative error of one operation.
    pub unit_roundoff: f64,
}

impl Precision {
    /// IEEE 754 binary64 throughout, u = 2^-53.
    pub const F64: Self = Self { unit_roundoff: f64::EPSILON / 2.0 };
    /// IEEE 754 binary32 throughout, u = 2^-24.
    pub const F32: Self = Self { unit_roundoff: f32::EPSILON as f64 / 2.0 };
}
