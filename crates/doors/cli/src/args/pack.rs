//! The arguments of `pack`.

use std::path::PathBuf;

use clap::Args;

use crate::args::scene::SceneArguments;
use crate::parsers;

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # A scene, its rays, and the exact answer to each.
  raypencil pack data/scenes/pyramids-small.toml -o out/pack
  # The questions alone; check knows the answers.
  raypencil pack --blind 7 -o out/blind
  # A pack to pass on.
  raypencil pack facets --pack-version 1.0.0 --licence CC0-1.0 -o out/shared
  # Rays of your own on a mesh.
  raypencil pack data/rays/cube.obj --rays data/rays/cube.npy -o out/cube-pack
  # Those of a LiDAR.
  raypencil pack data/rays/cube.obj --rays data/rays/vlp16.toml -o out/vlp16-pack")]
pub(crate) struct Pack {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,

    /// Write a difficult random scene with this seed, and its rays without answers; `check` computes the answers.
    #[arg(long, value_name = "SEED", conflicts_with_all = ["scene", "fan", "thickness", "flux", "at", "heading", "settings"])]
    pub(crate) blind: Option<u64>,

    /// Leave the scene as it is. Without this, plates and beams are added whose rays meet every limit of the contract
    /// exactly: edges, backs, the maximum range, ties.
    #[arg(long, conflicts_with = "blind")]
    pub(crate) no_bench: bool,

    /// Write an input pack: a glTF file with all that a loader can get wrong, and the triangles that it must become.
    #[arg(long, conflicts_with_all = ["blind", "no_bench", "scene", "fan", "thickness", "flux", "at", "heading", "settings"])]
    pub(crate) input: bool,

    /// Write a pack of rays: SCENE is a mesh, and these are rays on it: NPY, CSV, or a .toml with patterns. Of several patterns
    /// each is a pack of its own, in DIR/NAME.
    #[arg(
        long,
        value_name = "RAYS",
        requires = "scene",
        conflicts_with_all = ["blind", "no_bench", "input", "fan", "thickness", "flux", "at", "heading", "settings"]
    )]
    pub(crate) rays: Option<PathBuf>,

    /// With --rays: let rays pass through the backs of faces.
    // `requires` alone says nothing beside an argument that --rays cannot stand beside.
    #[arg(
        long,
        requires = "rays",
        conflicts_with_all = ["blind", "no_bench", "input", "fan", "thickness", "flux", "at", "heading", "settings"]
    )]
    pub(crate) fronts_only: bool,

    /// Version of the pack itself, such as 1.0.0: for packs that are passed on.
    #[arg(long, value_name = "VERSION", value_parser = parsers::pack_version, conflicts_with_all = ["input", "rays"])]
    pub(crate) pack_version: Option<String>,

    /// Licence of the pack itself, as an SPDX expression such as CC0-1.0.
    #[arg(long, value_name = "SPDX", value_parser = parsers::licence, conflicts_with_all = ["input", "rays"])]
    pub(crate) licence: Option<String>,

    /// Output folder.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
}
