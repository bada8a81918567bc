//! The arguments of `probe`.

use std::path::PathBuf;

use clap::Args;

use crate::args::declared::DeclaredArguments;
use crate::args::renderers::{DEFAULT_WITH, SwitchArguments};
use crate::args::scene::SceneArguments;
use crate::parsers::pair;

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # One pencil of the first beam.
  raypencil probe pyramids --beam 0 --pencil 412,3
  # One pixel, by the paper's approximations too.
  raypencil probe pyramids --pixel 412,300 --with scanline-paper,tracer")]
pub(crate) struct Probe {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,

    /// Index of the beam, from 0.
    #[arg(long, value_name = "N", requires = "pencil", conflicts_with = "pixel")]
    pub(crate) beam: Option<usize>,

    /// Column and row of the beam's pencil, from 0; row 0 is at the top.
    #[arg(long, value_name = "I,J", value_parser = pair::<u32>, requires = "beam")]
    pub(crate) pencil: Option<[u32; 2]>,

    /// Column and row of the camera's pixel, from 0; row 0 is at the top.
    #[arg(long, value_name = "I,J", value_parser = pair::<u32>, required_unless_present = "beam")]
    pub(crate) pixel: Option<[u32; 2]>,

    /// Renderers to ask: scanline, scanline-paper, tracer, referee.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', default_values = DEFAULT_WITH)]
    pub(crate) with: Vec<String>,

    /// Folder with another program's answers to this scene, to be asked beside the renderers. May be repeated.
    #[arg(long = "candidate", value_name = "DIR")]
    pub(crate) candidates: Vec<PathBuf>,

    #[command(flatten)]
    pub(crate) declared: DeclaredArguments,

    #[command(flatten)]
    pub(crate) switches: SwitchArguments,
}
