//! `raypencil terrain`: grounds from elsewhere.

mod import;

use crate::args::TerrainCommand;
use crate::{Outcome, Trouble};

pub(crate) fn terrain(command: &TerrainCommand, json: bool) -> Result<Outcome, Trouble> {
    match command {
        TerrainCommand::Import(command) => import::import(command, json),
    }
}
