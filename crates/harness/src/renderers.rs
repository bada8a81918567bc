//! The renderers of this house, by name.

use raypencil_referee::ExactRenderer;
use raypencil_scanline::Scanline;
use raypencil_scene::Renderer;
use raypencil_tracer::Tracer;

/// The names [`renderer`] knows.
pub const RENDERER_NAMES: &[&str] = &["scanline", "scanline-paper", "tracer", "referee"];

/// A renderer by its name.
pub fn renderer(name: &str) -> Option<Box<dyn Renderer>> {
    match name {
        "scanline" => Some(Box::new(Scanline::default())),
        // With the paper's own approximations, which are not attributed to their causes yet: against another
        // renderer each shows as a defect.
        "scanline-paper" => Some(Box::new(Scanline::paper())),
        "tracer" => Some(Box::new(Tracer::new())),
        "referee" => Some(Box::new(ExactRenderer)),
        _ => None,
    }
}
