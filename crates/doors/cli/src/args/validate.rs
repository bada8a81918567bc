//! The arguments of `validate`.

use std::path::PathBuf;

use clap::Args;
use raypencil::judge::JudgeShare;

use crate::args::declared::DeclaredArguments;
use crate::args::renderers::{DEFAULT_WITH, SwitchArguments};
use crate::args::scene::SceneArguments;
use crate::parsers::judge_share;

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # The default rig on a ground of your own, turned to the left.
  raypencil validate ground.glb --at 3,-2 --heading 45
  # The paper's approximations against exact rays; a thick sheet makes them visible.
  raypencil validate pyramids --with scanline-paper,tracer --thickness 80 -o out/paper
  # Another program's answers, judged beside the two renderers.
  raypencil validate facets --candidate my-renders --judge all")]
pub(crate) struct Validate {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,

    /// Two or more renderers to compare: scanline, scanline-paper, tracer, referee.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', default_values = DEFAULT_WITH)]
    pub(crate) with: Vec<String>,

    #[command(flatten)]
    pub(crate) switches: SwitchArguments,

    /// Share of the agreeing rays that the referee checks; it always checks the rays that differ.
    #[arg(long, value_name = "WHICH", default_value = "sample", value_parser = judge_share())]
    pub(crate) judge: JudgeShare,

    /// Folder with another program's answers to this scene, to be checked beside the renderers. May be repeated.
    #[arg(long = "candidate", value_name = "DIR")]
    pub(crate) candidates: Vec<PathBuf>,

    #[command(flatten)]
    pub(crate) declared: DeclaredArguments,

    /// Whether a wrong candidate makes the exit code 1. With `=false` the reports still call it wrong.
    #[arg(
        long,
        value_name = "BOOL",
        default_value_t = true,
        default_missing_value = "true",
        num_args = 0..=1,
        require_equals = true,
        action = clap::ArgAction::Set
    )]
    pub(crate) candidates_must_pass: bool,

    /// Exit with code 0 also if no ray of any sensor hits the terrain. Without it that is exit code 1.
    #[arg(long)]
    pub(crate) allow_empty: bool,

    /// Output folder; default: out/<scene's name>.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

impl Validate {
    /// The default command: the built-in pyramids.
    pub(crate) fn pyramids() -> Self {
        Self {
            scene: SceneArguments {
                scene: "pyramids".into(),
                fan: None,
                thickness: None,
                flux: None,
                at: None,
                heading: None,
                settings: Vec::new(),
            },
            with: DEFAULT_WITH.map(String::from).to_vec(),
            switches: SwitchArguments::default(),
            judge: JudgeShare::Sample,
            candidates: Vec::new(),
            declared: DeclaredArguments::default(),
            candidates_must_pass: true,
            allow_empty: false,
            output: None,
        }
    }
}
