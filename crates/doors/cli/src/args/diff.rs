//! The arguments of `diff`.

use std::path::PathBuf;

use clap::Args;
use raypencil::Precision;
use raypencil::io::Setting;

use crate::args::declared::DeclaredArguments;
use crate::parsers::{percent, precision, setting, threshold};

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # Two recordings, with 1 nm of tolerance.
  raypencil diff out/pyramids/scanline out/pyramids/tracer --fail 1e-9
  # A simulator's depth image against our depths; the option is for the side with such a channel.
  raypencil diff depth.tif out/maps --channel camera/depth.Z=depth --fail 1e-3 --shared-only
  # The referee rules where they differ.
  raypencil diff theirs ours --scene ground.glb -o out/diff")]
pub(crate) struct Diff {
    /// A file or a folder.
    #[arg(value_name = "A")]
    pub(crate) a: PathBuf,

    /// The file or folder to compare it with.
    #[arg(value_name = "B")]
    pub(crate) b: PathBuf,

    /// Allow an absolute difference of X, in the unit of the channel. A cell passes if --fail, --fail-relative or
    /// --fail-ulp allows its difference.
    #[arg(long, value_name = "X", default_value = "0", value_parser = threshold, allow_hyphen_values = true)]
    pub(crate) fail: f64,

    /// Allow a relative difference of X, relative to the larger of both numbers.
    #[arg(long, value_name = "X", default_value = "0", value_parser = threshold, allow_hyphen_values = true)]
    pub(crate) fail_relative: f64,

    /// Allow a difference of N units in the last place of the file with the lower precision.
    #[arg(long, value_name = "N", default_value = "0", value_parser = threshold, allow_hyphen_values = true)]
    pub(crate) fail_ulp: f64,

    /// Allow P percent of the cells of a channel to fail.
    #[arg(long, value_name = "P", default_value = "0", value_parser = percent, allow_hyphen_values = true)]
    pub(crate) fail_percent: f64,

    /// Fail if any cell differs by more than X, whatever the other options allow.
    #[arg(long, value_name = "X", value_parser = threshold, allow_hyphen_values = true)]
    pub(crate) hard_fail: Option<f64>,

    /// Ignore channels that only one side has.
    #[arg(long)]
    pub(crate) shared_only: bool,

    #[command(flatten)]
    pub(crate) declared: DeclaredArguments,

    /// The scene of both recordings. The referee then rules on each cell that differs by more than is allowed, and a
    /// channel fails only if a side is wrong. A built-in terrain, a scene .toml, a terrain (.glb, .gltf,
    /// .stl, .obj, .ply) or a .tif.
    #[arg(long, value_name = "SCENE")]
    pub(crate) scene: Option<String>,

    /// Set a key of the scene file SCENE, as in `validate`. May be repeated.
    #[arg(long, value_name = "KEY=VALUE", requires = "scene", value_parser = setting)]
    pub(crate) set: Vec<Setting>,

    /// Arithmetic in which both recordings were computed, for the referee. Default: for each as its candidate.json says,
    /// else f64.
    #[arg(long, value_name = "ARITHMETIC", requires = "scene", value_parser = precision())]
    pub(crate) arithmetic: Option<Precision>,

    /// Folder for report.html, junit.xml, summary.md and summary.json; without it none are written.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}
