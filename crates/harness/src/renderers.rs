//! The renderers of this house, by name, and which of the paper's approximations each makes.

use std::fmt;

use raypencil_referee::ExactRenderer;
use raypencil_scanline::{Fidelity, Options, Scanline, Switches};
use raypencil_scene::Renderer;
use raypencil_tracer::Tracer;

/// The names [`contender`] knows.
pub const RENDERER_NAMES: &[&str] = &["scanline", "scanline-paper", "tracer", "referee"];

/// A renderer to be compared with others.
pub struct Contender {
    /// The renderer.
    pub renderer: Box<dyn Renderer>,
    /// Which side each of its switches stands on; `None` for a renderer that has none.
    pub switches: Option<Switches>,
}

impl Contender {
    /// The scanline renderer with these switches.
    pub fn scanline(switches: Switches) -> Self {
        let options = Options { switches, ..Options::EXACT };
        Self { renderer: Box::new(Scanline::new(options)), switches: Some(switches) }
    }

    /// The same with one switch set; a renderer without switches stays as it is.
    ///
    /// # Errors
    /// If there is no switch of that name: says which there are.
    pub fn with_switch(self, name: &str, fidelity: Fidelity) -> Result<Self, String> {
        // The name is judged even where no switch is set.
        let mut switches = self.switches.unwrap_or_default();
        switches.set(name, fidelity).map_err(|error| error.to_string())?;
        Ok(if self.switches.is_some() { Self::scanline(switches) } else { self })
    }

    /// The approximations that it makes; none for a renderer without switches.
    pub fn approximations(&self) -> Switches {
        self.switches.unwrap_or(Switches::EXACT)
    }
}

impl<R: Renderer + 'static> From<R> for Contender {
    /// A renderer that has no switches.
    fn from(renderer: R) -> Self {
        Self { renderer: Box::new(renderer), switches: None }
    }
}

impl fmt::Debug for Contender {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Contender").field(&self.renderer.name()).finish()
    }
}

/// A renderer by its name.
pub fn contender(name: &str) -> Option<Contender> {
    match name {
        "scanline" => Some(Contender::scanline(Switches::EXACT)),
        "scanline-paper" => Some(Contender::scanline(Switches::PAPER)),
        "tracer" => Some(Tracer::new().into()),
        "referee" => Some(ExactRenderer.into()),
        _ => None,
    }
}
