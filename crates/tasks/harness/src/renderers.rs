//! raypencil's own renderers, by name, and which of the paper's approximations each makes.

use std::fmt;

use raypencil_judge::{Attributions, Judge};
use raypencil_referee::ExactRenderer;
use raypencil_scanline::{Scanline, ScanlineOptions};
use raypencil_scene::{Fidelity, Precision, RenderOutput, Renderer, Request, Switches};
use raypencil_scene_io::quoted;
use raypencil_tracer::Tracer;

/// The names that [`contender`] accepts.
pub const RENDERER_NAMES: &[&str] = &["scanline", "scanline-paper", "tracer", "referee"];

/// A renderer chosen for a comparison, with its switches.
///
/// ```
/// use raypencil_harness::{Contender, typed_contenders};
/// use raypencil_scene::{Fidelity, Switches};
/// use raypencil_tracer::Tracer;
///
/// let paper = Contender::scanline(Switches::PAPER);
/// let tracer = Contender::from(Tracer::new());
/// assert_eq!(typed_contenders(&[&paper, &tracer]), "--with scanline-paper,tracer");
/// // The tracer has no switches: it makes none of the paper's approximations, and setting one changes nothing.
/// let tracer = tracer.with_switch("facing", Fidelity::Paper).expect("a switch's name");
/// assert_eq!(tracer.approximations(), Switches::EXACT);
/// ```
pub struct Contender {
    /// The renderer.
    pub renderer: Box<dyn Renderer>,
    /// Its switches between the paper's approximations and exact computation; `None` for a renderer without any.
    pub switches: Option<Switches>,
}

impl Contender {
    /// The scanline renderer with these switches.
    pub fn scanline(switches: Switches) -> Self {
        let options = ScanlineOptions { switches, ..ScanlineOptions::EXACT };
        Self { renderer: Box::new(Scanline::new(options)), switches: Some(switches) }
    }

    /// This contender with one switch set; a renderer without switches stays as it is.
    ///
    /// # Errors
    /// There is no switch of that name; the message lists the names.
    pub fn with_switch(self, name: &str, fidelity: Fidelity) -> Result<Self, String> {
        // A wrong name is refused even for a renderer without switches.
        let mut switches = self.switches.unwrap_or_default();
        switches.set(name, fidelity).map_err(|error| error.to_string())?;
        Ok(if self.switches.is_some() { Self::scanline(switches) } else { self })
    }

    /// The paper's approximations that it makes; none for a renderer without switches.
    pub fn approximations(&self) -> Switches {
        self.switches.unwrap_or(Switches::EXACT)
    }
}

/// The command-line arguments that choose these renderers: `--with scanline,tracer --switch beam-edges=paper`.
/// A `--switch` applies to every scanline renderer among them.
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

/// Finds the causes of the errors in `output`, which the scanline renderer computed with `switches` for the judge's
/// scene.
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

/// The renderer of this name, one of [`RENDERER_NAMES`]; `None` for any other name.
///
/// ```
/// use raypencil_harness::contender;
/// use raypencil_scene::Switches;
///
/// // `scanline-paper` makes every approximation of the paper; `scanline` makes none.
/// assert_eq!(contender("scanline-paper").and_then(|it| it.switches), Some(Switches::PAPER));
/// assert_eq!(contender("scanline").and_then(|it| it.switches), Some(Switches::EXACT));
/// assert!(contender("mitsuba").is_none());
/// ```
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
        let named = |name| contender(name).expect("a renderer's name");
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
