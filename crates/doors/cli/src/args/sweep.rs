//! The arguments of `sweep`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use raypencil::campaign::Shard;
use raypencil::sweep::{Axis, Chart, Task};

use crate::parsers::{axis, chart, shard, task};

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true)]
#[command(after_help = "Examples:
  # Every combination of four pitches and two thicknesses.
  raypencil sweep pyramids --set camera.pitch_down_deg=20:35:5 --set beam.thickness_mm=2,4
  # A drive over each of three grounds.
  raypencil sweep data/scenes/rocky-drive.toml --set terrain.generate.seed=1,2,3 --do drive
  # Runs that a table lists.
  raypencil sweep data/designs/rover.toml --list data/designs/runs.csv --do drive -o out/designs")]
pub(crate) struct Sweep {
    #[command(subcommand)]
    pub(crate) command: Option<SweepCommand>,

    #[command(flatten)]
    pub(crate) run: SweepRun,
}

#[derive(Debug, Subcommand)]
pub(crate) enum SweepCommand {
    /// Join the parts of a sweep that were made by --shard, in any order.
    Merge(SweepMerge),
}

#[derive(Debug, Args)]
pub(crate) struct SweepRun {
    /// A built-in terrain (pyramids, facets), a scene .toml, a terrain (.glb, .gltf, .stl, .obj, .ply), or an
    /// elevation model .tif.
    #[arg(value_name = "SCENE", default_value = "pyramids")]
    pub(crate) scene: String,

    /// A key of the scene file with its values, in the file's units: beam.0.pitch_down_deg=20:35:5 (first, last, step) or
    /// terrain.generate.seed=1,2,3. Of several keys every combination is run. May be repeated.
    #[arg(long, value_name = "KEY=VALUES", value_parser = axis)]
    pub(crate) set: Vec<Axis>,

    /// CSV file with keys in its first line and a run in each line below; with --set, each of its runs is combined with all
    /// values.
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) list: Option<PathBuf>,

    /// What is done with each scene.
    #[arg(long = "do", value_name = "TASK", default_value = "validate", value_parser = task())]
    pub(crate) task: Task,

    /// Renderers; default: scanline,tracer to validate, else scanline, with --as-printed scanline-paper.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(crate) with: Vec<String>,

    /// With --do drive: drive as the paper prints it.
    #[arg(long)]
    pub(crate) as_printed: bool,

    /// Draw a result against a parameter; with a second parameter, a line for each of its values. May be repeated. Of
    /// images and drives the main results are drawn against each parameter anyhow; of --do validate nothing else is.
    #[arg(long, value_name = "RESULT,KEY[,KEY]", value_parser = chart)]
    pub(crate) chart: Vec<Chart>,

    /// Run part I of N, from 1; `sweep merge` joins the parts.
    #[arg(long, value_name = "I/N", value_parser = shard, default_value = "1/1")]
    pub(crate) shard: Shard,

    /// Output folder; a sweep that was interrupted there is resumed.
    #[arg(short, long, value_name = "DIR", default_value = "out/sweep")]
    pub(crate) output: PathBuf,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # Both parts of a sweep.
  raypencil sweep merge out/part-1 out/part-2 -o out/sweep")]
pub(crate) struct SweepMerge {
    /// Folders of the parts.
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folders: Vec<PathBuf>,

    /// Draw a result against a parameter, as above.
    #[arg(long, value_name = "RESULT,KEY[,KEY]", value_parser = chart)]
    pub(crate) chart: Vec<Chart>,

    /// Folder for the table and the charts.
    #[arg(short, long, value_name = "DIR", default_value = "out/sweep")]
    pub(crate) output: PathBuf,
}
