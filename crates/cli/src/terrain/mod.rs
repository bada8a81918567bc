//! `raypencil terrain`: grounds as files.

mod inspect;

use crate::args::TerrainCommand;
use crate::{Outcome, Trouble};

pub(crate) fn terrain(command: &TerrainCommand, json: bool) -> Result<Outcome, Trouble> {
    match command {
        TerrainCommand::Inspect(command) => inspect::inspect(command, json),
    }
}
