//! The renderers of a command and their switches.

use clap::Args;
use raypencil::Fidelity;
use raypencil::io::quoted;

use crate::parsers::switch;

/// Switches of the scanline renderer.
#[derive(Debug, Default, Args)]
pub(crate) struct SwitchArguments {
    /// Set a switch of the scanline renderer to the paper's approximation or to exact. Switches: beam-edges,
    /// skip-rules, facing, extent, place. May be repeated.
    #[arg(long = "switch", value_name = "NAME=paper|exact", value_parser = switch)]
    pub(crate) set: Vec<(String, Fidelity)>,
}

/// The default renderers of a comparison.
pub(crate) const DEFAULT_WITH: [&str; 2] = ["scanline", "tracer"];

/// The arguments that choose renderers, as typed after a scene; empty for the default.
pub(crate) fn typed_renderers(with: &[String], switches: &SwitchArguments) -> String {
    let mut text = String::new();
    if with != DEFAULT_WITH {
        let names: Vec<String> = with.iter().map(|name| quoted(name)).collect();
        text.push_str(&format!(" --with {}", names.join(",")));
    }
    for (name, fidelity) in &switches.set {
        text.push_str(&format!(" --switch {name}={fidelity}"));
    }
    text
}
