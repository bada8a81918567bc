//! The renderers of this house, by name, and which of the paper's approximations each makes.

use std::fmt;

use raypencil_judge::{Attributions, Judge};
use raypencil_referee::ExactRenderer;
use raypencil_scanline::{Scanline, ScanlineOptions};
use raypencil_scene::{Fidelity, Precision, RenderOutput, Renderer, Request, Switches};
use raypencil_scene_io::quoted;
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
        let options = ScanlineOptions { switches, ..ScanlineOptions::EXACT };
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

/// The words that choose these renderers on the command line: `--with scanline,tracer --switch beam-edges=paper`.
/// Switches are meant for every scanline renderer among them.
pub fn typed_contenders(contenders: &[&Contender]) -> String {
    let name = |contender: &&Contender| match contender.switches {
        None => quoted(contender.renderer.name()),
        Some(Switches::PAPER) => "scanline-paper".into(),
        Some(_) => "scanline".into(),
    };
    let names: Vec<String> = contenders.iter().map(name).collect();
    let mut words = format!("--with {}", names.join(","));
    let set = contenders.iter().filter_map(|contender| contender.switches);
    for switches in set.filter(|switches| *switches != Switches::PAPER) {
        let on = switches.iter().filter(|(_, fidelity)| *fidelity == Fidelity::Paper);
        on.for_each(|(name, fidelity)| words += &format!(" --switch {name}={fidelity}"));
    }
    words
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

/// Finds the causes of what `output` has wrong, which the scanline renderer made of the judge's scene with `switches`.
pub fn attribute(
    judge: &Judge<'_>,
    output: &RenderOutput,
    switches: Switches,
    precision: Precision,
) -> Attributions {
    let rerender = |switches: Switches, request: Request| {
        Scanline::new(ScanlineOptions { switches, ..ScanlineOptions::EXACT }).render(judge.scene(), &request)
    };
    Attributions::find(judge, output, switches, precision, &rerender)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contenders_are_typed_as_the_command_line_takes_them() {
        let named = |name| contender(name).expect("a renderer of this house");
        assert_eq!(typed_contenders(&[&named("scanline"), &named("tracer")]), "--with scanline,tracer");
        assert_eq!(
            typed_contenders(&[&named("tracer"), &named("scanline-paper")]),
            "--with tracer,scanline-paper"
        );
        let switched = named("scanline").with_switch("facing", Fidelity::Paper).expect("a switch");
        assert_eq!(
            typed_contenders(&[&switched, &named("referee")]),
            "--with scanline,referee --switch facing=paper"
        );
    }
}
