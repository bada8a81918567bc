//! The renderer trait: a program that turns a scene into maps.

use crate::{RenderOutput, Request, Scene};

/// A program, or the recording of one, that renders the maps of a scene's sensors.
///
/// A render does no IO and cannot fail: a [`Scene`] is valid by construction. A quantity that a renderer does not
/// compute is left out of its output.
///
/// ```
/// use raypencil_scene::{Precision, RenderOutput, Renderer, Request, Scene};
///
/// /// A renderer that computes nothing: every quantity is absent, which reports show as 'not compared'.
/// struct Empty;
///
/// impl Renderer for Empty {
///     fn name(&self) -> &str {
///         "empty"
///     }
///
///     fn precision(&self) -> Precision {
///         Precision::F64
///     }
///
///     fn render(&self, _scene: &Scene, _request: &Request) -> RenderOutput {
///         RenderOutput { camera: None, beams: vec![], returns: vec![], flux: vec![], stages: vec![] }
///     }
/// }
///
/// assert_eq!(Empty.precision().unit_roundoff, 1.0 / (1_u64 << 53) as f64);
/// ```
pub trait Renderer: Sync {
    /// A short name, fit for a folder.
    fn name(&self) -> &str;

    /// Precision of the renderer's arithmetic. The bounds that judge it follow from this.
    fn precision(&self) -> Precision;

    /// Renders what `request` asks for.
    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput;
}

/// Precision of an arithmetic.
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
