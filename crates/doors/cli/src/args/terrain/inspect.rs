//! The arguments of `terrain inspect`.

use std::path::PathBuf;

use clap::Args;
use raypencil::io::Setting;

use super::dem::DemArgs;
use crate::parsers::setting;

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # Open edges, wrong windings and other faults.
  raypencil terrain inspect ground.glb
  # The units, the unknown heights and the spikes of an elevation model.
  raypencil terrain inspect dem.tif
  # The same, repaired where only one repair is possible.
  raypencil terrain inspect ground.glb --repair -o out/repaired.glb")]
pub(crate) struct TerrainInspect {
    /// A terrain (.glb, .gltf, .stl, .obj, .ply), an elevation model (.tif), a scene .toml, or a built-in terrain (pyramids,
    /// facets).
    #[arg(value_name = "MESH")]
    pub(crate) mesh: String,

    /// Set a key of the scene file MESH, as in `validate`. May be repeated.
    #[arg(long, value_name = "KEY=VALUE", value_parser = setting)]
    pub(crate) set: Vec<Setting>,

    #[command(flatten)]
    pub(crate) dem: DemArgs,

    /// Remove faces without area, duplicate faces and unused vertices, weld vertices at the same position, and flip
    /// inverted faces. The exit code is then that of the repaired mesh.
    #[arg(long, requires = "output")]
    pub(crate) repair: bool,

    /// File for the repaired mesh, a .glb other than MESH.
    #[arg(short, long, value_name = "OUT.glb", requires = "repair")]
    pub(crate) output: Option<PathBuf>,
}
