//! The arguments of the command line. Their doc comments are the help texts.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use raypencil::campaign::{PartName, Shard};
use raypencil::harness::MapFormat;
use raypencil::io::{DEFAULT_REFLECTIVITY, Overrides, Setting, UpAxis, quoted};
use raypencil::judge::{Class, JudgeShare};
use raypencil::sweep::{Axis, Chart, Task};
use raypencil::{CastRay, Fidelity, FluxModel, Precision};

use crate::parsers::{
    axis, chart, class, flux_model, judge_share, map_format, numbers, pair, part_name, percent, precision,
    ray, record, rule, setting, shard, switch, task, threshold, up_axis,
};

/// Simulates a Mars rover's structured-light vision system with two independent renderers and compares every ray.
///
/// Without a command it validates the built-in terrain `pyramids` and writes to out/pyramids.
///
/// Exit codes: 0 all agree, 1 a defect or a difference, 2 an error.
#[derive(Debug, Parser)]
#[command(name = "raypencil", version)]
pub(crate) struct Arguments {
    /// Print JSON instead of text.
    #[arg(long, global = true)]
    pub(crate) json: bool,

    /// Number of worker threads; default: all cores. Results do not depend on it.
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,

    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a scene with two or more renderers, compare every ray, write maps and a report.
    Validate(Validate),
    /// Render a scene with one renderer and write its maps.
    Render(Render),
    /// Print every renderer's answer to one ray, with the exact answer.
    Probe(Probe),
    /// Write a reference pack for other renderers: a scene, its rays and every answer, correctly rounded.
    Pack(Pack),
    /// Check another program's answers against a reference pack, ray by ray.
    Check(Check),
    /// Run both renderers on many random terrains and judge every difference.
    Campaign(Campaign),
    /// Reduce a scene to the smallest one on which two renderers still differ. Exit code 1: they do not differ.
    Minimise(Minimise),
    /// Drive a rover and write images, stripes, terrain map, obstacle map and navigator map.
    Drive(Drive),
    /// Run a scene with many settings: one table of parameters and results, and charts.
    Sweep(Sweep),
    /// Compare two recordings channel by channel: files or folders of EXR, NPY and PFM.
    Diff(Diff),
    /// Cast any rays on any mesh and answer them exactly: first hits with their ties, or all hits in order.
    Cast(Cast),
    /// Generate, import or inspect terrains.
    #[command(subcommand)]
    Terrain(TerrainCommand),
}

/// The scene, and what is changed in it.
#[derive(Debug, Args)]
pub(crate) struct SceneArguments {
    /// A built-in terrain (pyramids, facets), a scene .toml, a terrain (.glb, .gltf, .stl, .obj, .ply), or an
    /// elevation model .tif.
    #[arg(value_name = "SCENE", default_value = "pyramids")]
    pub(crate) scene: String,

    /// Full fan angle of every beam, degrees.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub(crate) fan: Option<f64>,

    /// Thickness of every beam, millimetres.
    #[arg(long, value_name = "MM", allow_hyphen_values = true)]
    pub(crate) thickness: Option<f64>,

    /// Flux model; default: the scene's.
    #[arg(long, value_name = "MODEL", value_parser = flux_model())]
    pub(crate) flux: Option<FluxModel>,

    /// Position of the vehicle on the ground: global x,y in metres.
    #[arg(long, value_name = "X,Y", value_parser = pair::<f64>, allow_hyphen_values = true)]
    pub(crate) at: Option<[f64; 2]>,

    /// Heading of the vehicle, degrees to the left of the global x axis.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub(crate) heading: Option<f64>,

    /// Set a key of the scene file, in the file's units: camera.pitch_down_deg=25, beam.0.thickness_mm=4; beam.KEY sets
    /// every beam. May be repeated; the other options come after it.
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = setting)]
    pub(crate) settings: Vec<Setting>,
}

impl SceneArguments {
    /// The changes of the scene.
    pub(crate) fn overrides(&self) -> Overrides {
        Overrides {
            at: self.at,
            heading_deg: self.heading,
            fan_deg: self.fan,
            thickness_mm: self.thickness,
            flux_model: self.flux,
            settings: self.settings.clone(),
        }
    }

    /// These arguments as typed on the command line.
    pub(crate) fn typed(&self) -> String {
        let mut words = vec![quoted(&self.scene)];
        if let Some(fan) = self.fan {
            words.push(format!("--fan {fan}"));
        }
        if let Some(thickness) = self.thickness {
            words.push(format!("--thickness {thickness}"));
        }
        if let Some(flux) = self.flux {
            words.push(format!("--flux {}", flux.word()));
        }
        if let Some([x, y]) = self.at {
            words.push(format!("--at {x},{y}"));
        }
        if let Some(heading) = self.heading {
            words.push(format!("--heading {heading}"));
        }
        words.extend(self.settings.iter().map(typed_setting));
        words.join(" ")
    }
}

/// A setting as typed on the command line.
pub(crate) fn typed_setting(setting: &Setting) -> String {
    format!("--set {}", quoted(&setting.to_string()))
}

/// Switches of the scanline renderer.
#[derive(Debug, Default, Args)]
pub(crate) struct SwitchArguments {
    /// Set a switch of the scanline renderer to the paper's approximation or to exact. Switches: beam-edges,
    /// skip-rules, facing, extent, place. May be repeated.
    #[arg(long = "switch", value_name = "NAME=paper|exact", value_parser = switch)]
    pub(crate) set: Vec<(String, Fidelity)>,
}

/// The default renderers of a comparison.
pub(crate) const DEFAULT_WITH: [&str; 2] = ["scanline", "tracer"];

/// The default renderer of a drive. It takes half the time of `tracer`, both on 224 and on 225,280 faces.
pub(crate) const DRIVE_WITH: &str = "scanline";

/// The arguments that choose renderers, as typed after a scene; empty for the default.
pub(crate) fn typed_renderers(with: &[String], switches: &SwitchArguments) -> String {
    let mut text = String::new();
    if with != DEFAULT_WITH {
        let names: Vec<String> = with.iter().map(|name| quoted(name)).collect();
        text.push_str(&format!(" --with {}", names.join(",")));
    }
    for (name, fidelity) in &switches.set {
        text.push_str(&format!(" --switch {name}={fidelity}"));
    }
    text
}

#[derive(Debug, Args)]
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
            candidates_must_pass: true,
            allow_empty: false,
            output: None,
        }
    }
}

#[derive(Debug, Args)]
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

#[derive(Debug, Args)]
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
    /// from the table, and the printed rules of the maps.
    #[arg(long)]
    pub(crate) as_printed: bool,

    /// Put one rule of the maps in force as printed or mended. Rules: start, elevation, extrapolate, several,
    /// inconsistency, gap, settle, tests; start also takes footprint. May be repeated.
    #[arg(long = "rule", value_name = "NAME=paper|mended", value_parser = rule)]
    pub(crate) rules: Vec<(String, String)>,

    /// Record for other programs: images (png, npy), points, maps, mcap (a bag of ROS 2), or all. Poses and sectors always are.
    #[arg(long, value_name = "WHAT", value_delimiter = ',', value_parser = record)]
    pub(crate) record: Vec<String>,

    /// Take the stripes from DIR/stripes.npy, as a recording has them, instead of the rover's own extraction.
    #[arg(long, value_name = "DIR")]
    pub(crate) stripes: Option<PathBuf>,

    /// Renderer of the rover's images.
    #[arg(long, value_name = "NAME", default_value = DRIVE_WITH)]
    pub(crate) with: String,

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

#[derive(Debug, Args)]
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

    /// Write a pack of rays: SCENE is a mesh, and these are rays on it, both as `cast` takes them.
    #[arg(
        long,
        value_name = "RAYS",
        requires = "scene",
        conflicts_with_all = ["blind", "no_bench", "input", "fan", "thickness", "flux", "at", "heading", "settings"]
    )]
    pub(crate) rays: Option<PathBuf>,

    /// With --rays: let rays pass through the backs of faces.
    #[arg(long, requires = "rays")]
    pub(crate) fronts_only: bool,

    /// Output folder.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
}

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true)]
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
    #[arg(long, value_name = "SCENE.toml", requires = "scenes")]
    pub(crate) rig: Option<PathBuf>,

    /// Hunt in another renderer: the shell runs this for each scene, with {pack} replaced by the folder of a pack without
    /// answers and {out} by that for the answers, as `check` takes them. What it answers wrongly is left as packs of single rays.
    #[arg(long, value_name = "'PROGRAM {pack} {out}'")]
    pub(crate) candidate_command: Option<String>,

    /// Output folder; a campaign that was interrupted there is resumed.
    #[arg(short, long, value_name = "DIR", default_value = "out/campaign")]
    pub(crate) output: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct CampaignMerge {
    /// Folders with the results of the shards.
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folders: Vec<PathBuf>,

    /// Folder for summary.json; without it none is written.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Args)]
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

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true)]
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

    /// Renderers; default: scanline,tracer to validate, else scanline.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(crate) with: Vec<String>,

    /// With --do drive: drive as the paper prints it.
    #[arg(long)]
    pub(crate) as_printed: bool,

    /// Draw a result against a parameter; with a second parameter, a line for each of its values. May be repeated. The
    /// main results are drawn against each parameter anyhow.
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

#[derive(Debug, Args)]
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

#[derive(Debug, Args)]
pub(crate) struct Check {
    /// Folder of the reference pack, with its manifest.json, of an input pack, or of a pack of rays.
    #[arg(value_name = "PACK")]
    pub(crate) pack: PathBuf,

    /// Folder of the answers to check: EXR, NPY or PFM files, named as docs/formats/files.md says. For an input pack:
    /// triangles.npy, and reflectivity.npy if there is one. For a pack of rays: arrays as `cast` writes them.
    #[arg(value_name = "CANDIDATE")]
    pub(crate) candidate: PathBuf,

    /// Arithmetic in which the answers were computed, which may differ from their storage. Default: as their
    /// candidate.json says, else f64.
    #[arg(long, value_name = "ARITHMETIC", value_parser = precision())]
    pub(crate) arithmetic: Option<Precision>,

    /// Number that means "no hit" in every channel of numbers, such as 0, -1 or nan. Numbers that are not finite, and
    /// faces of -1 or 4294967295, always do.
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    pub(crate) miss: Option<f64>,

    /// Leave out the channel of faces, face.I.
    #[arg(long)]
    pub(crate) no_faces: bool,

    /// Folder for report.html, junit.xml and check.json; without it none are written.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Args)]
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
    pub(crate) switches: SwitchArguments,
}

#[derive(Debug, Args)]
pub(crate) struct Cast {
    /// A mesh: .glb, .gltf, .stl, .obj or .ply, or a folder with vertices.npy and faces.npy. Or a scene file (.toml) with
    /// tables [[rays]]: its terrain, and its own sets of rays unless others are given; its camera and beams are left out.
    #[arg(value_name = "MESH")]
    pub(crate) mesh: PathBuf,

    /// Rays: NPY of shape (..., 6) or (..., 8), or CSV: origin, direction, and if wanted t_min and t_max. `-` is standard
    /// input. Or sets of rays, such as patterns of LiDAR: TOML with tables [[rays]].
    #[arg(value_name = "RAYS", conflicts_with = "ray")]
    pub(crate) rays: Option<PathBuf>,

    /// A ray by its numbers, separated by commas: ox,oy,oz,dx,dy,dz and if wanted t_min,t_max. Its answers are printed.
    /// May be repeated.
    #[arg(long, value_name = "NUMBERS", value_parser = ray, allow_hyphen_values = true)]
    pub(crate) ray: Vec<CastRay>,

    /// Let rays pass through the backs of faces. Without it both sides are hit.
    #[arg(long)]
    pub(crate) fronts_only: bool,

    /// Ask for all hits of each ray, in exact order.
    #[arg(long)]
    pub(crate) all: bool,

    /// Ask whether each ray hits anything.
    #[arg(long)]
    pub(crate) any: bool,

    /// Ask how far each ray may be moved sideways, parallel to itself, before its answer changes.
    #[arg(long)]
    pub(crate) margins: bool,

    /// Set a key of the scene file MESH, as in `validate`. May be repeated.
    #[arg(long, value_name = "KEY=VALUE", value_parser = setting)]
    pub(crate) set: Vec<Setting>,

    /// Compare a renderer's first hits with the exact ones, ray by ray. Exit code 1: a ray is wrong, or nothing is hit.
    #[arg(long, value_name = "RENDERER", value_parser = ["tracer"])]
    pub(crate) with: Option<String>,

    /// Folder for the answers: NPY arrays of the rays' own shape, and summary.json. For sets of rays also point clouds and
    /// pictures; several sets have a folder each.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct Diff {
    /// A file or a folder.
    #[arg(value_name = "A")]
    pub(crate) a: PathBuf,

    /// The file or folder to compare it with.
    #[arg(value_name = "B")]
    pub(crate) b: PathBuf,

    /// Allow an absolute difference of X, in the unit of the channel. A cell passes if --fail, --fail-relative or
    /// --fail-ulp allows its difference.
    #[arg(long, value_name = "X", default_value = "0", value_parser = threshold)]
    pub(crate) fail: f64,

    /// Allow a relative difference of X, relative to the larger of both numbers.
    #[arg(long, value_name = "X", default_value = "0", value_parser = threshold)]
    pub(crate) fail_relative: f64,

    /// Allow a difference of N units in the last place of the file with the lower precision.
    #[arg(long, value_name = "N", default_value = "0", value_parser = threshold)]
    pub(crate) fail_ulp: f64,

    /// Allow P percent of the cells of a channel to fail.
    #[arg(long, value_name = "P", default_value = "0", value_parser = percent)]
    pub(crate) fail_percent: f64,

    /// Fail if any cell differs by more than X, whatever the other options allow.
    #[arg(long, value_name = "X", value_parser = threshold)]
    pub(crate) hard_fail: Option<f64>,

    /// Ignore channels that only one side has.
    #[arg(long)]
    pub(crate) shared_only: bool,

    /// The scene of both recordings. The referee then rules on each cell that differs by more than is allowed, and a
    /// channel fails only if a side is wrong. A built-in terrain, a scene .toml, a terrain (.glb, .gltf,
    /// .stl, .obj, .ply) or a .tif.
    #[arg(long, value_name = "SCENE")]
    pub(crate) scene: Option<String>,

    /// Set a key of the scene file SCENE, as in `validate`. May be repeated.
    #[arg(long, value_name = "KEY=VALUE", requires = "scene", value_parser = setting)]
    pub(crate) set: Vec<Setting>,

    /// Arithmetic in which both recordings were computed, for the referee.
    #[arg(long, value_name = "ARITHMETIC", default_value = "f64", requires = "scene", value_parser = precision())]
    pub(crate) arithmetic: Precision,

    /// Folder for report.html, junit.xml and summary.json; without it none are written.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum TerrainCommand {
    /// Generate a Mars-like terrain with relief, rocks, craters and crevasses.
    Generate(TerrainGenerate),
    /// Convert an elevation model (GeoTIFF) or a mesh (STL, OBJ, PLY, glTF) to a GLB terrain.
    Import(TerrainImport),
    /// Report the faults of a mesh, and repair those with only one possible repair. Exit code 1: the mesh has faults.
    Inspect(TerrainInspect),
}

#[derive(Debug, Args)]
pub(crate) struct TerrainInspect {
    /// A terrain (.glb, .gltf, .stl, .obj, .ply), a scene .toml, or a built-in terrain (pyramids, facets).
    #[arg(value_name = "MESH")]
    pub(crate) mesh: String,

    /// Set a key of the scene file MESH, as in `validate`. May be repeated.
    #[arg(long, value_name = "KEY=VALUE", value_parser = setting)]
    pub(crate) set: Vec<Setting>,

    /// Remove faces without area, duplicate faces and unused vertices, weld vertices at the same position, and flip
    /// inverted faces. The exit code is then that of the repaired mesh.
    #[arg(long, requires = "output")]
    pub(crate) repair: bool,

    /// File for the repaired mesh, a .glb other than MESH.
    #[arg(short, long, value_name = "OUT.glb", requires = "repair")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct TerrainGenerate {
    /// Preset of all parameters: smooth, viking1, pathfinder, crater_field, crevassed or worst (docs/guide/terrain.md).
    #[arg(long, value_name = "NAME", default_value = "viking1")]
    pub(crate) preset: String,

    /// Seed of all random numbers; the same seed gives the same terrain.
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    pub(crate) seed: u64,

    /// Side length of the square terrain, metres.
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub(crate) extent: Option<f64>,

    /// Distance between neighbouring posts, metres.
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub(crate) post_spacing: Option<f64>,

    /// Distance from the middle within which posts stand at a quarter of the spacing, metres; within 2.5 times of it
    /// they stand at half. 0: one spacing everywhere.
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub(crate) fine_radius: Option<f64>,

    /// Fraction of the area that rocks cover, 0 to 0.4.
    #[arg(long, value_name = "K", allow_hyphen_values = true)]
    pub(crate) rock_coverage: Option<f64>,

    /// Diameter of the smallest rocks, metres.
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub(crate) rock_smallest: Option<f64>,

    /// Number of crevasses.
    #[arg(long, value_name = "N")]
    pub(crate) crevasses: Option<u32>,

    /// Elevation model (GeoTIFF) whose posts the surface interpolates; the terrain gets its extent.
    #[arg(long, value_name = "DEM", conflicts_with = "extent")]
    pub(crate) coarse: Option<PathBuf>,

    /// Output file.
    #[arg(short, long, value_name = "FILE.glb")]
    pub(crate) output: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct TerrainImport {
    /// An elevation model: a GeoTIFF with one band, in metres. Or a mesh: .stl, .obj, .ply, .glb or .gltf.
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,

    /// Axis of a mesh that points up. Without it: y for glTF, as its specification says, z for STL, OBJ and PLY.
    #[arg(long, value_name = "AXIS", value_parser = up_axis())]
    pub(crate) up: Option<UpAxis>,

    /// Metres for each unit of a mesh: 0.001 if the file is in millimetres. Without it: 1.
    #[arg(long, value_name = "FACTOR", allow_hyphen_values = true)]
    pub(crate) scale: Option<f64>,

    /// Import only the posts in this window: x and y of its lower left corner, width and height, metres of the map.
    #[arg(long, value_name = "X,Y,W,H", value_parser = numbers::<4>, allow_hyphen_values = true)]
    pub(crate) window: Option<[f64; 4]>,

    /// Simplify the mesh; maximum vertical distance of a post from the simplified terrain, metres.
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub(crate) max_error: Option<f64>,

    /// Reflectivity of the terrain, 0 to 1; in glTF, of the materials that state none.
    #[arg(long, value_name = "R", default_value_t = DEFAULT_REFLECTIVITY, allow_hyphen_values = true)]
    pub(crate) reflectivity: f64,

    /// Output file.
    #[arg(short, long, value_name = "FILE.glb")]
    pub(crate) output: PathBuf,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_arguments_are_well_formed() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn typed_arguments_are_quoted_for_a_shell() {
        let parse = |words: &[&str]| {
            let words = ["raypencil", "validate"].into_iter().chain(words.iter().copied());
            match Arguments::try_parse_from(words).unwrap().command {
                Some(Command::Validate(validate)) => validate.scene.typed(),
                other => panic!("{other:?}"),
            }
        };
        assert_eq!(parse(&[]), "pyramids");
        assert_eq!(
            parse(&["my yard.glb", "--at", "-1.5,2", "--heading", "-90", "--fan", "120"]),
            "'my yard.glb' --fan 120 --at -1.5,2 --heading -90"
        );
    }
}
