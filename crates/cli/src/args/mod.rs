//! The arguments of the command line. Their doc comments are the help texts.
//!
//! This file has the command itself; below it, a file for each of its commands, and one for each group of arguments that
//! several commands share.

mod campaign;
mod cast;
mod check;
mod diff;
mod drive;
mod minimise;
mod pack;
mod probe;
mod render;
mod renderers;
mod scene;
mod sweep;
mod terrain;
mod validate;

use clap::{Parser, Subcommand};

pub(crate) use campaign::{Campaign, CampaignCommand, CampaignMerge, CampaignReplay, CampaignRun};
pub(crate) use cast::Cast;
pub(crate) use check::Check;
pub(crate) use diff::Diff;
pub(crate) use drive::Drive;
pub(crate) use minimise::Minimise;
pub(crate) use pack::Pack;
pub(crate) use probe::Probe;
pub(crate) use render::Render;
pub(crate) use renderers::{DEFAULT_WITH, DRIVE_WITH, SwitchArguments, typed_renderers};
pub(crate) use scene::{SceneArguments, typed_setting};
pub(crate) use sweep::{Sweep, SweepCommand, SweepMerge, SweepRun};
pub(crate) use terrain::{TerrainCommand, TerrainGenerate, TerrainImport, TerrainInspect};
pub(crate) use validate::Validate;

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
