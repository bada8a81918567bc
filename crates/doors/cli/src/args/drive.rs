//! The arguments of `drive`.

use std::path::PathBuf;

use clap::Args;

use crate::args::renderers::SwitchArguments;
use crate::args::scene::SceneArguments;
use crate::parsers::{pair, record, rule};

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # Both renderers in lockstep, 7.5 m towards the pyramids.
  raypencil drive pyramids --both
  # Your own ground, 3 m ahead, with a bag for ROS 2.
  raypencil drive ground.glb --to 3,0 --record mcap -o out/my-drive
  # Generated rocks, with the paper's printed rules.
  raypencil drive data/scenes/rocky-drive.toml --as-printed")]
pub(crate) struct Drive {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,

    /// Waypoint, metres ahead and to the left of the vehicle at its start; replaces the waypoints of the scene's drive.
    /// May be repeated.
    #[arg(long, value_name = "X,Y", value_parser = pair::<f64>, allow_hyphen_values = true)]
    pub(crate) to: Vec<[f64; 2]>,

    /// The waypoints of --to are in the global frame.
    #[arg(long, requires = "to")]
    pub(crate) to_global: bool,

    /// Drive as the paper prints it: ten frames a second, both beams lit together, the flux of equation 1 in W/m, points
    /// from the table, the printed rules of the maps, and a renderer with the paper's approximations.
    #[arg(long)]
    pub(crate) as_printed: bool,

    /// Put one rule of the maps in force as printed or mended. Rules: start, elevation, extrapolate, several,
    /// inconsistency, gap, settle, tests; start also takes footprint and circle. May be repeated.
    #[arg(long = "rule", value_name = "NAME=paper|mended", value_parser = rule)]
    pub(crate) rules: Vec<(String, String)>,

    /// Record for other programs: images (png, npy), points, maps, mcap (a bag of ROS 2), or all. Poses and sectors always are.
    #[arg(long, value_name = "WHAT", value_delimiter = ',', value_parser = record)]
    pub(crate) record: Vec<String>,

    /// Take the stripes from DIR/stripes.npy, as a recording has them, instead of the rover's own extraction.
    #[arg(long, value_name = "DIR")]
    pub(crate) stripes: Option<PathBuf>,

    /// Renderer of the rover's images; default: scanline, with --as-printed scanline-paper.
    #[arg(long, value_name = "NAME")]
    pub(crate) with: Option<String>,

    /// Drive with scanline and tracer in lockstep and report how far a difference between them propagates. Exit code 1:
    /// to a pixel of the digital image, or further.
    #[arg(long, conflicts_with = "with")]
    pub(crate) both: bool,

    #[command(flatten)]
    pub(crate) switches: SwitchArguments,

    /// Output folder; default: out/<scene's name>-drive.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}
