//! The arguments of `minimise`.

use std::path::PathBuf;

use clap::Args;
use raypencil::judge::Class;

use crate::args::renderers::{DEFAULT_WITH, SwitchArguments};
use crate::args::scene::SceneArguments;
use crate::parsers::class;

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # The smallest ground on which the paper errs by what it asks at the centre of a pixel.
  raypencil minimise pyramids --with scanline,tracer --switch place=paper --class approximation
  # A defect between two renderers, on a ground of your own.
  raypencil minimise ground.glb -o out/smallest")]
pub(crate) struct Minimise {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,

    /// Class of the difference that the reduced scene must keep on at least one ray.
    #[arg(long, value_name = "CLASS", default_value = "defect", value_parser = class())]
    pub(crate) class: Class,

    /// Two renderers to compare: scanline, scanline-paper, tracer, referee.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', default_values = DEFAULT_WITH)]
    pub(crate) with: Vec<String>,

    #[command(flatten)]
    pub(crate) switches: SwitchArguments,

    /// Output folder for the reduced scene.
    #[arg(short, long, value_name = "DIR", default_value = "out/minimised")]
    pub(crate) output: PathBuf,
}
