//! The arguments of the command line. Their doc comments are the help texts.
//!
//! This file has the command itself; below it, a file for each of its commands, and one for each group of arguments that
//! several commands share.

mod campaign;
mod cast;
mod check;
mod completions;
mod declared;
mod diff;
mod drive;
mod everywhere;
mod help;
mod minimise;
mod pack;
mod pages;
mod probe;
mod render;
mod renderers;
mod scene;
mod scene_command;
mod sweep;
mod terrain;
mod validate;

use std::ffi::OsString;

use clap::{ColorChoice, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum};

pub(crate) use campaign::{Campaign, CampaignCommand, CampaignMerge, CampaignReplay, CampaignRun};
pub(crate) use cast::Cast;
pub(crate) use check::Check;
pub(crate) use completions::Completions;
pub(crate) use declared::DeclaredArguments;
pub(crate) use diff::Diff;
pub(crate) use drive::Drive;
pub(crate) use everywhere::Everywhere;
pub(crate) use minimise::Minimise;
pub(crate) use pack::Pack;
pub(crate) use pages::{ManPages, ReferencePages};
pub(crate) use probe::Probe;
pub(crate) use render::Render;
pub(crate) use renderers::{DEFAULT_WITH, SwitchArguments, typed_renderers};
pub(crate) use scene::{SceneArguments, typed_setting};
pub(crate) use scene_command::{SceneCommand, SceneInit, SceneShow};
pub(crate) use sweep::{Sweep, SweepCommand, SweepMerge, SweepRun};
pub(crate) use terrain::{TerrainCommand, TerrainGenerate, TerrainImport, TerrainInspect};
pub(crate) use validate::Validate;

/// Simulates a Mars rover's structured-light vision system with two independent renderers and compares every ray.
///
/// Without a command it validates the built-in terrain `pyramids` and writes to out/pyramids.
///
/// Exit codes: 0 all agree, 1 a defect or a difference, 2 an error.
#[derive(Debug, Parser)]
#[command(
    name = "raypencil",
    version,
    after_help = "Examples:
  # Simulate twice, compare every ray, and leave out/pyramids/report.html.
  raypencil
  # A ground of your own.
  raypencil validate ground.glb
  # A renderer of your own, on 3,170 rays, most of them hard.
  raypencil check data/packs/hard my-renders"
)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) everywhere: Everywhere,

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
    /// Show a scene with its units and a picture, or begin a scene file.
    #[command(
        subcommand,
        after_help = "Examples:
  # A scene file with every key, to be changed.
  raypencil scene init my-scene.toml
  # What a scene is, in numbers and as a picture of rig and ground.
  raypencil scene show pyramids -o out/pyramids.png"
    )]
    Scene(SceneCommand),
    /// Generate, import or inspect terrains.
    #[command(
        subcommand,
        after_help = "Examples:
  # Ground like that of the Viking 1 site.
  raypencil terrain generate --preset viking1 --seed 7 -o out/ground.glb
  # What is wrong with a mesh.
  raypencil terrain inspect ground.glb"
    )]
    Terrain(TerrainCommand),
    /// Print the script by which a shell completes the words of this command.
    Completions(Completions),
    /// Write the manual pages of this command and of all below it.
    Man(ManPages),
    /// Write the reference of the command line, as Markdown.
    #[command(hide = true)]
    Reference(ReferencePages),
}

/// The whole command line, as clap sees it.
pub(crate) fn command_line() -> clap::Command {
    help::with_groups(Arguments::command())
}

impl Arguments {
    /// Parses words, the program's name first. Help and errors have colours as `color` says.
    pub(crate) fn read(words: Vec<OsString>, color: ColorChoice) -> Result<Self, clap::Error> {
        let matches = command_line().color(color).try_get_matches_from(words)?;
        Self::from_arg_matches(&matches)
    }

    /// The value of `--color` among words that may be wrong otherwise: what clap says of them has colours too.
    pub(crate) fn color_of(words: &[OsString]) -> ColorChoice {
        let words = words.iter().map(|word| word.to_str().unwrap_or_default());
        let words: Vec<&str> = words.take_while(|word| *word != "--").collect();
        let given = words.iter().enumerate().rev().find_map(|(k, word)| match word.strip_prefix("--color") {
            Some("") => words.get(k + 1).copied(),
            Some(rest) => rest.strip_prefix('='),
            None => None,
        });
        given.and_then(|word| ColorChoice::from_str(word, false).ok()).unwrap_or_default()
    }
}

#[cfg(test)]
#[path = "../../tests/unit/arguments.rs"]
mod tests;
