//! `raypencil terrain`: generates, imports and inspects terrains.

mod generate;
mod import;
mod import_mesh;
mod inspect;
mod output;

use crate::args::TerrainCommand;
use crate::{Outcome, Trouble};

pub(crate) fn terrain(command: &TerrainCommand, json: bool) -> Result<Outcome, Trouble> {
    match command {
        TerrainCommand::Generate(command) => generate::generate(command, json),
        TerrainCommand::Import(command) => import::import(command, json),
        TerrainCommand::Inspect(command) => inspect::inspect(command, json),
    }
}
