//! The arguments of `campaign`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use raypencil::campaign::{PartName, Shard};
use raypencil::pack::Arithmetic;

use crate::parsers::{arithmetic, part_name, seconds, shard};

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true)]
#[command(after_help = "Examples:
  # A thousand random terrains.
  raypencil campaign --terrains 1000 --seed 7
  # One of four parts, to be merged.
  raypencil campaign --terrains 1000 --shard 1/4 -o out/part-1
  # A hunt in your own renderer.
  raypencil campaign --terrains 20 --candidate-command 'my-renderer {pack} {out}'")]
pub(crate) struct Campaign {
    #[command(subcommand)]
    pub(crate) command: Option<CampaignCommand>,

    #[command(flatten)]
    pub(crate) run: CampaignRun,
}

#[derive(Debug, Subcommand)]
pub(crate) enum CampaignCommand {
    /// Merge the results of all shards, in any order.
    Merge(CampaignMerge),
    /// Write one scene of a campaign, so that its rays can be probed.
    Replay(CampaignReplay),
}

#[derive(Debug, Args)]
pub(crate) struct CampaignRun {
    /// Number of terrains.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub(crate) terrains: u64,

    /// Seed of all random numbers; the same seed gives the same campaign.
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    pub(crate) seed: u64,

    /// Run part I of N of the campaign, from 1; `campaign merge` merges the parts.
    #[arg(long, value_name = "I/N", value_parser = shard, default_value = "1/1")]
    pub(crate) shard: Shard,

    /// Folder with scenes of your own (.toml), terrains (.glb, .gltf, .stl, .obj, .ply) or elevation models (.tif), in place
    /// of random ones.
    #[arg(long, value_name = "DIR", conflicts_with = "terrains")]
    pub(crate) scenes: Option<PathBuf>,

    /// Scene file whose vehicle, camera and beams stand on each terrain of --scenes.
    // `requires` alone says nothing beside an argument that --scenes cannot stand beside.
    #[arg(long, value_name = "SCENE.toml", requires = "scenes", conflicts_with = "terrains")]
    pub(crate) rig: Option<PathBuf>,

    /// Hunt in another renderer: the shell runs this for each scene, with {pack} replaced by the folder of a pack without
    /// answers and {out} by that for the answers, as `check` takes them. What it answers wrongly is left as packs of single rays.
    #[arg(long, value_name = "'PROGRAM {pack} {out}'")]
    pub(crate) candidate_command: Option<String>,

    /// Most time of the program for one scene, seconds; default: 1800. Then it is ended with all that it has started.
    #[arg(long, value_name = "SECONDS", requires = "candidate_command", value_parser = seconds)]
    pub(crate) timeout: Option<u64>,

    /// Take answers that do not say what a ray hits, such as a light alone; without it such a sensor has no answer.
    #[arg(long, requires = "candidate_command")]
    pub(crate) partial: bool,

    /// Arithmetic of the program. Default: as its candidate.json says, else f64.
    #[arg(long, value_name = "ARITHMETIC", requires = "candidate_command", value_parser = arithmetic())]
    pub(crate) arithmetic: Option<Arithmetic>,

    /// Scenes of each terrain, separated by commas; default: all.
    #[arg(long, value_name = "PART,...", value_delimiter = ',', value_parser = part_name())]
    pub(crate) parts: Vec<PartName>,

    /// Leave out grounds with more faces. A lattice, which has few faces of its own, stays.
    #[arg(long, value_name = "N")]
    pub(crate) max_faces: Option<u64>,

    /// Output folder; a campaign that was interrupted there is resumed.
    #[arg(short, long, value_name = "DIR", default_value = "out/campaign")]
    pub(crate) output: PathBuf,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # Both parts of a campaign.
  raypencil campaign merge out/part-1 out/part-2 -o out/campaign")]
pub(crate) struct CampaignMerge {
    /// Folders with the results of the shards.
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folders: Vec<PathBuf>,

    /// Folder for summary.json; without it none is written.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # The thirteenth terrain of a campaign, to be probed.
  raypencil campaign replay --seed 7 --terrain 12 -o out/terrain-12")]
pub(crate) struct CampaignReplay {
    /// Seed of the campaign.
    #[arg(long, value_name = "SEED")]
    pub(crate) seed: u64,

    /// Number of the terrain, from 0.
    #[arg(long, value_name = "K")]
    pub(crate) terrain: u64,

    /// Folder of the campaign's own scenes.
    #[arg(long, value_name = "DIR")]
    pub(crate) scenes: Option<PathBuf>,

    /// Scene file of its rig.
    #[arg(long, value_name = "SCENE.toml", requires = "scenes")]
    pub(crate) rig: Option<PathBuf>,

    /// Scene of that terrain.
    #[arg(long, value_name = "PART", default_value = "own", value_parser = part_name())]
    pub(crate) part: PartName,

    /// Output folder for scene.toml and its terrain.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
}
