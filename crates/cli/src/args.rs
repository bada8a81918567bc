//! The command line's words.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use raypencil::Fidelity;
use raypencil::campaign::Shard;
use raypencil::io::Overrides;
use raypencil::io::quoted;
use raypencil::{FluxModel, Precision};

/// A Mars rover's structured-light vision, simulated twice by two unlike algorithms and compared ray by ray.
///
/// Without a command it validates the built-in pyramids into out/pyramids.
///
/// Exit codes are those of diff: 0 all agree, 1 a defect or difference, 2 trouble.
#[derive(Debug, Parser)]
#[command(name = "raypencil", version)]
pub(crate) struct Arguments {
    /// Print JSON instead of a screen.
    #[arg(long, global = true)]
    pub(crate) json: bool,

    /// Worker threads; all cores if not given. Results do not depend on it.
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,

    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a scene with every renderer, compare every ray, write maps and a report.
    Validate(Validate),
    /// Render a scene with one renderer and write its maps.
    Render(Render),
    /// Everything about one ray, from every renderer.
    Probe(Probe),
    /// Write a scene, its rays and every answer, correctly rounded, for other renderers to check themselves against.
    Pack(Pack),
    /// Judge another program's answers by a pack, ray by ray.
    Check(Check),
    /// Look hard: many random terrains, both renderers, every difference judged.
    Campaign(Campaign),
    /// Find the smallest scene on which two renderers still differ so. Exit code 1: they do not.
    Minimise(Minimise),
    /// Drive a rover: images, stripes, terrain map, obstacle map, navigator map, frame by frame.
    Drive(Drive),
    /// Compare two recordings of anything, channel by channel: files or folders of EXR, NPY and PFM.
    Diff(Diff),
    /// Grounds as files: make, import, inspect.
    #[command(subcommand)]
    Terrain(TerrainCommand),
}

/// Which scene.
#[derive(Debug, Args)]
pub(crate) struct SceneArguments {
    /// A built-in ground (pyramids, facets), a scene .toml, a terrain .glb or .gltf, or an elevation model .tif.
    #[arg(value_name = "SCENE", default_value = "pyramids")]
    pub(crate) scene: String,

    /// Full fan angle of every beam, degrees.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub(crate) fan: Option<f64>,

    /// Thickness of every beam's sheet, millimetres.
    #[arg(long, value_name = "MM", allow_hyphen_values = true)]
    pub(crate) thickness: Option<f64>,

    /// Equation of a pencil's flux; the scene's own if not given.
    #[arg(long, value_name = "MODEL")]
    pub(crate) flux: Option<FluxWord>,

    /// Stand here on the ground: global x,y in metres.
    #[arg(long, value_name = "X,Y", value_parser = pair::<f64>, allow_hyphen_values = true)]
    pub(crate) at: Option<[f64; 2]>,

    /// Heading, degrees to the left of the global x axis.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub(crate) heading: Option<f64>,
}

impl SceneArguments {
    pub(crate) fn overrides(&self) -> Overrides {
        Overrides {
            at: self.at,
            heading_deg: self.heading,
            fan_deg: self.fan,
            thickness_mm: self.thickness,
            flux_model: self.flux.map(|word| match word {
                FluxWord::Radiometric => FluxModel::Radiometric,
                FluxWord::Eq1 => FluxModel::Eq1,
            }),
        }
    }

    /// These arguments again, as one would type them.
    pub(crate) fn typed(&self) -> String {
        let mut words = vec![quoted(&self.scene)];
        if let Some(fan) = self.fan {
            words.push(format!("--fan {fan}"));
        }
        if let Some(thickness) = self.thickness {
            words.push(format!("--thickness {thickness}"));
        }
        match self.flux {
            Some(FluxWord::Radiometric) => words.push("--flux radiometric".into()),
            Some(FluxWord::Eq1) => words.push("--flux eq1".into()),
            None => {}
        }
        if let Some([x, y]) = self.at {
            words.push(format!("--at {x},{y}"));
        }
        if let Some(heading) = self.heading {
            words.push(format!("--heading {heading}"));
        }
        words.join(" ")
    }
}

/// What `--flux` takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FluxWord {
    /// What a pencil's watts really deliver, in watts.
    Radiometric,
    /// Equation (1) of the paper as printed, in W/m.
    Eq1,
}

/// Which sides of the scanline renderer's switches.
#[derive(Debug, Default, Args)]
pub(crate) struct SwitchArguments {
    /// Set a switch of the scanline renderer to the paper's approximation or to exact: beam-edges, skip-rules,
    /// facing, extent, place. May be given several times.
    #[arg(long = "switch", value_name = "NAME=paper|exact", value_parser = switch)]
    pub(crate) set: Vec<(String, Fidelity)>,
}

/// The renderers that are compared if none are named.
pub(crate) const DEFAULT_WITH: [&str; 2] = ["scanline", "tracer"];

/// The renderer of a drive if none is named: it takes half the time of `tracer`, on 224 faces as on 225,280.
pub(crate) const DRIVE_WITH: &str = "scanline";

/// The words that choose renderers, as one would type them after a scene; nothing for the default.
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

/// What `--judge` takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum JudgeWhich {
    /// One in a hundred or more.
    Sample,
    /// Every ray.
    All,
}

#[derive(Debug, Args)]
pub(crate) struct Validate {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,

    /// Renderers to compare, two or more.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', default_values = DEFAULT_WITH)]
    pub(crate) with: Vec<String>,

    #[command(flatten)]
    pub(crate) switches: SwitchArguments,

    /// Which of the rays that agree the referee rules on as well; it always rules on those that do not.
    #[arg(long, value_name = "WHICH", default_value = "sample")]
    pub(crate) judge: JudgeWhich,

    /// A folder with another program's answers to this scene, held to the truth beside ours. May be given several times.
    #[arg(long = "candidate", value_name = "DIR")]
    pub(crate) candidates: Vec<PathBuf>,

    /// Folder to write to; out/<scene's name> if not given.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

impl Validate {
    /// What `raypencil` does without a command.
    pub(crate) fn pyramids() -> Self {
        Self {
            scene: SceneArguments {
                scene: "pyramids".into(),
                fan: None,
                thickness: None,
                flux: None,
                at: None,
                heading: None,
            },
            with: DEFAULT_WITH.map(String::from).to_vec(),
            switches: SwitchArguments::default(),
            judge: JudgeWhich::Sample,
            candidates: Vec::new(),
            output: None,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct Render {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,

    /// The renderer.
    #[arg(long, value_name = "NAME")]
    pub(crate) with: String,

    /// Draw one ray at random within each pencil, by this seed, instead of its central ray.
    #[arg(long, value_name = "SEED", allow_hyphen_values = true)]
    pub(crate) jitter: Option<u64>,

    #[command(flatten)]
    pub(crate) switches: SwitchArguments,

    /// Folder to write to.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct Drive {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,

    /// Drive here, in metres of the global frame, in place of where the scene's own drive goes; may be given several times.
    /// From where the scene's vehicle stands.
    #[arg(long, value_name = "X,Y", value_parser = pair::<f64>, allow_hyphen_values = true)]
    pub(crate) to: Vec<[f64; 2]>,

    /// The renderer of the rover's images.
    #[arg(long, value_name = "NAME", default_value = DRIVE_WITH)]
    pub(crate) with: String,

    /// Drive scanline and tracer in lockstep, and tell how far a difference of theirs gets. Exit code 1: to a pixel of the
    /// digital image, or farther.
    #[arg(long, conflicts_with = "with")]
    pub(crate) both: bool,

    #[command(flatten)]
    pub(crate) switches: SwitchArguments,

    /// Folder to write to; out/<scene's name>-drive if not given.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct Pack {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,

    /// Write the questions alone, of a hostile scene that this seed makes; `check` makes the answers from it again.
    #[arg(long, value_name = "SEED", conflicts_with_all = ["scene", "fan", "thickness", "flux", "at", "heading"])]
    pub(crate) blind: Option<u64>,

    /// Folder to write to.
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
    /// Put the results of all shards together, in any order.
    Merge(CampaignMerge),
    /// Write a scene of a terrain, to look at one of its rays again.
    Replay(CampaignReplay),
}

#[derive(Debug, Args)]
pub(crate) struct CampaignRun {
    /// How many terrains.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub(crate) terrains: u64,

    /// Of everything that is drawn: the same seed is the same campaign.
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    pub(crate) seed: u64,

    /// Run part I of N of the campaign, from 1; the parts are put together by `campaign merge`.
    #[arg(long, value_name = "I/N", value_parser = shard, default_value = "1/1")]
    pub(crate) shard: Shard,

    /// Folder to write to; a campaign that was broken off there goes on.
    #[arg(short, long, value_name = "DIR", default_value = "out/campaign")]
    pub(crate) output: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct CampaignMerge {
    /// Folders with the results of shards.
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folders: Vec<PathBuf>,

    /// Folder to write summary.json to; none is written if not given.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct CampaignReplay {
    /// The campaign's seed.
    #[arg(long, value_name = "SEED")]
    pub(crate) seed: u64,

    /// The terrain's number.
    #[arg(long, value_name = "K")]
    pub(crate) terrain: u64,

    /// Which of its scenes.
    #[arg(long, value_name = "PART", default_value = "own")]
    pub(crate) part: PartWord,

    /// Folder to write scene.toml and its terrain to.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
}

/// What `--part` takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum PartWord {
    /// A random rig's own sensors.
    Own,
    /// The same, with the paper's approximations.
    Paper,
    /// Narrow sensors at what is hard.
    Aimed,
    /// A lattice whose vertices lie exactly on rays.
    Lattice,
}

/// `I/N`, from 1.
fn shard(text: &str) -> Result<Shard, String> {
    let wrong = || "expected a part and how many there are, such as 2/4".to_string();
    let (index, count) = text.split_once('/').ok_or_else(wrong)?;
    let one = |text: &str| text.trim().parse::<u64>().map_err(|_| wrong());
    match (one(index)?, one(count)?) {
        (index, count) if (1..=count).contains(&index) => Ok(Shard { index: index - 1, count }),
        _ => Err(wrong()),
    }
}

#[derive(Debug, Args)]
pub(crate) struct Minimise {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,

    /// What two renderers must differ by, on one ray at least.
    #[arg(long, value_name = "CLASS", default_value = "defect")]
    pub(crate) class: ClassWord,

    /// The two renderers.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', default_values = DEFAULT_WITH)]
    pub(crate) with: Vec<String>,

    #[command(flatten)]
    pub(crate) switches: SwitchArguments,

    /// Folder to write the smallest scene to.
    #[arg(short, long, value_name = "DIR", default_value = "out/minimised")]
    pub(crate) output: PathBuf,
}

/// What `--class` takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ClassWord {
    /// One of them is wrong.
    Defect,
    /// The referee could not tell.
    Undecided,
    /// An approximation of the paper.
    Approximation,
    /// Faces nearer to each other, or to the ray, than rounding.
    Rounding,
    /// Several faces met at exactly the same point.
    Tie,
}

#[derive(Debug, Args)]
pub(crate) struct Check {
    /// Folder of the pack, with its manifest.json.
    #[arg(value_name = "PACK")]
    pub(crate) pack: PathBuf,

    /// Folder of the answers to judge: EXR, NPY or PFM files with the names of docs/formats/files.md.
    #[arg(value_name = "CANDIDATE")]
    pub(crate) candidate: PathBuf,

    /// The arithmetic that the answers were computed in, whatever they are stored as. If not given, what their own
    /// candidate.json says; without one f64.
    #[arg(long, value_name = "ARITHMETIC")]
    pub(crate) arithmetic: Option<ArithmeticWord>,

    /// Folder to write junit.xml and check.json to.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

/// What `--arithmetic` takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ArithmeticWord {
    /// Double precision.
    F64,
    /// Single precision.
    F32,
}

impl ArithmeticWord {
    pub(crate) fn precision(self) -> Precision {
        match self {
            Self::F64 => Precision::F64,
            Self::F32 => Precision::F32,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct Probe {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,

    /// Index of the beam whose pencil to probe, from 0.
    #[arg(long, value_name = "N", requires = "pencil", conflicts_with = "pixel")]
    pub(crate) beam: Option<usize>,

    /// Column and row of the pencil, from 0; row 0 is on top.
    #[arg(long, value_name = "I,J", value_parser = pair::<u32>, requires = "beam")]
    pub(crate) pencil: Option<[u32; 2]>,

    /// Column and row of the camera's pixel, from 0; row 0 is on top.
    #[arg(long, value_name = "I,J", value_parser = pair::<u32>, required_unless_present = "beam")]
    pub(crate) pixel: Option<[u32; 2]>,

    /// Renderers to ask.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', default_values = DEFAULT_WITH)]
    pub(crate) with: Vec<String>,

    #[command(flatten)]
    pub(crate) switches: SwitchArguments,
}

#[derive(Debug, Args)]
pub(crate) struct Diff {
    /// A file or a folder.
    #[arg(value_name = "A")]
    pub(crate) a: PathBuf,

    /// Another one.
    #[arg(value_name = "B")]
    pub(crate) b: PathBuf,

    /// Allow an absolute difference of X, in the channel's unit. A cell passes if any of --fail, --fail-relative
    /// and --fail-ulp allows its difference.
    #[arg(long, value_name = "X", default_value = "0", value_parser = threshold)]
    pub(crate) fail: f64,

    /// Allow a difference of X relative to the larger of the two numbers.
    #[arg(long, value_name = "X", default_value = "0", value_parser = threshold)]
    pub(crate) fail_relative: f64,

    /// Allow a difference of N units in the last place of the coarser of the two files.
    #[arg(long, value_name = "N", default_value = "0", value_parser = threshold)]
    pub(crate) fail_ulp: f64,

    /// Allow P percent of a channel's cells to differ.
    #[arg(long, value_name = "P", default_value = "0", value_parser = percent)]
    pub(crate) fail_percent: f64,

    /// Fail if any cell differs by more than X, whatever else is allowed.
    #[arg(long, value_name = "X", value_parser = threshold)]
    pub(crate) hard_fail: Option<f64>,

    /// Do not fail for channels that only one side has.
    #[arg(long)]
    pub(crate) shared_only: bool,

    /// The scene that both recorded: the referee rules on each cell that differs by more than is allowed, and only
    /// a side that is wrong fails. A built-in ground, a scene .toml (of a pack, too), a .glb or .gltf, a .tif.
    #[arg(long, value_name = "SCENE")]
    pub(crate) scene: Option<String>,

    /// The arithmetic that both were computed in, for the referee.
    #[arg(long, value_name = "ARITHMETIC", default_value = "f64", requires = "scene")]
    pub(crate) arithmetic: ArithmeticWord,

    /// Folder for report.html, junit.xml and summary.json; none are written if not given.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum TerrainCommand {
    /// Make ground as Mars has it: relief, rocks, craters and crevasses by their laws.
    Generate(TerrainGenerate),
    /// Make a GLB terrain of an elevation model (GeoTIFF).
    Import(TerrainImport),
    /// Tell what is wrong with a mesh, and mend what needs no guess. Exit code 1: something is.
    Inspect(TerrainInspect),
}

#[derive(Debug, Args)]
pub(crate) struct TerrainInspect {
    /// A terrain .glb or .gltf, a scene .toml, or a built-in ground (pyramids, facets).
    #[arg(value_name = "MESH")]
    pub(crate) mesh: String,

    /// Drop faces without area, copies of faces and unused vertices, weld vertices in one place, turn faces that are
    /// the wrong way round; the exit code is then that of what is left.
    #[arg(long, requires = "output")]
    pub(crate) repair: bool,

    /// The repaired mesh, a .glb file other than MESH.
    #[arg(short, long, value_name = "OUT.glb", requires = "repair")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct TerrainGenerate {
    /// Where all numbers start from: smooth, viking1, pathfinder, crater_field, crevassed or worst; docs/guide/terrain.md.
    #[arg(long, value_name = "NAME", default_value = "viking1")]
    pub(crate) preset: String,

    /// Which of the grounds with these numbers.
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    pub(crate) seed: u64,

    /// Side of the square, metres.
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub(crate) extent: Option<f64>,

    /// Distance of its posts, metres.
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub(crate) post_spacing: Option<f64>,

    /// Share of the ground that rocks cover, 0 to 0.4.
    #[arg(long, value_name = "K", allow_hyphen_values = true)]
    pub(crate) rock_coverage: Option<f64>,

    /// Diameter of the smallest rocks, metres.
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub(crate) rock_smallest: Option<f64>,

    /// How many crevasses.
    #[arg(long, value_name = "N")]
    pub(crate) crevasses: Option<u32>,

    /// An elevation model (GeoTIFF) whose posts the surface passes through; the ground is as large as it is.
    #[arg(long, value_name = "DEM", conflicts_with = "extent")]
    pub(crate) coarse: Option<PathBuf>,

    /// The GLB file to write.
    #[arg(short, long, value_name = "FILE.glb")]
    pub(crate) output: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct TerrainImport {
    /// A GeoTIFF of one band, in metres.
    #[arg(value_name = "DEM")]
    pub(crate) dem: PathBuf,

    /// Take the posts in this part alone: x and y of its lower left corner, width and height, metres of the map.
    #[arg(long, value_name = "X,Y,W,H", value_parser = numbers::<4>, allow_hyphen_values = true)]
    pub(crate) window: Option<[f64; 4]>,

    /// Make fewer faces, so that no post is farther from the ground than this along z, metres.
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub(crate) max_error: Option<f64>,

    /// Reflectivity of the ground, 0 to 1.
    #[arg(long, value_name = "R", default_value_t = raypencil::io::DEFAULT_REFLECTIVITY, allow_hyphen_values = true)]
    pub(crate) reflectivity: f64,

    /// The GLB file to write.
    #[arg(short, long, value_name = "FILE.glb")]
    pub(crate) output: PathBuf,
}

/// A number that may be allowed to differ: finite and not negative.
fn threshold(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number >= 0.0 && number.is_finite() => Ok(number),
        _ => Err("expected a number from 0 on, such as 1e-6".into()),
    }
}

/// A share of all cells.
fn percent(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if (0.0..=100.0).contains(&number) => Ok(number),
        _ => Err("expected a share from 0 to 100 percent".into()),
    }
}

/// `NAME=paper` or `NAME=exact`; the name is judged where the switches are known.
fn switch(text: &str) -> Result<(String, Fidelity), String> {
    let (name, side) = text.split_once('=').unwrap_or((text, ""));
    match side {
        "paper" => Ok((name.into(), Fidelity::Paper)),
        "exact" => Ok((name.into(), Fidelity::Exact)),
        _ => Err("expected a switch and its side, such as beam-edges=paper or skip-rules=exact".into()),
    }
}

/// As many numbers with commas between them.
fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let all: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    all.ok()
        .and_then(|all| all.try_into().ok())
        .ok_or_else(|| format!("expected {N} numbers with commas between them"))
}

/// `A,B`.
fn pair<T: std::str::FromStr>(text: &str) -> Result<[T; 2], String> {
    let wrong = || "expected two numbers with a comma between them, such as 3,4".to_string();
    let (a, b) = text.split_once(',').ok_or_else(wrong)?;
    let one = |text: &str| text.trim().parse().map_err(|_| wrong());
    Ok([one(a)?, one(b)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_words_are_well_formed() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn what_was_typed_comes_back_as_a_shell_would_take_it() {
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
