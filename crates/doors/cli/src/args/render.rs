//! The arguments of `render`.

use std::path::PathBuf;

use clap::Args;
use raypencil::harness::MapFormat;

use crate::args::renderers::SwitchArguments;
use crate::args::scene::SceneArguments;
use crate::parsers::map_format;

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # Every quantity of every ray, as EXR.
  raypencil render pyramids --with tracer -o out/maps
  # One random ray in each pencil, as NPY.
  raypencil render ground.glb --with tracer --jitter 1 --format npy -o out/jittered")]
pub(crate) struct Render {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,

    /// The renderer: scanline, scanline-paper, tracer or referee.
    #[arg(long, value_name = "NAME")]
    pub(crate) with: String,

    /// Trace one random ray within each pencil, drawn with this seed, instead of the central ray.
    #[arg(long, value_name = "SEED", allow_hyphen_values = true)]
    pub(crate) jitter: Option<u64>,

    #[command(flatten)]
    pub(crate) switches: SwitchArguments,

    /// Format of the maps.
    #[arg(long, value_name = "FORMAT", default_value = "exr", value_parser = map_format())]
    pub(crate) format: MapFormat,

    /// Output folder.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
}
