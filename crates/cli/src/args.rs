//! The command line's words.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use raypencil_harness::Fidelity;
use raypencil_scene::FluxModel;
use raypencil_scene_io::Overrides;

/// A Mars rover's structured-light vision, simulated twice by two unlike algorithms and compared ray by ray.
///
/// Without a command it validates the built-in pyramids into out/pyramids.
///
/// Exit codes are those of diff: 0 all agree, 1 a defect or difference, 2 trouble.
#[derive(Debug, Parser)]
#[command(name = "raypencil", version)]
pub(crate) struct Arguments {
    /// Print JSON instead of a screen.
    #[arg(long, global = true)]
    pub(crate) json: bool,

    /// Worker threads; all cores if not given. Results do not depend on it.
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,

    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a scene with every renderer, compare every ray, write maps and a report.
    Validate(Validate),
    /// Render a scene with one renderer and write its maps.
    Render(Render),
    /// Everything about one ray, from every renderer.
    Probe(Probe),
}

/// Which scene.
#[derive(Debug, Args)]
pub(crate) struct SceneArguments {
    /// A built-in ground (pyramids, facets), a scene .toml, or a terrain .glb or .gltf.
    #[arg(value_name = "SCENE", default_value = "pyramids")]
    pub(crate) scene: String,

    /// Full fan angle of every beam, degrees.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub(crate) fan: Option<f64>,

    /// Thickness of every beam's sheet, millimetres.
    #[arg(long, value_name = "MM", allow_hyphen_values = true)]
    pub(crate) thickness: Option<f64>,

    /// Equation of a pencil's flux; the scene's own if not given.
    #[arg(long, value_name = "MODEL")]
    pub(crate) flux: Option<FluxWord>,

    /// Stand here on the ground: global x,y in metres.
    #[arg(long, value_name = "X,Y", value_parser = pair::<f64>, allow_hyphen_values = true)]
    pub(crate) at: Option<[f64; 2]>,

    /// Heading, degrees to the left of the global x axis.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub(crate) heading: Option<f64>,
}

impl SceneArguments {
    pub(crate) fn overrides(&self) -> Overrides {
        Overrides {
            at: self.at,
            heading_deg: self.heading,
            fan_deg: self.fan,
            thickness_mm: self.thickness,
            flux_model: self.flux.map(|word| match word {
                FluxWord::Radiometric => FluxModel::Radiometric,
                FluxWord::Eq1 => FluxModel::Eq1,
            }),
        }
    }

    /// These arguments again, as one would type them.
    pub(crate) fn typed(&self) -> String {
        let mut words = vec![quoted(&self.scene)];
        if let Some(fan) = self.fan {
            words.push(format!("--fan {fan}"));
        }
        if let Some(thickness) = self.thickness {
            words.push(format!("--thickness {thickness}"));
        }
        match self.flux {
            Some(FluxWord::Radiometric) => words.push("--flux radiometric".into()),
            Some(FluxWord::Eq1) => words.push("--flux eq1".into()),
            None => {}
        }
        if let Some([x, y]) = self.at {
            words.push(format!("--at {x},{y}"));
        }
        if let Some(heading) = self.heading {
            words.push(format!("--heading {heading}"));
        }
        words.join(" ")
    }
}

/// What `--flux` takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FluxWord {
    /// What a pencil's watts really deliver, in watts.
    Radiometric,
    /// Equation (1) of the paper as printed, in W/m.
    Eq1,
}

/// A word as a shell takes it for one.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "._-/+@%:,=".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_string()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// Which sides of the scanline renderer's switches.
#[derive(Debug, Default, Args)]
pub(crate) struct SwitchArguments {
    /// Set a switch of the scanline renderer to the paper's approximation or to exact: beam-edges, skip-rules,
    /// facing, extent, place. May be given several times.
    #[arg(long = "switch", value_name = "NAME=paper|exact", value_parser = switch)]
    pub(crate) set: Vec<(String, Fidelity)>,
}

/// The renderers that are compared if none are named.
const DEFAULT_WITH: [&str; 2] = ["scanline", "tracer"];

/// The words that choose renderers, as one would type them after a scene; nothing for the default.
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

/// What `--judge` takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum JudgeWhich {
    /// One in a hundred or more.
    Sample,
    /// Every ray.
    All,
}

#[derive(Debug, Args)]
pub(crate) struct Validate {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,

    /// Renderers to compare, two or more.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', default_values = DEFAULT_WITH)]
    pub(crate) with: Vec<String>,

    #[command(flatten)]
    pub(crate) switches: SwitchArguments,

    /// Which of the rays that agree the referee rules on as well; it always rules on those that do not.
    #[arg(long, value_name = "WHICH", default_value = "sample")]
    pub(crate) judge: JudgeWhich,

    /// Folder to write to; out/<scene's name> if not given.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

impl Validate {
    /// What `raypencil` does without a command.
    pub(crate) fn pyramids() -> Self {
        Self {
            scene: SceneArguments {
                scene: "pyramids".into(),
                fan: None,
                thickness: None,
                flux: None,
                at: None,
                heading: None,
            },
            with: DEFAULT_WITH.map(String::from).to_vec(),
            switches: SwitchArguments::default(),
            judge: JudgeWhich::Sample,
            output: None,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct Render {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,

    /// The renderer.
    #[arg(long, value_name = "NAME")]
    pub(crate) with: String,

    /// Draw one ray at random within each pencil, by this seed, instead of its central ray.
    #[arg(long, value_name = "SEED", allow_hyphen_values = true)]
    pub(crate) jitter: Option<u64>,

    #[command(flatten)]
    pub(crate) switches: SwitchArguments,

    /// Folder to write to.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct Probe {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,

    /// Index of the beam whose pencil to probe, from 0.
    #[arg(long, value_name = "N", requires = "pencil", conflicts_with = "pixel")]
    pub(crate) beam: Option<usize>,

    /// Column and row of the pencil, from 0; row 0 is on top.
    #[arg(long, value_name = "I,J", value_parser = pair::<u32>, requires = "beam")]
    pub(crate) pencil: Option<[u32; 2]>,

    /// Column and row of the camera's pixel, from 0; row 0 is on top.
    #[arg(long, value_name = "I,J", value_parser = pair::<u32>, required_unless_present = "beam")]
    pub(crate) pixel: Option<[u32; 2]>,

    /// Renderers to ask.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', default_values = DEFAULT_WITH)]
    pub(crate) with: Vec<String>,

    #[command(flatten)]
    pub(crate) switches: SwitchArguments,
}

/// `NAME=paper` or `NAME=exact`; the name is judged where the switches are known.
fn switch(text: &str) -> Result<(String, Fidelity), String> {
    let (name, side) = text.split_once('=').unwrap_or((text, ""));
    match side {
        "paper" => Ok((name.into(), Fidelity::Paper)),
        "exact" => Ok((name.into(), Fidelity::Exact)),
        _ => Err("expected a switch and its side, such as beam-edges=paper or skip-rules=exact".into()),
    }
}

/// `A,B`.
fn pair<T: std::str::FromStr>(text: &str) -> Result<[T; 2], String> {
    let wrong = || "expected two numbers with a comma between them, such as 3,4".to_string();
    let (a, b) = text.split_once(',').ok_or_else(wrong)?;
    let one = |text: &str| text.trim().parse().map_err(|_| wrong());
    Ok([one(a)?, one(b)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_words_are_well_formed() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn what_was_typed_comes_back_as_a_shell_would_take_it() {
        let parse = |words: &[&str]| {
            let words = ["raypencil", "validate"].into_iter().chain(words.iter().copied());
            match Arguments::try_parse_from(words).unwrap().command {
                Some(Command::Validate(validate)) => validate.scene.typed(),
                other => panic!("{other:?}"),
            }
        };
        assert_eq!(parse(&[]), "pyramids");
        assert_eq!(
            parse(&["my yard.glb", "--at", "-1.5,2", "--heading", "-90", "--fan", "120"]),
            "'my yard.glb' --fan 120 --at -1.5,2 --heading -90"
        );
    }
}
